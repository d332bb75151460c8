"""Steps become one motion: walking, turning and walking on is one gait, other steps stay apart."""

import numpy as np

from mmweaver.motion.animation.assemble import assemble, dense_times
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import Step


def move(start_s: float, end_s: float) -> Move:
    return Move(
        start_s=start_s, end_s=end_s, length_m=1.0, direction_rad=0.0, ramp_in_s=0.2, ramp_out_s=0.2
    )  # fmt: skip


def test_a_motion_covers_its_duration_and_stands_on_its_floor():
    steps = (PlacedStep(step=Step(upper="wave", end_s=1.5)),)
    path = RootPath(start_m=(0.2, 2.0), heading_rad=0.0)
    pose = assemble(steps, path, SkeletonProportions(1.75), seed=0, duration_s=1.5, floor_z_m=-1.1)
    assert np.array_equal(pose.time_s, dense_times(1.5))
    assert pose.time_s[0] < 0
    assert pose.time_s[-1] > 1.5
    assert -1.11 < pose.joints_m[..., 2].min() < -1.05
    assert np.abs(pose.joints_m[:, 0, :2] - [0.2, 2.0]).max() < 0.1
