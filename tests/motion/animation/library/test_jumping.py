"""Flight is free fall, knees bend, landings are soft."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from rooms import FLOOR_Z_M, WINDOW_M, room


def made(text: str, seed: int, duration_s: float):
    return compose(plan_motion(text, duration_s), room(), seed=seed, range_window_m=WINDOW_M).pose


def knee_deg(joints: np.ndarray, side: str) -> np.ndarray:
    thigh = joints[:, joint(f"{side}_hip")] - joints[:, joint(f"{side}_knee")]
    shank = joints[:, joint(f"{side}_ankle")] - joints[:, joint(f"{side}_knee")]
    cosine = np.sum(thigh * shank, axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
    return 180 - np.degrees(np.arccos(cosine))


@pytest.mark.parametrize("seed", range(5))
def test_a_jump_falls_freely(seed: int):
    pose = made("jumps once", seed, 2.5)
    feet = pose.joints_m[:, [10, 11], 2].min(axis=1) - FLOOR_Z_M
    air = feet > 0.05
    assert 0.15 < air.sum() / 120 < 0.5
    pelvis = pose.joints_m[:, 0, 2]
    acceleration = np.gradient(np.gradient(pelvis, pose.time_s), pose.time_s)
    assert acceleration[air].mean() == pytest.approx(-9.81, abs=0.5)
    assert np.flatnonzero(np.diff(air.astype(int)) == 1).size == 1


@pytest.mark.parametrize("count", [1, 2, 4])
def test_jumps_are_counted(count: int):
    pose = made(f"jumps {count} times", 0, 6.0)
    air = pose.joints_m[:, [10, 11], 2].min(axis=1) - FLOOR_Z_M > 0.05
    assert (np.diff(air.astype(int)) == 1).sum() == count


@pytest.mark.parametrize("seed", range(5))
def test_a_squat_bends_the_knees_on_wide_feet(seed: int):
    """As the first subject of MARS does it: 122 degrees, feet 0.49 m apart."""
    joints = made("squats", seed, 2.0).joints_m
    for side in ("left", "right"):
        assert 100 < knee_deg(joints, side).max() < 138
    assert knee_deg(joints, "left").min() < 25
    apart_m = np.linalg.norm((joints[:, 7] - joints[:, 8])[:, :2], axis=1).max()
    assert 0.28 < apart_m < 0.62


@pytest.mark.parametrize("seed", range(3))
def test_jacks_spread_arms_and_legs_together(seed: int):
    joints = made("does three jumping jacks", seed, 4.0).joints_m
    feet = np.linalg.norm(joints[:, 7] - joints[:, 8], axis=1)
    hands = joints[:, [20, 21], 2].mean(axis=1)
    assert feet.max() > feet.min() + 0.3
    assert hands.max() > joints[:, 15, 2].max() + 0.1
    assert np.corrcoef(feet, hands)[0, 1] > 0.8
    wide = feet > (feet.min() + feet.max()) / 2
    assert (np.diff(wide.astype(int)) == 1).sum() == 3


@pytest.mark.parametrize("seed", range(3))
def test_who_is_doing_squats_does_two_at_least(seed: int):
    pelvis_m = compose(
        plan_motion("a person is doing squats"), room(), seed=seed, range_window_m=WINDOW_M
    ).pose.joints_m[:, 0, 2]
    is_low = pelvis_m < (pelvis_m.min() + pelvis_m.max()) / 2
    assert np.sum(np.diff(is_low.astype(int)) == 1) >= 2


@pytest.mark.parametrize("seed", range(3))
def test_who_remains_in_a_squat_stays_down(seed: int):
    pelvis_m = made("squats down and remains in that position", seed, 4.0).joints_m[:, 0, 2]
    assert pelvis_m[-1] < pelvis_m[0] - 0.25
    assert np.ptp(pelvis_m[-100:]) < 0.03
