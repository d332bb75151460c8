"""Figures of a made-up exercise are what was put into it."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out
from studies.motion.mars_exercises import EXERCISES, figures, period_s


def test_figures_of_a_body_that_lifts_a_hand():
    pose = act_out("a person stands still", duration_s=8.0, seed=0, height_m=1.75).pose
    joints_m = np.repeat(pose.joints_m[:1], 80, axis=0)
    head_m = joints_m[0, joint("head"), 2]
    joints_m[:, joint("left_wrist"), 2] = head_m - 0.5 + 0.4 * np.sin(2 * np.pi * np.arange(80) / 20)
    found = figures(joints_m, 0.1, 1.75)
    assert found["period_s"] == pytest.approx(2.0, rel=0.1)
    assert found["left_hand_high_m"] == pytest.approx(-0.1, abs=0.02)
    assert found["left_hand_low_m"] == pytest.approx(-0.9, abs=0.02)
    assert found["pelvis_drop_m"] == 0.0
    assert np.isnan(period_s(np.repeat(joints_m[:1], 30, axis=0), 0.1))


def test_every_exercise_has_rows_of_both_splits():
    assert len(EXERCISES) == 10
    for _, validate, test in EXERCISES.values():
        assert validate[1] - validate[0] > 100
        assert test[1] - test[0] > 100
