"""Encodes some frames of a recording as chunks at one step: to a size, or to a quality (encoder side)."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from mmweaver.compression.chunk import ChunkEncoder, CodedChunk
from mmweaver.compression.chunk_frames import ChunkFrames
from mmweaver.compression.mode_choice import ModeChooser
from mmweaver.core.records import RadarCube

SHORT_CHUNK = 20  # frames
MOST_VALUES, MOST_FRAMES = 2**20, 2048  # of a chunk: complex numbers, frames
COARSER = 4  # step of cells without signal in steps of those with signal
FINEST_STEP, COARSEST_STEP = 1e-7, 0.5
TRIALS = 9
USUAL_QUALITY_STEP = 0.02
BENT = 0.1  # trials whose log sizes differ by less are interpolated linearly
CLOSE_ENOUGH = 0.985  # of the bytes allowed
# first guess: the step that suits 500 bytes per frame, and its slope over the logarithm of the size
FIRST_STEP, FIRST_SLOPE, USUAL_BYTES = 3e-3, 1.2, 500
EVEN_TRIALS, EVEN_DB = 14, 0.25  # dB that the error over all cells may exceed that of an even coder
SHORTER = 0.8  # bytes of a chunk in estimated ones
LN2 = 0.6931  # median of a chi-squared with two degrees of freedom over its mean

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Scale:
    """What all chunks of a file share: largest magnitude, and the power above which a cell is active."""

    peak: float
    active_power: float


class SegmentEncoder:
    """Chunks of some frames, each in the mode that suits it."""

    def __init__(self, cube: RadarCube, scale: Scale, *, coarser: int = COARSER, without: tuple[str, ...] = ()):
        self.cube, self.scale, self.coarser, self.without = cube, scale, coarser, without
        self._choosers: list[ModeChooser] = []

    def plan(self, step: float) -> list[range]:
        """Decides how long chunks are: short ones, or as long as memory allows, whichever cost less."""
        num = len(self.cube.values)
        most = max(1, min(MOST_FRAMES, MOST_VALUES // math.prod(self.cube.values.shape[1:])))
        short, long = split(num, min(SHORT_CHUNK, most)), split(num, most)
        if len(short) != len(long):
            sample = long[0]
            costs = []
            for parts in (split(len(sample), SHORT_CHUNK), [range(len(sample))]):
                choosers = [self._chooser(part, (*self.without, "scatterers", "low rank")) for part in parts]
                coded = [chooser.encode(step, self.coarser) for chooser in choosers]
                costs.append(sum(one.cost(self.coarser) for one in coded))
            short = short if costs[0] <= costs[1] else long
        self.parts = short
        self._choosers = [self._chooser(part, self.without) for part in short]
        return short

    def plan_for(self, num_bytes: int | None) -> list[range]:
        """The plan for a size, or for the usual quality."""
        return self.plan(USUAL_QUALITY_STEP if num_bytes is None else first_step(num_bytes / len(self.cube.values)))

    def encode(self, step: float) -> list[CodedChunk]:
        """All chunks at a step."""
        if not self._choosers:
            self.plan(step)
        return [chooser.encode(step, self.coarser) for chooser in self._choosers]

    def errs_evenly(self, coded: list[CodedChunk], num_bytes: int) -> bool:
        """Whether the error over all cells is that of a coder of as many bytes that treats all cells alike.

        That coder's error is estimated, with its best transform and without scatterers.
        """
        error = sum(chunk.all_error for chunk in coded)
        low, high = math.log(FINEST_STEP), math.log(COARSEST_STEP)
        even = error
        for _ in range(EVEN_TRIALS):
            middle = (low + high) / 2
            pairs = [chooser.even_estimate(math.exp(middle)) for chooser in self._choosers]
            size = SHORTER * sum(pair[0] for pair in pairs)
            if size > num_bytes:
                low = middle
            else:
                high, even = middle, sum(pair[1] for pair in pairs)
        return error <= even * 10 ** (EVEN_DB / 10)

    def exact(self) -> list[bytes]:
        """All chunks without loss."""
        if not self._choosers:
            self.plan(COARSEST_STEP)
        return [
            chooser.encoder.exact(self.cube.values[part.start : part.stop])
            for chooser, part in zip(self._choosers, self.parts, strict=True)
        ]

    def _chooser(self, part: range, without: tuple[str, ...]) -> ModeChooser:
        return ModeChooser(chunk_encoder(some_frames(self.cube, part), self.scale), without=without)


def chunk_encoder(cube: RadarCube, scale: Scale) -> ChunkEncoder:
    """The encoder of one chunk."""
    frames = ChunkFrames.of_cube(cube)
    peak = np.float32(scale.peak)
    return ChunkEncoder(
        frames=frames,
        target=frames.working(cube.values / peak),
        peak=float(peak),
        noise_power=noise_power(cube) / float(peak) ** 2,
        active_power=None if frames.hop else scale.active_power / float(peak) ** 2,
    )


def noise_power(cube: RadarCube) -> float:
    """Power of a cell of noise: the median over all cells, over the median of its distribution."""
    power = np.square(np.real(cube.values)) + np.square(np.imag(cube.values))
    return float(np.median(power.ravel()[:: max(1, power.size // 100_000)])) / LN2


def split(num_frames: int, length: int) -> list[range]:
    """Parts of about equal length, of at most `length` frames."""
    parts = -(-num_frames // length)
    bounds = [round(part * num_frames / parts) for part in range(parts + 1)]
    return [range(first, last) for first, last in pairwise(bounds)]


def some_frames(cube: RadarCube, part: Sequence[int]) -> RadarCube:
    """A stretch of frames."""
    chosen = slice(part[0], part[-1] + 1)
    grid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[chosen])
    return replace(cube, values=cube.values[chosen], grid=grid)


def first_step(bytes_a_frame: float) -> float:
    """A step to begin with."""
    log_step = math.log(FIRST_STEP) - FIRST_SLOPE * math.log(bytes_a_frame / USUAL_BYTES)
    return math.exp(min(max(log_step, math.log(FINEST_STEP)), math.log(COARSEST_STEP)))


def next_step(seen: list[tuple[float, float]], low: float, high: float) -> float:
    """Next log(step) to try so that the second value of `seen` becomes zero, or slightly less.

    Regula falsi between the trials on either side of zero, or bisection where it is slow. With trials on one side
    only: the line through the last two, or one of the usual slope.
    """
    above = [trial for trial in seen if trial[1] > 0]
    below = [trial for trial in seen if trial[1] <= 0]
    if above and below:
        first, second = max(above), min(below)
        if min(first[1], -second[1]) > BENT and (seen[-1][1] > 0) == (seen[-2][1] > 0):
            return (first[0] + second[0]) / 2  # only one side moves: the curve is bent
    elif len(seen) > 1:
        first, second = seen[-2:]
    else:
        first, second = seen[0], (seen[0][0] + 1.0, seen[0][1] - 0.8)
    run = second[0] - first[0]
    slope = min((second[1] - first[1]) / run, -0.2) if run else -0.8
    guess = first[0] + (-0.008 - first[1]) / slope
    edge = 0.03 * (high - low)
    return min(max(guess, low + edge), high - edge)
