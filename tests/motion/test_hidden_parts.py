"""What is hidden of things that are seen in part."""

import dataclasses

import numpy as np
from tests.motion.rooms import FLOOR_Z_M, room

from mmweaver.core.records import CameraIntrinsics, Plane, RgbdPhoto, Scene
from mmweaver.motion.hidden_parts import feet_of, legs_of


def test_low_points_reach_the_floor_and_high_ones_do_not():
    points = np.array([[0.0, 2.0, FLOOR_Z_M + 0.1], [0.5, 2.0, FLOOR_Z_M + 0.7]])
    feet = feet_of(points, FLOOR_Z_M)
    assert set(feet[:, 0]) == {0.0}
    assert 0.03 < feet[:, 2].min() - FLOOR_Z_M < 0.07


def _with_table(seen_behind_m: float) -> Scene:
    """A table top at 0.7 m; the camera measures one distance everywhere."""
    lens = CameraIntrinsics(fx=200.0, fy=200.0, cx=159.5, cy=119.5, width=320, height=240)
    photo = RgbdPhoto(
        rgb=np.zeros((240, 320, 3), np.uint8), depth_m=np.full((240, 320), seen_behind_m), intrinsics=lens
    )
    top = Plane(
        kind="top", centre_m=np.array([0.0, 2.5, FLOOR_Z_M + 0.7]), normal=np.array([0.0, 0.0, 1.0]),
        axis_u=np.array([1.0, 0.0, 0.0]), axis_v=np.array([0.0, 1.0, 0.0]), half_size_m=(0.6, 0.4), material="wood",
    )  # fmt: skip
    scene = room()
    return dataclasses.replace(scene, photo=photo, planes=(*scene.planes, top))


def test_legs_stand_under_hidden_corners():
    legs = legs_of(_with_table(1.0))
    assert np.allclose(sorted({round(float(x), 1) for x in np.abs(legs[:, 0])}), [0.5, 0.6])
    assert legs[:, 2].max() < FLOOR_Z_M + 0.7
    assert legs[:, 2].min() < FLOOR_Z_M + 0.1


def test_no_legs_where_the_camera_looks_through_or_nothing_is_a_table():
    assert len(legs_of(_with_table(4.5))) == 0
    assert legs_of(room()).shape == (0, 3)
