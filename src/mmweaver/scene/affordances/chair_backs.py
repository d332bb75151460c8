"""Chairs of which only the back is visible, above the far edge of a table.

Positions are (row, column) of the height map, in squares, as are directions.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Seat
from mmweaver.core.shapes import Array, GridMask
from mmweaver.scene.layout.class_evidence import GridClass
from mmweaver.scene.layout.connected_components import label_components
from mmweaver.scene.layout.height_map import CELL_M, HeightMap

_BACK_TOP_M, _LONG_M, _THICK_M = (0.78, 1.05), (0.3, 0.62), 0.22  # as seen: squares are 5 cm
_LEVEL_M, _MIN_SQUARES = 0.05, 7  # between the quartiles of a back's height: plants and laptops slope
_AHEAD_M, _NEAR_M = (0.4, 0.8), (0.05, 0.3)  # ranges with a table, and without: a laptop stands on one
_MIN_AHEAD, _MAX_ELSEWHERE = 0.3, 0.05  # share of table squares in these two ranges
_TO_SEAT_M, _SEAT_HEIGHT_M, _SEAT_SIZE_M = 0.18, 0.45, (0.42, 0.4)  # of a usual chair: the seat itself is occluded
_APART_M = 0.45  # from seats already found

Place = Float[Array, "2"]


def chairs_behind_tables(
    height_map: HeightMap, tables: GridMask, seats: tuple[Seat, ...], evidence: GridClass | None
) -> tuple[Seat, ...]:
    """Seats inferred in front of chair backs: level strips as wide as a chair, with a table ahead and none behind.

    Args:
        height_map: The room from above.
        tables: Squares of table tops, (y, x).
        seats: Seats already found; backs within 0.45 m of one are skipped.
        evidence: Class evidence for seats, (y, x), see `class_evidence.seat_evidence`; None without a class mask.

    Returns:
        Seats of usual height and size (0.45 m high, 0.42 x 0.4 m), since the seat itself is occluded.
    """
    is_back = (height_map.top_m > _BACK_TOP_M[0]) & (height_map.top_m < _BACK_TOP_M[1]) & ~tables
    if evidence is not None:
        is_back &= evidence >= 0
    labels, _ = label_components(is_back)
    found: list[Seat] = []
    for label in np.nonzero(np.bincount(labels.ravel())[1:] >= _MIN_SQUARES)[0] + 1:
        seat = _seat_of_back(height_map, labels == label, tables)
        if seat is not None and not any(_are_near(seat, other) for other in (*seats, *found)):
            found.append(seat)
    return tuple(found)


def _seat_of_back(height_map: HeightMap, back: GridMask, tables: GridMask) -> Seat | None:
    places = np.argwhere(back)
    axes = np.linalg.eigh(np.cov(places.T))[1]
    thick_m, long_m = (np.ptp(places @ axes, axis=0) + 1) * CELL_M
    low_m, high_m = np.percentile(height_map.top_m[back], (25, 75))
    if not _LONG_M[0] <= long_m <= _LONG_M[1] or thick_m > _THICK_M or high_m - low_m > _LEVEL_M:
        return None
    middle, across = places.mean(axis=0), axes[:, 0]
    shares = [_share_of_table(tables, middle, sign * across, _AHEAD_M) for sign in (-1.0, 1.0)]
    nearby = [_share_of_table(tables, middle, sign * across, _NEAR_M) for sign in (-1.0, 1.0)]
    if max(min(shares), *nearby) > _MAX_ELSEWHERE or max(shares) < _MIN_AHEAD:
        return None
    ahead = across if shares[1] > shares[0] else -across
    row, column = middle + ahead * _TO_SEAT_M / CELL_M
    x_m, y_m = height_map.x_m[0] + column * CELL_M, height_map.y_m[0] + row * CELL_M
    return Seat(
        position_m=np.array([x_m, y_m, height_map.floor_z_m + _SEAT_HEIGHT_M]),
        facing_rad=float(np.arctan2(ahead[0], ahead[1])),
        size_m=_SEAT_SIZE_M,
    )


def _share_of_table(tables: GridMask, middle: Place, ahead: Place, reach_m: tuple[float, float]) -> float:
    """Share of table squares ahead of the middle of a strip, between two distances."""
    aside = np.array([-ahead[1], ahead[0]])
    steps = np.arange(*reach_m, CELL_M)[:, None, None] * ahead + np.array([[-0.1], [0.0], [0.1]]) * aside
    row, column = np.round(middle + steps.reshape(-1, 2) / CELL_M).astype(int).T
    inside = (row >= 0) & (row < tables.shape[0]) & (column >= 0) & (column < tables.shape[1])
    return float((inside & tables[np.where(inside, row, 0), np.where(inside, column, 0)]).mean())


def _are_near(one: Seat, other: Seat) -> bool:
    return float(np.hypot(*(one.position_m - other.position_m)[:2])) < _APART_M
