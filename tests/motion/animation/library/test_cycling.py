"""On an exercise bike."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out


def test_feet_go_round_half_a_turn_apart_while_the_pelvis_stays():
    for seed in range(3):
        pose = act_out("a person pedals on an exercise bike", seed=seed).pose
        joints = pose.joints_m[2:-2].astype(float) + np.array([0.0, 0.0, RADAR_HEIGHT_M])
        left, right = (joints[:, joint(f"{side}_foot"), 2] for side in ("left", "right"))
        assert np.corrcoef(left, right)[0, 1] < -0.9
        assert 0.25 < np.ptp(left) < 0.45
        assert min(left.min(), right.min()) > 0.05
        assert np.ptp(joints[:, 0], axis=0).max() < 0.06
        leg_m = np.linalg.norm(joints[:, joint("left_hip")] - joints[:, joint("left_ankle")], axis=-1)
        assert leg_m.max() < 0.485 * pose.height_m


def test_who_stands_gets_on_and_off_without_a_jerk():
    joints = act_out("a person waves, then pedals on an exercise bike, then waves", seed=1).pose.joints_m.astype(float)
    assert np.linalg.norm(np.diff(joints, n=2, axis=0), axis=-1).max() * 120 < 0.6
