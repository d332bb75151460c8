"""A person's habits."""

import numpy as np

from mmweaver.motion.animation.controls import habits_of
from mmweaver.motion.empty_floor import act_out

TIME_S = np.arange(-0.5, 20.5, 1 / 120)


def test_a_person_has_the_same_habits_every_time_and_another_has_others():
    assert habits_of(7) == habits_of(7)
    assert habits_of(7) != habits_of(8)
    amplitudes = [habits_of(subject).amplitude for subject in range(40)]
    assert 0.85 < min(amplitudes) < 0.98 < 1.02 < max(amplitudes) < 1.15


def test_an_uneven_step_starts_and_ends_as_planned_and_never_goes_back():
    for subject in range(5):
        reached_s = habits_of(subject).warped(TIME_S, 0.0, 20.0)
        outside = (TIME_S <= 0) | (TIME_S >= 20.0)
        assert np.allclose(reached_s[outside], TIME_S[outside])
        assert np.diff(reached_s).min() > 0
        rate = np.gradient(reached_s, TIME_S)
        assert np.abs(np.diff(rate)).max() < 0.05, "the tempo changes smoothly"
        assert rate[~outside].min() < 0.4, "there is a pause"


def test_twenty_seconds_of_waving_are_not_periodic():
    motion = act_out("a person waves with the right hand", duration_s=20.0, seed=2)
    wrist = motion.pose.joints_m[:, 21, 0] - motion.pose.joints_m[:, 17, 0]
    wrist = wrist[240:-240] - wrist[240:-240].mean()
    crossings = np.flatnonzero((wrist[:-1] < 0) & (wrist[1:] >= 0))
    periods_s = np.diff(crossings) / 120
    assert len(periods_s) > 8
    assert periods_s.std() / periods_s.mean() > 0.04
