"""Floor that the photo does not show."""

import numpy as np

from mmweaver.core.records import CameraIntrinsics, Plane, RgbdPhoto
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.scene.affordances.assumed_floor import find_assumed_floor
from mmweaver.scene.affordances.free_space import find_free_space
from mmweaver.scene.layout.height_map import make_height_map

FLOOR_M = -1.1
LEVEL = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def _view(board_top_m: float) -> AlignedPhoto:
    """A wall 4 m away, and before it, 2 m away, a board from the floor to a height, which fills the lower picture."""
    lens = CameraIntrinsics(fx=300.0, fy=300.0, cx=159.5, cy=119.5, width=320, height=240)
    rows = np.arange(240)[:, None] + np.zeros((1, 320))
    hits_board = 2.0 * (lens.cy - rows) / lens.fy < FLOOR_M + board_top_m
    depth = np.where(hits_board, 2.0, 4.0)
    photo = RgbdPhoto(rgb=np.zeros((240, 320, 3), np.uint8), depth_m=depth, intrinsics=lens)
    return AlignedPhoto(photo=photo, radar_from_camera=LEVEL, floor_z_m=FLOOR_M)


def _free_at(board_top_m: float, y_m: float) -> tuple[bool, bool]:
    """Whether a place straight ahead is free, and whether it is assumed to be."""
    view = _view(board_top_m)
    height_map = make_height_map(view)
    free = find_free_space(height_map)
    assumed = find_assumed_floor(height_map, view, (), free.is_free)
    row, column = np.argmin(np.abs(free.y_m - y_m)), np.argmin(np.abs(free.x_m))
    return bool(free.is_free[row, column]), bool(assumed[row, column])


def test_floor_goes_on_behind_a_board_over_which_the_camera_looks():
    """Over a low board the floor behind is inferred anyway; over a high one only chest and head would be seen."""
    assert _free_at(0.6, 3.2) == (True, False)
    assert _free_at(1.25, 3.2) == (False, True)
    assert _free_at(1.9, 3.2) == (False, False), "nothing of a body behind it would be seen"


def test_nothing_is_assumed_in_the_board_or_behind_the_wall():
    assert _free_at(1.25, 2.0)[1] is False
    assert _free_at(1.25, 4.2)[1] is False


def test_floor_before_what_fills_the_picture_is_free_one_way_or_the_other():
    assert any(_free_at(1.0, 1.2))


def test_walls_end_the_floor():
    view = _view(1.25)
    height_map = make_height_map(view)
    free = find_free_space(height_map)
    wall = Plane(
        kind="wall", centre_m=np.array([0.0, 3.0, 0.0]), normal=np.array([0.0, -1.0, 0.0]),
        axis_u=np.array([1.0, 0.0, 0.0]), axis_v=np.array([0.0, 0.0, 1.0]), half_size_m=(3.0, 1.5), material="brick",
    )  # fmt: skip
    behind = find_assumed_floor(height_map, view, (wall,), free.is_free)[free.y_m > 3.0]
    assert not behind.any()
