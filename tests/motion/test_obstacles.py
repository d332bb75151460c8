"""A body against what the photo shows."""

import dataclasses

import numpy as np
from tests.rooms import standing_person

from mmweaver.motion.obstacles import Obstacles
from mmweaver.scene.procedural.room import make_room
from mmweaver.scene.reconstruction import reconstruct


def test_a_body_in_the_open_is_clear_and_one_in_the_wall_is_not():
    room = make_room("corridor", 0, 3)
    scene = reconstruct(dataclasses.replace(room.photo(), classes=None))
    obstacles = Obstacles(scene)
    free = scene.free_space
    row, column = np.nonzero(free.is_free & free.is_seen)
    x, y = free.x_m[column], free.y_m[row]
    inside = (np.abs(x) < 0.15) & (y > 1.2) & (y < 2.5)
    assert inside.any()
    at = (float(np.median(x[inside])), float(np.median(y[inside])), scene.floor_z_m)
    assert obstacles.deepest_m(standing_person(at, seconds=0.3)) == 0.0
    wall = next(plane for plane in scene.planes if plane.kind == "wall")
    beside = wall.centre_m - 0.02 * wall.normal
    near = (float(beside[0]), float(beside[1]), scene.floor_z_m)
    assert obstacles.deepest_m(standing_person(near, seconds=0.3)) > 0.05
