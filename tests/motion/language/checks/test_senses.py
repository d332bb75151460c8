"""Words that a step shows in another sense than the sentence means."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        ("a person sweeps the left leg", "is shown as sweeping the floor with both hands"),
        ("a person does a small sweep with the right foot", "is shown as sweeping the floor"),
        ("a person does a sweep kick with the right foot", "'sweep' is shown as sweeping the floor"),
        ("the man picks up the soap and washes his left arm", "is shown as picking something up from the floor"),
        ("a person does a foot rise", "'rise' is shown as standing up"),
        (
            "the person walks, spins and continues walking until they reach about 3/4ths",
            "'reach' is shown as reaching out with a hand",
        ),
        ("a person moves their hands in one direction & runs in the other one", "'runs' is shown as one step"),
        ("a person does two side jumps", "'side jumps' is shown as jumping on the spot"),
        ("a person kicks steps to the right and then to the left", "'kicks steps' is shown as a kick before the steps"),
    ],
)
def test_another_sense_is_said(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a person tries to stand up",
        "a person bends down and attempts to stand back up",
        "a person is trying to walk",
        "a person struggles to get up",
    ],
)
def test_an_attempt_is_no_success(sentence: str) -> None:
    last = parse(sentence, in_part=True).clauses[-1]
    assert "shown as done, not only tried" in last.how


@pytest.mark.parametrize(
    "sentence",
    [
        "a person sweeps the floor",
        "a person reaches forward",
        "a person picks something up from the floor",
        "a person takes one step forward",
        "a person jumps to the side",
    ],
)
def test_the_usual_sense_has_no_note(sentence: str) -> None:
    plan = parse(sentence, in_part=True)
    assert all(record.status == "done" for record in plan.clauses), plan.notes
