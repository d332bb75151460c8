"""Rooms are taken by what faces the radar, on rectangles at known places."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import Plane
from mmweaver.scene.procedural.procedural_room import make_room_of
from mmweaver.scene.procedural.room_kinds import KINDS
from studies.physics import rooms_without_facing_wall
from studies.physics.rooms_without_facing_wall import (
    WALLS,
    first_free,
    is_free_of_facing_walls,
    median_interval,
    nearest_facing_m,
    without_mirrors,
)
from tests.rooms import back_wall, floor, plane, scene_of, side_wall


def panel(y_m: float, half_m: float = 0.4, turned_deg: float = 0.0) -> Plane:
    """An upright square straight ahead."""
    cosine, sine = np.cos(np.radians(turned_deg)), np.sin(np.radians(turned_deg))
    return plane("panel", (0.0, y_m, 0.0), (sine, -cosine, 0), (cosine, sine, 0), (half_m, half_m), "wood")


@pytest.mark.parametrize(("others", "expected_m"), [
    ((), np.inf),
    ((back_wall(3.2),), 3.2),
    ((back_wall(5.2), side_wall(0.95)), 5.2),  # a side wall faces the radar 90 degrees out of the beam
    ((back_wall(5.2), panel(2.0)), 2.0),
    ((back_wall(5.2), panel(2.0, half_m=0.3)), 5.2),  # 0.36 m2
    ((back_wall(5.2), panel(2.0, turned_deg=35.0)), 5.2),
    ((panel(1.0, turned_deg=35.0), panel(1.5, half_m=0.36)), np.inf),  # hidden
])  # fmt: skip
def test_the_nearest_flat_surface_that_faces_the_radar_is_found(others, expected_m):
    assert nearest_facing_m(scene_of((floor(), *others))) == pytest.approx(expected_m, abs=0.1)


@pytest.mark.parametrize(("wall_m", "is_free"), [(3.2, False), (4.7, False), (5.2, True)])
def test_no_wall_stands_within_two_metres_behind_the_walkers(wall_m, is_free):
    assert is_free_of_facing_walls(scene_of((floor(), back_wall(wall_m)))) is is_free


def test_the_first_draw_that_qualifies_is_taken(monkeypatch):
    class Drawn:
        def __init__(self, kind, layout, seed):
            assert layout == seed
            self.wall_m = 3.2 if layout < 702 else min(kind.wall_distance_m)

        def scene(self):
            return scene_of((floor(), back_wall(self.wall_m)))

    monkeypatch.setattr(rooms_without_facing_wall, "make_room_of", Drawn)
    draw, scene = first_free(KINDS["office"])
    assert draw == 702
    assert nearest_facing_m(scene) == pytest.approx(5.1)


def test_a_deeper_room_has_its_wall_where_the_recipe_says():
    room = make_room_of(replace(KINDS["office"], wall_distance_m=(5.5, 5.6)), 0, 0)
    ahead = max((one for one in room.planes if one.kind == "wall"), key=lambda one: -one.normal[1])
    assert 5.5 <= -float(ahead.centre_m @ ahead.normal) <= 5.6


def test_walls_of_one_side_cease_to_be_mirrors_and_stay_in_the_mesh():
    scene = scene_of((floor(), back_wall(5.2), side_wall(0.95), panel(2.0)))
    no_sides, not_ahead = (without_mirrors(scene, walls) for walls in WALLS.values())
    assert [one.centre_m[1] for one in no_sides.planes if one.kind == "wall"] == [5.2]
    assert [one.centre_m[0] for one in not_ahead.planes if one.kind == "wall"] == [0.95]
    assert {one.kind for one in no_sides.planes} == {"floor", "wall", "panel"}
    assert len(no_sides.faces) == len(scene.faces)


def test_the_interval_of_a_median_holds_it_and_leaves_out_rooms_without_the_row():
    low, high = median_interval([float(value) for value in range(21)])
    assert 4.0 < low < 10.0 < high < 16.0
    assert median_interval([2.0, None, 2.0]) == [2.0, 2.0]
