"""Limbs, sides, ways and things of the sentence's plain words that no step has are named."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import APPROXIMATED, DONE
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "what"),
    [
        ("a person walks and sits down and stretches out both legs", "stretched out"),
        ("a person jumps from side to side", "side to side"),
        ("a person hops sideways on the right foot", "the side"),
        ("a man kicks, the left arm behind the back", "behind the back"),
        ("someone claps behind the back", "behind the back"),
        ("someone picks something up from a high shelf", "shelf"),
        ("a person hops on the left foot, then on the right", "other hand or foot"),
        ("the person moves their head in circles", "circles"),
        ("a man sits down and bows", "standing, after getting up"),
        ("a person opens a drawer", "drawer"),
        ("a person walks five steps forward, knees slightly bend", "knees"),
        ("someone bows with hands together", "hands together"),
        ("a person raises the right hand to his face", "to his face"),
        ("a man raises both arms and turns from side to side", "side to side"),
        ("a person dances jazz, jumping", "one after the other"),
        ("a woman wipes the table before returning to a neutral pose", "shown as standing"),
    ],
)
def test_what_the_patterns_lose_is_named(sentence: str, what: str) -> None:
    records = [record for record in parse(sentence).clauses if what in record.how]
    assert records
    assert all(record.status == APPROXIMATED for record in records)


@pytest.mark.parametrize(
    "sentence",
    [
        "a person leans to the left, then to the right",
        "a man is pushed from the left and stumbles to the right",
        "someone raises both arms out to the sides",
        "a person stands up to his feet and raises the right hand",
        "a woman walks five steps, starting with the left foot",
        "a man turns to face left",
        "someone shakes the head from side to side",
        "a person kicks with the left leg, then with the right leg",
    ],
)
def test_nothing_is_named_where_it_is_shown(sentence: str) -> None:
    assert {record.status for record in parse(sentence).clauses} == {DONE}


@pytest.mark.parametrize("sentence", ["the left hand comes to the chest", "a man puts it to face"])
def test_a_limb_that_goes_somewhere_is_no_walk_and_a_face_no_turn(sentence: str) -> None:
    with pytest.raises(InputError):
        parse(sentence)


def test_the_person_stays_seated_and_keeps_the_side():
    steps = parse("a person sits down on a chair, stays for two seconds and waves").steps
    assert {step.lower for step in steps} == {"sit_down", "sit"}
    assert [step.direction for step in parse("a man leans to his right, then to his left").steps] == ["right", "left"]
    assert parse("a person lifts the left arm, then waves with their right").steps[-1].hand == "right"
    assert parse("a woman carries a box to the door, then opens it").steps[0].upper == "carry"
    assert parse("a person spins a plate on a stick").steps[0].lower == "stand"
    assert [step.lower for step in parse("a person jogs at a moderate pace").steps] == ["jog"]
    assert parse("a person bends the right arm and nods").steps[-1].upper == "nod"


@pytest.mark.parametrize(
    ("text", "not_shown"),
    [
        ("a boy bounces on the bed", "'on the bed' is not shown"),
        ("a person jumps off the chair", "'off the chair'"),
        ("a person looks for something under the bed", "'under the bed' is not shown"),
        ("a person reads a book on the sofa", ""),
        ("a person sits down on the chair and waves", ""),
    ],
)
def test_furniture_that_no_step_uses_is_named(text: str, not_shown: str):
    said = "".join(clause.how for clause in parse(text, in_part=True).clauses if clause.status != DONE)
    assert (not_shown in said) if not_shown else not said


def test_two_sides_that_are_shown_one_after_the_other_are_shown():
    assert [clause.status for clause in parse("a person turns to the left and to the right").clauses] == ["done"] * 2


@pytest.mark.parametrize(
    ("sentence", "is_said"),
    [
        ("a person is in a squat and then raises the left hand", True),
        ("a person gets down on the knees and hops backwards", True),
        ("a person squats and then raises the left hand", False),
        ("a person gets down on the knees, then gets up and hops backwards", False),
    ],
)
def test_getting_up_that_no_word_asks_for_is_said(sentence: str, *, is_said: bool) -> None:
    assert any("after getting up" in record.how for record in parse(sentence, in_part=True).clauses) == is_said
