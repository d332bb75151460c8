"""Panes: their depth, and their panels on walls."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import CameraIntrinsics, ClassMask, Plane, RgbdPhoto
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.layout.doors_and_windows import add_wall_panels, fill_panes, find_wall_panels
from tests.rooms import back_wall, plane, side_wall

SHAPE = (120, 160)
LENS = CameraIntrinsics(fx=120.0, fy=120.0, cx=79.5, cy=59.5, width=160, height=120)


def wall_with_pane(behind_m: float, name: str = "window-other") -> tuple[RgbdPhoto, np.ndarray, np.ndarray]:
    """An oblique wall from 2.5 to 4 m with a pane that shows `behind_m`: its depth, and the mask of the pane."""
    wall_m = 1 / np.linspace(1 / 2.5, 1 / 4.0, 160)[None, :] + np.zeros((120, 1))
    pane = np.zeros(SHAPE, bool)
    pane[30:80, 60:110] = True
    index = np.where(pane, NAMES.index(name), 0).astype(np.uint8)
    photo = RgbdPhoto(
        rgb=np.zeros((*SHAPE, 3), np.uint8), depth_m=np.where(pane, behind_m, wall_m), intrinsics=LENS,
        classes=ClassMask(index=index, names=NAMES),
    )  # fmt: skip
    return photo, wall_m, pane


@pytest.mark.parametrize("name", ["window-other", "mirror-stuff"])
@pytest.mark.parametrize("behind_m", [float("nan"), 9.0])
def test_holes_and_points_behind_are_put_on_the_walls_plane(behind_m: float, name: str):
    photo, wall_m, _ = wall_with_pane(behind_m, name)
    closed, sentences = fill_panes(photo)
    assert closed.depth_m == pytest.approx(wall_m, rel=0.01)
    assert sentences[0].startswith("1 windows or mirrors")


def test_a_curtain_next_to_a_pane_does_not_shift_its_plane():
    photo, wall_m, pane = wall_with_pane(9.0)
    assert photo.classes is not None
    index, depth = np.full(SHAPE, NAMES.index("wall-other"), np.uint8), photo.depth_m.copy()
    index[pane] = NAMES.index("window-other")
    curtain = np.zeros(SHAPE, bool)
    curtain[20:90, 50:60] = curtain[20:90, 110:120] = True
    index[curtain], depth[curtain] = NAMES.index("curtain"), wall_m[curtain] - 0.15
    closed, _ = fill_panes(replace(photo, depth_m=depth, classes=ClassMask(index=index, names=NAMES)))
    assert closed.depth_m[pane] == pytest.approx(wall_m[pane], rel=0.01)


def test_a_screen_gets_its_own_plane_and_not_the_walls():
    photo, _, screen = wall_with_pane(float("nan"), "tv")
    depth = photo.depth_m.copy()
    depth[30:80:4, 60:110:3] = 2.2
    closed, sentences = fill_panes(replace(photo, depth_m=depth))
    assert closed.depth_m[screen] == pytest.approx(np.full(screen.sum(), 2.2), rel=0.01)
    (sentence,) = sentences
    assert "1 screens" in sentence


LENS = CameraIntrinsics(fx=120.0, fy=120.0, cx=79.5, cy=59.5, width=160, height=120)
RADAR_FROM_CAMERA = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
WALL_M = 3.0


def _photo(
    name: str, depth_m: float = WALL_M, rows: slice = slice(30, 70), columns: slice = slice(90, 130)
) -> RgbdPhoto:
    index = np.full((120, 160), NAMES.index("wall-other"), np.uint8)
    index[rows, columns] = NAMES.index(name)
    depth = np.full((120, 160), WALL_M)
    depth[rows, columns] = depth_m
    return RgbdPhoto(
        rgb=np.zeros((120, 160, 3), np.uint8), depth_m=depth, intrinsics=LENS,
        classes=ClassMask(index=index, names=NAMES),
    )  # fmt: skip


def _found(photo: RgbdPhoto) -> tuple[Plane, ...]:
    view = AlignedPhoto(photo=photo, radar_from_camera=RADAR_FROM_CAMERA, floor_z_m=-1.3)
    return find_wall_panels(view, [side_wall(2.4), back_wall(WALL_M)])


@pytest.mark.parametrize(("name", "material"), [("window-other", "glass"), ("mirror", "metal"), ("door-stuff", "wood")])
def test_a_pane_is_a_rectangle_of_its_own_material(name: str, material: str):
    (panel,) = _found(_photo(name))
    assert panel.material == material
    assert panel.normal == pytest.approx([0, -1, 0])
    assert panel.centre_m == pytest.approx([0.75, WALL_M - 0.01, 0.25], abs=0.02)
    assert panel.half_size_m == pytest.approx((0.5, 0.5), abs=0.03)


def test_a_leaf_in_front_of_its_wall_keeps_its_offset():
    (panel,) = _found(_photo("door", depth_m=WALL_M - 0.05))
    assert panel.centre_m[1] == pytest.approx(WALL_M - 0.05, abs=0.005)


def test_regions_off_the_walls_small_ones_and_other_classes_are_ignored():
    assert _found(_photo("tv", depth_m=2.2)) == ()
    assert _found(_photo("window-other", rows=slice(30, 36))) == ()
    assert _found(_photo("couch")) == ()
    assert _found(replace(_photo("window-other"), classes=None)) == ()


def test_a_panel_replaces_the_planes_that_it_covers():
    (panel,) = _found(_photo("window-other"))
    same = plane("panel", (0.7, WALL_M - 0.03, 0.2), (0, -1, 0), (1, 0, 0), (0.3, 0.3), "wood")
    elsewhere = plane("panel", (-0.7, 2.0, 0.2), (0, -1, 0), (1, 0, 0), (0.3, 0.3), "wood")
    wall = back_wall(WALL_M)
    assert add_wall_panels([wall, same, elsewhere], [panel], [wall]) == (panel, wall, elsewhere)
