"""Every clause says all that it is shown as, unless its own words say just that."""

import pytest

from mmweaver.motion.language.explanations import add_explanations
from mmweaver.motion.language.plan import APPROXIMATED, DONE, ClauseRecord, Side, Step, Way
from mmweaver.motion.language.postures import add_shown_text


def said(words: str, *steps: Step, status: str = APPROXIMATED, how: str = "'so' is not shown") -> ClauseRecord:
    """The record of a sentence of one clause."""
    own = [Step(**{**vars(step), "clauses": (0,)}) for step in steps]
    return add_explanations(add_shown_text([ClauseRecord(words, status, how)], own), own, roughly=False)[0]


@pytest.mark.parametrize(
    ("words", "step"),
    [
        ("a person waves", Step(upper="wave")),
        ("she kneels down", Step(lower="kneel_down")),
        ("walks three steps forward", Step(lower="walk", direction=Way.FORWARDS, count=3)),
        ("raises the left arm overhead and lowers it", Step(upper="raise", hand="left")),
        ("walks to the couch", Step(lower="walk", seat="couch", direction=Way.SEAT)),
        ("turns left", Step(lower="turn", direction=Side.LEFT)),
        ("claps twice", Step(upper="clap", count=2)),
    ],
)
def test_words_that_say_just_what_is_shown_need_no_others(words: str, step: Step) -> None:
    assert said(words, step).how == "'so' is not shown"


@pytest.mark.parametrize(
    ("words", "steps", "shown"),
    [
        ("waves", [Step(upper="wave", hand="both")], "waving with both hands repeatedly"),
        ("raises an arm", [Step(upper="raise")], "raising one hand overhead and lowering it once"),
        ("waves twice", [Step(upper="wave")], "waving with one hand repeatedly"),
        ("waves with the left hand", [Step(upper="wave", hand="right")], "waving with the right hand repeatedly"),
        ("walks to his left", [Step(lower="walk", direction=Side.RIGHT)], "walking to the right in the photo"),
        ("walks", [Step(lower="walk", count=2)], "walking two steps"),
        ("walks", [Step(lower="walk", speed=1)], "walking quickly"),
        ("kneels", [Step(lower="kneel", style="knee")], "kneeling on one knee"),
        ("kicks with both legs", [Step(lower="kick")], "kicking with one foot once"),
        ("walks and waves", [Step(lower="walk"), Step(upper="wave")], "walking, then waving with one hand repeatedly"),
        ("drinks", [Step(lower="sit", upper="drink")], "sitting while drinking with one hand once or more"),
    ],
)
def test_another_side_count_posture_limb_or_order_is_said(words: str, steps: list[Step], shown: str) -> None:
    record = said(words, *steps)
    assert record.how == f"is shown as {shown}; 'so' is not shown"
    assert record.shown == shown


def test_a_clause_within_the_movement_before_says_so() -> None:
    steps = [Step(upper="wave", hand="both", clauses=(0, 1))]
    records = [ClauseRecord("flaps", APPROXIMATED, "'flaps' is not shown"), ClauseRecord("wings", APPROXIMATED, "it")]
    hows = [record.how for record in add_explanations(add_shown_text(records, steps), steps, roughly=False)]
    assert hows == [
        "is shown as waving with both hands repeatedly; 'flaps' is not shown",
        "is shown as the same movement; it",
    ]


@pytest.mark.parametrize("status", [DONE, APPROXIMATED])
def test_a_clause_without_a_step_of_its_own_is_shown_as_its_neighbour(status: str) -> None:
    steps = [Step(lower="bend", clauses=(0,))]
    records = add_shown_text([ClauseRecord("bends down"), ClauseRecord("tries to get up", status)], steps)
    tries = add_explanations(records, steps, roughly=False)[1]
    assert (tries.status, tries.how) == (status, f"is shown as {records[0].shown}")
