"""Exercises of rehabilitation: what moves, to which side, how far and how often, as their names say."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def _pose(text: str, seed: int) -> np.ndarray:
    return act_out(f"a person {text}", seed=seed).pose.joints_m[2:-2].astype(float)


def _left(joints: np.ndarray) -> np.ndarray:
    across = (joints[0, joint("left_hip")] - joints[0, joint("right_hip")])[:2]
    return across / np.hypot(*across)


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_a_side_lunge_goes_over_the_bent_leg_from_a_wide_stance_with_the_arms_out(side: str, sign: float):
    for seed in range(3):
        joints = _pose(f"does side lunges with the {side} leg", seed)
        left = _left(joints)
        pelvis = joints[:, 0, :2] @ left * sign
        deepest, start = np.argmin(joints[:, 0, 2]), 0
        assert 0.1 < pelvis[deepest] - pelvis[start] < 0.6
        assert 0.05 < joints[start, 0, 2] - joints[deepest, 0, 2] < 0.4
        feet = (joints[:, joint("left_ankle"), :2] - joints[:, joint("right_ankle"), :2]) @ left
        assert feet.min() > 0.38
        wrists = (joints[:, joint("left_wrist"), :2] - joints[:, joint("right_wrist"), :2]) @ left
        assert wrists.min() > 1.0


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_limb_extension_raises_leg_and_arm_of_one_side(side: str):
    other = "right" if side == "left" else "left"
    joints = _pose(f"extends the {side} arm and leg to the side", 1)
    rise = np.ptp(joints[:, :, 2], axis=0)
    assert rise[joint(f"{side}_wrist")] > 0.8
    assert rise[joint(f"{side}_ankle")] > 0.05
    assert rise[joint(f"{other}_ankle")] < 0.03
    assert rise[joint(f"{other}_wrist")] < 0.3


def test_an_arm_extension_is_repeated_above_the_shoulder():
    joints = _pose("extends the right arm up at the side three times", 0)
    high = joints[:, joint("right_wrist"), 2] - joints[:, joint("right_shoulder"), 2]
    assert (np.diff((high > 0.25).astype(int)) == 1).sum() == 3
    assert high.min() < -0.4


def test_hands_are_held_up_all_through_a_squat():
    joints = _pose("does squats with the hands up", 0)
    for side in ("left", "right"):
        hands = joints[:, joint(f"{side}_wrist"), 2] - joints[:, joint("spine3"), 2]
        assert hands.min() > -0.1


def test_a_front_lunge_leaves_the_leg_behind_straight_and_is_repeated():
    joints = _pose("does front lunges with the left leg", 0)
    thigh, shank = joints[:, 2] - joints[:, 5], joints[:, 8] - joints[:, 5]  # of the right leg, from the knee
    cosine = np.sum(thigh * shank, axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
    deepest = np.argmin(joints[:, 0, 2])
    assert np.degrees(np.arccos(cosine[deepest])) > 145


def test_some_keep_both_feet_where_they_are_between_front_lunges():
    steps = []
    for seed in range(8):
        joints = _pose("does three front lunges with the left leg", seed)
        in_between = slice(len(joints) // 4, 3 * len(joints) // 4)
        steps.append(float(np.ptp(joints[in_between, 7, :2], axis=0).max()))
    assert min(steps) < 0.02
    assert max(steps) > 0.3


def test_who_opens_a_door_steps_back_and_returns():
    joints = _pose("opens the door", 0)
    feet = joints[:, (7, 8), :2]
    moved_m = np.linalg.norm(feet - feet[0], axis=2).max(axis=0)
    assert moved_m.max() > 0.15 > moved_m.min()
    assert np.linalg.norm(feet[-1] - feet[0], axis=1).max() < 0.03
