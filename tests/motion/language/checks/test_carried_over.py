"""What a part of a sentence shares with an earlier one: hands, counts, postures and places."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        (
            "a person picks something up with their left hand, then waves their hand",
            "that it is the left hand is not shown",
        ),
        (
            "a person walks forward, and uses their left hand to reach over the table and grab an object",
            "that it is the left hand is not shown",
        ),
        ("a person reaches forward with their left hand, then down to the floor twice", "only 2 are shown, all alike"),
        ("a person bends down and jumps up 3 times", "'bends down' is shown once only"),
        ("a man jumps in three different heights", "'three'"),
        (
            "a person is leaning over and swaying arms while walking forwards",
            "'leaning over' is shown before walking, not during it",
        ),
        ("a person jumps while moving his legs and holds his arms up over his head", "one after the other"),
        ("a person picks up a box on the right and puts it down on the left", "put down where it was picked up"),
        ("a person jogging up and down a short slope", "'up and down' is shown as one way"),
        (
            "a man is holding something with both hands and raises the right hand and returns it to item he is holding",
            "'returns it' is not shown",
        ),
        ("a person starts walking and takes eleven steps forward", "steps before the eleven are shown, too"),
    ],
)
def test_what_is_carried_over_is_said(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a person raises the left arm and then lowers their arm",
        "a person bends down and jumps up",
        "a person reaches forward twice",
        "a person picks up a box and puts it down",
        "a person jogs up and down the room",
        "a person picks something up on the left and walks to the right and puts it down",
        "a person takes eleven steps forward",
        "a person walks while holding both arms up",
    ],
)
def test_what_is_shown_has_no_note(sentence: str) -> None:
    plan = parse(sentence, in_part=True)
    assert all(record.status == "done" for record in plan.clauses), plan.notes
