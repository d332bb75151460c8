"""Lying on a couch that the room has, and falling off a seat."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.compose import compose
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out
from mmweaver.motion.language.timing import plan_motion
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.sample_photo import sample_photo


def test_somebody_lies_on_the_couch_of_the_room_and_gets_up():
    photo, _ = sample_photo()
    scene = reconstruct(photo)
    plan = plan_motion("a person lies on the sofa, then gets up")
    assert [step.lower for step in plan.steps] == ["lie_on_seat", "sit_up", "stand_up"]
    motion = compose(plan, scene, seed=0, range_window_m=(0.7, 3.48))
    assert not any("is assumed at" in note for note in motion.assumptions)
    height_m = motion.pose.joints_m[..., 2] - scene.floor_z_m
    lying, standing = height_m[2], height_m[-3]
    couch_m = min(float(np.hypot(*(seat.position_m[:2] - motion.pose.joints_m[2, 0, :2]))) for seat in scene.seats)
    assert couch_m < 0.5
    assert 0.4 < lying[joint("pelvis")] < 0.8
    assert abs(lying[joint("neck")] - lying[joint("pelvis")]) < 0.15
    assert standing[joint("neck")] > 1.2


def test_a_fall_off_a_chair_ends_on_the_floor_on_the_side_that_is_named():
    motion = act_out("a person falls off the chair to the left", seed=1)
    height_m = motion.pose.joints_m[..., 2] + RADAR_HEIGHT_M
    assert height_m[2, joint("pelvis")] > 0.45
    assert height_m[-3, joint("pelvis")] < 0.25
    assert height_m[-3, joint("left_shoulder")] < height_m[-3, joint("right_shoulder")] - 0.2
