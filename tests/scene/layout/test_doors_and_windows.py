"""Doors and windows without a mask."""

import numpy as np
import pytest

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import CameraIntrinsics, Plane, RgbdPhoto
from mmweaver.scene.layout.doors_and_windows import find_openings
from tests.motion.rooms import LEVEL

FLOOR_Z_M, AWAY_M = -1.3, 3.0
LENS = CameraIntrinsics(fx=260.0, fy=260.0, cx=319.5, cy=199.5, width=640, height=480)
WALL = Plane(
    kind="wall", centre_m=np.array([0.0, AWAY_M, 0.0]), normal=np.array([0.0, -1.0, 0.0]),
    axis_u=np.array([1.0, 0.0, 0.0]), axis_v=np.array([0.0, 0.0, 1.0]), half_size_m=(3.0, 1.3), material="plasterboard",
)  # fmt: skip


def _found(*patches: tuple[float, float, float, float], hidden_below_m: float = 0.0) -> list[str]:
    """Openings found on a white wall with red patches (left, right, bottom, top above the floor)."""
    rows, columns = np.mgrid[0:480, 0:640]
    x, z = (columns - LENS.cx) / LENS.fx * AWAY_M, -(rows - LENS.cy) / LENS.fy * AWAY_M - FLOOR_Z_M
    rgb = np.full((480, 640, 3), 220, np.uint8)
    for left, right, bottom, top in patches:
        rgb[(x > left) & (x < right) & (z > bottom) & (z < top)] = (140, 40, 30)
    depth = np.full((480, 640), AWAY_M)
    depth[z < 0] = np.nan
    depth[z < hidden_below_m] = 1.5
    photo = RgbdPhoto(rgb=rgb, depth_m=depth, intrinsics=LENS)
    view = AlignedPhoto(photo=photo, radar_from_camera=LEVEL, floor_z_m=FLOOR_Z_M)
    return [opening.kind for opening in find_openings(view, (WALL,))]


def test_a_door_reaches_the_floor_and_ends_below_the_lintel():
    assert _found((-0.4, 0.5, 0.0, 2.05)) == ["door"]
    assert _found((-0.4, 0.5, 0.0, 2.05), hidden_below_m=0.2) == ["door"]


@pytest.mark.parametrize(
    ("patch", "hidden"),
    [
        ((-0.4, 0.5, 0.25, 2.05), 0.0),  # a board: the wall goes on below it
        ((-0.4, 0.5, 0.0, 2.6), 0.0),  # a curtain or cupboard up to the ceiling
        ((-0.4, 0.5, 0.0, 2.05), 0.9),  # half hidden: it may stand on something
        ((-0.4, 0.5, 0.45, 2.05), 0.0),
    ],
)
def test_a_partial_match_is_not_a_door(patch: tuple[float, float, float, float], hidden: float):
    assert "door" not in _found(patch, hidden_below_m=hidden)


def test_a_window_is_above_a_sill():
    assert _found((-0.7, 0.7, 0.95, 2.1)) == ["window"]
    assert _found() == []
