"""Every word of content is carried out by a step or named in the clause's record."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import APPROXIMATED, DONE
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "what"),
    [
        ("a person walks sadly", "sadly"),
        ("a person takes two large steps forward", "large"),
        ("a person walks in a big circle", "big"),
        ("a man jumps high", "high"),
        ("a person walks through the door", "through the door"),
        ("a person walks quickly and angrily", "angrily"),
        ("a person walks from the door to the table", "from the door"),
        ("a person stands in front of the sofa facing the wall", "facing the wall"),
        ("a person walks with the hands behind the back", "behind the back"),
        ("a person walks backwards away from the radar", "'backwards' is not shown"),
    ],
)
def test_what_no_step_shows_is_named(sentence: str, what: str) -> None:
    """Manners, sizes, places and sides, in the clause that was absorbed by the one before too."""
    records = [record for record in parse(sentence).clauses if what in record.how]
    assert records
    assert all(record.status == APPROXIMATED for record in records)


@pytest.mark.parametrize(
    "sentence",
    [
        "a person walks slowly to the door",
        "a person takes two steps forward, then waves with the left hand",
        "a burglar turns around twice",
        "a person kicks high with the left leg",
        "a person lies down on the floor",
        "someone walks two metres",
    ],
)
def test_nothing_is_named_where_all_is_shown(sentence: str) -> None:
    """No record speaks of words that a step carries out."""
    assert {record.status for record in parse(sentence).clauses} == {DONE}


def test_a_place_in_a_clause_without_a_verb_is_gone_to() -> None:
    """'Quickly and angrily to the door' leads to the door."""
    (step,) = parse("a person walks quickly and angrily to the door").steps
    assert (step.target, step.speed) == ("door", 1)


def test_the_other_hand_or_foot_does_it_again() -> None:
    """'Then the right' after a movement of the left one."""
    hands = [step.hand for step in parse("a person punches with the left hand, then the right").steps]
    assert hands == ["left", "right"]
    feet = [step.foot for step in parse("a person kicks with the left leg, then with the right leg").steps]
    assert feet == ["left", "right"]


def test_a_movement_that_is_described_twice_is_done_once() -> None:
    """A participle of the same movement adds the hand to it."""
    (step,) = parse("the man is boxing, throwing punches with both hands").steps
    assert (step.upper, step.hand) == ("punch", "both")


def test_a_sofa_that_is_passed_is_no_seat() -> None:
    """'Past the sofa' neither leads to it nor is dropped."""
    plan = parse("someone walks past the sofa")
    assert plan.steps[0].direction != "seat"
    assert "past the sofa" in plan.clauses[0].how


@pytest.mark.parametrize(
    ("sentence", "lower", "direction"),
    [
        ("a person leans to the left", "lean", "left"),
        ("a person bends to the right side", "lean", "right"),
        ("a person leans back", "lean", "backwards"),
        ("a person twists the upper body from side to side", "twist", ""),
        ("a person leans forward", "bend", "forwards"),
    ],
)
def test_the_trunk_leans_and_twists(sentence: str, lower: str, direction: str) -> None:
    """Sides and back are movements of their own; forward is a bow of the trunk."""
    (step,) = parse(sentence).steps
    assert step.lower == lower
    assert direction in (step.direction, "forwards")


def test_what_stays_unknown_is_refused() -> None:
    """No coverage makes a handstand of something else."""
    with pytest.raises(InputError, match="handstand"):
        parse("a person does a handstand")


@pytest.mark.parametrize(
    ("sentence", "keys"),
    [
        ("a person is facing forward and walks backward", ["stand", "walk"]),
        ("a person stands up from a seated position", ["stand_up"]),
        ("a person moves along a clockwise path", ["walk"]),
        ("touches back of head with right hand", ["comb"]),
        ("raise both arms in the air", ["raise"]),
        ("a person falls forward from a chair", ["sit", "fall_off"]),
        ("a person stumbles but does not fall", ["stumble"]),
        ("a person falls backwards while walking", ["walk", "fall"]),
        ("a person rotates the head slowly", ["look_around"]),
        ("a person squats and stays down", ["crouch"]),
        ("a person jogs in place for eight seconds, then stretches", ["jog", "stretch"]),
    ],
)
def test_words_with_more_than_one_meaning(sentence: str, keys: list[str]) -> None:
    """Facing forward is no turn, and the back of the head no direction."""
    assert [step.upper or step.lower for step in parse(sentence).steps] == keys
