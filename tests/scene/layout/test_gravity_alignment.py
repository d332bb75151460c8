"""The depth grid aligned with gravity."""

from collections.abc import Callable

import numpy as np
import pytest

from mmweaver.scene.layout.gravity_alignment import align_room
from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.reconstruction import reconstruct


def test_floor_and_walls_of_a_tilted_photo_are_aligned(box_room: Callable):
    photo = box_room(pitch_deg=12.0).photo(width=640, height=480)
    room = align_room(make_grid(photo))
    scene = reconstruct(photo)
    assert room.gravity.floor_z_m == pytest.approx(scene.floor_z_m)
    assert np.array_equal(room.radar_from_camera, scene.radar_from_camera)
    assert any(surface.plane.kind == "wall" for surface in room.surfaces)
    on_floor = np.abs(room.grid.points_m[..., 2] - room.gravity.floor_z_m) < 0.02
    assert on_floor[-20:].mean() > 0.8
