"""The maps that the pictures show: fans, thinning, slow movement, points below the floor."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.viz.figure_data import Fan, FigureData
from tests.viz.views import BREATHING_M, breathing_view


def test_a_fan_puts_a_target_at_its_position_in_metres():
    range_m, angle_rad = np.linspace(0.5, 3.5, 61), np.deg2rad(np.linspace(-60, 60, 121))
    values = np.zeros((61, 121))
    values[30, 90] = 1.0  # 2 m, 30 degrees right
    fan = Fan.over(range_m, angle_rad)
    raster = fan.lay(values)
    row, column = np.argwhere(raster == 1.0).mean(axis=0)
    left, right, near, far = fan.extent
    x_m = left + (right - left) * column / (raster.shape[1] - 1)
    y_m = near + (far - near) * row / (raster.shape[0] - 1)
    assert (x_m, y_m) == pytest.approx((2 * np.sin(np.pi / 6), 2 * np.cos(np.pi / 6)), abs=0.02)


def test_a_fan_is_empty_beyond_its_angles_and_before_its_first_range():
    fan = Fan.over(np.linspace(1.0, 3.0, 21), np.deg2rad(np.linspace(-45, 45, 91)))
    raster = fan.lay(np.ones((21, 91)))
    assert np.isnan(raster[0]).all()  # beside and at the radar
    assert np.isnan(raster[-1, 0])
    middle = raster[:, raster.shape[1] // 2]
    assert np.isnan(middle[: len(middle) // 4]).all()
    assert (middle[len(middle) // 2 : -2] == 1.0).all()


def test_moving_maps_show_the_walker_and_full_maps_the_static_target(view: FigureData):
    pelvis_m = np.linalg.norm(view.poses[0].joints_m[:, 0], axis=1)
    extent_m = np.linalg.norm(view.poses[0].joints_m, axis=2)
    range_m = view.cube.grid.range_m
    moving_m = range_m[view.range_doppler_moving.sum(axis=2).argmax(axis=1)]
    assert (moving_m > extent_m.min(axis=1) - 0.1).all()
    assert (moving_m < extent_m.max(axis=1) + 0.1).all()
    standing_m = range_m[view.range_doppler[:, :, 16].argmax(axis=1)]
    assert standing_m == pytest.approx(np.hypot(0.6, 2.0), abs=0.05)
    assert np.ptp(pelvis_m) > 0.8


def test_azimuth_of_the_walker_is_left(view: FigureData):
    azimuth_rad = view.azimuth_rad[view.range_azimuth_moving.mean(axis=0).max(axis=0).argmax()]
    assert np.tan(azimuth_rad) == pytest.approx(-0.3 / 2.5, abs=0.06)


def test_somebody_who_just_breathes_is_slow_and_a_walker_is_not(view: FigureData):
    assert not view.is_slow
    assert breathing_view(view).is_slow
    assert not replace(breathing_view(view, 0.0)).is_slow


def test_slow_movement_is_what_changes_over_frames(view: FigureData):
    slow = breathing_view(view)
    profile = slow.range_doppler_moving.max(axis=(0, 2))
    assert slow.cube.grid.range_m[profile.argmax()] == pytest.approx(BREATHING_M, abs=0.05)
    assert slow.slow_cells[0].range_m == pytest.approx(BREATHING_M, abs=0.05)


def test_points_below_the_floor_are_known(view: FigureData):
    assert not view.is_below_floor.any()
    deep = replace(view.points, z_m=np.where(view.points.frame == 3, -1.5, 0.0))
    assert np.flatnonzero(replace(view, points=deep).is_below_floor).tolist() == [3]
    assert not replace(view, points=deep, aligned=None).is_below_floor.any()
