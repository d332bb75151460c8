"""The time of the steps."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import plan_motion, schedule


def spans(text: str, duration_s: float) -> list[float]:
    return [step.end_s - step.start_s for step in schedule(parse(text), duration_s).steps]


def test_they_fill_the_duration():
    for text in ("walks", "claps twice", "walks, then sits down", "turns around, waves and squats"):
        for duration in (4.0, 5.5, 20.0):
            assert sum(spans(text, duration)) == pytest.approx(duration)


def test_extra_time_goes_to_what_can_go_on():
    walk, turn = spans("walks, then turns around", 10.0)
    assert turn < 2.0 < walk
    clap, wave = spans("claps twice, then waves", 10.0)
    assert clap < 2.0 < wave


def test_a_duration_that_is_said_is_kept():
    assert np.allclose(spans("sits for 3 seconds, then stands up", 5.0)[0], 3.0)


def test_default_two_seconds_hold_a_walk_and_sitting_down():
    assert min(spans("walks to the left, then sits down", 2.0)) > 0.8


@pytest.mark.parametrize(
    "text", ["bows", "jumps forward", "falls forward", "does ten jumping jacks", "stands up", "squats"]
)
def test_what_nothing_would_be_seen_of_is_refused_and_the_time_said_is_enough(text: str):
    with pytest.raises(InputError, match="takes at least") as refused:
        schedule(parse(text), 0.1)
    needed_s = float(str(refused.value).split("at least ")[1].split(" s")[0])
    assert schedule(parse(text), needed_s).clauses[0].status == "approximated"
    with pytest.raises(InputError, match="takes at least"):
        schedule(parse(text), needed_s - 0.11)


def test_what_does_not_fit_is_cut_and_said():
    plan = schedule(parse("claps ten times"), 2.0)
    assert 3 <= plan.steps[0].count < 10
    assert plan.clauses[0].status == "approximated"
    assert f"{plan.steps[0].count} of 10 times" in plan.clauses[0].how
    plan = schedule(parse("walks to the left, bows, then lies down"), 2.5)
    assert [step.lower for step in plan.steps] == ["walk", "bow"]
    assert [clause.status for clause in plan.clauses] == ["done", "done", "not done"]
    assert "2.5 s are over" in plan.clauses[2].how
    with pytest.raises(InputError, match=r"at least 0\.6 s"):
        schedule(parse("squats, then waves"), 0.1)


def test_a_short_sentence_is_repeated_in_a_long_time():
    plan = plan_motion("bows", 10.0)
    assert len(plan.steps) == 4
    assert "4 times" in plan.notes[-1]
    assert len(plan_motion("falls", 10.0).steps) == 1  # it would have to get up first
    assert len(plan_motion("waves", 10.0).steps) == 1  # goes on


@pytest.mark.parametrize("text", ["turns around", "sits down", "gets up from the floor", "waves twice"])
def test_what_is_done_slowly_takes_longer(text):
    slowly, usual, quickly = (plan_motion(f"a person {text}{how}").duration_s for how in (" slowly", "", " quickly"))
    assert quickly < 0.9 * usual
    assert usual < 0.85 * slowly


def test_who_walks_slowly_goes_less_far_in_the_same_time():
    assert plan_motion("a person walks slowly").duration_s == plan_motion("a person walks").duration_s
