"""Entropy coding of cells (time, range, doppler): a class per cell, then the integer levels of the open cells.

Order: a coarse lattice first, then the cells in between, so that every cell except those of the first phase has known
neighbours on both sides along at least one axis, whatever the shape. Levels are coded beam by beam, or several beams
at once where few cells are open. Contexts are the known neighbours, the preceding beams, the real part for the
imaginary one, and the position. The FFT windows correlate neighbouring cells along range and Doppler, including signs,
so a weighted sum of the neighbours predicts the level.
"""

import operator
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np

from mmweaver.compression.entropy import BitStream
from mmweaver.compression.symbol_model import ALWAYS, Batches, MixedModel, SignedModel

Integers = np.ndarray  # int64; called thousands of times per cube
Classes = np.ndarray  # (time, range, doppler) int64
Phase = tuple[int, int, int]

# parity of (time, range, doppler)
PHASES: tuple[Phase, ...] = ((0, 0, 0), (0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0), (1, 1, 1))
WEIGHTS = {1: 4, 2: 2, 3: 1}  # of a neighbour, by the number of axes along which it differs

CLOSED, COARSE, FINE = 0, 1, 2
CLASS_STRIDES = (4, 2, 1)  # of the lattices, in coding order
CLASS_MARGIN = 4
OPEN_BOUNDS = np.array([1, 3, 6, 9, 13])  # sixteenths of the known neighbours
FINE_BOUNDS = np.array([1, 6, 12])
BYTE = 255
SEEN = np.array([0, 1, 1 + (1 << 8)], np.int16)  # contribution of a class to the counts of open and fine neighbours
NUM_OPEN, NUM_FINE, NUM_NEAR = len(OPEN_BOUNDS) + 2, len(FINE_BOUNDS) + 1, 4

SIZE_BOUNDS = np.array([1, 2, 4, 6, 9, 13, 18, 26, 36, 50, 70, 100, 150, 230, 400, 800, 1600, 3200])  # eighths
TREND_BOUNDS = np.array([1, 3, 6, 9])  # eighths of a level
WIDE_BOUNDS = np.array([1, 3, 8, 24])
CORNERS = ((-1, -1), (-1, 1), (1, -1), (1, 1))
FAR = 12  # eighths of a level; for larger predictions the deviation is coded
NUM_SIZES, NUM_TRENDS, NUM_WIDE = len(SIZE_BOUNDS) + 1, len(TREND_BOUNDS) + 2, len(WIDE_BOUNDS) + 1
NUM_REAL = 4
UNKNOWN = NUM_SIZES  # class of an unknown size
OWN, OTHER, WIDE, REAL = 3, 3, 2, 2  # weights of the predictors of the size
LARGER, MIN_SCALE = 2.0, 0.3
DIGITS, DIGITS_IN_3 = 3, 4  # bits of an expected level beyond which the lowest are coded as uniform; in version 3
LARGE, MIDDLE = 20_000, 500  # open cells
FEW_BEAMS = 3  # up to which all lattices pay off
# strides of the lattices in coding order, by the number of open cells from which on they pay off
LATTICES = ((LARGE, (4, 2, 1)), (MIDDLE, (2, 1)), (0, (1,)))
LATTICES_IN = {3: (1,), 4: (4, 2, 1)}
VALUES_AT_ONCE = 20_000  # open cells times beams that are coded in the phases of one pass


@cache
def _known_neighbours(phase: Phase) -> tuple[tuple[Phase, int], ...]:
    """Offsets and weights of the neighbours that belong to earlier phases."""
    rank = PHASES.index(phase)
    found: list[tuple[Phase, int]] = []
    steps = (-1, 0, 1)
    for time, row, column in product(steps, steps, steps):
        parity = (phase[0] ^ abs(time), phase[1] ^ abs(row), phase[2] ^ abs(column))
        if PHASES.index(parity) < rank:
            found.append(((time, row, column), WEIGHTS[abs(time) + abs(row) + abs(column)]))
    return tuple(found)


class ClassMapCoder:
    """Codes the map of classes with adaptive contexts."""

    def __init__(self, num_doppler: int, prior: tuple[float, ...] = (0.94, 0.03, 0.03)):
        """Initialises the models.

        Args:
            num_doppler: Number of Doppler bins.
            prior: Initial probabilities of the classes.
        """
        contexts = (NUM_OPEN * NUM_FINE * len(CLASS_STRIDES), NUM_OPEN * NUM_FINE * NUM_NEAR, NUM_OPEN * num_doppler)
        self.model = MixedModel([np.tile(prior, (num, 1)) for num in contexts])

    def code(self, stream: BitStream, classes: Classes, near: Classes) -> None:
        """Encodes the classes, or fills them in when decoding.

        Args:
            stream: Encoder or decoder.
            classes: Class of each cell (time, range, doppler), int64.
            near: Strength of the nearest scatterer (time, range, doppler), 0 for none.
        """
        batches = Batches(stream)
        seen = np.zeros([size + 2 * CLASS_MARGIN for size in classes.shape], np.int16)
        inside = seen[(slice(CLASS_MARGIN, -CLASS_MARGIN),) * 3]
        for stride in CLASS_STRIDES:
            for phase in PHASES if stride == CLASS_STRIDES[0] else PHASES[1:]:
                own = tuple(slice(stride * odd, None, 2 * stride) for odd in phase)
                if classes[own].size:
                    contexts = self._contexts(seen, phase, stride, near[own])
                    wanted = classes[own].ravel()
                    parts = [
                        self.model.code(stream, [context[batch] for context in contexts], wanted[batch])
                        for batch in batches.of(len(wanted))
                    ]
                    values = np.concatenate(parts)
                    classes[own] = values.reshape(classes[own].shape)
                    inside[own] = SEEN.take(classes[own])

    def _contexts(self, seen: np.ndarray, phase: Phase, stride: int, near: Classes) -> list[np.ndarray]:
        found, total = np.zeros(near.shape, np.int16), 0  # sums of open cells, and of fine ones in the upper byte
        for offset, weight in _known_neighbours(phase):
            first = [CLASS_MARGIN + stride * (odd + step) for odd, step in zip(phase, offset, strict=True)]
            at = tuple(
                slice(start, start + 2 * stride * (num - 1) + 1, 2 * stride)
                for start, num in zip(first, near.shape, strict=True)
            )
            found += weight * seen[at]
            total += weight
        by_open = np.full(near.shape, NUM_OPEN - 1)
        by_fine = np.zeros(near.shape, np.int64)
        if total:
            sums = np.arange(total + 1) * 16 // total
            by_open = OPEN_BOUNDS.searchsorted(sums, "right").take(found & BYTE)
            by_fine = FINE_BOUNDS.searchsorted(sums, "right").take(found >> 8)
        both = by_open * NUM_FINE + by_fine
        column = np.broadcast_to(phase[2] * stride + 2 * stride * np.arange(near.shape[2]), near.shape)
        contexts = (
            both * len(CLASS_STRIDES) + CLASS_STRIDES.index(stride),
            both * NUM_NEAR + np.minimum(near, NUM_NEAR - 1),
            column * NUM_OPEN + by_open,
        )
        return [context.ravel() for context in contexts]


@dataclass(frozen=True, kw_only=True)
class PhaseGroup:
    """Open cells of one phase (n,), as indices into the list of open cells.

    Closed neighbours have the index after the last.
    """

    cells: Integers
    column: Integers
    factor: Integers  # step of the cell in units of the fine step
    around: list[tuple[int, Integers]]  # weights and indices of the known neighbours
    rows: list[Integers]  # neighbours that predict the sign: along range, along Doppler, and diagonal ones
    columns: list[Integers]
    corners: list[Integers]


@dataclass(frozen=True, kw_only=True)
class KnownSizes:
    """Magnitudes around the values of a group in eighths of a level: same beam, preceding beams, their neighbours."""

    own: Integers | None
    other: Integers | None
    wide: Integers
    real: Integers | None = None  # magnitude of the real part, in levels

    def some(self, values: slice, real: Integers | None) -> "KnownSizes":
        """The entries of a slice of values, with the magnitudes of the real part of all."""
        own, other, real = (None if size is None else size[values] for size in (self.own, self.other, real))
        return KnownSizes(own=own, other=other, wide=self.wide[values], real=real)


class LevelCoder:
    """Codes the levels of open cells (beam, time, range, doppler) with adaptive contexts."""

    def __init__(self, shape: tuple[int, int, int, int], correlated: tuple[bool, bool] = (True, True)):
        """Initialises the models.

        Args:
            shape: Shape (beam, time, range, doppler) of all cells.
            correlated: Whether neighbours along range, and along Doppler, predict each other's sign.
        """
        self.shape, self.correlated = shape, correlated
        middle = np.append(SIZE_BOUNDS, 2 * SIZE_BOUNDS[-1]) / 8 * LARGER + MIN_SCALE
        known_or_not = np.append(middle, 1.0)
        self.scales = [
            np.repeat(middle, NUM_TRENDS),
            np.repeat(known_or_not, NUM_REAL * NUM_TRENDS),
            np.repeat(known_or_not, NUM_WIDE * NUM_TRENDS),
            np.ones(shape[0] * shape[3] * NUM_TRENDS),
        ]
        self.levels = SignedModel(self.scales)

    def code(self, stream: BitStream, levels: Integers, factor: Integers) -> None:
        """Encodes levels, or fills them in when decoding.

        Args:
            stream: Encoder or decoder.
            levels: Levels (part, beam, cell) of the open cells, int64.
            factor: Step of each cell (time, range, doppler) in units of the finest, 0 where it is closed.
        """
        beams, num = levels.shape[1:]
        if not num:
            return
        lattices = LATTICES_IN.get(stream.version) or _lattices_of(num, beams)
        margins = [lattices[0] if size > 1 or stream.version == 3 else 0 for size in self.shape[1:]]
        places = CellPlaces(factor, margins)
        groups = list(self.groups(places, lattices, has_all=stream.version == 3))
        neighbours = [places.of(places.at, offset) for offset in _neighbour_axes(margins)]
        factors = factor[factor > 0][:, None]
        batches, before, first = Batches(stream), np.zeros(num + 1, np.int64), 0
        passes = range(1, beams + 1) if stream.version in LATTICES_IN else self.passes(beams, num)
        for last in passes:
            some = levels[:, first:last]
            planes = np.zeros((2, num + 1, some.shape[1]), np.int64)
            planes[:, :-1] = some.swapaxes(1, 2) * factors
            size = np.zeros(planes.shape[1:], np.int64)
            wide = sum((before[cells] for cells in neighbours), np.zeros(num, np.int64)) // 6
            for group in groups:
                known = self._known(group, size, before if first else None, wide)
                self._code_group(stream, group, planes, known, first, batches)
                size[group.cells] = np.abs(planes[:, group.cells]).sum(axis=0)
            some[...] = (planes[:, :-1] // factors).swapaxes(1, 2)
            for beam in size.T:
                before = (beam + before) // 2 if first else beam
                first += 1

    @staticmethod
    def passes(beams: int, num_open: int) -> Iterator[int]:
        """The number of beams that are known after each pass."""
        last = 0
        while last < beams:
            last = min(beams, last + min(max(last, 1), -(-VALUES_AT_ONCE // num_open)))
            yield last

    def groups(self, places: "CellPlaces", lattices: tuple[int, ...], *, has_all: bool) -> Iterator[PhaseGroup]:
        """The phases of the lattices.

        Args:
            places: The open cells.
            lattices: Strides of the lattices, in coding order.
            has_all: Whether neighbours along axes of length one are included, as zeros (version 3).
        """
        single = [num == 1 and not has_all for num in self.shape[1:]]
        for stride in lattices:
            for phase in PHASES if stride == lattices[0] else PHASES[1:]:
                cells = places.phase_cells(phase, stride)
                if not len(cells):
                    continue
                at = places.at[cells]
                around = [
                    (weight, places.of(at, [stride * step for step in offset]))
                    for offset, weight in _known_neighbours(phase)
                    if not any(map(operator.and_, map(bool, offset), single))
                ]
                along = bool(phase[1]) and self.correlated[0] and stride == 1
                across = bool(phase[2]) and self.correlated[1] and stride == 1
                yield PhaseGroup(
                    cells=cells,
                    column=places.cell[2][cells],
                    factor=places.factor[cells],
                    around=around,
                    rows=[places.of(at, (0, side, 0)) for side in (-1, 1) if along],
                    columns=[places.of(at, (0, 0, side)) for side in (-1, 1) if across],
                    corners=[places.of(at, (0, *side)) for side in CORNERS if along and across],
                )

    def _known(self, group: PhaseGroup, size: Integers, before: Integers | None, wide: Integers) -> KnownSizes:
        cells, factor, beams = group.cells, group.factor, size.shape[1]
        around, total = np.zeros((len(cells), beams), np.int64), 0
        for weight, places in group.around:
            around += weight * size[places]
            total += weight
        return KnownSizes(
            own=(4 * around // (total * factor[:, None])).ravel() if total else None,
            other=None if before is None else np.repeat(4 * before[cells] // factor, beams),
            wide=np.repeat(4 * wide[cells] // factor, beams),
        )

    def _code_group(self, stream, group: PhaseGroup, planes, known: KnownSizes, first: int, batches) -> None:
        cells, factor = group.cells, group.factor[:, None]
        place = ((first + np.arange(planes.shape[2])) * self.shape[3] + group.column[:, None]).ravel()
        real: Integers | None = None
        for plane in planes:
            trend = _trend_of(plane, group)
            trend = None if trend is None else (trend // factor).ravel()
            wanted = plane[cells] // factor
            values = [
                self._numbers(
                    stream,
                    known.some(batch, real),
                    None if trend is None else trend[batch],
                    place[batch],
                    wanted.ravel()[batch],
                )
                for batch in batches.of(wanted.size)
            ]
            joined = np.concatenate(values)
            plane[cells] = joined.reshape(wanted.shape) * factor
            real = np.abs(joined)

    def _numbers(
        self, stream, known: KnownSizes, trend: Integers | None, place: Integers, wanted: Integers
    ) -> Integers:
        expected = _expected(known, len(wanted))
        shift, scaled = self._shifts(stream, expected)
        by_real = NUM_REAL - 1 if known.real is None else np.minimum(known.real >> scaled, NUM_REAL - 2)
        contexts = [
            SIZE_BOUNDS.searchsorted(expected >> scaled, "right"),
            _class_of(known.own, scaled, len(wanted)) * NUM_REAL + by_real,
            _class_of(known.other, scaled, len(wanted)) * NUM_WIDE
            + WIDE_BOUNDS.searchsorted(known.wide >> scaled, "right"),
            place,
        ]
        if trend is None:
            contexts = [context * NUM_TRENDS for context in contexts]
            return self.levels.code(stream, contexts, shift, wanted, ALWAYS)
        towards = np.abs(trend)
        is_far = towards >= FAR
        by_trend = np.where(is_far, NUM_TRENDS - 1, TREND_BOUNDS.searchsorted(towards, "right"))
        contexts = [context * NUM_TRENDS + by_trend for context in contexts]
        up = np.where(trend < 0, -1, 1)
        offset = np.where(is_far, (towards + 4) // 8, 0)
        return (self.levels.code(stream, contexts, shift, wanted * up - offset, by_trend == 0) + offset) * up

    def _shifts(self, stream: BitStream, expected: Integers) -> tuple[Integers | None, Integers | int]:
        """Number of low bits of levels that are coded as uniform, None for none, and the scaling of contexts."""
        most = DIGITS_IN_3 if stream.version == 3 else DIGITS
        if int(expected.max()) >> 3 < 1 << most:
            return None, 0
        digits = np.frexp(np.maximum(expected >> 3, 1).astype(np.float64))[1].astype(np.int64)
        shift = np.maximum(digits - most, 0)
        return shift, 0 if stream.version == 3 else shift


class CellPlaces:
    """Open cells (cell,) of an array (time, range, doppler), with access to their neighbours."""

    def __init__(self, factor: Integers, margins: Sequence[int]):
        self.cell = np.nonzero(factor)
        self.factor = factor[self.cell]
        sizes = [num + 2 * margin for num, margin in zip(factor.shape, margins, strict=True)]
        self.strides = (sizes[1] * sizes[2], sizes[2], 1)
        self.at = self._flat([index + margin for index, margin in zip(self.cell, margins, strict=True)])
        self._index = np.full(sizes[0] * self.strides[0], len(self.at))
        self._index[self.at] = np.arange(len(self.at))

    def of(self, at: Integers, offset: Sequence[int]) -> Integers:
        """Indices of neighbours of open cells.

        Args:
            at: Flat places (n,) of the cells.
            offset: Offset in time, range and Doppler.

        Returns:
            Indices (n,) into the list of open cells; the number of cells where the neighbour is closed.
        """
        return self._index[at + self._flat(offset)]

    def phase_cells(self, phase: Phase, stride: int) -> Integers:
        """Indices of the cells of a phase of a lattice."""
        own = [index % (2 * stride) == stride * odd for index, odd in zip(self.cell, phase, strict=True)]
        return np.flatnonzero(own[0] & own[1] & own[2])

    def _flat(self, index: Sequence):
        return index[0] * self.strides[0] + index[1] * self.strides[1] + index[2] * self.strides[2]


def _trend_of(plane: Integers, group: PhaseGroup) -> Integers | None:
    """Level (cell, beam) predicted by the windows' correlation, in eighths of a fine step; None without neighbours."""
    near = [plane[cells] for cells in (*group.rows, *group.columns)]
    if not near:
        return None
    if not group.corners:
        return 5 * sum(near)
    return 4 * sum(near) - 2 * sum(plane[cells] for cells in group.corners)


def _lattices_of(num_open: int, num_beams: int) -> tuple[int, ...]:
    return next(strides for least, strides in LATTICES if num_open >= least or num_beams <= FEW_BEAMS)


def _neighbour_axes(margins: Sequence[int]) -> list[tuple[int, ...]]:
    """Offsets to both sides along the axes of several cells."""
    axes = [axis for axis, margin in enumerate(margins) if margin]
    return [tuple(side * (axis == other) for other in range(3)) for axis in axes for side in (-1, 1)]


def _expected(known: KnownSizes, num: int) -> Integers:
    """Weighted mean of the known magnitudes, in eighths of a level."""
    total, weight = np.zeros(num, np.int64), 0
    wide = None if known.other is None else known.wide
    real = None if known.real is None else 8 * known.real
    for size, share in ((known.own, OWN), (known.other, OTHER), (wide, WIDE), (real, REAL)):
        if size is not None:
            total += share * size
            weight += share
    return total // weight if weight else total + 5


def _class_of(size: Integers | None, shift: Integers | int, num: int) -> Integers:
    return np.full(num, UNKNOWN) if size is None else SIZE_BOUNDS.searchsorted(size >> shift, "right")
