"""On hands and feet, and on the back."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out


def _heights(text: str, seed: int) -> np.ndarray:
    joints = act_out(f"a person {text}", seed=seed).pose.joints_m[2:-2].astype(float)
    return joints + np.array([0.0, 0.0, RADAR_HEIGHT_M])


def test_push_ups_keep_the_body_straight_and_the_hands_on_the_floor():
    for seed in range(3):
        joints = _heights("does three push-ups", seed)
        shoulder = joints[:, joint("left_shoulder"), 2]
        assert (np.diff((shoulder < shoulder.min() + 0.4 * np.ptp(shoulder)).astype(int)) == 1).sum() == 3
        assert np.ptp(shoulder) > 0.15
        assert joints[:, joint("left_wrist"), 2].max() < 0.3
        trunk = joints[:, joint("neck")] - joints[:, 0]
        leg = joints[:, 0] - joints[:, joint("left_ankle")]
        cosine = (trunk * leg).sum(-1) / np.linalg.norm(trunk, axis=-1) / np.linalg.norm(leg, axis=-1)
        assert cosine.min() > np.cos(np.radians(25))
        assert joints[..., 2].min() > -0.08


def test_crawling_goes_on_with_the_trunk_level_and_low():
    joints = _heights("crawls to the left", 1)
    gone = joints[-1, 0, :2] - joints[0, 0, :2]
    assert gone[0] < -0.4
    assert joints[:, joint("neck"), 2].max() < 0.9
    assert joints[:, joint("left_knee"), 2].max() < 0.25
    stride = (joints[:, joint("left_ankle"), :2] - joints[:, 0, :2]) @ (gone / np.hypot(*gone))
    assert np.ptp(stride) > 0.15


def test_sit_ups_raise_the_trunk_as_often_as_said_and_leave_the_feet_where_they_are():
    for seed in range(3):
        joints = _heights("does three sit-ups", seed)
        neck = joints[:, joint("neck"), 2]
        assert (np.diff((neck > neck.min() + 0.6 * np.ptp(neck)).astype(int)) == 1).sum() == 3
        assert neck.min() < 0.25
        assert neck.max() > 0.45
        assert np.ptp(joints[:, joint("left_ankle")], axis=0).max() < 0.05
        assert np.ptp(joints[:, 0], axis=0).max() < 0.1
        assert joints[..., 2].min() > -0.05
