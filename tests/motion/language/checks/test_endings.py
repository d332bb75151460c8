"""What undoes something, and postures that are kept."""

import pytest

from mmweaver.motion.language.checks.endings import endings_not_shown
from mmweaver.motion.language.checks.given import given
from mmweaver.motion.language.plan import ClauseRecord, Step
from mmweaver.motion.language.sentence import parse


def _said(clauses: tuple[str, ...], *steps: Step) -> list[str]:
    records = {number: ClauseRecord(words) for number, words in enumerate(clauses)}
    return [how for _, how in endings_not_shown(given(" and ".join(clauses), steps, records, set()))]


def test_what_is_uncrossed_has_a_step() -> None:
    clauses, crossed = ("crosses the arms", "uncrosses them"), Step(upper="cross_arms", clauses=(0, 1))
    assert _said(clauses, crossed) == ["'uncrosses' is not shown"]
    assert not _said(clauses, Step(upper="cross_arms", clauses=(0,)), Step(clauses=(1,)))


def test_who_returns_walks_back() -> None:
    clauses = ("a person walks to the left", "steps back to where he was")
    walk = Step(lower="walk", direction="left", clauses=(0,))
    assert _said(clauses, walk, Step(lower="walk", direction="backwards", clauses=(1,))) == [
        "the way back is not shown"
    ]
    assert not _said(clauses, walk, Step(lower="walk", direction="back", clauses=(1,)))
    assert not _said(clauses, walk, Step(lower="walk", direction="right", clauses=(1,)))


def test_a_pose_that_is_returned_to_is_no_place() -> None:
    clauses = ("a person walks to the left", "returns to a standing position")
    assert not _said(clauses, Step(lower="walk", direction="left", clauses=(0,)), Step(clauses=(1,)))


def test_what_stops_is_not_done() -> None:
    clauses = ("claps", "stops clapping")
    clap = Step(upper="clap", clauses=(0,))
    assert _said(clauses, clap, Step(upper="clap", clauses=(1,))) == ["the end of 'clapping' is not shown"]
    assert not _said(clauses, clap, Step(clauses=(1,)))


def test_a_hand_that_is_placed_back_down_is_no_thing() -> None:
    clauses = ("lifts his left hand", "places it back down")
    put_down = Step(lower="put_down", clauses=(1,))
    assert _said(clauses, Step(upper="raise", clauses=(0,)), put_down) == [
        "the hand is not lowered: a thing is put down"
    ]
    assert not _said(("lifts a box with his hand", "places it back down"), put_down)


@pytest.mark.parametrize(
    ("sentence", "is_said"),
    [
        ("someone is positioned in a squat and then raises the left hand", True),
        ("someone is in a squat, then stands up and raises the left hand", False),
    ],
)
def test_a_posture_is_kept_or_it_is_said(sentence: str, is_said: bool) -> None:
    hows = " ".join(record.how for record in parse(sentence, in_part=True).clauses)
    assert ("is shown standing, after squatting" in hows) == is_said


def test_arms_that_come_down_stretched_out_are_said_to_come_down_otherwise() -> None:
    clauses, lifts = (
        ("stretches the arms overhead", "lowers them extended to both sides"),
        Step(upper="raise_hold", clauses=(0,)),
    )
    down = Step(clauses=(0, 1))
    assert _said(clauses, lifts, down) == ["'extended to both sides' is not shown"]
    assert not _said(clauses, lifts, Step(upper="arms_out", clauses=(1,)), down)
    assert not _said(("lifts the arms", "lowers them slowly"), lifts, down)
