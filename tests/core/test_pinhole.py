"""Pixels to points and back."""

import numpy as np
import pytest

from mmweaver.core.pinhole import (
    binned,
    project,
    resized,
    rotated_clockwise,
    subsampled,
    unproject,
    viewing_rays,
)
from mmweaver.core.records import CameraIntrinsics

CAMERA = CameraIntrinsics(fx=400.0, fy=410.0, cx=30.0, cy=25.0, width=64, height=48)


def test_project_undoes_unproject():
    depth = np.random.default_rng(0).uniform(0.5, 4, (48, 64))
    pixels, back = project(unproject(depth, CAMERA).reshape(-1, 3), CAMERA)
    row, column = np.mgrid[:48, :64]
    np.testing.assert_allclose(pixels, np.stack([column.ravel(), row.ravel()], 1), atol=1e-9)
    np.testing.assert_allclose(back, depth.ravel())


def test_axes_are_right_down_forward():
    points = unproject(np.full((48, 64), 2.0), CAMERA)
    assert points[25, 30].tolist() == [0, 0, 2]
    assert points[25, 31, 0] > 0
    assert points[26, 30, 1] > 0


def test_points_behind_have_no_pixel_and_holes_stay_holes():
    pixels, depth = project(np.array([[0.1, 0.1, -1.0], [0, 0, 0]]), CAMERA)
    assert np.isnan(pixels).all()
    assert depth.tolist() == [-1, 0]
    holes = np.full((48, 64), np.nan)
    assert np.isnan(unproject(holes, CAMERA)).all()


def test_subsampling_keeps_the_rays_of_the_pixels_that_stay():
    small = subsampled(CAMERA, 3)
    assert (small.width, small.height) == (22, 16)
    np.testing.assert_allclose(viewing_rays(small), viewing_rays(CAMERA)[::3, ::3], atol=1e-12)


@pytest.mark.parametrize("small", [binned(CAMERA, 4), resized(CAMERA, 16, 12)])
def test_binning_and_resizing_average_the_rays_of_a_block(small: CameraIntrinsics):
    blocks = viewing_rays(CAMERA).reshape(12, 4, 16, 4, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(viewing_rays(small), blocks, atol=1e-12)


def test_rotating_the_picture_rotates_its_rays():
    """Clockwise: the left edge becomes the top edge."""
    rays = np.rot90(viewing_rays(CAMERA), -1)
    rotated = viewing_rays(rotated_clockwise(CAMERA))
    np.testing.assert_allclose(rotated[..., 0], -rays[..., 1], atol=1e-12)
    np.testing.assert_allclose(rotated[..., 1], rays[..., 0], atol=1e-12)
