"""Encodes some frames of a recording as chunks at one step: to a size, or to a quality (encoder side)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from mmweaver.compression.cell_sample import CellSample
from mmweaver.compression.chunk import ChunkEncoder
from mmweaver.compression.chunk_frames import ChunkFrames
from mmweaver.compression.chunk_transform import MOST_DOPPLER
from mmweaver.compression.coded_chunk import ChunkMode, CodedChunk
from mmweaver.compression.mode_choice import ModeChooser
from mmweaver.compression.residual_stream import USUAL_PRICE, Price
from mmweaver.core.records import RadarCube

SHORT_CHUNK = 20  # frames
MOST_VALUES, MOST_FRAMES = 2**20, 2048  # of a chunk: complex numbers, frames
SAMPLED, REPEATED = 4096, 0.05  # numbers that are looked at; share that differs in a cube that repeats itself
COARSER = 4  # step of cells without signal in steps of those with signal
LARGEST_LEVEL = 2.0**27
USUAL_QUALITY_STEP = 0.02
# the step that suits 500 bytes per frame, and its slope over the logarithm of the size
FIRST_STEP, FIRST_SLOPE, USUAL_BYTES = 3e-3, 1.2, 500
LN2 = 0.6931  # median of a chi-squared with two degrees of freedom over its mean


@dataclass(frozen=True, kw_only=True)
class Scale:
    """What all chunks of a file share: largest magnitude, and the power above which a cell is active."""

    peak: float
    active_power: float


class SegmentEncoder:
    """Chunks of some frames, each in the mode that suits it."""

    def __init__(self, cube: RadarCube, scale: Scale, *, coarser: int = COARSER, without: tuple[str, ...] = ()):
        self.cube, self.scale, self.coarser, self.without = cube, scale, coarser, without
        self.parts: list[range] = []
        self._choosers: list[ModeChooser] = []
        self._num_bytes = math.inf

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
                coded = [chooser.encode(step, self.coarser, only_size=True) for chooser in choosers]
                costs.append(sum(one.cost(self.coarser) for one in coded))
            short = short if costs[0] <= costs[1] else long
        self.parts = short
        self._choosers = [self._chooser(part, self.without) for part in short]
        return short

    def plan_for(self, num_bytes: int | None) -> list[range]:
        """The plan for a size, or for the usual quality."""
        self._num_bytes = math.inf if num_bytes is None else num_bytes
        return self.plan(USUAL_QUALITY_STEP if num_bytes is None else first_step(num_bytes / len(self.cube.values)))

    @property
    def coarsest_step(self) -> float:
        """Steps above it leave nothing: the largest coefficient of any transform, relative to the peak."""
        frames, _, doppler, antennas = self.cube.values.shape
        return 2 * math.sqrt(min(frames, MOST_FRAMES) * antennas * min(doppler, MOST_DOPPLER))

    @property
    def finest_step(self) -> float:
        """Steps below it have levels that cannot be coded."""
        return self.coarsest_step / LARGEST_LEVEL

    @property
    def bounds(self) -> tuple[float, float]:
        """The finest and the coarsest step."""
        return self.finest_step, self.coarsest_step

    def decide(self, step: float, coarser: int | None = None) -> bool:
        """Decides on the mode of each chunk near a step; whether any is another one than before."""
        before = [chooser.mode for chooser in self._choosers]
        for chooser in self._choosers:
            chooser.decide(step, self.coarser if coarser is None else coarser)
        return before != [chooser.mode for chooser in self._choosers]

    def modes(self) -> list[ChunkMode | None]:
        """The modes decided on."""
        return [chooser.mode for chooser in self._choosers]

    def take_modes(self, modes: Sequence[ChunkMode | None]) -> None:
        """Takes modes instead of those decided on."""
        for chooser, mode in zip(self._choosers, modes, strict=True):
            chooser.mode = mode

    @property
    def had_points(self) -> bool:
        """Whether scatterers were decided on at any step."""
        return any(chooser.had_points for chooser in self._choosers)

    def start_again(self, *left_out: str) -> None:
        """Forgets what was decided; from now on some more of FREE_MODES are left out."""
        for chooser in self._choosers:
            chooser.start_again((*self.without, *left_out))

    def encode(
        self, step: float, coarser: int, noise_step: float = 0.0, price: Price = USUAL_PRICE, *, only_size: bool = False
    ) -> list[CodedChunk]:
        """All chunks at a step, in the modes decided on; with a noise layer where it has a step.

        `only_size`: see `ChunkEncoder.encode`.
        """
        return [chooser.encode(step, coarser, noise_step, price, only_size=only_size) for chooser in self._choosers]

    def noise_samples(self) -> list[CellSample]:
        """Samples of the noise layers."""
        return [chooser.encoder.noise_sample() for chooser in self._choosers]

    def modes_as_noise(self) -> list[ChunkMode]:
        """The modes of a noise layer of everything."""
        return [replace(chooser.plain, only_noise=True) for chooser in self._choosers]

    def samples_as_noise(self) -> list[CellSample]:
        """Samples of the chunks in these."""
        return [chooser.encoder.sample_as_noise() for chooser in self._choosers]

    def plain_modes(self) -> list[ChunkMode]:
        """The modes without layers."""
        return [chooser.plain for chooser in self._choosers]

    def modes_over_range(self) -> list[ChunkMode]:
        """These with a DCT of the ranges."""
        return [chooser.over_range for chooser in self._choosers]

    def samples_over_range(self) -> list[CellSample]:
        """Samples of the chunks in these."""
        return [chooser.encoder.sample(chooser.over_range.transform) for chooser in self._choosers]

    @property
    def active_share(self) -> float:
        """Share of the cells that are active."""
        return float(np.mean([chooser.encoder.is_active.mean() for chooser in self._choosers]))

    def mode_samples(self) -> list[CellSample]:
        """Samples of the transforms of the modes, without layers."""
        modes = [(chooser.encoder, chooser.mode) for chooser in self._choosers if chooser.mode]
        return [one.sample_as_noise() if mode.only_noise else one.sample(mode.transform) for one, mode in modes]

    def samples(self) -> list[CellSample]:
        """Samples of the chunks without layers."""
        return [chooser.encoder.sample(chooser.plain.transform) for chooser in self._choosers]

    def decided_samples(self) -> list[CellSample]:
        """Samples of the chunks in the modes decided on."""
        return [chooser.sample for chooser in self._choosers if chooser.sample is not None]

    def exact(self) -> list[bytes]:
        """All chunks without loss."""
        return [
            chooser.encoder.exact(self.cube.values[part.start : part.stop])
            for chooser, part in zip(self._choosers, self.parts, strict=True)
        ]

    def repeats(self) -> bool:
        """Whether a few numbers make up the cube, so that a file without loss may be the smallest."""
        some = self.cube.values.ravel()[:: max(1, self.cube.values.size // SAMPLED)]
        return len(np.unique(some)) < REPEATED * len(some)

    def _chooser(self, part: range, without: tuple[str, ...]) -> ModeChooser:
        encoder = chunk_encoder(some_frames(self.cube, part), self.scale)
        return ModeChooser(encoder, without=without, most_bytes=self._num_bytes * len(part) / len(self.cube.values))


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
    some = cube.values.ravel()[:: max(1, cube.values.size // 100_000)]
    power = np.square(some.real, dtype=np.float64) + np.square(some.imag, dtype=np.float64)
    return float(np.median(power)) / LN2


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
    """A step to plan with."""
    log_step = math.log(FIRST_STEP) - FIRST_SLOPE * math.log(bytes_a_frame / USUAL_BYTES)
    return math.exp(min(max(log_step, math.log(1e-7)), math.log(0.5)))
