"""Hips that go round over feet that stay."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def test_hula_hooping_hips_go_round_while_feet_and_head_stay():
    joints = act_out("a person hula hoops", duration_s=4.0, seed=2, height_m=1.75).pose.joints_m.astype(float)
    hips = joints[:, 0, :2] - joints[:, 0, :2].mean(axis=0)
    angle = np.unwrap(np.arctan2(hips[:, 1], hips[:, 0]))
    assert 3 < abs(angle[-1] - angle[0]) / (2 * np.pi) < 9
    assert np.hypot(*hips.T).min() > 0.02
    assert np.ptp(joints[:, joint("left_ankle"), :2], axis=0).max() < 0.01
    assert np.ptp(joints[:, joint("head"), :2], axis=0).max() < 2 * np.ptp(hips, axis=0).max()
