"""Entropy coding of integer levels (beam, frame, range, doppler), real and imaginary, mostly zero and clustered.

Levels are coded beam by beam in blocks of range rows, all frames together; within a block the cells of even row and
even Doppler bin come first, then those between them along Doppler, then the odd rows in the same order. Contexts are
the neighbours already coded, the preceding beams, and whether a scatterer is near. The FFT windows correlate
neighbouring cells, signs included, so a weighted sum of the neighbours predicts the sign.
"""

import numpy as np
from jaxtyping import Int

from mmweaver.compression.entropy import BitModel, BitStream, Mixture, NumberModel

Levels = Int[np.ndarray, "2 beam frame range doppler"]
Nearness = Int[np.ndarray, "frame range doppler"]

# a sum of neighbours falls into the class of the first bound above it
SUM_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 11, 16, 24, 40, 70, 120, 220, 400, 800, 1600, 3200, 6400])
TREND_BOUNDS = np.array([1, 4, 7, 11, 16, 23, 33, 49, 73, 110, 180, 300, 500, 900, 1600, 3000, 6000])  # in eighths
NUM_SUMS, NUM_TRENDS = len(SUM_BOUNDS) + 1, len(TREND_BOUNDS) + 1
NUM_NEAR = 6
CAP = 4000
FAR = 160  # eighths of a level; from this predicted magnitude on, the deviation from the prediction is coded
MARGIN = 2
BLOCK_ROWS = 16
STEPS = 14


class ResidualCoder:
    """Adaptive models of one cube: `code` encodes `levels`, or fills them in when decoding."""

    def __init__(self, shape: tuple[int, int, int, int]):
        self.shape = shape
        beams, _, num_range, num_doppler = shape
        n, t = NUM_SUMS, NUM_TRENDS
        self.zero = Mixture(
            [
                BitModel(8 * t * n, 0.02, 0.5),
                BitModel(n * NUM_NEAR * t, 0.02, 0.5),
                BitModel(n * 3 * t, 0.02, 0.5),
                BitModel(beams * num_doppler, 0.02, 0.5),
                BitModel(num_range * NUM_NEAR, 0.02, 0.5),
            ]
        )
        self.sign = Mixture([BitModel(2 * t, 0.5, 4.0)])
        self.size = NumberModel(n * t * 2, STEPS, 0.3)
        self.deviation = NumberModel(n, STEPS, 0.8)

    def code(self, stream: BitStream, levels: Levels, near: Nearness) -> None:
        """Levels (part, beam, frame, range, doppler), changed in place when decoding. `near`: see `nearness`."""
        beams, frames, num_range, num_doppler = self.shape
        padded = np.zeros((2, beams, frames, num_range + 2 * MARGIN, num_doppler + 2 * MARGIN), np.int64)
        before = np.zeros(padded.shape[2:], np.int64)  # weighted magnitudes of the preceding beams
        inside = slice(MARGIN, -MARGIN)
        for beam in range(beams):
            plane = padded[:, beam]
            size = np.zeros(plane.shape[1:], np.int64)
            other = spread(before)
            for row in range(0, num_range, BLOCK_ROWS):
                for phase in range(4):
                    self._code_cells(stream, levels, plane, size, other, near, beam, row, phase)
            before = (before + 2 * size) // 2
        levels[...] = padded[:, :, :, inside, inside]

    def _code_cells(self, stream, levels, plane, size, other, near, beam, row, phase) -> None:
        frames, num_range, num_doppler = self.shape[1:]
        rows = np.arange(row + phase // 2, min(row + BLOCK_ROWS, num_range), 2)
        bins = np.arange(phase % 2, num_doppler, 2)
        if not len(rows) or not len(bins):
            return
        within = (slice(None), *np.ix_(rows, bins))
        at = (slice(None), *np.ix_(rows + MARGIN, bins + MARGIN))
        around = _around(size, rows + MARGIN, bins + MARGIN)
        other_beams = other[at]
        by_around = np.searchsorted(SUM_BOUNDS, around.ravel(), side="right")
        by_other_beams = np.searchsorted(SUM_BOUNDS, other_beams.ravel(), side="right")
        by_total = np.searchsorted(SUM_BOUNDS, ((around + other_beams + 1) // 2).ravel(), side="right")
        by_near = np.minimum(near[within], NUM_NEAR - 1).ravel()
        shape = (frames, len(rows), len(bins))
        at_bin = np.broadcast_to(beam * num_doppler + bins, shape).ravel()
        at_row = np.broadcast_to(rows[:, None], shape).ravel()
        known = np.zeros(len(by_around), np.int64)
        for part in (0, 1):
            trend = _trend(plane[part], rows + MARGIN, bins + MARGIN, phase).ravel()
            by_trend = np.searchsorted(TREND_BOUNDS, np.abs(trend), side="right")
            t = NUM_TRENDS
            contexts = [
                ((part * 4 + phase) * NUM_SUMS + by_around) * t + by_trend,
                (by_other_beams * NUM_NEAR + by_near) * t + by_trend,
                (by_total * 3 + np.minimum(known, 2)) * t + by_trend,
                at_bin,
                at_row * NUM_NEAR + by_near,
            ]
            values = self._numbers(
                stream, contexts, by_total, by_trend, trend, part, levels[part, beam][within].ravel()
            )
            plane[part][at] = values.reshape(shape)
            known = np.abs(values) + known
        size[at] = np.minimum(known, CAP).reshape(shape)

    def _numbers(self, stream, contexts, by_total, by_trend, trend, part, wanted) -> np.ndarray:
        values = np.zeros(len(wanted), np.int64)
        is_far = np.abs(trend) >= FAR
        if is_far.any():
            values[is_far] = self._far(stream, by_total[is_far], trend[is_far], wanted[is_far])
            near = np.flatnonzero(~is_far)
            contexts = [context[near] for context in contexts]
            values[near] = self._near(stream, contexts, by_total[near], by_trend[near], trend[near], part, wanted[near])
            return values
        return self._near(stream, contexts, by_total, by_trend, trend, part, wanted)

    def _far(self, stream, by_total, trend, wanted) -> np.ndarray:
        expected = (trend + 4) // 8
        deviation = wanted - expected
        size = self.deviation.code(stream, by_total, np.abs(deviation))
        some = np.flatnonzero(size)
        size[some] *= 1 - 2 * stream.bits(np.full(len(some), 0.5), (deviation[some] < 0).astype(np.int64))
        return expected + size

    def _near(self, stream, contexts, by_total, by_trend, trend, part, wanted) -> np.ndarray:
        values = np.zeros(len(wanted), np.int64)
        some = np.flatnonzero(self.zero.code(stream, contexts, (wanted != 0).astype(np.int64)))
        if len(some):
            up = np.where(trend[some] < 0, -1, 1)
            against = (wanted[some] * up < 0).astype(np.int64)
            against = self.sign.code(stream, [part * NUM_TRENDS + by_trend[some]], against)
            context = (by_total[some] * NUM_TRENDS + by_trend[some]) * 2 + against
            size = 1 + self.size.code(stream, context, np.abs(wanted[some]) - 1)
            values[some] = size * up * (1 - 2 * against)
        return values


def _at(values: np.ndarray, rows: np.ndarray, bins: np.ndarray, off_row: int, off_bin: int) -> np.ndarray:
    """Values at an offset from the given rows and bins (frame, row, bin)."""
    return values[:, (rows + off_row)[:, None], bins + off_bin]


def _cross(values: np.ndarray, rows: np.ndarray, bins: np.ndarray, far: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Sums of the two neighbours along range, and of those along Doppler."""
    along = _at(values, rows, bins, -far, 0) + _at(values, rows, bins, far, 0)
    return along, _at(values, rows, bins, 0, -far) + _at(values, rows, bins, 0, far)


def _corners(values: np.ndarray, rows: np.ndarray, bins: np.ndarray) -> np.ndarray:
    left = _at(values, rows, bins, -1, -1) + _at(values, rows, bins, 1, -1)
    return left + _at(values, rows, bins, -1, 1) + _at(values, rows, bins, 1, 1)


def _around(size: np.ndarray, rows: np.ndarray, bins: np.ndarray) -> np.ndarray:
    """Weighted magnitudes of the known neighbours (frame, row, bin); cells not decoded yet are zero."""
    along, across = _cross(size, rows, bins)
    further, wider = _cross(size, rows, bins, 2)
    return 2 * (along + across) + _corners(size, rows, bins) + further + wider


def _trend(plane: np.ndarray, rows: np.ndarray, bins: np.ndarray, phase: int) -> np.ndarray:
    """Level predicted from the neighbours by the windows' correlation, in eighths of a level (frame, row, bin)."""
    if phase == 0:
        return 6 * _at(plane, rows, bins, -1, 0) - 2 * _at(plane, rows, bins, -2, 0)
    along, across = _cross(plane, rows, bins)
    if phase == 3:
        return 4 * (across + along) - 2 * _corners(plane, rows, bins)
    return 5 * (across if phase == 1 else along)


def spread(before: np.ndarray) -> np.ndarray:
    """Magnitudes (frame, range, doppler) smoothed over the neighbours in range, Doppler and time."""
    out = 2 * before
    out[:, 1:] += before[:, :-1]
    out[:, :-1] += before[:, 1:]
    out[:, :, 1:] += before[:, :, :-1]
    out[:, :, :-1] += before[:, :, 1:]
    out[1:] += before[:-1] // 2
    out[:-1] += before[1:] // 2
    return out // 2
