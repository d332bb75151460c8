"""Bends, turns by an angle, leaps, and the floor that somebody lies on."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import joint
from mmweaver.motion.compose import compose
from mmweaver.motion.empty_floor import act_out
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.floor_map import FloorMap
from rooms import WINDOW_M, room


def headings(text: str, seconds: float, seed: int = 0) -> np.ndarray:
    joints = act_out(text, duration_s=seconds, seed=seed).pose.joints_m
    across = joints[:, joint("left_hip"), :2] - joints[:, joint("right_hip"), :2]
    return np.unwrap(np.arctan2(-across[:, 0], across[:, 1]))


@pytest.mark.parametrize(
    ("text", "angle"),
    [
        ("walks a quarter circle to the left", 90),
        ("walks a half circle to the right", -180),
        ("turns 270 degrees to the left", 270),
        ("spins 360 degrees to the right", -360),
        ("walks forward while turning left", 90),
    ],
)
def test_angles_are_kept_left_being_the_persons_own(text: str, angle: float):
    turned = headings(text, 4.0)
    assert np.degrees(turned[-1] - turned[0]) == pytest.approx(angle, abs=25)


def test_nobody_lies_in_furniture():
    boxes = ((-1.6, -0.7, 1.2, 1.8), (0.8, 1.8, 1.5, 2.2), (-0.4, 0.3, 3.0, 3.3))
    scene = room(boxes=boxes)
    for seed in range(9):
        text = ("falls", "lies down", "falls forward")[seed % 3]
        made = compose(plan_motion(text, 4.0), scene, seed=seed, range_window_m=WINDOW_M)
        floor = FloorMap(scene, WINDOW_M, made.pose.height_m)
        trunk_and_legs = made.pose.joints_m[:, :18]  # arms may reach over what is low
        assert floor.clearance_at(trunk_and_legs[..., :2]).min() > 0.0
    cell = room(boxes=((-3.0, -0.4, 0.0, 6.0), (0.4, 3.0, 0.0, 6.0), (-3.0, 3.0, 0.0, 1.6), (-3.0, 3.0, 2.4, 6.0)))
    with pytest.raises(InputError, match="no room"):
        compose(plan_motion("lies down", 4.0), cell, seed=0, range_window_m=WINDOW_M, may_touch=False)


@pytest.mark.parametrize("text", ["walks around", "walks in a circle", "walks forward"])
def test_a_walk_without_an_aim_begins_along_the_heading_that_is_given(text: str):
    scene = room(boxes=((-1.6, -0.7, 1.2, 1.8), (0.8, 1.8, 1.5, 2.2)))
    for heading_rad in (-2.5, 0.1, 1.6):
        pose = compose(
            plan_motion(text, 4.0), scene, seed=3, range_window_m=WINDOW_M, heading_rad=heading_rad
        ).pose  # fmt: skip
        across = pose.joints_m[:5, joint("left_hip"), :2] - pose.joints_m[:5, joint("right_hip"), :2]
        faces_rad = np.arctan2(-across[:, 0], across[:, 1]).mean()
        assert np.cos(faces_rad - heading_rad) > np.cos(np.radians(25))


@pytest.mark.parametrize(("text", "is_said"), [("runs in a circle", True), ("walks in a circle", False)])
def test_running_in_a_circle_is_said_to_be_slower_than_running(text: str, is_said: bool):
    motion = compose(plan_motion(text, 5.0), room(), seed=1, range_window_m=WINDOW_M)
    assert any("slower than running" in note for note in motion.assumptions) == is_said
    assert (motion.clauses[0].status == "approximated") == is_said
    pelvis_m = motion.pose.joints_m[120:-120, joint("pelvis"), :2]
    speed_mps = np.linalg.norm(np.diff(pelvis_m, axis=0), axis=1).mean() * 120
    assert speed_mps < 2.1
