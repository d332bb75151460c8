"""Entropy coding of sparse integer levels (beam, frame, range, doppler), real and imaginary, in selected cells only.

A significance map first tells which cells (frame, range, doppler) are open, for all beams, and how finely: open cells
without signal are quantised COARSER times as coarsely. The levels of the open cells follow beam by beam. Cells of even
row and even Doppler bin come first, then those between them along Doppler, then the odd rows in the same order, so that
every later cell has known neighbours on both sides. The FFT windows correlate neighbouring cells, signs included, so a
weighted sum of the neighbours predicts the level.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from mmweaver.compression.entropy import BitModel, BitStream, LadderModel, Mixture
from mmweaver.compression.residual_coder import NUM_NEAR, NUM_SUMS, NUM_TRENDS, SUM_BOUNDS, TREND_BOUNDS, spread

Levels = Int[np.ndarray, "2 beam frame range doppler"]
Cells = Int[np.ndarray, "frame range doppler"]
Integers = np.ndarray  # (n,) int64; called thousands of times a cube

CLOSED, COARSE, FINE = 0, 1, 2
COARSER = 4
FAR = 160  # eighths of a level; from this predicted magnitude on, the deviation from the prediction is coded
CAP = 4000
MARGIN = 2
CELLS_AT_ONCE = 512  # approximate number of map cells coded together
BLOCK_ROWS = 16  # rows of levels coded together
NUM_OPEN = 10
OPEN_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 11, 14, 18])


class MapCoder:
    """Codes the map of open cells, frame by frame, with adaptive contexts."""

    def __init__(self, shape: tuple[int, int, int]):
        self.shape = shape
        n = NUM_OPEN
        self.open = Mixture(
            [
                BitModel(4 * n * n, 0.05, 0.5),
                BitModel(n * n * NUM_NEAR, 0.05, 0.5),
                BitModel(NUM_NEAR * shape[2], 0.05, 0.5),
                BitModel(n * shape[1], 0.05, 0.5),
            ]
        )
        self.fine = Mixture([BitModel(n * n, 0.5, 0.5), BitModel(NUM_NEAR * shape[2], 0.5, 0.5)])

    def code(self, stream: BitStream, classes: Cells, near: Cells) -> None:
        """Encodes `classes` (CLOSED, COARSE or FINE), or fills them in when decoding. `near`: see `nearness`."""
        frames, num_range, num_doppler = self.shape
        padded = np.zeros((frames, num_range + 2, num_doppler + 2), np.int64)
        earlier = np.zeros((2, num_range + 2, num_doppler + 2), np.int64)
        block = max(2, CELLS_AT_ONCE * 4 // num_doppler // 2 * 2)
        for frame in range(frames):
            opened, fine = _smoothed_plane(earlier[0]), _smoothed_plane(earlier[1])
            for row in range(0, num_range, block):
                for phase in range(4):
                    r = np.arange(row + phase // 2, min(row + block, num_range), 2)
                    d = np.arange(phase % 2, num_doppler, 2)
                    if len(r) and len(d):
                        self._code_cells(stream, classes[frame], padded[frame], opened, fine, near[frame], r, d, phase)
            earlier = np.stack([padded[frame] > 0, padded[frame] == FINE]).astype(np.int64)

    def _code_cells(self, stream, classes, padded, opened, fine, near, r, d, phase) -> None:
        at = np.ix_(r + 1, d + 1)
        n = NUM_OPEN
        around = _class_of(_neighbour_sum((padded > 0).astype(np.int64), r + 1, d + 1))
        before = _class_of(opened[at])
        both = _class_of((_neighbour_sum((padded > 0).astype(np.int64), r + 1, d + 1) + opened[at]) // 2)
        by_near = np.minimum(near[np.ix_(r, d)], NUM_NEAR - 1)
        at_bin = by_near * self.shape[2] + d
        contexts = [
            (phase * n + around) * n + before,
            (both * n + before) * NUM_NEAR + by_near,
            at_bin,
            both * self.shape[1] + r[:, None],
        ]
        wanted = classes[np.ix_(r, d)].ravel()
        contexts = [context.ravel() for context in contexts]
        is_open = self.open.code(stream, contexts, (wanted > 0).astype(np.int64))
        out = is_open.copy()
        some = np.flatnonzero(is_open)
        if len(some):
            mine = _class_of(_neighbour_sum((padded == FINE).astype(np.int64), r + 1, d + 1)).ravel()
            past = _class_of(fine[at]).ravel()
            is_fine = self.fine.code(
                stream, [(mine * n + past)[some], contexts[2][some]], (wanted[some] == FINE).astype(np.int64)
            )
            out[some] += is_fine
        out = out.reshape(len(r), len(d))
        padded[at] = out
        classes[np.ix_(r, d)] = out


def _neighbour_sum(flags: np.ndarray, rows: np.ndarray, bins: np.ndarray) -> np.ndarray:
    """Weighted sum of the eight neighbours (row, bin); those along the axes count twice."""

    def at(off_row: int, off_bin: int) -> np.ndarray:
        return flags[(rows + off_row)[:, None], bins + off_bin]

    straight = at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1)
    return 2 * straight + at(-1, -1) + at(-1, 1) + at(1, -1) + at(1, 1)


def _smoothed_plane(flags: np.ndarray) -> np.ndarray:
    """Weighted 3 x 3 sum over a padded plane of the previous frame."""
    out = 3 * flags
    rows = flags.copy()
    rows[1:] += flags[:-1]
    rows[:-1] += flags[1:]
    around = rows.copy()
    around[:, 1:] += rows[:, :-1]
    around[:, :-1] += rows[:, 1:]
    return 2 * out + around - flags


def _class_of(count: np.ndarray) -> np.ndarray:
    return np.searchsorted(OPEN_BOUNDS, count, side="right")


@dataclass(frozen=True, kw_only=True)
class CellGroup:
    """Open cells that are coded together: their places in the padded planes and their fixed contexts."""

    at: Integers  # flat index in a padded (frame, range, doppler)
    phase: int
    factor: Integers  # step of the cell in units of the fine step
    by_near: Integers
    row: Integers
    doppler: Integers


class NumberCoder:
    """Codes the levels of the open cells: `code` encodes them, or fills them in when decoding."""

    def __init__(self, shape: tuple[int, int, int, int]):
        self.shape = shape
        beams, _, num_range, num_doppler = shape
        n, t = NUM_SUMS, NUM_TRENDS
        self.zero = Mixture(
            [
                BitModel(8 * t * n, 0.3, 0.5),
                BitModel(n * NUM_NEAR * t, 0.3, 0.5),
                BitModel(n * 3 * t, 0.3, 0.5),
                BitModel(2 * beams * num_doppler, 0.3, 0.5),
                BitModel(num_range * NUM_NEAR, 0.3, 0.5),
            ]
        )
        self.sign = Mixture([BitModel(8 * t, 0.5, 4.0)])
        self.size = LadderModel([n * t * 2, n * 3], 0.4)
        self.deviation = LadderModel([n, n], 0.8)

    def code(self, stream: BitStream, levels: Levels, classes: Cells, near: Cells) -> None:
        """Levels (part, beam, frame, range, doppler), changed in place when decoding."""
        beams, frames, num_range, num_doppler = self.shape
        wide = num_doppler + 2 * MARGIN
        padded = np.zeros((2, beams, frames, num_range + 2 * MARGIN, wide), np.int64)
        inside = slice(MARGIN, -MARGIN)
        padded[:, :, :, inside, inside] = levels
        wanted = padded.reshape(2, beams, -1).copy()
        groups = _groups(classes, near, padded.shape[2:])
        before = np.zeros(padded.shape[2:], np.int64)  # weighted magnitudes of the preceding beams
        for beam in range(beams):
            planes = np.zeros((2, wanted.shape[2]), np.int64)  # in fine steps
            size = np.zeros(wanted.shape[2], np.int64)
            other = spread(before).ravel()
            for group in groups:
                self._code_group(stream, group, wanted[:, beam], planes, size, other, beam, wide)
            before = (before + 2 * size.reshape(before.shape)) // 2
        levels[...] = wanted.reshape(padded.shape)[:, :, :, inside, inside]

    def _code_group(self, stream, group: CellGroup, wanted, planes, size, other, beam: int, wide: int) -> None:
        at, factor = group.at, group.factor
        around = _around(size, at, wide) // factor
        other_beams = other[at] // factor
        by_around = np.searchsorted(SUM_BOUNDS, around, side="right")
        by_other_beams = np.searchsorted(SUM_BOUNDS, other_beams, side="right")
        by_total = np.searchsorted(SUM_BOUNDS, (around + other_beams + 1) // 2, side="right")
        at_bin = beam * self.shape[3] + group.doppler
        known = np.zeros(len(at), np.int64)
        n, t = NUM_SUMS, NUM_TRENDS
        for part in (0, 1):
            trend = _trend(planes[part], at, wide, group.phase)
            trend = np.sign(trend) * (np.abs(trend) // factor)
            by_trend = np.searchsorted(TREND_BOUNDS, np.abs(trend), side="right")
            by_known = np.minimum(known, 2)
            contexts = [
                ((part * 4 + group.phase) * n + by_around) * t + by_trend,
                (by_other_beams * NUM_NEAR + group.by_near) * t + by_trend,
                (by_total * 3 + by_known) * t + by_trend,
                at_bin * 2 + (factor > 1),
                group.row * NUM_NEAR + group.by_near,
            ]
            sizes = [(by_total * t + by_trend) * 2, by_other_beams * 3 + by_known]
            signs = (part * 4 + group.phase) * t + by_trend
            values = self._numbers(stream, contexts, signs, sizes, by_around, trend, wanted[part][at])
            wanted[part][at] = values
            planes[part][at] = values * factor
            known = np.abs(values) + known
        size[at] = np.minimum(known * factor, CAP)

    def _numbers(self, stream, contexts, signs, sizes, by_around, trend, wanted) -> Integers:
        is_far = np.abs(trend) >= FAR
        if not is_far.any():
            return self._near(stream, contexts, signs, sizes, trend, wanted)
        values = np.zeros(len(wanted), np.int64)
        far, near = np.flatnonzero(is_far), np.flatnonzero(~is_far)
        values[far] = self._far(stream, [sizes[1][far] // 3, by_around[far]], trend[far], wanted[far])
        contexts, sizes = [context[near] for context in contexts], [size[near] for size in sizes]
        values[near] = self._near(stream, contexts, signs[near], sizes, trend[near], wanted[near])
        return values

    def _far(self, stream, contexts, trend, wanted) -> Integers:
        expected = (trend + 4) // 8
        deviation = wanted - expected
        size = self.deviation.code(stream, contexts, np.abs(deviation))
        some = np.flatnonzero(size)
        size[some] *= 1 - 2 * stream.bits(np.full(len(some), 0.5), (deviation[some] < 0).astype(np.int64))
        return expected + size

    def _near(self, stream, contexts, signs, sizes, trend, wanted) -> Integers:
        values = np.zeros(len(wanted), np.int64)
        some = np.flatnonzero(self.zero.code(stream, contexts, (wanted != 0).astype(np.int64)))
        if len(some):
            up = np.where(trend[some] < 0, -1, 1)
            against = self.sign.code(stream, [signs[some]], (wanted[some] * up < 0).astype(np.int64))
            size = 1 + self.size.code(stream, [sizes[0][some] + against, sizes[1][some]], np.abs(wanted[some]) - 1)
            values[some] = size * up * (1 - 2 * against)
        return values


def _groups(classes: Cells, near: Cells, padded_shape: tuple[int, ...]) -> list[CellGroup]:
    """Groups open cells by block of rows and interleaving phase."""
    frame, r, d = np.nonzero(classes)
    phase = 2 * (r % 2) + d % 2
    key = r // BLOCK_ROWS * 4 + phase
    _, rows, bins = padded_shape
    at = (frame * rows + r + MARGIN) * bins + d + MARGIN
    factor = np.where(classes[frame, r, d] == FINE, 1, COARSER)
    by_near = np.minimum(near[frame, r, d], NUM_NEAR - 1)
    groups = []
    for value in np.unique(key):
        own = np.flatnonzero(key == value)
        groups.append(
            CellGroup(
                at=at[own], phase=int(value % 4), factor=factor[own], by_near=by_near[own], row=r[own],
                doppler=d[own],
            )
        )  # fmt: skip
    return groups


def _around(size: Integers, at: Integers, wide: int) -> Integers:
    """Weighted magnitudes of the known neighbours; cells not decoded yet are zero."""
    out = size[at - 1] + size[at + 1] + size[at - wide] + size[at + wide]
    out = 2 * out + size[at - wide - 1] + size[at - wide + 1] + size[at + wide - 1] + size[at + wide + 1]
    return out + size[at - 2] + size[at + 2] + size[at - 2 * wide] + size[at + 2 * wide]


def _trend(plane: Integers, at: Integers, wide: int, phase: int) -> Integers:
    """Level predicted from the neighbours by the windows' correlation, in eighths of a level."""
    if phase == 0:
        return 6 * plane[at - wide] - 2 * plane[at - 2 * wide]
    across = plane[at - 1] + plane[at + 1]
    along = plane[at - wide] + plane[at + wide]
    if phase == 3:
        corners = plane[at - wide - 1] + plane[at - wide + 1] + plane[at + wide - 1] + plane[at + wide + 1]
        return 4 * (across + along) - 2 * corners
    return 5 * (across if phase == 1 else along)
