"""Every clause says all that it is shown as, unless its own words say just that."""

import pytest

from mmweaver.motion.language.explanations import add_explanations
from mmweaver.motion.language.plan import APPROXIMATED, DONE, ClauseRecord, Side, Step, Way
from mmweaver.motion.language.postures import add_shown_text
from mmweaver.motion.language.sentence import parse


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


def test_what_is_done_says_in_its_record_alone_what_is_shown() -> None:
    plan = parse("a person bows, then claps three times")
    assert [record.shown for record in plan.clauses] == ["bowing once", "then clapping three times"]
    assert {record.status for record in plan.clauses} == {DONE}
    assert plan.notes == ()


def test_reasons_that_only_say_what_is_shown_are_left_out() -> None:
    record = said("moves the left arm", Step(upper="wave", hand="left"), how="a moving arm is shown as waving")
    assert record.how == "is shown as waving with the left hand repeatedly"


def test_a_clause_within_the_movement_before_says_so() -> None:
    steps = [Step(upper="wave", hand="both", clauses=(0, 1))]
    records = [ClauseRecord("flaps", APPROXIMATED, "'flaps' is not shown"), ClauseRecord("wings", APPROXIMATED, "it")]
    hows = [record.how for record in add_explanations(add_shown_text(records, steps), steps, roughly=False)]
    assert hows == [
        "is shown as waving with both hands repeatedly; 'flaps' is not shown",
        "is shown as the same movement; it",
    ]


def test_every_clause_says_what_it_is_shown_as_unless_its_words_do() -> None:
    stops, bows = parse("a person stops, then bows politely", in_part=True).clauses
    assert (stops.status, stops.how) == (DONE, "is shown as standing")
    assert bows.how == "is shown as bowing once; 'politely' is not shown"
    walks, _ = parse("a person walks, then bows politely", in_part=True).clauses
    assert walks.how == ""


def test_notes_are_of_clauses_that_are_not_done() -> None:
    plan = parse("a person stops, then bows")
    assert [record.how for record in plan.clauses] == ["is shown as standing", ""]
    assert plan.notes == ()
    assert parse("a person stops, then bows politely", in_part=True).notes == (
        "'bows politely' is shown as bowing once; 'politely' is not shown",
    )


@pytest.mark.parametrize("status", [DONE, APPROXIMATED])
def test_a_clause_without_a_step_of_its_own_is_shown_as_its_neighbour(status: str) -> None:
    steps = [Step(lower="bend", clauses=(0,))]
    records = add_shown_text([ClauseRecord("bends down"), ClauseRecord("tries to get up", status)], steps)
    tries = add_explanations(records, steps, roughly=False)[1]
    assert (tries.status, tries.how) == (status, f"is shown as {records[0].shown}")


@pytest.mark.parametrize(
    ("text", "status", "how"),
    [
        (
            "a person scratches their back with the left hand, then the right hand", APPROXIMATED,
            "is shown as waving with the right hand repeatedly",
        ),
        ("a person tilts the head left and right", APPROXIMATED, "is shown as looking to the right in the photo"),
        ("a person walks forward with a rope, then backwards", DONE, "is shown as walking backwards"),
    ],
)  # fmt: skip
def test_what_goes_on_from_another_movement_is_not_done(text: str, status: str, how: str) -> None:
    first, second = parse(text, in_part=True).clauses
    assert (first.status, second.status, second.how) == (APPROXIMATED, status, how)


def test_what_goes_on_from_a_movement_that_says_what_is_shown_says_so_too() -> None:
    first, second = parse("a person does side lunges to the left and right").clauses
    assert (first.status, second.status) == (DONE, DONE)
    assert second.how == first.how.replace("left", "right")


@pytest.mark.parametrize(
    ("text", "how"),
    [
        ("a person walks forward with arms stretched out in front like a zombie", "the unsteady gait is not shown"),
        ("a person walks like a zombie", "is shown as staggering"),
    ],
)
def test_staggering_that_is_not_shown_is_not_said_to_be(text: str, how: str) -> None:
    assert parse(text).clauses[-1].how.endswith(how)
