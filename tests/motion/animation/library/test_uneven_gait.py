"""Sideways without crossing, limping unevenly, pushed the way that is said."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("side", "sign"), [("left", -1.0), ("right", 1.0)])
def test_sidesteps_go_to_the_side_that_is_said_facing_as_before_and_never_cross(side: str, sign: float, seed: int):
    joints = act_out(f"takes two steps sideways to the {side}", duration_s=3.0, seed=seed).pose.joints_m
    gone = joints[-1, 0] - joints[0, 0]
    assert sign * gone[0] > 0.25
    across = joints[:, joint("left_hip"), :2] - joints[:, joint("right_hip"), :2]
    heading = np.arctan2(-across[:, 0], across[:, 1])
    assert np.ptp(np.unwrap(heading)) < 0.4
    apart = np.sum((joints[:, joint("left_ankle"), :2] - joints[:, joint("right_ankle"), :2]) * across, axis=1)
    assert apart.min() > 0


@pytest.mark.parametrize(
    ("text", "way"),
    [
        ("is pushed to the left", (-1, 0)),
        ("is pushed from the left", (1, 0)),
        ("is pushed from behind", (0, -1)),
        ("is pushed from the front", (0, 1)),
    ],
)
def test_a_push_moves_the_body_its_way(text: str, way: tuple[int, int]):
    """Who is pushed faces the radar: forwards is towards it, to smaller y."""
    for seed in range(3):
        pelvis = act_out(f"a person {text}", duration_s=2.5, seed=seed).pose.joints_m[:, 0, :2]
        gone = pelvis[-1] - pelvis[0]
        assert gone @ np.array(way) > 0.15


@pytest.mark.parametrize("seed", range(3))
def test_a_limp_is_uneven(seed: int):
    """The sound foot stands longer than the lame one; the same person limping on either side is compared."""

    def longer_on_the_left(lame: str) -> float:
        joints = act_out(f"a person limps on the {lame} leg", duration_s=6.0, seed=seed, height_m=1.75).pose.joints_m[
            240:-120
        ]
        stands = []
        for side in ("left", "right"):
            step_m = np.linalg.norm(np.diff(joints[:, joint(f"{side}_ankle"), :2], axis=0), axis=1)
            stands.append(float(np.mean(step_m * 120 < 0.25)))
        return stands[0] - stands[1]

    assert longer_on_the_left("right") - longer_on_the_left("left") > 0.1


def test_walking_lunges_go_ahead_and_down_with_every_step():
    for seed in range(2):
        joints = act_out("a person does four walking lunges to the left", seed=seed, height_m=1.75).pose.joints_m
        high = joints[:, 0, 2].astype(float)
        lowest = (high[1:-1] < high[:-2]) & (high[1:-1] <= high[2:]) & (high[1:-1] < high.max() - 0.15)
        assert 3 <= lowest.sum() <= 6
        apart = np.linalg.norm(joints[:, joint("left_ankle"), :2] - joints[:, joint("right_ankle"), :2], axis=1)
        assert apart.max() > 0.5
        assert np.linalg.norm(joints[-1, 0, :2] - joints[0, 0, :2]) > 1.5


def upright_between_s(text: str) -> float:
    """How long the trunk is within 4 degrees of upright from the last catching step to the fall."""
    motion = act_out(text, seed=1)
    joints_m, time_s = motion.pose.joints_m, motion.pose.time_s
    trunk_m = joints_m[:, joint("neck")] - joints_m[:, joint("pelvis")]
    lean_rad = np.arctan2(np.linalg.norm(trunk_m[:, :2], axis=1), trunk_m[:, 2])
    between = (time_s > 0.9) & (time_s < motion.plan.steps[0].end_s + 0.6)
    return float((lean_rad[between] < np.radians(4)).sum() / 120)


def test_who_trips_and_falls_does_not_stand_up_in_between():
    assert upright_between_s("trips and falls") < 0.1 < 0.3 < upright_between_s("trips, then falls backwards")
