"""The wrist gets where it was asked to be."""

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.kinematics import solve
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions


def upright(n: int, arm: np.ndarray) -> Controls:
    zeros = np.zeros((n, 3))
    return Controls(
        pelvis_m=np.tile([0.0, 0.0, 0.95], (n, 1)), heading_rad=np.zeros(n), pelvis_rad=zeros, spine_rad=zeros,
        head_rad=np.zeros((n, 2)), arm_rad=np.stack([arm, arm], axis=1),
        foot_m=np.tile([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]], (n, 1, 1)), foot_rad=np.zeros((n, 2, 2)),
        knee_out_rad=np.zeros((n, 2)), knee_up_rad=np.zeros(n), roll_over_rad=np.zeros(n), knee_room=np.zeros(n),
        contact=np.ones((n, 2)),
    )  # fmt: skip


@pytest.mark.parametrize("height", [1.63, 1.96])
def test_reach_is_the_inverse_of_the_arm(height: float):
    body, rng = SkeletonProportions(height), stream(0, "reach")
    target = rng.uniform([0.12, 0.02, -0.08], [0.2, 0.18, 0.12], (50, 3)) * height
    joints = solve(body, upright(50, reach(body, target)))
    chest = joints[:, joint("spine3")]
    for side, name in ((LEFT, "left"), (RIGHT, "right")):
        mirrored = target * np.array([1.0, 1.0 if side == LEFT else -1.0, 1.0])
        assert np.abs(joints[:, joint(f"{name}_wrist")] - chest - mirrored).max() < 2e-3


def test_a_target_out_of_reach_is_approached():
    body = SkeletonProportions(1.75)
    joints = solve(body, upright(1, reach(body, np.array([[3.0, 0.3, 0.1]]))))
    arm = joints[0, joint("left_wrist")] - joints[0, joint("left_shoulder")]
    assert arm[0] / np.linalg.norm(arm) > 0.95
    assert np.linalg.norm(arm) > 0.95 * (body.upper_arm_m + body.forearm_m)
