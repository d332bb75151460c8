"""A body against what the photo shows."""

import dataclasses

import numpy as np

from mmweaver.core.records import CameraIntrinsics, RgbdPhoto, Scene
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.collision import CollisionMap, PulledChair
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from tests.motion.rooms import WINDOW_M, seat
from tests.motion.rooms import room as bare_room
from tests.rooms import standing_person


def test_a_body_in_the_open_is_clear_and_one_in_the_wall_is_not():
    room = make_room("corridor", 0, 3)
    scene = reconstruct(dataclasses.replace(room.photo(), classes=None))
    obstacles = CollisionMap(scene)
    free = scene.free_space
    row, column = np.nonzero(free.is_free & free.is_seen)
    x, y = free.x_m[column], free.y_m[row]
    inside = (np.abs(x) < 0.15) & (y > 1.2) & (y < 2.5)
    assert inside.any()
    at = (float(np.median(x[inside])), float(np.median(y[inside])), scene.floor_z_m)
    assert obstacles.penetration_m(standing_person(at, seconds=0.3)) == 0.0
    wall = next(plane for plane in scene.planes if plane.kind == "wall")
    beside = wall.centre_m - 0.02 * wall.normal
    near = (float(beside[0]), float(beside[1]), scene.floor_z_m)
    assert obstacles.penetration_m(standing_person(near, seconds=0.3)) > 0.05


def _before_a_board(height_m: float, away_m: float) -> Scene:
    """A room whose photo shows nothing but a level board's front edge, so high above the floor, so far away."""
    scene = bare_room()
    lens = CameraIntrinsics(fx=300.0, fy=300.0, cx=159.5, cy=119.5, width=320, height=240)
    row = round(lens.cy - (scene.floor_z_m + height_m) / away_m * lens.fy)
    depth = np.full((240, 320), np.nan)
    depth[row - 1 : row + 2] = away_m
    photo = RgbdPhoto(rgb=np.zeros((240, 320, 3), np.uint8), depth_m=depth, intrinsics=lens)
    return dataclasses.replace(scene, photo=photo)


def test_thighs_may_sink_into_the_seat_but_not_into_the_table_before_it():
    """The same board: under the sitter at the height of a seat; before the belly at that of a table."""
    chair = seat(y_m=2.0)
    sits = compose(plan_motion("a person sits", 1.0), bare_room(seats=(chair,)), seed=0, range_window_m=WINDOW_M)
    place = (float(chair.position_m[0]), float(chair.position_m[1]))
    for height, touches in ((0.45, False), (0.62, True)):
        obstacles = CollisionMap(_before_a_board(height, 1.75))
        assert (obstacles.penetration_m(sits.pose, (place,)) > 0.0) == touches


def test_a_table_behind_a_seat_is_no_back_of_it():
    """A board close behind the sitter: as wide as a table one must not lean into it, as narrow as a chair one may."""
    chair = seat(y_m=2.0)
    sits = compose(plan_motion("a person sits", 1.0), bare_room(seats=(chair,)), seed=0, range_window_m=WINDOW_M)
    place = (float(chair.position_m[0]), float(chair.position_m[1]))
    for width, touches in ((0.36, False), (1.4, True)):
        scene = _before_a_board(0.72, 2.08)
        depth = scene.photo.depth_m.copy()
        half = round(width / 2 / 2.08 * 300.0)
        depth[:, : 160 - half] = depth[:, 160 + half :] = np.nan
        obstacles = CollisionMap(dataclasses.replace(scene, photo=dataclasses.replace(scene.photo, depth_m=depth)))
        assert (obstacles.penetration_m(sits.pose, (place,)) > 0.0) == touches


def test_the_back_of_a_chair_that_is_pulled_out_is_left_out_with_it():
    """Posts from the floor up behind its seat, as upright as a table's legs, where the sitter is once it is pulled."""
    bare = bare_room(seats=(seat(y_m=2.3),))
    sits = compose(plan_motion("a person sits", 1.0), bare, seed=0, range_window_m=WINDOW_M)
    scene = _before_a_board(0.0, 2.2)
    lens, depth = scene.photo.intrinsics, np.full(scene.photo.depth_m.shape, np.nan)
    top, low = (round(lens.cy - (scene.floor_z_m + height) / 2.1 * lens.fy) for height in (0.9, 0.1))
    for x in (-0.16, 0.16):
        column = round(lens.cx + x / 2.1 * lens.fx)
        depth[top:low, column - 2 : column + 3] = 2.1
    obstacles = CollisionMap(dataclasses.replace(scene, photo=dataclasses.replace(scene.photo, depth_m=depth)))
    place = ((0.0, 2.3),)
    chair = PulledChair((0.0, 2.0), -np.pi / 2, 0.3)  # it faces the radar
    assert obstacles.penetration_m(sits.pose, place) > 0.0
    assert obstacles.penetration_m(sits.pose, place, chair=chair) == 0.0
    table_leg = np.array([[0.2, 1.8, 0.5]])  # ahead of the chair's middle: no part of its back
    assert not chair.has_back_at(table_leg, 0.0).any()
