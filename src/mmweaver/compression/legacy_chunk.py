"""Read-only: chunks of versions 1 and 2 of the .mmw format.

Version 1 codes the levels of all cells; version 2 may code a map of open cells first and then their levels only. Levels
are coded beam by beam in blocks of range rows, all frames together; within a block the cells of even row and even
Doppler bin come first, then those between them along Doppler, then the odd rows in the same order. Contexts are the
neighbours already coded, the preceding beams, and whether a scatterer is near. The FFT windows correlate neighbouring
cells, signs included, so a weighted sum of the neighbours predicts the level.
"""

import math
import struct
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from mmweaver.compression.cell_coder import CLOSED, COARSE, FINE
from mmweaver.compression.chunk import (
    HAS_GAINS,
    ChunkFrames,
    DecodedChunk,
    decode_layers,
    one_line_errors,
)
from mmweaver.compression.entropy import BitModel, BitStream, Decoder, Mixture, NumberModel
from mmweaver.compression.quantised_cells import beams_of
from mmweaver.compression.scatterer_coder import PointCoder, PointSteps, unpack_gains
from mmweaver.compression.transforms import ChunkTransform, TransformChoice
from mmweaver.core.radar_config import RadarConfig
from mmweaver.signal.point_response import PointResponse

Levels = Int[np.ndarray, "2 beam frame range doppler"]
Cells = Int[np.ndarray, "frame range doppler"]
Integers = np.ndarray  # (n,) int64; called thousands of times per cube

# frames, hop, peak, step, centroids of 1 and of more, noise, flags
PREFIX = struct.Struct("<HHffBBBB")
HAS_ALL_CELLS, HAS_OPEN_CELLS = 4, 16
COARSER = 4
# a sum of neighbours falls into the class of the first bound above it
SUM_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 11, 16, 24, 40, 70, 120, 220, 400, 800, 1600, 3200, 6400])
TREND_BOUNDS = np.array([1, 4, 7, 11, 16, 23, 33, 49, 73, 110, 180, 300, 500, 900, 1600, 3000, 6000])  # in eighths
OPEN_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 11, 14, 18])
AROUND_BOUNDS = np.array([1, 2, 3, 4, 6, 8, 12])
NUM_SUMS, NUM_TRENDS, NUM_OPEN, NUM_AROUND = (
    len(bounds) + 1 for bounds in (SUM_BOUNDS, TREND_BOUNDS, OPEN_BOUNDS, AROUND_BOUNDS)
)
NUM_NEAR = 6
CAP = 4000
FAR = 160  # eighths of a level; for larger predictions the deviation is coded
MARGIN = 2
CELLS_AT_ONCE = 512  # approximate number of map cells coded together
BLOCK_ROWS = 16  # rows of levels coded together
STEPS = 14
MAX_IN_A_CELL = 10_000
LAST_SINGLE = 3
RUNGS = np.array([0, 1, 2, 3, *(2**octave * half // 2 for octave in range(2, 30) for half in (2, 3))])
MAX_RUNGS = len(RUNGS) - 2


@one_line_errors
def decode_legacy_chunk(data: bytes, config: RadarConfig, *, with_residual: bool = True) -> DecodedChunk:
    """Decodes a chunk of version 1 or 2.

    Args:
        data: The chunk.
        config: Radar of the file.
        with_residual: Whether the residual is decoded; otherwise static layer and scatterers alone.

    Raises:
        InputError: For a malformed chunk.
    """
    num_frames, hop, peak, step, one, more, noise, flags = PREFIX.unpack_from(data)
    if not (num_frames and hop < config.num_loops and step > 0 and math.isfinite(step) and math.isfinite(peak)):
        raise ValueError("impossible prefix")
    is_dense, is_open = bool(flags & HAS_ALL_CELLS), bool(flags & HAS_OPEN_CELLS)
    if flags >= 2 * HAS_OPEN_CELLS or (is_dense and is_open):
        raise ValueError("impossible flags")
    frames = ChunkFrames.of(config, num_frames, hop)
    at, gains = PREFIX.size, None
    if flags & HAS_GAINS:
        gains = unpack_gains(data[at : at + 2 * config.num_antennas])
        at += 2 * config.num_antennas
    stream, noise_power = Decoder(data[at:]), 10 ** (-noise / 20)
    layers, near = decode_layers(
        stream, frames, step, flags, gains, noise_power, code_static=_code_static, point_coder=_RowPointCoder.of
    )
    residual, num_values = None, 0
    if (is_dense or is_open) and with_residual:
        levels = np.zeros((2, config.num_antennas, *near.shape), np.int64)
        classes = np.full(near.shape, FINE if is_dense else CLOSED)
        if is_open:
            LegacyMapCoder(classes.shape).code(stream, classes, near)
        LegacyLevelCoder(levels.shape[1:], is_dense=is_dense).code(stream, levels, classes, near)
        num_values = int(np.count_nonzero(levels))
        size = np.abs(levels)
        magnitude = size + np.where(size == 1, (one - 128) / 256, (more - 128) / 256)
        values = np.sign(levels) * magnitude * (step * np.where(classes == COARSE, COARSER, 1))
        residual = _transform(config).inverse(values[0] + 1j * values[1]).astype(np.complex64)
    return DecodedChunk(
        frames=frames,
        layers=layers,
        residual=residual,
        peak=peak,
        noise_power=noise_power,
        num_residual_values=num_values,
    )


def _transform(config: RadarConfig) -> ChunkTransform:
    beams = beams_of(config)
    return ChunkTransform(choice=TransformChoice(), antennas=beams, doppler=None, signs=(False, False), words=b"")


def _code_static(stream: BitStream, levels: Levels) -> None:
    classes = np.full(levels.shape[2:], FINE)
    LegacyLevelCoder(levels.shape[1:], is_dense=True).code(stream, levels, classes, np.zeros_like(classes))


class LegacyMapCoder:
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
        """Encodes classes, or fills them in when decoding.

        Args:
            stream: Encoder or decoder.
            classes: CLOSED, COARSE or FINE per cell (frame, range, doppler).
            near: Strength of the nearest scatterer, see `nearness`.
        """
        frames, num_range, num_doppler = self.shape
        padded = np.zeros((frames, num_range + 2, num_doppler + 2), np.int64)
        earlier = np.zeros((2, num_range + 2, num_doppler + 2), np.int64)
        block = max(2, CELLS_AT_ONCE * 4 // num_doppler // 2 * 2)
        for frame in range(frames):
            smooth = _smoothed_plane(earlier[0]), _smoothed_plane(earlier[1])
            for row in range(0, num_range, block):
                for phase in range(4):
                    r = np.arange(row + phase // 2, min(row + block, num_range), 2)
                    d = np.arange(phase % 2, num_doppler, 2)
                    if len(r) and len(d):
                        self._code_cells(stream, classes[frame], padded[frame], smooth, near[frame], (r, d), phase)
            earlier = np.stack([padded[frame] > 0, padded[frame] == FINE]).astype(np.int64)

    def _code_cells(self, stream, classes, padded, smooth, near, cells, phase) -> None:
        (r, d), n = cells, NUM_OPEN
        at = np.ix_(r + 1, d + 1)
        known, earlier = _neighbour_sum((padded > 0).astype(np.int64), r + 1, d + 1), smooth[0][at]
        around, before, both = _class_of(known), _class_of(earlier), _class_of((known + earlier) // 2)
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
            past = _class_of(smooth[1][at]).ravel()
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
class LegacyGroup:
    """Open cells that are coded together: their positions in the padded planes and their fixed contexts."""

    at: Integers  # flat index in a padded (frame, range, doppler)
    phase: int
    factor: Integers  # step of the cell in units of the fine step
    by_near: Integers
    row: Integers
    doppler: Integers


class LegacyLevelCoder:
    """Codes the levels of cells: `code` encodes them, or fills them in when decoding.

    `is_dense` selects the models of version 1, for all cells, instead of those of version 2, for open ones.
    """

    def __init__(self, shape: tuple[int, int, int, int], *, is_dense: bool):
        self.shape, self.is_dense = shape, is_dense
        beams, _, num_range, num_doppler = shape
        n, t = NUM_SUMS, NUM_TRENDS
        sizes = (8 * t * n, n * NUM_NEAR * t, n * 3 * t, 2 * beams * num_doppler, num_range * NUM_NEAR)
        self.zero = Mixture([BitModel(size, 0.02 if is_dense else 0.3, 0.5) for size in sizes])
        self.sign = Mixture([BitModel(8 * t, 0.5, 4.0)])
        self.size = NumberModel(n * t * 2, STEPS, 0.3) if is_dense else LadderModel([n * t * 2, n * 3], 0.4)
        self.deviation = NumberModel(n, STEPS, 0.8) if is_dense else LadderModel([n, n], 0.8)

    def code(self, stream: BitStream, levels: Levels, classes: Cells, near: Cells) -> None:
        """Encodes levels (part, beam, frame, range, doppler), or changes them in place when decoding."""
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
            other = _spread(before).ravel()
            for group in groups:
                self._code_group(stream, group, wanted[:, beam], planes, size, other, beam, wide)
            before = (before + 2 * size.reshape(before.shape)) // 2
        levels[...] = wanted.reshape(padded.shape)[:, :, :, inside, inside]

    def _code_group(self, stream, group: LegacyGroup, wanted, planes, size, other, beam: int, wide: int) -> None:
        at, factor = group.at, group.factor
        around = _neighbourhood(size, at, wide) // factor
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
            by_part = part * 4 + group.phase
            zeros = [
                (by_part * n + by_around) * t + by_trend,
                (by_other_beams * NUM_NEAR + group.by_near) * t + by_trend,
                (by_total * 3 + by_known) * t + by_trend,
                at_bin * 2 + (factor > 1),
                group.row * NUM_NEAR + group.by_near,
            ]
            signs = (part if self.is_dense else by_part) * t + by_trend
            sizes = [(by_total * t + by_trend) * 2, by_other_beams * 3 + by_known]
            far = [by_total] if self.is_dense else [by_other_beams, by_around]
            values = self._numbers(stream, zeros, signs, sizes, far, trend, wanted[part][at])
            wanted[part][at] = values
            planes[part][at] = values * factor
            known = np.abs(values) + known
        size[at] = np.minimum(known * factor, CAP)

    def _numbers(self, stream, zeros, signs, sizes, far, trend, wanted) -> Integers:
        values = np.zeros(len(wanted), np.int64)
        is_far = np.abs(trend) >= FAR
        chosen = np.flatnonzero(is_far)
        if len(chosen):
            expected = (trend[chosen] + 4) // 8
            deviation = wanted[chosen] - expected
            size = self._coded(self.deviation, stream, [context[chosen] for context in far], np.abs(deviation))
            some = np.flatnonzero(size)
            size[some] *= 1 - 2 * stream.bits(np.full(len(some), 0.5), (deviation[some] < 0).astype(np.int64))
            values[chosen] = expected + size
        near = np.flatnonzero(~is_far)
        is_open = self.zero.code(stream, [context[near] for context in zeros], (wanted[near] != 0).astype(np.int64))
        some = near[np.flatnonzero(is_open)]
        if len(some):
            up = np.where(trend[some] < 0, -1, 1)
            against = self.sign.code(stream, [signs[some]], (wanted[some] * up < 0).astype(np.int64))
            contexts = [sizes[0][some] + against, sizes[1][some]]
            size = 1 + self._coded(self.size, stream, contexts, np.abs(wanted[some]) - 1)
            values[some] = size * up * (1 - 2 * against)
        return values

    @staticmethod
    def _coded(model: "NumberModel | LadderModel", stream, contexts: list[Integers], values: Integers) -> Integers:
        if isinstance(model, NumberModel):
            return model.code(stream, contexts[0], values)
        return model.code(stream, contexts, values)


def _groups(classes: Cells, near: Cells, padded_shape: tuple[int, ...]) -> list[LegacyGroup]:
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
            LegacyGroup(
                at=at[own],
                phase=int(value % 4),
                factor=factor[own],
                by_near=by_near[own],
                row=r[own],
                doppler=d[own],
            )
        )
    return groups


def _neighbourhood(size: Integers, at: Integers, wide: int) -> Integers:
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


def _spread(before: np.ndarray) -> np.ndarray:
    """Magnitudes (frame, range, doppler) smoothed over the neighbours in range, Doppler and time."""
    out = 2 * before
    out[:, 1:] += before[:, :-1]
    out[:, :-1] += before[:, 1:]
    out[:, :, 1:] += before[:, :, :-1]
    out[:, :, :-1] += before[:, :, 1:]
    out[1:] += before[:-1] // 2
    out[:-1] += before[1:] // 2
    return out // 2


class LadderModel:
    """Non-negative integers with mixed contexts: an adaptive bit per rung of a ladder, then uniform bits.

    Rungs are 0, 1, 2, 3, then two per octave: 4-5, 6-7, 8-11, 12-15, 16-23, ...
    """

    def __init__(self, num_contexts: list[int], probability: float = 0.4):
        self.rungs = [Mixture([BitModel(num, probability, 2.0) for num in num_contexts]) for _ in range(MAX_RUNGS)]

    def code(self, stream: BitStream, contexts: list[Integers], values: Integers) -> Integers:
        """Codes numbers given one context per model and number; returns them."""
        wanted = np.searchsorted(RUNGS, values, side="right") - 1
        rung = np.zeros(len(values), np.int64)
        active = np.arange(len(values))
        for step, model in enumerate(self.rungs):
            if not len(active):
                break
            more = model.code(
                stream, [context[active] for context in contexts], (wanted[active] > step).astype(np.int64)
            )
            active = active[more > 0]
            rung[active] = step + 1
        if len(active):
            raise ValueError("a number too large: the stream is damaged")
        out = RUNGS[rung]
        wide = np.flatnonzero(rung > LAST_SINGLE)
        if len(wide):
            out[wide] += stream.uniform(RUNGS[rung[wide] + 1] - out[wide], values[wide] - out[wide])
        return out


class _RowPointCoder(PointCoder):
    """Codes the number of scatterers per cell row by row, given those of the preceding frame."""

    def __init__(self, shape: tuple[int, int, int], steps: PointSteps, num_directions: int, moves: int):
        """`moves`: range cells that a scatterer moves per Doppler cell and frame, times 256."""
        super().__init__(shape, steps, num_directions)
        self.moves, a = moves, NUM_AROUND
        self.more = [
            Mixture([BitModel(a * a * 2, 0.03, 0.5), BitModel(a * a, 0.03, 0.5), BitModel(shape[2], 0.03, 0.5)])
            for _ in range(4)
        ]

    @classmethod
    def of(cls, frames: ChunkFrames, steps: PointSteps, response: PointResponse) -> "_RowPointCoder":
        moves = round(256 * frames.config.frame_period_s * response.velocity_a_bin_mps / response.range_a_bin_m)
        return cls(frames.working_shape[:3], steps, response.num_directions, moves)

    def _counts(self, stream: BitStream, wanted: np.ndarray) -> np.ndarray:
        frames, num_range, num_doppler = self.shape
        counts = np.zeros(self.shape, np.int64)
        for frame in range(frames):
            before = (
                self._predicted_counts(counts[frame - 1]) if frame else np.zeros((num_range, num_doppler), np.int64)
            )
            for row in range(num_range):
                self._code_row(stream, wanted[frame, row], counts[frame], row, before)
        return counts

    def _predicted_counts(self, counts: np.ndarray) -> np.ndarray:
        """Scatterer counts of the previous frame, moved by their velocity and smoothed over the neighbours."""
        num_range, num_doppler = counts.shape
        static = num_doppler // 2
        out = np.zeros((num_range + 2, num_doppler + 2), np.int64)
        r, d = np.nonzero(counts)
        to = np.clip(r + ((d - static) * self.moves + 128) // 256, 0, num_range - 1)
        np.add.at(out, (to + 1, d + 1), 2 * counts[r, d])
        near = out.copy()
        near[1:] += out[:-1] // 2
        near[:-1] += out[1:] // 2
        near[:, 1:] += out[:, :-1] // 2
        near[:, :-1] += out[:, 1:] // 2
        return near[1:-1, 1:-1]

    def _code_row(self, stream, wanted, counts, row, before) -> None:
        num_doppler = counts.shape[1]
        padded = np.zeros((3, num_doppler + 2), np.int64)
        if row:
            padded[0, 1:-1] = counts[row - 1]
        if row > 1:
            padded[1, 1:-1] = counts[row - 2]
        for first in (0, 1):
            d = np.arange(first, num_doppler, 2)
            around = 2 * padded[0, d + 1] + padded[0, d] + padded[0, d + 2] + padded[1, d + 1]
            if first:
                around = around + 2 * (padded[2, d] + padded[2, d + 2])
            around = np.searchsorted(AROUND_BOUNDS, around, side="right")
            earlier = np.searchsorted(AROUND_BOUNDS, before[row, d], side="right")
            total = np.searchsorted(AROUND_BOUNDS, around + before[row, d], side="right")
            contexts = [(around * NUM_AROUND + earlier) * 2 + first, total * NUM_AROUND + earlier, d]
            value = np.zeros(len(d), np.int64)
            active = np.arange(len(d))
            step = 0
            while len(active):
                model = self.more[min(step, len(self.more) - 1)]
                chosen = [context[active] for context in contexts]
                more = model.code(stream, chosen, (wanted[d[active]] > step).astype(np.int64))
                active = active[more > 0]
                value[active] += 1
                step += 1
                if step > MAX_IN_A_CELL:
                    raise ValueError("too many scatterers in one cell: the stream is damaged")
            counts[row, d] = value
            padded[2, d + 1] = value
