"""Whole numbers on (beam, frame, range, doppler), real and imaginary, that are mostly zero and come in clusters.

Coded beam by beam and range row by range row, all frames at once, every second Doppler bin first. What is likely is
judged by the neighbours that are already known: rows before, beams before, the other Doppler bins of the row, and
whether a scatterer is near. The windows of the transforms make neighbours alike in sign, too: their sum says which
sign comes.
"""

import numpy as np
from jaxtyping import Int

from mmweaver.fields.codec.entropy import BitModel, BitStream, Mixture, NumberModel

Levels = Int[np.ndarray, "2 beam frame range doppler"]
Nearness = Int[np.ndarray, "frame range doppler"]

# a sum of neighbours falls into the class of the first bound above it
SUM_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 11, 16, 24, 40, 70])
TREND_BOUNDS = np.array([1, 4, 7, 11, 16, 23, 33, 49, 73, 110, 180])  # in eighths
NUM_SUMS, NUM_TRENDS = len(SUM_BOUNDS) + 1, len(TREND_BOUNDS) + 1
NUM_NEAR = 6
CAP = 40
MARGIN = 2
STEPS = 14


class ResidualCoder:
    """The models of one cube. `code` writes `levels`, or fills them where the stream reads."""

    def __init__(self, shape: tuple[int, int, int, int]):
        self.shape = shape
        beams, _, num_range, num_doppler = shape
        n, t = NUM_SUMS, NUM_TRENDS
        self.zero = Mixture(
            [
                BitModel(4 * t * n, 0.02, 0.5),
                BitModel(n * NUM_NEAR * t, 0.02, 0.5),
                BitModel(n * 3 * t, 0.02, 0.5),
                BitModel(beams * num_doppler, 0.02, 0.5),
                BitModel(num_range * NUM_NEAR, 0.02, 0.5),
            ]
        )
        self.sign = Mixture([BitModel(2 * t, 0.5, 4.0)])
        self.size = NumberModel(n * t * 2, STEPS, 0.3)

    def code(self, stream: BitStream, levels: Levels, near: Nearness) -> None:
        """Levels (part, beam, frame, range, doppler), changed in place by a reader."""
        beams, frames, num_range, num_doppler = self.shape
        padded = np.zeros((2, beams, frames, num_range + 2 * MARGIN, num_doppler + 2 * MARGIN), np.int64)
        before = np.zeros(padded.shape[2:], np.int64)  # sizes of the beams before, weighted
        inside = slice(MARGIN, -MARGIN)
        for beam in range(beams):
            plane = padded[:, beam]
            size = np.zeros(plane.shape[1:], np.int64)
            other = _spread(before)
            for row in range(num_range):
                for first in (0, 1):
                    self._code_row(stream, levels, plane, size, other, near, beam, row, first)
            before = (before + 2 * size) // 2
        levels[...] = padded[:, :, :, inside, inside]

    def _code_row(self, stream, levels, plane, size, other, near, beam, row, first) -> None:
        frames, num_doppler = self.shape[1], self.shape[3]
        r = row + MARGIN
        d = np.arange(first, num_doppler, 2) + MARGIN
        if not len(d):
            return
        around = 2 * size[:, r - 1, d] + size[:, r - 1, d - 1] + size[:, r - 1, d + 1] + size[:, r - 2, d]
        around = around + (size[:, r - 1, d + 2] + size[:, r - 1, d - 2]) // 2
        if first:
            around = around + 2 * (size[:, r, d - 1] + size[:, r, d + 1])
        beside = other[:, r, d]
        by_around = np.searchsorted(SUM_BOUNDS, around.ravel(), side="right")
        by_beside = np.searchsorted(SUM_BOUNDS, beside.ravel(), side="right")
        by_total = np.searchsorted(SUM_BOUNDS, ((around + beside + 1) // 2).ravel(), side="right")
        by_near = np.minimum(near[:, row, d - MARGIN], NUM_NEAR - 1).ravel()
        at_bin = np.tile(beam * num_doppler + d - MARGIN, frames)
        known = np.zeros(len(by_around), np.int64)
        for part in (0, 1):
            trend = _trend(plane[part], r, d, first).ravel()
            by_trend = np.searchsorted(TREND_BOUNDS, np.abs(trend), side="right")
            t = NUM_TRENDS
            contexts = [
                ((part * 2 + first) * NUM_SUMS + by_around) * t + by_trend,
                (by_beside * NUM_NEAR + by_near) * t + by_trend,
                (by_total * 3 + np.minimum(known, 2)) * t + by_trend,
                at_bin,
                row * NUM_NEAR + by_near,
            ]
            wanted = levels[part, beam, :, row, d - MARGIN].T.ravel()  # advanced indices go first
            values = self._numbers(stream, contexts, by_total, by_trend, trend, part, wanted)
            plane[part][:, r, d] = values.reshape(frames, len(d))
            known = np.abs(values) + known
        size[:, r, d] = np.minimum(known, CAP).reshape(frames, len(d))

    def _numbers(self, stream, contexts, by_total, by_trend, trend, part, wanted) -> np.ndarray:
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


def _trend(plane: np.ndarray, r: int, d: np.ndarray, first: int) -> np.ndarray:
    """What the windows' colour makes of the neighbours, in eighths of a level (frame, bin)."""
    above, further = plane[:, r - 1], plane[:, r - 2]
    if not first:
        return 7 * above[:, d] - 3 * further[:, d]
    row = plane[:, r]
    across = 5 * (row[:, d - 1] + row[:, d + 1])
    return across + 6 * above[:, d] - 3 * (above[:, d - 1] + above[:, d + 1])


def _spread(before: np.ndarray) -> np.ndarray:
    """Sizes at and around each cell, in the frame, its neighbours in range, Doppler and time."""
    out = 2 * before
    out[:, 1:] += before[:, :-1]
    out[:, :-1] += before[:, 1:]
    out[:, :, 1:] += before[:, :, :-1]
    out[:, :, :-1] += before[:, :, 1:]
    out[1:] += before[:-1] // 2
    out[:-1] += before[1:] // 2
    return out // 2
