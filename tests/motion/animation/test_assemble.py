"""Steps become one motion: walking, turning and walking on is one gait, other steps stay apart."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.assemble import _merge_gait, assemble, dense_times
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import Step


def move(start_s: float, end_s: float) -> Move:
    return Move(
        start_s=start_s, end_s=end_s, length_m=1.0, direction_rad=0.0, ramp_in_s=0.2, ramp_out_s=0.2
    )  # fmt: skip


def test_walking_turning_and_walking_on_is_one_gait():
    walk, turn, on = (
        PlacedStep(step=Step(lower=lower, start_s=start, end_s=start + 1.0), moves=moves)
        for lower, start, moves in (
            ("walk", 0.0, (move(0.0, 1.0),)),
            ("turn", 1.0, ()),
            ("walk", 2.0, (move(2.0, 3.0),)),
        )
    )
    wave = PlacedStep(step=Step(upper="wave", start_s=3.0, end_s=4.0))
    merged = _merge_gait((walk, turn, on, wave))
    assert [(placed.step.lower, placed.step.end_s, len(placed.moves)) for placed in merged] == [
        ("walk", 3.0, 2), ("stand", 4.0, 0),
    ]  # fmt: skip


def test_a_motion_covers_its_duration_and_stands_on_its_floor():
    steps = (PlacedStep(step=Step(upper="wave", end_s=1.5)),)
    path = RootPath(start_m=(0.2, 2.0), heading_rad=0.0)
    pose = assemble(steps, path, SkeletonProportions(1.75), seed=0, duration_s=1.5, floor_z_m=-1.1)
    assert np.array_equal(pose.time_s, dense_times(1.5))
    assert pose.time_s[0] < 0
    assert pose.time_s[-1] > 1.5
    assert -1.11 < pose.joints_m[..., 2].min() < -1.05
    assert np.abs(pose.joints_m[:, 0, :2] - [0.2, 2.0]).max() < 0.1


def test_arms_that_are_held_through_two_steps_do_not_come_down_between():
    steps = tuple(
        PlacedStep(step=Step(lower=lower, upper="arms_out", hand="both", start_s=start, end_s=start + 2.0))
        for lower, start in (("stand", 0.0), ("one_leg", 2.0))
    )
    pose = assemble(
        steps,
        RootPath(start_m=(0.0, 2.0), heading_rad=0.0),
        SkeletonProportions(1.75),
        seed=0,
        duration_s=4.0,
        floor_z_m=-1.1,
    )
    wrist, shoulder = (pose.joints_m[:, joint(f"left_{name}"), 2] for name in ("wrist", "shoulder"))
    between = (pose.time_s > 1.5) & (pose.time_s < 2.5)
    assert (wrist - shoulder)[between].min() > -0.25
