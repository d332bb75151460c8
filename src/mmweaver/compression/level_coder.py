"""Entropy coding of the integer levels (part, beam, time, range, doppler) of open cells, whatever the shape.

Beam by beam, in the phases of `lattice`. Contexts are the known neighbours, the preceding beams, the real part for
the imaginary one, and the place. The FFT windows correlate neighbouring cells along range and Doppler, signs included,
so a weighted sum of the neighbours predicts the level.
"""

import operator
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from mmweaver.compression.entropy import BitStream
from mmweaver.compression.lattice import PHASES, Phase, known_neighbours
from mmweaver.compression.symbol_model import ALWAYS, Batches, SignedModel

Integers = np.ndarray  # int64; called thousands of times a cube

SIZE_BOUNDS = np.array([1, 2, 4, 6, 9, 13, 18, 26, 36, 50, 70, 100, 150, 230, 400, 800, 1600, 3200])  # eighths
TREND_BOUNDS = np.array([1, 3, 6, 9])  # eighths of a level
WIDE_BOUNDS = np.array([1, 3, 8, 24])
FAR = 12  # eighths of a level; from this prediction on, the deviation from it is coded
NUM_SIZES, NUM_TRENDS, NUM_WIDE = len(SIZE_BOUNDS) + 1, len(TREND_BOUNDS) + 2, len(WIDE_BOUNDS) + 1
NUM_REAL = 4
UNKNOWN = NUM_SIZES  # class of a size that is not known
OWN, OTHER, WIDE, REAL = 3, 3, 2, 2  # weights of what predicts the size
LARGER, LEAST_SCALE = 2.0, 0.3
DIGITS, DIGITS_IN_3 = 3, 4  # bits of an expected level beyond which the lowest are coded as uniform; in version 3
STRIDES, STRIDES_IN_3 = (4, 2, 1), (1,)  # of the lattices, one after the other


@dataclass(frozen=True, kw_only=True)
class PhaseGroup:
    """Open cells of one phase."""

    phase: Phase
    stride: int
    at: Integers  # flat index in the padded (time, range, doppler)
    column: Integers
    factor: Integers  # step of the cell in units of the fine step


@dataclass(frozen=True, kw_only=True)
class KnownSizes:
    """Magnitudes around the cells of a group in eighths of a level: same beam, preceding beams, their neighbours."""

    own: Integers | None
    other: Integers | None
    wide: Integers
    real: Integers | None = None  # magnitude of the real part, in levels

    def some(self, cells: slice, real: Integers | None) -> "KnownSizes":
        """Of some cells, with the magnitude of the real part of all."""
        own, other, real = (None if size is None else size[cells] for size in (self.own, self.other, real))
        return KnownSizes(own=own, other=other, wide=self.wide[cells], real=real)


class LevelCoder:
    """Codes levels of open cells (beam, time, range, doppler).

    `correlated`: whether neighbours along range, and along Doppler, predict the sign.
    """

    def __init__(self, shape: tuple[int, int, int, int], correlated: tuple[bool, bool] = (True, True)):
        self.shape, self.correlated = shape, correlated
        middle = np.append(SIZE_BOUNDS, 2 * SIZE_BOUNDS[-1]) / 8 * LARGER + LEAST_SCALE
        known_or_not = np.append(middle, 1.0)
        self.levels = SignedModel(
            [
                np.repeat(middle, NUM_TRENDS),
                np.repeat(known_or_not, NUM_REAL * NUM_TRENDS),
                np.repeat(known_or_not, NUM_WIDE * NUM_TRENDS),
                np.ones(shape[0] * shape[3] * NUM_TRENDS),
            ]
        )

    def code(self, stream: BitStream, levels: Integers, factor: Integers) -> None:
        """Encodes `levels` (part, beam, time, range, doppler), or fills them in when decoding.

        `factor` (time, range, doppler): step of each cell in units of the finest, 0 where it is closed.
        """
        beams = self.shape[0]
        lattices = STRIDES_IN_3 if stream.is_version_3 else STRIDES
        batches = Batches(stream)
        self.offsets = {phase: self._offsets(phase, has_all=stream.is_version_3) for phase in PHASES}
        margins = [lattices[0] if num > 1 or stream.is_version_3 else 0 for num in self.shape[1:]]
        size_of = tuple(num + 2 * margin for num, margin in zip(self.shape[1:], margins, strict=True))
        strides = (size_of[1] * size_of[2], size_of[2], 1)
        groups = list(_groups(factor, strides, lattices, margins))
        planes = np.zeros((2, beams, *size_of), np.int64)
        inside = tuple(slice(margin, margin + num) for margin, num in zip(margins, self.shape[1:], strict=True))
        inner = planes[(slice(None), slice(None), *inside)]
        inner[...] = levels * factor
        planes = planes.reshape(2, beams, -1)
        before = np.zeros(planes.shape[2], np.int64)
        for beam in range(beams):
            size = np.zeros_like(before)
            wide = _neighbour_mean(before.reshape(size_of)).ravel() if beam else before
            for group in groups:
                known = self._known(group, size, before if beam else None, wide, strides)
                self._code_group(stream, group, planes[:, beam], known, beam, strides, batches)
                size[group.at] = np.abs(planes[0, beam][group.at]) + np.abs(planes[1, beam][group.at])
            before = (size + before) // 2 if beam else size
        levels[...] = inner // np.maximum(factor, 1)

    def _offsets(self, phase: Phase, *, has_all: bool) -> list[tuple[Phase, int]]:
        """Known neighbours and their weights, without those along axes of one cell unless `has_all`."""
        found = known_neighbours(phase)
        single = [num == 1 and not has_all for num in self.shape[1:]]
        return [(offset, weight) for offset, weight in found if not any(map(operator.and_, map(bool, offset), single))]

    def _known(self, group: PhaseGroup, size: Integers, before, wide: Integers, strides) -> KnownSizes:
        at, factor = group.at, group.factor
        around, total = np.zeros(len(at), np.int64), 0
        for offset, weight in self.offsets[group.phase]:
            around += weight * size[at + group.stride * _flat(offset, strides)]
            total += weight
        return KnownSizes(
            own=4 * around // (total * factor) if total else None,
            other=None if before is None else 4 * before[at] // factor,
            wide=4 * wide[at] // factor,
        )

    def _code_group(self, stream, group: PhaseGroup, planes, known: KnownSizes, beam: int, strides, batches) -> None:
        at, factor = group.at, group.factor
        place = beam * self.shape[3] + group.column
        real: Integers | None = None
        for plane in planes:
            trend = self._trend(plane, group, strides)
            trend = None if trend is None else trend // factor
            wanted = plane[at] // factor
            values = np.concatenate(
                [
                    self._numbers(
                        stream,
                        known.some(batch, real),
                        None if trend is None else trend[batch],
                        place[batch],
                        wanted[batch],
                    )
                    for batch in batches.of(len(at))
                ]
            )
            plane[at] = values * factor
            real = np.abs(values)

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
        """Low bits of levels that are uniform, None where there are none, and by how much contexts are scaled."""
        most = DIGITS_IN_3 if stream.is_version_3 else DIGITS
        if int(expected.max()) >> 3 < 1 << most:
            return None, 0
        digits = np.frexp(np.maximum(expected >> 3, 1).astype(np.float64))[1].astype(np.int64)
        shift = np.maximum(digits - most, 0)
        return shift, 0 if stream.is_version_3 else shift

    def _trend(self, plane: Integers, group: PhaseGroup, strides) -> Integers | None:
        """Level predicted by the windows' correlation, in eighths of a fine step; None where nothing does."""
        at, (_, row, column) = group.at, strides
        along = bool(group.phase[1]) and self.correlated[0] and group.stride == 1
        across = bool(group.phase[2]) and self.correlated[1] and group.stride == 1
        if not (along or across):
            return None
        zero = np.zeros(len(at), np.int64)
        rows = plane[at - row] + plane[at + row] if along else zero
        columns = plane[at - column] + plane[at + column] if across else zero
        if not (along and across):
            return 5 * (rows + columns)
        corners = plane[at - row - column] + plane[at - row + column]
        corners = corners + plane[at + row - column] + plane[at + row + column]
        return 4 * (rows + columns) - 2 * corners


def _expected(known: KnownSizes, num: int) -> Integers:
    """Weighted mean of what is known about the size, in eighths of a level."""
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


def _groups(
    factor: Integers, strides: tuple[int, int, int], lattices: tuple[int, ...], margins: Sequence[int]
) -> Iterator[PhaseGroup]:
    for stride in lattices:
        for phase in PHASES if stride == lattices[0] else PHASES[1:]:
            own = factor[tuple(slice(stride * odd, None, 2 * stride) for odd in phase)]
            where = np.nonzero(own)
            if len(where[0]):
                cell = [stride * (2 * index + odd) for index, odd in zip(where, phase, strict=True)]
                at = _flat([index + margin for index, margin in zip(cell, margins, strict=True)], strides)
                yield PhaseGroup(phase=phase, stride=stride, at=at, column=cell[2], factor=own[where])


def _flat(index: Sequence, strides: tuple[int, int, int]):
    return index[0] * strides[0] + index[1] * strides[1] + index[2] * strides[2]


def _neighbour_mean(size: Integers) -> Integers:
    """Mean magnitude of the six neighbours along the axes."""
    out = np.zeros_like(size)
    for axis in range(3):
        line, into = np.moveaxis(size, axis, 0), np.moveaxis(out, axis, 0)
        into[1:] += line[:-1]
        into[:-1] += line[1:]
    return out // 6
