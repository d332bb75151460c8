"""Where a body may stand, in rooms whose furniture is known."""

from collections.abc import Callable

import numpy as np

from mmweaver.core.records import FreeSpace
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


def test_two_flying_pixels_do_not_block(box_room: Callable):
    photo = box_room().photo(width=640, height=480)
    clean = reconstruct(photo).free_space.is_free
    photo.depth_m[300, 320:322] = 1.5
    assert (reconstruct(photo).free_space.is_free == clean).mean() > 0.9995
