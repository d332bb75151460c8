"""Chairs of which a table hides all but the back."""

import dataclasses

import numpy as np
import pytest

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import Seat
from mmweaver.scene.affordances.seats import chairs_behind_tables
from mmweaver.scene.layout.height_map import HeightMap, make_height_map
from tests.motion.rooms import room as bare_room

BACK = (slice(60, 62), slice(60, 69))  # 0.45 m wide, 0.45 m behind the table's far edge
TABLE = (slice(36, 51), slice(52, 77))


def _seen(back: tuple[slice, slice] = BACK, height_m: float = 0.9) -> HeightMap:
    height_map = make_height_map(AlignedPhoto.of(bare_room()))
    top_m = np.full(height_map.top_m.shape, np.nan)
    top_m[TABLE], top_m[back] = 0.74, height_m
    return dataclasses.replace(height_map, top_m=top_m)


def _tables(*places: tuple[slice, slice]) -> np.ndarray:
    tables = np.zeros(_seen().top_m.shape, bool)
    for place in places:
        tables[place] = True
    return tables


def test_before_a_back_behind_a_table_is_a_seat_that_faces_the_table():
    height_map = _seen()
    (seat,) = chairs_behind_tables(height_map, _tables(TABLE), (), None)
    back_m = np.array([height_map.x_m[64], (height_map.y_m[60] + height_map.y_m[61]) / 2])
    assert seat.position_m[:2] == pytest.approx(back_m - [0.0, 0.18], abs=0.01)
    assert seat.position_m[2] - height_map.floor_z_m == pytest.approx(0.45)
    assert np.rad2deg(seat.facing_rad) == pytest.approx(-90, abs=1)


def test_what_is_no_back_of_a_chair():
    behind = (slice(71, 86), slice(52, 77))
    assert not chairs_behind_tables(_seen(), _tables(), (), None)  # no table
    assert not chairs_behind_tables(_seen(), _tables(TABLE, behind), (), None)  # a table on either side: a laptop
    under = (slice(45, 60), slice(52, 77))
    assert not chairs_behind_tables(_seen(), _tables(under), (), None)  # it stands on the table: a laptop at an edge
    assert not chairs_behind_tables(_seen((slice(60, 62), slice(50, 75))), _tables(TABLE), (), None)  # a cupboard
    assert not chairs_behind_tables(_seen(height_m=1.2), _tables(TABLE), (), None)  # a screen
    other_furniture = np.where(_tables(BACK), -1, 0)
    assert not chairs_behind_tables(_seen(), _tables(TABLE), (), other_furniture)


def test_a_chair_whose_seat_is_found_is_not_found_again():
    height_map = _seen()
    (seat,) = chairs_behind_tables(height_map, _tables(TABLE), (), None)
    found = Seat(position_m=seat.position_m + np.array([0.1, 0.1, 0.0]), facing_rad=0.0, size_m=(0.4, 0.4))
    assert not chairs_behind_tables(height_map, _tables(TABLE), (found,), None)
