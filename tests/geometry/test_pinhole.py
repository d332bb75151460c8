"""Pixels to points and back."""

import numpy as np

from mmweaver.core.records import CameraIntrinsics
from mmweaver.geometry.pinhole import project, unproject

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


def test_what_is_behind_has_no_pixel_and_holes_stay_holes():
    pixels, depth = project(np.array([[0.1, 0.1, -1.0], [0, 0, 0]]), CAMERA)
    assert np.isnan(pixels).all()
    assert depth.tolist() == [-1, 0]
    holes = np.full((48, 64), np.nan)
    assert np.isnan(unproject(holes, CAMERA)).all()
