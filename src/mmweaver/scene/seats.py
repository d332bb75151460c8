"""Where a person could sit: level surfaces at seat height, with a back behind them and room for legs in front."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import Seat
from mmweaver.core.shapes import Array
from mmweaver.scene.height_map import CELL_M, HeightMap
from mmweaver.scene.patches import labelled, places

_LOWEST_M, _HIGHEST_M = 0.33, 0.60
_FLAT_M = 0.055
_DIRECTIONS = 24
_MAX_SEATS = 8
_APART_M = 0.55
_MIN_ON_SEAT, _MAX_CONTRARY = 0.55, 0.15
_MIN_BACK = 0.5
_BACK_M = (0.13, 0.85)  # a backrest reaches this far above the seat; a wall reaches farther
_STOOL_M = (0.30, 0.60)
_STOOL_HIGHEST_M = 0.52

# Squares around a sitter, in metres: forward, leftward.
_ACROSS = np.arange(-0.20, 0.201, 0.05)
_ON_SEAT = np.stack(np.meshgrid(np.arange(-0.20, 0.201, 0.05), _ACROSS, indexing="ij"), axis=-1)
_BEHIND = np.stack(np.meshgrid(np.arange(-0.55, -0.23, 0.05), _ACROSS, indexing="ij"), axis=-1)
_IN_FRONT = np.stack(np.meshgrid(np.arange(0.30, 0.61, 0.05), _ACROSS, indexing="ij"), axis=-1)


@dataclass(frozen=True, kw_only=True)
class _Candidates:
    """One entry for each place and direction."""

    x_m: Float[Array, " candidate"]
    y_m: Float[Array, " candidate"]
    facing_rad: Float[Array, " candidate"]
    height_m: Float[Array, " candidate"]

    def tops(self, height_map: HeightMap, offsets: Float[Array, "a b 2"]) -> Float[Array, "candidate a b"]:
        """What stands at the offsets (forward, leftward) from each place, above its seat; nan where nothing does."""
        forward, left = offsets[..., 0], offsets[..., 1]
        cosine, sine = np.cos(self.facing_rad)[:, None, None], np.sin(self.facing_rad)[:, None, None]
        x = self.x_m[:, None, None] + cosine * forward - sine * left
        y = self.y_m[:, None, None] + sine * forward + cosine * left
        column = np.floor((x - height_map.x_m[0]) / CELL_M + 0.5).astype(int)
        row = np.floor((y - height_map.y_m[0]) / CELL_M + 0.5).astype(int)
        rows, columns = height_map.top_m.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        top = height_map.top_m[np.where(inside, row, 0), np.where(inside, column, 0)]
        return np.where(inside, top, np.nan) - self.height_m[:, None, None]

    def only(self, chosen: Bool[Array, " candidate"]) -> "_Candidates":
        return _Candidates(
            x_m=self.x_m[chosen],
            y_m=self.y_m[chosen],
            facing_rad=self.facing_rad[chosen],
            height_m=self.height_m[chosen],
        )


def find_seats(height_map: HeightMap, floor_z_m: float) -> tuple[Seat, ...]:
    """Seats, the best first. Those with a back come from all level patches, those without only from stool-sized ones.

    A low table has no back of its own: what stands behind it is lower than a backrest, or too far away, or a wall.
    """
    level = _level_squares(height_map)
    candidates = _candidates(height_map, level)
    if len(candidates.x_m) == 0:
        return ()
    on_seat = candidates.tops(height_map, _ON_SEAT)
    fits = np.abs(on_seat) < _FLAT_M
    contrary = np.isfinite(on_seat) & ~fits | _floor_at(height_map, candidates, _ON_SEAT)
    suits = (fits.mean(axis=(1, 2)) > _MIN_ON_SEAT) & (contrary.mean(axis=(1, 2)) < _MAX_CONTRARY)
    candidates, fit = candidates.only(suits), fits[suits].mean(axis=(1, 2))
    if len(candidates.x_m) == 0:
        return ()
    back = _back_share(height_map, candidates)
    front = candidates.tops(height_map, _IN_FRONT)
    # Legs need room: nothing above the seat, save a table top high enough for the thighs to go under.
    obstructed = ((front > 0.08) & (front < 0.22)).mean(axis=(1, 2)) + 0.3 * (front >= 0.22).mean(axis=(1, 2))
    drop = (np.isnan(front) | (front < -0.12)).mean(axis=(1, 2))
    score = back + 0.5 * fit + drop - 2 * obstructed
    is_backed = (back >= _MIN_BACK) & (obstructed < 0.35) & (drop > 0.4)
    is_stool = _on_stool(height_map, level, candidates) & (obstructed < 0.1)
    score = np.where(is_backed, score + 2, score)
    return _spread_out(height_map, candidates, np.where(is_backed | is_stool, score, -np.inf), floor_z_m)


def _level_squares(height_map: HeightMap) -> Bool[Array, "y x"]:
    """Squares at seat height with at least two neighbours at the same height."""
    top = np.pad(height_map.top_m, 1, constant_values=np.nan)
    centre = height_map.top_m
    rows, columns = centre.shape
    neighbours = np.zeros(centre.shape, int)
    for row, column in ((0, 1), (1, 0), (2, 1), (1, 2)):
        neighbours += np.abs(top[row : row + rows, column : column + columns] - centre) < 0.6 * _FLAT_M
    return (centre > _LOWEST_M) & (centre < _HIGHEST_M) & (neighbours >= 2)


def _candidates(height_map: HeightMap, level: Bool[Array, "y x"]) -> _Candidates:
    row, column = np.nonzero(level)
    facing = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    return _Candidates(
        x_m=np.repeat(height_map.x_m[column], _DIRECTIONS),
        y_m=np.repeat(height_map.y_m[row], _DIRECTIONS),
        facing_rad=np.tile(facing, len(row)),
        height_m=np.repeat(height_map.top_m[row, column], _DIRECTIONS),
    )


def _floor_at(
    height_map: HeightMap, candidates: _Candidates, offsets: Float[Array, "a b 2"]
) -> Bool[Array, "candidate a b"]:
    """True where the floor is seen: there is no seat there."""
    bare = np.where(height_map.is_floor_seen & ~height_map.is_blocked, 0.0, np.nan)
    floor_map = HeightMap(**{**vars(height_map), "top_m": bare})
    return np.isfinite(candidates.tops(floor_map, offsets))


def _back_share(height_map: HeightMap, candidates: _Candidates) -> Float[Array, " candidate"]:
    """Share of the width behind the sitter at which a backrest stands."""
    behind = candidates.tops(height_map, _BEHIND)
    return ((behind > _BACK_M[0]) & (behind < _BACK_M[1])).any(axis=1).mean(axis=1)


def _on_stool(height_map: HeightMap, level: Bool[Array, "y x"], candidates: _Candidates) -> Bool[Array, " candidate"]:
    """True on a patch of a stool's size and height that stands by itself."""
    labels, count = labelled(level)
    is_stool = np.zeros(count + 1, bool)
    for label, (rows, columns) in enumerate(places(labels), start=1):
        sizes = ((rows.stop - rows.start) * CELL_M, (columns.stop - columns.start) * CELL_M)
        height = np.median(height_map.top_m[labels == label])
        is_stool[label] = min(sizes) >= _STOOL_M[0] and max(sizes) <= _STOOL_M[1] and height <= _STOOL_HIGHEST_M
    row = np.round((candidates.y_m - height_map.y_m[0]) / CELL_M).astype(int)
    column = np.round((candidates.x_m - height_map.x_m[0]) / CELL_M).astype(int)
    return is_stool[labels[row, column]]


def _spread_out(
    height_map: HeightMap, candidates: _Candidates, score: Float[Array, " candidate"], floor_z_m: float
) -> tuple[Seat, ...]:
    """The best candidates, no two closer than a person is wide."""
    seats: list[Seat] = []
    for index in np.argsort(-score, kind="stable"):
        if not np.isfinite(score[index]) or len(seats) == _MAX_SEATS:
            break
        x, y = candidates.x_m[index], candidates.y_m[index]
        if any(np.hypot(seat.position_m[0] - x, seat.position_m[1] - y) < _APART_M for seat in seats):
            continue
        one = candidates.only(np.arange(len(score)) == index)
        tops = one.tops(height_map, _ON_SEAT)[0]
        height = one.height_m[0] + float(np.median(tops[np.abs(tops) < _FLAT_M]))
        seats.append(
            Seat(
                position_m=np.array([x, y, floor_z_m + height]),
                facing_rad=float(np.angle(np.exp(1j * one.facing_rad[0]))),
                size_m=_size_m(height_map, one),
            )
        )
    return tuple(seats)


def _size_m(height_map: HeightMap, one: _Candidates) -> tuple[float, float]:
    """How far the surface goes on from its middle: across and along the facing."""
    reach = np.arange(0.0, 1.21, CELL_M)
    lengths = []
    for forward, left in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        offsets = np.stack([forward * reach, left * reach], axis=-1)[None]
        on_seat = np.abs(one.tops(height_map, offsets)[0, 0]) < _FLAT_M
        # One missing square is a gap in the measurement, two are the edge.
        gone = ~(on_seat | np.append(on_seat[1:], False))
        lengths.append(reach[np.argmax(gone)] if gone.any() else reach[-1])
    return float(lengths[0] + lengths[1]), float(lengths[2] + lengths[3])
