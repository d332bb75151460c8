"""Poses as their names say."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out


def _in_the_middle(text: str) -> np.ndarray:
    joints_m = act_out(f"a person {text}", seed=2, height_m=1.75).pose.joints_m
    return joints_m[len(joints_m) // 2] + np.array([0.0, 0.0, RADAR_HEIGHT_M])


def test_the_tree_stands_on_one_leg_with_the_hands_over_the_head():
    joints_m = _in_the_middle("does the tree pose")
    ankles = sorted(joints_m[[joint("left_ankle"), joint("right_ankle")], 2])
    assert ankles[0] < 0.15
    assert ankles[1] > 0.4
    assert joints_m[[joint("left_wrist"), joint("right_wrist")], 2].min() > joints_m[joint("head"), 2]


def test_the_warrior_has_a_wide_stance_and_the_arms_out():
    joints_m = _in_the_middle("holds the warrior pose")
    apart = np.linalg.norm(joints_m[joint("left_ankle"), :2] - joints_m[joint("right_ankle"), :2])
    span = np.linalg.norm(joints_m[joint("left_wrist")] - joints_m[joint("right_wrist")])
    assert apart > 0.75
    assert span > 1.2


def test_in_the_downward_dog_the_hips_are_highest_and_the_hands_near_the_floor():
    joints_m = _in_the_middle("does the downward dog")
    assert joints_m[..., 2].argmax() in (joint("pelvis"), joint("left_hip"), joint("right_hip"), joint("spine1"))
    assert joints_m[[joint("left_wrist"), joint("right_wrist")], 2].max() < 0.25
