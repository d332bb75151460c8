"""Floor that is free, and floor that is assumed."""

from collections.abc import Callable

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, RgbdPhoto
from mmweaver.scene.affordances.landmarks import find_assumed_floor, find_free_space
from mmweaver.scene.layout.height_map import make_height_map
from mmweaver.scene.reconstruction import reconstruct


def _at(space: FreeSpace, x_m: float, y_m: float) -> tuple[bool, bool]:
    row, column = np.argmin(np.abs(space.y_m - y_m)), np.argmin(np.abs(space.x_m - x_m))
    return bool(space.is_free[row, column]), bool(space.is_seen[row, column])


def test_free_blocked_occluded_and_outside_places(box_room: Callable):
    cabinet = ((0.6, 1.4), (2.4, 2.8), (0.0, 2.0))
    table = ((-1.0, -0.2), (2.2, 2.8), (0.69, 0.73))
    space = reconstruct(box_room(boxes=[cabinet, table]).photo(width=640, height=480)).free_space
    assert _at(space, 0.2, 2.5) == (True, True)
    assert _at(space, -0.6, 2.5) == (False, False)  # the table
    assert _at(space, 1.0, 2.6) == (False, False)  # inside the cabinet
    assert _at(space, 1.2, 3.3) == (False, False)  # behind it
    assert _at(space, 0.2, 4.2) == (False, False)  # behind the wall
    assert _at(space, 2.9, 1.0) == (False, False)  # beside the picture
    assert _at(space, 0.0, 0.8) == (True, False)  # under the picture's lower edge
    assert _at(space, 0.0, 0.4) == (False, False)  # too close


def test_a_place_behind_a_table_is_free_but_unseen(box_room: Callable):
    counter = ((-1.0, 1.0), (1.7, 1.9), (0.0, 0.9))
    space = reconstruct(box_room(boxes=[counter], pitch_deg=18.0).photo(width=640, height=480)).free_space
    assert _at(space, 0.0, 2.2) == (True, False)
    assert _at(space, 0.0, 1.8) == (False, False)


def test_a_lamp_above_head_height_does_not_block(box_room: Callable):
    lamp = ((-0.2, 0.2), (2.3, 2.7), (2.05, 2.2))
    space = reconstruct(box_room(boxes=[lamp], pitch_deg=8.0).photo(width=640, height=480)).free_space
    assert _at(space, 0.0, 2.5)[0]


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
