"""Words that no step accounts for are named, clauses that are not understood are recorded as not done."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "what"),
    [
        ("a person raises both their hands to the left", "the side"),
        ("a person picks up a box from his left", "the side"),
        ("waving hands around near face", "face"),
        ("a person raises both arms to his chest", "chest"),
        ("a man waves forward", "forward"),
        ("a person claps and walks with the arms apart", "apart"),
        ("a person walks while boldly turning around", "boldly"),
        ("a person limps toward the end of the plane", "toward"),
        ("a person walks backwards and is dancing and squatting", "one after the other"),
    ],
)
def test_words_without_a_step_are_named(sentence: str, what: str) -> None:
    records = [record for record in parse(sentence).clauses if what in record.how]
    assert records
    assert all(record.status == APPROXIMATED for record in records)


@pytest.mark.parametrize(
    "sentence",
    [
        "a person walks a few steps forward, then backwards",
        "a person raises both arms and lowers them",
        "someone does two jumping jacks, then jumps up with both legs",
        "a person is walking forwards and then stumbling",
        "a man kicks with the right leg after bending down",
        "she takes a quick step to the right",
        "a person stirs something in front of him",
        "a person performs a walk with a 90 degree turn to the left",
        "a person sits down on the sofa and stands up quickly",
    ],
)
def test_nothing_is_named_where_all_is_shown(sentence: str) -> None:
    assert [(record.clause, record.how) for record in parse(sentence).clauses if record.status != DONE] == []


@pytest.mark.parametrize(
    ("sentence", "names", "missed"),
    [
        ("a person picks something up and then brushes an object", ["picking up"], 1),
        ("a person walks forward, the right arm comes over, then goes back, then he sits down",
         ["walking", "sitting down"], 2),
        ("a man sits down and pets an object", ["sitting down"], 1),
    ],
)  # fmt: skip
def test_a_clause_that_is_not_understood_is_not_done(sentence: str, names: list[str], missed: int) -> None:
    plan = parse(sentence, in_part=True)
    assert [step.name for step in plan.steps] == names
    assert sum(record.status == NOT_DONE for record in plan.clauses) == missed
    assert sum("is not done" in note for note in plan.notes) == missed


@pytest.mark.parametrize(
    "sentence",
    [
        "a person walks and then does a cartwheel",
        "a person brushes an object",
        "a person pets it, brushes an object, then walks",
        "a person walks, but never brushes an object",
    ],
)
def test_more_must_be_understood_than_missed(sentence: str) -> None:
    with pytest.raises(InputError):
        parse(sentence, in_part=True)


def test_labelled_data_is_parsed_whole() -> None:
    with pytest.raises(InputError, match="pets an object"):
        parse("a man sits down and pets an object")


@pytest.mark.parametrize(
    ("sentence", "names"),
    [
        ("a person takes a step forward and throws a ball", ["walking", "throwing"]),
        ("he is taking a step forward and throwing a ball", ["walking", "throwing"]),
        ("a person jogs and increases the pace", ["jogging"]),
        ("a person jumps up and down with arms away from the hips", ["jumping"]),
        ("a person prepares to jump, then jumps forward", ["standing", "jumping somewhere"]),
        ("with the right hand he does a circular movement", ["drawing a circle in the air"]),
    ],
)
def test_no_step_is_added(sentence: str, names: list[str]) -> None:
    assert [step.name for step in parse(sentence, in_part=True).steps] == names


def test_three_quarters_of_a_turn_are_270_degrees() -> None:
    assert [step.turn_deg for step in parse("a person makes a three-quarter turn").steps] == [270.0]


@pytest.mark.parametrize(
    ("sentence", "clauses"),
    [
        ("she juggles three balls", ["she juggles three balls"]),
        ("A person scratches their head, then walks left", ["A person scratches their head", "walks left"]),
        ("a person waves and frobnicates", ["a person waves", "frobnicates"]),
    ],
)  # fmt: skip
def test_clauses_are_recorded_in_the_sentence_s_own_words(sentence: str, clauses: list[str]):
    plan = parse(sentence, in_part=True)
    assert [record.clause for record in plan.clauses] == clauses
    for record in plan.clauses:
        assert record.status == DONE or any(repr(record.clause) in note for note in plan.notes)
