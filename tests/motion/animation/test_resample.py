"""Cubic interpolation in time."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.motion.animation.root_path import resample


def moving(time_s: np.ndarray) -> PoseSequence:
    joints = np.zeros((len(time_s), 22, 3))
    joints[..., 0] = np.sin(2 * np.pi * 1.5 * time_s)[:, None] * np.linspace(0.1, 1, 22)
    return PoseSequence(time_s=time_s, joints_m=joints, height_m=1.7, subject=3)


def test_a_sine_comes_back_to_microns_at_slow_time():
    dense = moving(np.arange(-2, 243) / 120)
    fine = np.linspace(0.0, 2.0, 3001)
    again = resample(dense, fine)
    assert np.abs(again.joints_m - moving(fine).joints_m).max() < 5e-6
    assert (again.height_m, again.subject) == (1.7, 3)


def test_its_own_times_give_itself():
    dense = moving(np.arange(50) / 120)
    assert np.allclose(resample(dense, dense.time_s).joints_m, dense.joints_m, atol=1e-12)


def test_it_never_extrapolates():
    with pytest.raises(InputError, match="longer"):
        resample(moving(np.arange(50) / 120), np.array([0.0, 1.0]))
