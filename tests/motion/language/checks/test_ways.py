"""Sides and ways as often as they are named."""

import pytest

from mmweaver.motion.language.checks.given import given
from mmweaver.motion.language.checks.ways import ways_not_shown
from mmweaver.motion.language.plan import DONE, ClauseRecord, Step
from mmweaver.motion.language.sentence import parse

RECORDS = {0: ClauseRecord("goes right"), 1: ClauseRecord("left"), 2: ClauseRecord("left again")}
RIGHT = Step(lower="walk", direction="right", clauses=(0,))


def _said(text: str, *steps: Step) -> list[str]:
    return [how for _, how in ways_not_shown(given(text, steps, RECORDS, set()))]


def test_a_side_that_is_gone_to_twice_has_two_steps() -> None:
    """A step that two clauses share shows one of them."""
    both = Step(lower="walk", direction="left", clauses=(1, 2))
    each = [Step(lower="walk", direction="left", clauses=(n,)) for n in (1, 2)]
    text = "goes right and then left and then left again"
    assert _said(text, RIGHT, both) == ["'left' is shown once, not twice"]
    assert not _said(text, RIGHT, *each)


def test_ways_in_another_order_are_said() -> None:
    ahead, back = (Step(lower="walk", direction=way, clauses=(n,)) for n, way in enumerate(("forwards", "backwards")))
    assert _said("goes forward, then backward", back, ahead) == [
        "the order shown is walking backwards, then walking forwards"
    ]
    assert not _said("goes forward, then backward", ahead, back)


def test_limbs_are_named_in_their_order() -> None:
    left, right = (Step(upper="raise", hand=side) for side in ("left", "right"))
    text = "raises the left hand, the right hand, the left hand"
    assert not _said(text, left, right, left)
    assert _said("raises the left hand, the right hand", right, left) == ["that the right hand comes then is not shown"]


@pytest.mark.parametrize(
    "sentence",
    [
        "a person waves with the left hand right after that",
        "a person turns left and turns back",
        "a person walks forward while going forward",
        "a person wipes the table with his back straight",
        "a person walks back and forth",
    ],
)
def test_words_that_are_no_ways(sentence: str) -> None:
    records = {0: ClauseRecord(sentence)}
    step = Step(lower="walk", upper="wipe", direction="forwards", hand="left", clauses=(0,))
    assert not [how for _, how in ways_not_shown(given(sentence, [step], records, set())) if "back" in how]


def test_what_goes_to_both_sides_shows_both() -> None:
    assert {record.status for record in parse("a person twists left and right").clauses} == {DONE}


@pytest.mark.parametrize(
    "text",
    ["lifts right foot to left knee then lifts left foot to right knee", "lifts their left leg up to their right knee"],
)
def test_the_leg_that_another_one_is_lifted_to_is_not_the_one_that_is_lifted(text: str) -> None:
    plan = parse(f"a person {text}")
    sides = [word for word in text.split() if word in ("left", "right")]
    assert [step.foot for step in plan.steps] == sides[::2]
    assert all("comes then" not in clause.how and "knee" not in clause.shown for clause in plan.clauses)
