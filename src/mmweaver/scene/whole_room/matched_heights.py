"""Shifts one photo's view of a room from above onto another's: where tops, floor and walls agree in height."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Array, Points, Vec3

CELL_M, REACH_M = 0.05, 8.0
SAME_HEIGHT_M = 0.06
LOWEST_M = 0.15  # above the floor: what is lower is floor
FLOOR_WEIGHT = 0.2  # of cells where both show the floor: it is the same everywhere
FEWEST_CELLS = 150  # that both show, and not as floor


def height_map(points_m: Points, floor_z_m: float) -> Float[Array, "y x"]:
    """The highest point above each square, metres above the floor, nan where nothing was measured."""
    side = int(2 * REACH_M / CELL_M)
    points_m = points_m[np.isfinite(points_m).all(axis=1)]
    column, row = (np.floor((points_m[:, axis] + REACH_M) / CELL_M).astype(int) for axis in (0, 1))
    inside = (column >= 0) & (column < side) & (row >= 0) & (row < side)
    found = np.full(side * side, -np.inf)
    np.maximum.at(found, row[inside] * side + column[inside], points_m[inside, 2] - floor_z_m)
    found[np.abs(found) < LOWEST_M] = 0.0
    return np.where(np.isfinite(found), found, np.nan).reshape(side, side)


def shift_by_heights(own: Float[Array, "y x"], known: Float[Array, "y x"], spread_m: float) -> Vec3:
    """The horizontal shift of `own` for which most squares have the height of `known`; none where too few agree.

    Squares of other heights count against it; `spread_m` is the standard deviation that is expected of the shift.
    """
    steps = range(-int(2.5 * spread_m / CELL_M), int(2.5 * spread_m / CELL_M) + 1)
    best, shift = -np.inf, (0, 0)
    for rows in steps:
        for columns in steps:
            moved = np.roll(own, (rows, columns), axis=(0, 1))
            both = np.isfinite(moved) & np.isfinite(known)
            a, b = moved[both], known[both]
            is_same = np.abs(a - b) < SAME_HEIGHT_M
            is_floor = (a == 0) & (b == 0)
            agree = (is_same & ~is_floor).sum()
            score = agree + FLOOR_WEIGHT * is_floor.sum() - 0.5 * (~is_same).sum()
            score -= 0.5 * FEWEST_CELLS * ((rows**2 + columns**2) * CELL_M**2) / spread_m**2
            if score > best and agree > FEWEST_CELLS:
                best, shift = score, (rows, columns)
    return np.array([shift[1] * CELL_M, shift[0] * CELL_M, 0.0])
