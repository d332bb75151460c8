"""What is hidden of things that are seen in part."""

import dataclasses

import numpy as np
import pytest

from mmweaver.core.records import CameraIntrinsics, Plane, RgbdPhoto, Scene
from mmweaver.motion.planning.occluded_geometry import (
    extended_to_floor,
    occluded_along,
    occluded_share,
    table_legs,
    table_tops,
    unseen_share,
    upright_structures,
)
from tests.motion.rooms import FLOOR_Z_M, room


def test_low_points_reach_the_floor_and_high_ones_do_not():
    points = np.array([[0.0, 2.0, FLOOR_Z_M + 0.1], [0.5, 2.0, FLOOR_Z_M + 0.7]])
    feet = extended_to_floor(points, FLOOR_Z_M)
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
    legs = table_legs(_with_table(1.0))
    assert np.allclose(sorted({round(float(x), 1) for x in np.abs(legs[:, 0])}), [0.5, 0.6])
    assert legs[:, 2].max() < FLOOR_Z_M + 0.7
    assert legs[:, 2].min() < FLOOR_Z_M + 0.1


def _before_a_rim(width_m: float, thick_m: float = 0.04, *, above_m: float = 0.02) -> Scene:
    """The photo shows the front edge of a board alone, 2 m away, so high above the camera."""
    lens = CameraIntrinsics(fx=200.0, fy=200.0, cx=159.5, cy=119.5, width=320, height=240)
    depth = np.full((240, 320), np.nan)
    half = round(width_m / 2 / 2.0 * lens.fx)
    low, high = (round(119.5 - z / 2.0 * lens.fy) for z in (above_m, above_m + thick_m))
    depth[high:low, 160 - half : 160 + half] = 2.0
    photo = RgbdPhoto(rgb=np.zeros((240, 320, 3), np.uint8), depth_m=depth, intrinsics=lens)
    return dataclasses.replace(room(floor_z_m=-0.7), photo=photo)


def _tops(scene: Scene) -> np.ndarray:
    rows, columns = np.nonzero(np.isfinite(scene.photo.depth_m))
    lens = scene.photo.intrinsics
    away = scene.photo.depth_m[rows, columns]
    points = np.column_stack([(columns - lens.cx) / lens.fx * away, away, -(rows - lens.cy) / lens.fy * away])
    return table_tops(scene, points)


def test_a_top_goes_on_behind_the_rim_that_hides_it():
    tops = _tops(_before_a_rim(1.0))
    assert tops[:, 1].min() < 2.05
    assert 2.5 < tops[:, 1].max() < 2.9
    assert np.abs(tops[:, 0]).max() < 0.8


def test_backs_of_chairs_and_of_sofas_are_no_tops():
    assert len(_tops(_before_a_rim(0.4))) == 0  # narrow
    assert len(_tops(_before_a_rim(1.0, 0.3))) == 0  # thick


def test_nothing_goes_on_where_the_camera_sees_farther():
    scene = _before_a_rim(1.0, 0.02, above_m=0.1)  # seen from below
    farther = np.where(np.isnan(scene.photo.depth_m), 5.0, scene.photo.depth_m)
    open_behind = dataclasses.replace(scene, photo=dataclasses.replace(scene.photo, depth_m=farther))
    rim = _tops(scene)
    rim = rim[rim[:, 1] < 2.01]
    assert table_tops(scene, rim)[:, 1].max() > 2.5
    assert table_tops(open_behind, rim)[:, 1].max() < 2.5


def test_what_is_behind_a_thing_is_hidden():
    scene = _with_table(2.0)
    assert occluded_share(scene, np.array([[[0.0, 2.5, 0.0], [0.0, 1.5, 0.0]]])) == 0.5
    assert occluded_share(scene, np.array([[[9.0, 2.5, 0.0]]])) == 0.0  # beside the picture
    assert unseen_share(scene, np.array([[[9.0, 2.5, 0.0], [0.0, 2.5, 0.0], [0.0, 1.5, 0.0]]])) == pytest.approx(2 / 3)


def test_a_way_behind_a_thing_is_one_that_the_camera_does_not_see():
    scene = _with_table(2.0)
    tracks = np.array([[[0.0, 1.5], [0.0, 1.6]], [[0.0, 1.5], [0.0, 2.8]], [[np.nan, np.nan], [0.0, 1.5]]])
    hidden = occluded_along(scene, tracks)
    assert hidden[0].tolist() == [0.0, 0.0]
    assert hidden[1, 1] > 0.9
    assert hidden[2, 0] == 0.0


def test_a_top_goes_on_behind_the_chairs_that_hide_a_part_of_it():
    """Two parts of a level top 2 m away and below the camera; between them something stands 1.2 m away, or nothing."""
    lens = CameraIntrinsics(fx=200.0, fy=200.0, cx=159.5, cy=119.5, width=320, height=240)
    x, y = np.meshgrid(np.arange(-0.8, 0.8, 0.02), np.arange(2.0, 2.5, 0.02))
    seen = np.abs(x) > 0.2
    points = np.column_stack([x[seen], y[seen], np.full(int(seen.sum()), -0.4)])
    for before_m, hidden in ((1.2, True), (4.0, False)):
        photo = RgbdPhoto(rgb=np.zeros((240, 320, 3), np.uint8), depth_m=np.full((240, 320), before_m), intrinsics=lens)
        tops = table_tops(dataclasses.replace(room(), photo=photo), points)
        between = (np.abs(tops[:, 0]) < 0.1) & (np.abs(tops[:, 1] - 2.25) < 0.1)
        assert between.any() == hidden


def test_a_table_s_legs_are_pillars_and_a_seat_under_it_is_none():
    scene = _with_table(3.0)
    x, y = np.meshgrid(np.arange(-0.6, 0.6, 0.02), np.arange(2.0, 2.5, 0.02))
    top = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, FLOOR_Z_M + 0.72)])
    height = np.arange(0.1, 0.7, 0.02)
    leg = np.column_stack([np.full(len(height), 0.5), np.full(len(height), 2.05), FLOOR_Z_M + height])
    seat = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, FLOOR_Z_M + 0.45)])
    seat = seat[np.abs(seat[:, 0]) < 0.2]
    legs = upright_structures(scene, np.concatenate([top, leg, seat]))
    assert len(legs) > 0
    assert np.abs(legs[:, 0] - 0.5).max() < 0.06
    assert len(upright_structures(scene, np.concatenate([top, seat]))) == 0
