"""Seats, and surfaces that are none."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import Seat
from mmweaver.scene.affordances.seats import complete_planks, cut_beds
from mmweaver.scene.layout.height_map import CELL_M, make_height_map
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.single_view import see
from tests.motion.rooms import room as bare_room

SOFA = [((-0.8, 0.8), (2.3, 2.9), (0.0, 0.44)), ((-0.8, 0.8), (2.9, 3.1), (0.0, 0.85))]


def test_the_seats_of_a_sofa_face_the_radar(box_room: Callable):
    scene = reconstruct(box_room(boxes=SOFA).photo(width=640, height=480))
    assert 2 <= len(scene.seats) <= 3
    for seat in scene.seats:
        assert seat.position_m[2] - scene.floor_z_m == pytest.approx(0.44, abs=0.03)
        assert np.rad2deg(seat.facing_rad) == pytest.approx(-90, abs=16)
        assert -0.8 < seat.position_m[0] < 0.8
        assert 2.35 < seat.position_m[1] < 2.85


def test_a_chair_seen_from_its_side(box_room: Callable):
    """Its back is at the left: the sitter faces right, +x, which is 0."""
    chair = [((0.2, 0.65), (2.0, 2.45), (0.40, 0.46)), ((0.15, 0.2), (2.0, 2.45), (0.40, 0.95))]
    seats = reconstruct(box_room(boxes=chair).photo(width=640, height=480)).seats
    assert len(seats) == 1
    assert np.rad2deg(seats[0].facing_rad) == pytest.approx(0, abs=31)
    assert seats[0].position_m[:2] == pytest.approx([0.43, 2.22], abs=0.12)


@pytest.mark.parametrize(
    "thing",
    [
        ((-0.6, 0.6), (2.0, 2.7), (0.0, 0.45)),
        ((-0.5, 0.5), (2.0, 2.6), (0.0, 0.75)),
        ((-0.9, 0.9), (3.4, 3.8), (0.0, 0.5)),
    ],
    ids=["low table", "table", "bench at the wall"],
)
def test_tables_are_not_seats(box_room: Callable, thing: tuple):
    assert reconstruct(box_room(boxes=[thing]).photo(width=640, height=480)).seats == ()


def test_a_bench_on_trestles_is_a_seat_and_a_cabinet_of_its_size_is_none(box_room: Callable):
    plank = ((-0.6, 0.6), (2.2, 2.56), (0.42, 0.46))
    trestles = [((x, x + 0.05), (2.22, 2.54), (0.0, 0.42)) for x in (-0.5, 0.45)]
    seats = reconstruct(box_room(boxes=[plank, *trestles]).photo(width=640, height=480)).seats
    assert len(seats) >= 1
    assert all(abs(seat.position_m[0]) < 0.6 and 2.15 < seat.position_m[1] < 2.6 for seat in seats)
    cabinet = ((-0.6, 0.6), (2.2, 2.56), (0.0, 0.46))
    assert reconstruct(box_room(boxes=[cabinet]).photo(width=640, height=480)).seats == ()


def test_a_bench_seen_at_a_flat_angle_is_a_seat():
    """In this procedural corridor the camera is 12 cm above a bench: little but its edges is measured."""
    corridor = make_room("corridor", layout=7, seed=60007)
    seats = see(dataclasses.replace(corridor.photo(list(LIGHTINGS)[3], noise=True), classes=None)).seats
    for place in corridor.seats:
        assert any(np.hypot(*(seat.position_m - place.position_m)[:2]) < 0.35 for seat in seats)


def test_between_the_edges_of_a_plank_is_plank_but_not_of_what_reaches_down():
    for lowest_m, is_plank in ((0.40, True), (0.10, False)):
        height_map = make_height_map(AlignedPhoto.of(bare_room()))
        top_m, bottom_m = np.full(height_map.top_m.shape, np.nan), np.full(height_map.top_m.shape, np.inf)
        for edge in (70, 76):
            top_m[40:62, edge], bottom_m[40:62, edge] = 0.44, lowest_m
        height_map = dataclasses.replace(height_map, top_m=top_m, bottom_m=bottom_m)
        filled = complete_planks(height_map, ()).top_m
        assert np.isfinite(filled[42:60, 70:77]).all() == is_plank
        assert np.isfinite(filled).sum() == (22 * 7 if is_plank else 44)
        place_m = np.array([height_map.x_m[73], height_map.y_m[50], 0.4])
        on_it = Seat(position_m=place_m, facing_rad=0.0, size_m=(0.5, 0.4))
        assert np.isfinite(complete_planks(height_map, (on_it,)).top_m).sum() == 44  # a seat is found there already


def test_surfaces_as_large_as_low_tables_are_no_beds():
    for size, expected in (((0.6, 1.2), False), ((0.85, 1.6), False), ((1.0, 1.7), True)):
        near = np.zeros((60, 60), bool)
        near[5 : 5 + round(size[0] / CELL_M), 5 : 5 + round(size[1] / CELL_M)] = True
        assert cut_beds(near).any() == expected
