"""Finds seats: horizontal surfaces at seat height, with a backrest behind and room for legs in front.

Chairs of which only the back is visible, above the far edge of a table.

Positions are (row, column) of the height map, in squares, as are directions.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import Seat
from mmweaver.core.shapes import Array, GridMask
from mmweaver.scene.layout.class_evidence import GridClass
from mmweaver.scene.layout.height_map import (
    CELL_M,
    SEAT_LEVELS_M,
    HeightMap,
    bounding_slices,
    label_components,
    nearest_squares,
)

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


# Heights are above the floor unless they are relative to the seat.
_SEAT_HEIGHTS_M = (0.33, 0.60)
_FLATNESS_M = 0.055
_NUM_DIRECTIONS = 24
_MAX_SEATS = 8
_MIN_SPACING_M = 0.55  # between seats: a person's width
_MIN_FLAT, _MAX_CONTRARY = 0.22, 0.15  # shares of the seat area
_MIN_BACK = 0.38  # share of the width behind the sitter
_BACK_M = (0.22, 0.85)  # a backrest's top above the seat; a wall reaches higher
_FULL_BACK_M = 0.42
_THIGH_M = 0.16  # clearance above the seat that thighs need below a table
_SAG_M = 0.06  # a seat's middle lies this much below its rim
_TABLE_HEIGHTS_M = (0.60, 1.0)
_BED_HEIGHTS_M, _MIN_BED_M2 = (0.38, 0.66), 1.0
_CUT_BED_M2, _CUT_BED_SIZE_M, _CUT_BED_FILLED = 0.5, (0.9, 1.3), 0.35  # of the visible part of a bed
_MIN_SIZE_M = 0.25  # visible size of a seat
_STOOL_SIZE_M = (0.30, 0.60)
_MAX_STOOL_HEIGHT_M = 0.52
# A bench is a narrow plank with a clear view below it: a cabinet's front reaches down, a low table is wider.
_BENCH_LENGTH_M, _BENCH_WIDTH_M, _BENCH_HEIGHT_M = (0.75, 2.1), (0.2, 0.46), (0.38, 0.52)
_PLANK_M, _MAX_BELOW = 0.15, 0.5  # points farther below the top are no plank; maximum share of its length
_GAP_SQUARES, _EDGE_NOISE_M = np.ones((7, 7), bool), 0.04  # of a plank seen at a grazing angle
_TABLE_SQUARES = np.ones((7, 7), bool)

# Sample places around a sitter, in metres: forward, leftward.
_ACROSS = np.arange(-0.20, 0.201, 0.05)
_ON_SEAT = np.stack(np.meshgrid(np.arange(-0.20, 0.201, 0.05), _ACROSS, indexing="ij"), axis=-1)
_BEHIND = np.stack(np.meshgrid(np.arange(-0.55, -0.23, 0.05), _ACROSS, indexing="ij"), axis=-1)
_IN_FRONT = np.stack(np.meshgrid(np.arange(0.30, 0.61, 0.05), _ACROSS, indexing="ij"), axis=-1)

Offsets = Float[Array, "a b 2"]  # forward, leftward
PerCandidate = Float[Array, " candidate"]
CandidateMask = Bool[Array, " candidate"]
SampleMask = Bool[Array, "candidate a b"]


@dataclass(frozen=True, kw_only=True)
class _Candidates:
    """Possible seats: every place at seat height in every direction of view."""

    x_m: PerCandidate
    y_m: PerCandidate
    facing_rad: PerCandidate
    height_m: PerCandidate

    def select(self, chosen: CandidateMask) -> "_Candidates":
        return _Candidates(**{name: values[chosen] for name, values in vars(self).items()})

    def squares(self, height_map: HeightMap, offsets: Offsets) -> "_Squares":
        """The squares of the map at the offsets from each place."""
        forward, left = offsets[..., 0], offsets[..., 1]
        cosine, sine = np.cos(self.facing_rad)[:, None, None], np.sin(self.facing_rad)[:, None, None]
        x = self.x_m[:, None, None] + cosine * forward - sine * left
        y = self.y_m[:, None, None] + sine * forward + cosine * left
        row, column, inside = nearest_squares(x, y, height_map.x_m, height_map.y_m)
        return _Squares(
            height_map=height_map, seat_m=self.height_m[:, None, None], inside=inside, row=row, column=column
        )


@dataclass(frozen=True, kw_only=True)
class _Squares:
    """Squares of a height map around each candidate."""

    height_map: HeightMap
    seat_m: Float[Array, "candidate 1 1"]  # the seat's height
    inside: SampleMask  # whether the place lies on the map
    row: Int[Array, "candidate a b"]  # 0 where it does not
    column: Int[Array, "candidate a b"]

    @property
    def height_m(self) -> Float[Array, "candidate a b"]:
        """Height of obstacles above the seat in metres; nan where there are none."""
        return np.where(self.inside, self.height_map.top_m[self.row, self.column], np.nan) - self.seat_m

    @property
    def is_clear(self) -> SampleMask:
        """Whether lines of sight pass at, or just below, the seat's height: no surface lies there."""
        level = np.argmin(np.abs(SEAT_LEVELS_M - (self.seat_m[:, 0] - _SAG_M)), axis=1)[:, None, None]
        return self.inside & self.height_map.is_clear_at[level, self.row, self.column]

    def look_up(self, mask: GridMask) -> SampleMask:
        """A mask of the map there; False outside the map."""
        return self.inside & mask[self.row, self.column]


def find_seats(height_map: HeightMap, evidence: GridClass | None = None) -> tuple[Seat, ...]:
    """Finds seats: surfaces of any size with a backrest, and stool-sized ones without.

    A low table has no backrest: what stands behind it is lower, too far away, or a wall. If benches without a seat
    remain, the search is repeated with their planks completed.

    Args:
        height_map: The room from above.
        evidence: Result of `class_evidence.seat_evidence`, (y, x): excludes other furniture and accepts chairs, benches
            and beds without a backrest. None uses geometry alone.

    Returns:
        Seats, the best first; those inferred from chair backs behind tables come last.
    """
    seats = _seats_of(height_map, evidence)
    whole = complete_planks(height_map, seats)
    if not np.array_equal(whole.top_m, height_map.top_m, equal_nan=True):
        seats = _seats_of(whole, evidence)
    return (*seats, *chairs_behind_tables(height_map, table_squares(height_map), seats, evidence))


def _seats_of(height_map: HeightMap, evidence: GridClass | None) -> tuple[Seat, ...]:
    is_seat_height = _horizontal_squares(height_map)
    if evidence is not None:
        is_seat_height &= evidence >= 0
    candidates = _candidates(height_map, is_seat_height)
    if len(candidates.x_m) == 0:
        return ()
    # 1. The surface is flat where one sits.
    seat_squares = candidates.squares(height_map, _ON_SEAT)
    on_seat = seat_squares.height_m
    is_flat = np.abs(on_seat) < _FLATNESS_M
    # A lower surface contradicts a seat only where the seat would have been visible: not below a chair seen edge-on.
    is_contrary = (on_seat >= _FLATNESS_M) | (~is_flat & seat_squares.is_clear)
    labelled = bed_squares(height_map)
    if evidence is not None:  # on a bed, the duvet may be labelled as something other than furniture
        labelled = (evidence > 0) | (labelled & (evidence >= 0))
    is_labelled = candidates.squares(height_map, np.zeros((1, 1, 2))).look_up(labelled)[:, 0, 0]
    on_stool, on_bench = (_is_on(kind, height_map, is_seat_height, candidates) for kind in (_is_stool, _is_plank))
    inner = slice(2, -2)  # a stool is smaller than the area that a sitter covers
    is_flat_stool = on_stool & (is_contrary[:, inner, inner].mean(axis=(1, 2)) < _MAX_CONTRARY)
    narrow = is_contrary[:, inner].mean(axis=(1, 2)) < _MAX_CONTRARY  # a bench is no deeper than a stool
    is_whole = (is_contrary.mean(axis=(1, 2)) < _MAX_CONTRARY) | is_flat_stool | (on_bench & narrow)
    chosen = (is_flat.mean(axis=(1, 2)) > _MIN_FLAT) & is_whole
    candidates, flat_share = candidates.select(chosen), is_flat[chosen].mean(axis=(1, 2))
    is_labelled, on_stool, is_flat_stool = is_labelled[chosen], on_stool[chosen], is_flat_stool[chosen]
    on_bench = on_bench[chosen]
    if len(candidates.x_m) == 0:
        return ()
    # 2. A backrest stands behind, and legs have room in front: nothing above the seat, except a table top that is high
    # enough for the thighs.
    back_share = _back_share(height_map, candidates)
    front_squares = candidates.squares(height_map, _IN_FRONT)
    front = front_squares.height_m
    obstructed = ((front > 0.08) & (front < _THIGH_M)).mean(axis=(1, 2))
    is_drop = (front < -0.12) | (np.isnan(front) & front_squares.look_up(_is_open(height_map)))
    drop, under_table = is_drop.mean(axis=(1, 2)), (front >= _THIGH_M).mean(axis=(1, 2))
    # 3. Score, and keep what is a seat with a backrest, a stool, or labelled as a seat (one sits at its edge).
    score = 2 * back_share + (0.5 + 1.5 * is_flat_stool) * flat_share + drop + 0.7 * under_table - 2 * obstructed
    has_back = (back_share >= _MIN_BACK) & (obstructed < 0.35) & (drop + under_table > 0.4)
    is_stool = on_stool & (obstructed < 0.1)
    is_bench = (is_labelled | on_bench) & (obstructed < 0.35) & (drop + under_table > 0.8)
    score = np.where(has_back, score + 2, score)
    return _best_seats(height_map, candidates, np.where(has_back | is_stool | is_bench, score, -np.inf))


def _horizontal_squares(height_map: HeightMap) -> GridMask:
    """Squares at seat height with at least two neighbours at the same height."""
    top = np.pad(height_map.top_m, 1, constant_values=np.nan)
    centre = height_map.top_m
    rows, columns = centre.shape
    neighbours = np.zeros(centre.shape, int)
    for row, column in ((0, 1), (1, 0), (2, 1), (1, 2)):
        neighbours += np.abs(top[row : row + rows, column : column + columns] - centre) < 0.6 * _FLATNESS_M
    return (centre > _SEAT_HEIGHTS_M[0]) & (centre < _SEAT_HEIGHTS_M[1]) & (neighbours >= 2)


def table_squares(height_map: HeightMap) -> GridMask:
    """Squares of horizontal surfaces at table height (0.6 to 1.0 m) at least 35 cm across: no backs of sofas or chairs.

    Args:
        height_map: The room from above.

    Returns:
        Mask (y, x).
    """
    from scipy import ndimage

    found = np.zeros(height_map.top_m.shape, bool)
    for height_m in np.arange(_TABLE_HEIGHTS_M[0], _TABLE_HEIGHTS_M[1], 0.02):
        near = np.abs(height_map.top_m - height_m) < 0.02
        if np.count_nonzero(near) < _TABLE_SQUARES.size:
            continue
        found |= np.asarray(ndimage.binary_opening(near, structure=_TABLE_SQUARES), bool)
    return found


def bed_squares(height_map: HeightMap) -> GridMask:
    """Squares of horizontal surfaces at bed height, larger than low tables.

    Args:
        height_map: The room from above.

    Returns:
        Mask (y, x) of surfaces at least 65 cm across and 1 m2 large, and of beds cut off by the picture's edge.
    """
    from scipy import ndimage

    found = np.zeros(height_map.top_m.shape, bool)
    for height_m in np.arange(_BED_HEIGHTS_M[0], _BED_HEIGHTS_M[1], 0.03):
        near = ndimage.binary_closing(np.abs(height_map.top_m - height_m) < 0.05, structure=np.ones((3, 3), bool))
        wide = np.asarray(ndimage.binary_opening(near, structure=np.ones((13, 13), bool)), bool)
        labels, _ = label_components(wide)
        large = np.bincount(labels.ravel()) * CELL_M**2 >= _MIN_BED_M2
        found |= wide & large[labels]
        found |= cut_beds(near)
    return found


def cut_beds(near: GridMask) -> GridMask:
    """Squares of surfaces that are larger than low tables even though the picture's edge cuts them off.

    Args:
        near: Squares at one height, (y, x).

    Returns:
        Mask (y, x) of components of at least 0.5 m2 that measure at least 0.9 x 1.3 m along their principal axes.
    """
    from scipy import ndimage

    whole = np.asarray(ndimage.binary_opening(near, structure=np.ones((5, 5), bool)), bool)
    labels, count = label_components(whole)
    areas_m2 = np.bincount(labels.ravel(), minlength=count + 1) * CELL_M**2
    found = np.zeros(near.shape, bool)
    for label in np.nonzero(areas_m2[1:] >= _CUT_BED_M2)[0] + 1:
        places_m = np.argwhere(labels == label) * CELL_M
        width_m, length_m = np.ptp(places_m @ np.linalg.eigh(np.cov(places_m.T))[1], axis=0) + CELL_M
        is_wide = min(width_m, length_m) >= _CUT_BED_SIZE_M[0] and max(width_m, length_m) >= _CUT_BED_SIZE_M[1]
        if is_wide and areas_m2[label] >= _CUT_BED_FILLED * width_m * length_m:
            found |= labels == label
    return found


def complete_planks(height_map: HeightMap, seats: tuple[Seat, ...]) -> HeightMap:
    """Completes the planks of benches: at a grazing angle little more than their edges is measured.

    Args:
        height_map: The room from above.
        seats: Seats already found; planks with a seat on them are left unchanged.

    Returns:
        The height map with the gaps of these planks filled at their median height.
    """
    from scipy import ndimage

    top_m = height_map.top_m.copy()
    taken = [(seat.position_m[1] - height_map.y_m[0], seat.position_m[0] - height_map.x_m[0]) for seat in seats]
    row, column = np.round(np.array(taken).reshape(-1, 2).T / CELL_M).astype(int)
    for height_m in np.arange(*_BENCH_HEIGHT_M, 0.02):
        near = np.abs(height_map.top_m - height_m) < _EDGE_NOISE_M
        labels, _ = label_components(np.asarray(ndimage.binary_closing(near, structure=_GAP_SQUARES), bool))
        for label, region in enumerate(bounding_slices(labels), start=1):
            if max(part.stop - part.start for part in region) * CELL_M < _BENCH_LENGTH_M[0]:
                continue
            patch = labels == label
            if not patch[row, column].any() and _is_bench(height_map, patch, height_m):
                top_m[patch & np.isnan(top_m)] = np.median(height_map.top_m[near & patch])
    return replace(height_map, top_m=top_m)


def _is_open(height_map: HeightMap) -> GridMask:
    """Squares where legs have room: floor that is visible or inferred."""
    return height_map.is_floor_seen | height_map.is_seen_through | height_map.is_below_picture


def _candidates(height_map: HeightMap, squares: GridMask) -> _Candidates:
    """All squares of the mask, each in every direction."""
    row, column = np.nonzero(squares)
    facing_rad = 2 * np.pi * np.arange(_NUM_DIRECTIONS) / _NUM_DIRECTIONS
    return _Candidates(
        x_m=np.repeat(height_map.x_m[column], _NUM_DIRECTIONS),
        y_m=np.repeat(height_map.y_m[row], _NUM_DIRECTIONS),
        facing_rad=np.tile(facing_rad, len(row)),
        height_m=np.repeat(height_map.top_m[row, column], _NUM_DIRECTIONS),
    )


def _back_share(height_map: HeightMap, candidates: _Candidates) -> PerCandidate:
    """Share of the width behind the sitter at which a backrest stands."""
    squares = candidates.squares(height_map, _BEHIND)
    behind = squares.height_m
    is_back = (behind > _BACK_M[0]) & (behind < _BACK_M[1])
    # An armrest is lower than a backrest and counts for less.
    highest = np.where(is_back, behind, 0.0).max(axis=1)
    share = np.minimum(highest / _FULL_BACK_M, 1.0).mean(axis=1)
    is_back &= ~squares.look_up(table_squares(height_map))
    # A table top is as high as a low backrest, but horizontal: a backrest is thin, or slopes.
    height = np.where(is_back, behind, -1.0)
    quarter = height[0].size // 4
    upper_quartile = np.partition(height.reshape(len(height), -1), -quarter, axis=1)[:, -quarter]
    is_table = (np.abs(behind - upper_quartile[:, None, None]) < 0.025).mean(axis=(1, 2)) > 0.4
    return np.where(is_table, 0.0, share)


def _is_on(
    kind: Callable[[HeightMap, GridMask], bool], height_map: HeightMap, squares: GridMask, candidates: _Candidates
) -> CandidateMask:
    """Whether a candidate is on a patch of these squares that is of a kind."""
    labels, count = label_components(squares)
    is_kind = np.array([False, *(kind(height_map, labels == label) for label in range(1, count + 1))])
    row, column, _ = nearest_squares(candidates.x_m, candidates.y_m, height_map.x_m, height_map.y_m)
    return is_kind[labels[row, column]]


def _sizes_m(patch: GridMask) -> Float[Array, "2"]:
    """Extents of a patch along y and x, metres."""
    return (np.ptp(np.argwhere(patch), axis=0) + 1) * CELL_M


def _is_stool(height_map: HeightMap, patch: GridMask) -> bool:
    """Whether an isolated patch has a stool's size and height."""
    sizes_m = _sizes_m(patch)
    has_size = sizes_m.min() >= _STOOL_SIZE_M[0] and sizes_m.max() <= _STOOL_SIZE_M[1]
    return bool(has_size and np.median(height_map.top_m[patch]) <= _MAX_STOOL_HEIGHT_M)


def _is_plank(height_map: HeightMap, patch: GridMask) -> bool:
    """Whether a patch is a plank of a bench's length, width and height, with little below it."""
    is_long = _sizes_m(patch).max() >= 0.7 * _BENCH_LENGTH_M[0]
    return bool(is_long) and _is_bench(height_map, patch, float(np.median(height_map.top_m[patch])))


def _is_bench(height_map: HeightMap, patch: GridMask, height_m: float) -> bool:
    from scipy import ndimage

    places_m = np.argwhere(patch) * CELL_M
    axes = np.linalg.eigh(np.cov(places_m.T))[1]
    width_m, length_m = np.ptp(places_m @ axes, axis=0) + CELL_M
    sizes = ((width_m, _BENCH_WIDTH_M), (length_m, _BENCH_LENGTH_M), (height_m, _BENCH_HEIGHT_M))
    if not all(least < size < most for size, (least, most) in sizes):
        return False
    around = np.asarray(ndimage.binary_dilation(patch, np.ones((3, 3), bool)), bool)
    is_low = around & (height_map.bottom_m < height_m - _PLANK_M)
    along = [np.unique(np.floor(np.argwhere(mask) @ axes[:, 1])) for mask in (is_low, around)]
    return len(along[0]) < _MAX_BELOW * len(along[1])


def _best_seats(height_map: HeightMap, candidates: _Candidates, score: PerCandidate) -> tuple[Seat, ...]:
    """Non-maximum suppression: the best candidates, no two closer than a person is wide."""
    seats: list[Seat] = []
    for index in np.argsort(-score, kind="stable"):
        if not np.isfinite(score[index]) or len(seats) == _MAX_SEATS:
            break
        x, y = candidates.x_m[index], candidates.y_m[index]
        if any(np.hypot(seat.position_m[0] - x, seat.position_m[1] - y) < _MIN_SPACING_M for seat in seats):
            continue
        one = candidates.select(np.arange(len(score)) == index)
        size_m = _size_m(height_map, one)
        if min(size_m) < _MIN_SIZE_M:
            continue
        heights = one.squares(height_map, _ON_SEAT).height_m[0]
        height_m = one.height_m[0] + float(np.median(heights[np.abs(heights) < _FLATNESS_M]))
        seats.append(
            Seat(
                position_m=np.array([x, y, height_map.floor_z_m + height_m]),
                facing_rad=float(np.angle(np.exp(1j * one.facing_rad[0]))),
                size_m=size_m,
            )
        )
    return tuple(seats)


def _size_m(height_map: HeightMap, one: _Candidates) -> tuple[float, float]:
    """Extent of the surface around one candidate: across and along its facing, metres."""
    reach_m = np.arange(0.0, 1.21, CELL_M)
    lengths = []
    for forward, left in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        offsets = np.stack([forward * reach_m, left * reach_m], axis=-1)[None]
        on_seat = np.abs(one.squares(height_map, offsets).height_m[0, 0]) < _FLATNESS_M
        # One missing square is a gap in the measurement, two are the edge.
        is_edge = ~(on_seat | np.append(on_seat[1:], False))
        lengths.append(reach_m[np.argmax(is_edge)] if is_edge.any() else reach_m[-1])
    return float(lengths[0] + lengths[1]), float(lengths[2] + lengths[3])
