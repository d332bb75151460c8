"""Where a person could sit: level surfaces at seat height, with a back behind them and room for legs in front."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import Seat
from mmweaver.core.shapes import Array
from mmweaver.scene.layout.class_evidence import GridClass
from mmweaver.scene.layout.connected_patches import labelled, places
from mmweaver.scene.layout.height_map import CELL_M, SEAT_LEVELS_M, HeightMap

_LOWEST_M, _HIGHEST_M = 0.33, 0.60
_FLAT_M = 0.055
_DIRECTIONS = 24
_MAX_SEATS = 8
_APART_M = 0.55
_MIN_ON_SEAT, _MAX_CONTRARY = 0.22, 0.15
_MIN_BACK = 0.38
_BACK_M = (0.22, 0.85)  # a backrest reaches this far above the seat; a wall reaches farther
_FULL_BACK_M = 0.42
_THIGH_M = 0.16
_SAG_M = 0.06  # a seat's middle lies this much below its rim
_TABLE_M = (0.60, 1.0)
_BED_M, _MIN_BED_M2 = (0.38, 0.66), 1.0
_SMALLEST_M = 0.25  # of what is seen of a seat
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
        inside, row, column = self._squares(height_map, offsets)
        return np.where(inside, height_map.top_m[row, column], np.nan) - self.height_m[:, None, None]

    def at(
        self, height_map: HeightMap, mask: Bool[Array, "y x"], offsets: Float[Array, "a b 2"]
    ) -> Bool[Array, "candidate a b"]:
        """The mask at the offsets from each place; False outside the map."""
        inside, row, column = self._squares(height_map, offsets)
        return inside & mask[row, column]

    def bare(self, height_map: HeightMap, offsets: Float[Array, "a b 2"]) -> Bool[Array, "candidate a b"]:
        """True where lines of sight pass even below the seat's height: no surface lies there."""
        inside, row, column = self._squares(height_map, offsets)
        level = np.argmin(np.abs(SEAT_LEVELS_M - (self.height_m[:, None] - _SAG_M)), axis=1)[:, None, None]
        return inside & height_map.is_bare[level, row, column]

    def _squares(
        self, height_map: HeightMap, offsets: Float[Array, "a b 2"]
    ) -> tuple[Bool[Array, "candidate a b"], Int[Array, "candidate a b"], Int[Array, "candidate a b"]]:
        """Whether the offset places lie on the map, and their rows and columns (0 where not)."""
        forward, left = offsets[..., 0], offsets[..., 1]
        cosine, sine = np.cos(self.facing_rad)[:, None, None], np.sin(self.facing_rad)[:, None, None]
        x = self.x_m[:, None, None] + cosine * forward - sine * left
        y = self.y_m[:, None, None] + sine * forward + cosine * left
        column = np.floor((x - height_map.x_m[0]) / CELL_M + 0.5).astype(int)
        row = np.floor((y - height_map.y_m[0]) / CELL_M + 0.5).astype(int)
        rows, columns = height_map.top_m.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        return inside, np.where(inside, row, 0), np.where(inside, column, 0)

    def on(self, height_map: HeightMap, mask: Bool[Array, "y x"] | None) -> Bool[Array, " candidate"]:
        """The mask at the places themselves; all False without one."""
        if mask is None:
            return np.zeros(len(self.x_m), bool)
        return self.at(height_map, mask, np.zeros((1, 1, 2)))[:, 0, 0]

    def only(self, chosen: Bool[Array, " candidate"]) -> "_Candidates":
        return _Candidates(
            x_m=self.x_m[chosen],
            y_m=self.y_m[chosen],
            facing_rad=self.facing_rad[chosen],
            height_m=self.height_m[chosen],
        )


def find_seats(height_map: HeightMap, floor_z_m: float, sittable: GridClass | None = None) -> tuple[Seat, ...]:
    """Seats, the best first. Those with a back come from all level patches, those without only from stool-sized ones.

    A low table has no back of its own: what stands behind it is lower than a backrest, or too far away, or a wall.
    `sittable` (class_evidence) rules out what is something else, and lets chairs, benches and beds do without a back.
    """
    level = _level_squares(height_map)
    if sittable is not None:
        level &= sittable >= 0
    candidates = _candidates(height_map, level)
    if len(candidates.x_m) == 0:
        return ()
    on_seat = candidates.tops(height_map, _ON_SEAT)
    fits = np.abs(on_seat) < _FLAT_M
    # What is lower speaks against a seat only where the seat would have been seen: not under a chair seen edge-on.
    contrary = (on_seat >= _FLAT_M) | (~fits & candidates.bare(height_map, _ON_SEAT))
    is_named = candidates.on(height_map, bed_squares(height_map) if sittable is None else sittable > 0)
    on_stool = _on_stool(height_map, level, candidates)
    inner = slice(2, -2)  # a stool is smaller than the place that a sitter takes
    is_round = on_stool & (contrary[:, inner, inner].mean(axis=(1, 2)) < _MAX_CONTRARY)
    is_whole = (contrary.mean(axis=(1, 2)) < _MAX_CONTRARY) | is_round
    suits = (fits.mean(axis=(1, 2)) > _MIN_ON_SEAT) & is_whole
    candidates, fit = candidates.only(suits), fits[suits].mean(axis=(1, 2))
    is_named, on_stool, is_round = is_named[suits], on_stool[suits], is_round[suits]
    if len(candidates.x_m) == 0:
        return ()
    back = _back_share(height_map, candidates)
    front = candidates.tops(height_map, _IN_FRONT)
    # Legs need room: nothing above the seat, save a table top high enough for the thighs to go under.
    obstructed = ((front > 0.08) & (front < _THIGH_M)).mean(axis=(1, 2))
    drop = (front < -0.12) | (np.isnan(front) & candidates.at(height_map, _is_open(height_map), _IN_FRONT))
    drop, under_table = drop.mean(axis=(1, 2)), (front >= _THIGH_M).mean(axis=(1, 2))
    score = 2 * back + (0.5 + 1.5 * is_round) * fit + drop + 0.7 * under_table - 2 * obstructed
    is_backed = (back >= _MIN_BACK) & (obstructed < 0.35) & (drop + under_table > 0.4)
    is_stool = on_stool & (obstructed < 0.1)
    # Without a back one sits at the edge.
    is_bench = is_named & (obstructed < 0.35) & (drop + under_table > 0.8)
    score = np.where(is_backed, score + 2, score)
    return _spread_out(height_map, candidates, np.where(is_backed | is_stool | is_bench, score, -np.inf), floor_z_m)


def _level_squares(height_map: HeightMap) -> Bool[Array, "y x"]:
    """Squares at seat height with at least two neighbours at the same height."""
    top = np.pad(height_map.top_m, 1, constant_values=np.nan)
    centre = height_map.top_m
    rows, columns = centre.shape
    neighbours = np.zeros(centre.shape, int)
    for row, column in ((0, 1), (1, 0), (2, 1), (1, 2)):
        neighbours += np.abs(top[row : row + rows, column : column + columns] - centre) < 0.6 * _FLAT_M
    return (centre > _LOWEST_M) & (centre < _HIGHEST_M) & (neighbours >= 2)


def table_squares(height_map: HeightMap) -> Bool[Array, "y x"]:
    """Squares of level surfaces at table height that are 35 cm across and more: no backs of sofas or chairs."""
    from scipy import ndimage

    found = np.zeros(height_map.top_m.shape, bool)
    for height in np.arange(_TABLE_M[0], _TABLE_M[1], 0.02):
        near = np.abs(height_map.top_m - height) < 0.02
        found |= np.asarray(ndimage.binary_opening(near, structure=np.ones((7, 7), bool)), bool)
    return found


def bed_squares(height_map: HeightMap) -> Bool[Array, "y x"]:
    """Squares of level surfaces at a bed's height that are 65 cm across and 1 m2 large: larger than low tables."""
    from scipy import ndimage

    found = np.zeros(height_map.top_m.shape, bool)
    for height in np.arange(_BED_M[0], _BED_M[1], 0.03):
        near = ndimage.binary_closing(np.abs(height_map.top_m - height) < 0.05, structure=np.ones((3, 3), bool))
        wide = np.asarray(ndimage.binary_opening(near, structure=np.ones((13, 13), bool)), bool)
        labels, _ = labelled(wide)
        large = np.bincount(labels.ravel()) * CELL_M**2 >= _MIN_BED_M2
        found |= wide & large[labels]
    return found


def _is_open(height_map: HeightMap) -> Bool[Array, "y x"]:
    return height_map.is_floor_seen | height_map.is_seen_through | height_map.is_below_picture


def _candidates(height_map: HeightMap, level: Bool[Array, "y x"]) -> _Candidates:
    row, column = np.nonzero(level)
    facing = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    return _Candidates(
        x_m=np.repeat(height_map.x_m[column], _DIRECTIONS),
        y_m=np.repeat(height_map.y_m[row], _DIRECTIONS),
        facing_rad=np.tile(facing, len(row)),
        height_m=np.repeat(height_map.top_m[row, column], _DIRECTIONS),
    )


def _back_share(height_map: HeightMap, candidates: _Candidates) -> Float[Array, " candidate"]:
    """Share of the width behind the sitter at which a backrest stands."""
    behind = candidates.tops(height_map, _BEHIND)
    stands = (behind > _BACK_M[0]) & (behind < _BACK_M[1])
    # An armrest is lower than a back and counts for less.
    highest = np.where(stands, behind, 0.0).max(axis=1)
    share = np.minimum(highest / _FULL_BACK_M, 1.0).mean(axis=1)
    stands &= ~candidates.at(height_map, table_squares(height_map), _BEHIND)
    # A table top is as high as a low back, but level: a back is thin, or slopes.
    height = np.where(stands, behind, -1.0)
    middle = np.partition(height.reshape(len(height), -1), -(height[0].size // 4), axis=1)[:, -(height[0].size // 4)]
    is_table = (np.abs(behind - middle[:, None, None]) < 0.025).mean(axis=(1, 2)) > 0.4
    return np.where(is_table, 0.0, share)


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
        size_m = _size_m(height_map, one)
        if min(size_m) < _SMALLEST_M:
            continue
        tops = one.tops(height_map, _ON_SEAT)[0]
        height = one.height_m[0] + float(np.median(tops[np.abs(tops) < _FLAT_M]))
        seats.append(
            Seat(
                position_m=np.array([x, y, floor_z_m + height]),
                facing_rad=float(np.angle(np.exp(1j * one.facing_rad[0]))),
                size_m=size_m,
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
