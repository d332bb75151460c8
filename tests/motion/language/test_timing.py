"""The time of the steps."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import schedule


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


def test_a_part_of_one_movement_is_fine_but_not_of_a_counted_one():
    assert spans("squats", 0.4)[0] > 1.0
    with pytest.raises(InputError, match="at least"):
        spans("claps ten times", 1.0)
