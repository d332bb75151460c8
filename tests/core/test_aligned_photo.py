"""Pixels of an aligned photo as points of the radar's frame, and back."""

import numpy as np
import pytest

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto

CAMERA = CameraIntrinsics(fx=40.0, fy=40.0, cx=15.5, cy=11.5, width=32, height=24)
PITCH_RAD = 0.3


@pytest.fixture
def view() -> AlignedPhoto:
    """A camera that looks down by `PITCH_RAD` at a surface 2 m away along the optical axis, with one hole."""
    depth_m = np.full((24, 32), 2.0)
    depth_m[3, 4] = np.nan
    level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    cosine, sine = np.cos(PITCH_RAD), np.sin(PITCH_RAD)
    tilt = np.array([[1.0, 0, 0], [0, cosine, sine], [0, -sine, cosine]])
    photo = RgbdPhoto(rgb=np.zeros((24, 32, 3), np.uint8), depth_m=depth_m, intrinsics=CAMERA)
    return AlignedPhoto(photo=photo, radar_from_camera=level @ tilt, floor_z_m=-1.2)


def test_the_optical_axis_points_down_by_the_pitch(view: AlignedPhoto):
    axis = (view.points_m[11:13, 15:17]).mean(axis=(0, 1))
    assert axis == pytest.approx([0.0, 2 * np.cos(PITCH_RAD), -2 * np.sin(PITCH_RAD)], abs=1e-9)


def test_depth_times_ray_is_the_point(view: AlignedPhoto):
    np.testing.assert_allclose(view.rays * view.photo.depth_m[..., None], view.points_m, atol=1e-12)
    assert np.isnan(view.points_m[3, 4]).all()


def test_look_up_undoes_points(view: AlignedPhoto):
    row, column = np.mgrid[:24, :32]
    seen = view.look_up(2.0 * view.rays)
    assert seen.in_picture.all()
    assert np.array_equal(seen.row, row)
    assert np.array_equal(seen.column, column)
    np.testing.assert_allclose(seen.depth_m, 2.0)


def test_points_behind_or_outside_are_not_in_the_picture(view: AlignedPhoto):
    seen = view.look_up(np.array([[0.0, -2.0, 0.0], [50.0, 2.0, 0.0], [0.0, 0.0, 0.0]]))
    assert not seen.in_picture.any()
    assert (seen.row == 0).all()
    assert (seen.column == 0).all()
    assert seen.depth_m[0] < 0
