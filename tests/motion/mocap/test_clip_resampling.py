"""Any frame rate becomes 120 Hz without steps, spikes or lag; jitter of markers goes, the motion stays."""

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.skeleton import BONES
from mmweaver.motion.mocap.clip import MotionClip, low_passed, resampled_clip

TRUTH_FPS = 120.0


def clip(fps: float, seconds: float = 2.0, noise_m: float = 0.0) -> MotionClip:
    joints = walk(fps, seconds)
    return MotionClip(
        joints_m=joints + noise_m * np.random.default_rng(0).normal(size=joints.shape), fps=fps, label="walk"
    )


def figures(joints: np.ndarray) -> tuple[float, float]:
    """The highest speed and acceleration, m/s and m/s2, of 120 Hz joints."""
    speed = np.linalg.norm(np.diff(joints, axis=0), axis=-1) * TRUTH_FPS
    acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * TRUTH_FPS**2
    return float(speed.max()), float(acceleration.max())


@pytest.mark.parametrize(
    ("fps", "error_m"), [(20.0, 0.025), (30.0, 0.012), (60.0, 0.006), (100.0, 0.006), (240.0, 0.006)]
)
def test_the_motion_is_kept_at_any_rate(fps: float, error_m: float):
    time_s, joints = resampled_clip(clip(fps), 1.8)
    assert time_s[0] < 0 < 1.8 < time_s[-1]
    inside = (time_s >= 0) & (time_s <= 1.8)
    truth = walk(TRUTH_FPS)[: inside.sum()]
    assert np.abs(joints[inside] - truth).max() < error_m
    speed, acceleration = figures(joints)
    true_speed, true_acceleration = figures(walk(TRUTH_FPS))
    assert speed < 1.1 * true_speed
    assert acceleration < 1.6 * true_acceleration, "a spike at a joint of the spline"


def test_bones_keep_their_length_between_frames():
    _, joints = resampled_clip(clip(20.0), 1.8)
    for parent, child in BONES:
        length = np.linalg.norm(joints[:, child] - joints[:, parent], axis=-1)
        assert np.ptp(length) < 0.02


def test_jitter_is_taken_out_and_the_motion_is_not_late():
    noisy = clip(120.0, noise_m=0.0007)
    clean = clip(120.0)
    left = low_passed(noisy) - low_passed(clean)
    assert np.sqrt((left[10:-10] ** 2).mean()) < 0.5 * 0.0007
    removed = low_passed(clean) - clean.joints_m
    assert np.sqrt((removed**2).mean()) < 0.0006
    kept = MotionClip(joints_m=noisy.joints_m, fps=120.0, label="walk", has_jitter=False)
    np.testing.assert_array_equal(low_passed(kept), noisy.joints_m)
    np.testing.assert_array_equal(low_passed(clip(20.0)), walk(20.0))
