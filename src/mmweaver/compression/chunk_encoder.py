"""Encodes the frames of a chunk in a given mode at a given step, and estimates the cost of other modes.

A mode is a transform, with or without scatterers, and with or without a separate layer for cells without signal.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import torch

from mmweaver.compression.chunk import (
    HAS_CELLS,
    HAS_GAINS,
    HAS_NOISE,
    HAS_POINTS,
    HAS_STATIC,
    IS_EXACT,
    IS_NEW,
    PREFIX,
    ChunkFrames,
    pack_exact,
    pack_steps,
    point_coder_of,
)
from mmweaver.compression.entropy import Encoder
from mmweaver.compression.noise_layer import NoiseLayer, signal_filled, to_noise
from mmweaver.compression.quantised_cells import active_mask, active_power, beams_of, cell_power, code_cells, quantise
from mmweaver.compression.rate_model import CellSample, Estimate
from mmweaver.compression.scatterer_coder import (
    PointSteps,
    code_static,
    dequantize,
    nearness,
    pack_gains,
    quantize,
    static_levels,
    static_of,
    unpack_gains,
)
from mmweaver.compression.scatterers.fitting import FitRecipe, fitted
from mmweaver.compression.scatterers.layers import (
    Layers,
    fit_static,
    rendered,
    static_cells,
    static_response,
    strongest,
    subtract_static,
    values_of_point,
)
from mmweaver.compression.scatterers.refinement import Damping, refined
from mmweaver.compression.transforms import ChunkTransform, TransformChoice
from mmweaver.core.records import RadarCube
from mmweaver.signal.point_response import Points

MIN_SIZE = 2  # steps; weaker scatterers cost fewer bits as residual
REFINED_BELOW, REFINED_STEPS, SAME_COUNT = 0.85, 3, 0.15  # see `_kept_points`
SAME_NOISE = 0.3  # difference of log(step) up to which the noise layer of a chunk with scatterers is reused
MIN_GAIN = 0.03  # antenna gains that differ less from 1 are dropped
BYTES_PER_POINT = 6.0  # few, well-fitted scatterers are worth more than many: the residual is coded separately
POINTS_PER_FRAME, POINTS_OF_FEW_FRAMES = 35, (50, 250)  # for few frames: per frame, and in total
POINT_GAIN = 12.0  # energy that a scatterer must explain, in noise powers of a cell
FEW_FRAMES, FIT_OF_FEW_FRAMES, FIT = 4, (16, 3, 1.0), (22, 1, 1.3)  # stages, last steps and growth of a fit
DEVIATIONS, MARGIN = 3.5, 3  # threshold of cells for the fit in standard deviations of noise; cells around them
LN2 = 0.6931  # median of a chi-squared with two degrees of freedom over its mean


@dataclass(frozen=True, kw_only=True)
class ChunkMode:
    """How a chunk is coded; one of the candidates that the optimiser compares."""

    transform: TransformChoice = field(default_factory=TransformChoice)
    with_points: bool = False
    with_noise: bool = False  # cells without signal in a separate layer; everything if all cells are active


@dataclass(frozen=True, kw_only=True)
class CodedLayers:
    """Static layer and scatterers coded at a step, and the residual `target` (frame, range, doppler, antenna).

    `front` are the bytes before the stream, `num_values` the number of real parameters; for `near` see `nearness`.
    """

    target: np.ndarray
    near: np.ndarray
    stream: Encoder
    flags: int = 0
    front: bytes = b""
    num_values: int = 0


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Scale common to all chunks of a file: largest magnitude, and the power above which a cell is active."""

    peak: float
    active_power: float

    @classmethod
    def of(cls, cube: RadarCube) -> "Scale":
        """The scale of a cube; a cube of zeros has peak 1."""
        return cls(peak=float(np.abs(cube.values).max()) or 1.0, active_power=active_power(cell_power(cube.values)))


class ChunkEncoder:
    """Encodes consecutive frames at any step, which is relative to the peak of the file."""

    def __init__(self, cube: RadarCube, scale: Scale):
        """Converts the frames to working frames.

        Args:
            cube: The frames of the chunk alone.
            scale: Scale of the file.
        """
        peak = np.float32(scale.peak)
        self.values, self.frames, self.peak = cube.values, ChunkFrames.from_cube(cube), float(peak)
        self.target = self.frames.working(cube.values / peak)  # working frames (frame, range, doppler, antenna)
        self.noise_power = noise_power(cube) / self.peak**2
        self.is_active = active_mask(self.target, None if self.frames.hop else scale.active_power / self.peak**2)
        self.beams = beams_of(cube.config)
        self.layers: Layers | None = None
        self._transforms: dict[tuple[bool, bool], ChunkTransform] = {}
        self._coefficients: dict[TransformChoice, np.ndarray] = {}
        self._samples: dict[TransformChoice, CellSample] = {}
        self._noise: dict[bool, tuple[float, np.ndarray]] = {}  # of the noise layer: step, coefficients
        self._point_samples: dict[tuple[TransformChoice, float], CellSample] = {}
        self._noise_samples: dict[bool, CellSample] = {}
        self._kept: tuple[int, Points] | None = None

    @property
    def can_have_points(self) -> bool:
        """Whether scatterers may pay off.

        With one antenna a scatterer has about as many numbers as the cells it covers.
        """
        return self.frames.can_have_points and self.target.shape[3] > 1 and bool(self.target.any())

    def fit(self, num_bytes: float) -> bool:
        """Fits the scatterers that a chunk of a given size can afford.

        Args:
            num_bytes: Size of the chunk in bytes.

        Returns:
            Whether the fit is usable.
        """
        layers = _fit(self, num_bytes)
        if not bool(layers.static.isfinite().all() & layers.points.amplitude.isfinite().all()):
            return False  # nearly empty cubes have no noise to compare scatterers with
        gains = layers.calibration
        is_plain = bool((gains - 1).abs().max() < MIN_GAIN)
        gains = torch.ones_like(gains) if is_plain else unpack_gains(pack_gains(gains))
        self.layers = replace(layers, calibration=gains)
        return True

    def encode(self, step: float, mode: ChunkMode, coarser: int) -> bytes:
        """The chunk with an error of about step / sqrt(12) in each coded cell.

        Args:
            step: Quantisation step, relative to the peak.
            mode: How the chunk is coded.
            coarser: Step of cells without signal relative to that of the others.

        Returns:
            The bytes that `decode_chunk` reads.
        """
        step = float(np.float32(step))
        if mode.with_noise and self.is_active.all():
            noise = NoiseLayer.of(self._noise_coefficients(self.target, step, with_points=False), step, self.beams)
            return self._prefix(step, HAS_NOISE + IS_NEW) + noise.packed + Encoder().to_bytes()
        layers = self._layers(step, with_points=mode.with_points)
        stream, flags, front, target = layers.stream, layers.flags + IS_NEW, layers.front, layers.target
        if mode.with_noise:
            coefficients = self._noise_coefficients(target, step, with_points=mode.with_points)
            noise = NoiseLayer.of(coefficients, coarser * step, self.beams)
            flags, front, target, coarser = flags + HAS_NOISE, front + noise.packed, target - noise.values, 0
        transform, coefficients = self._transformed(mode.transform, target)
        cells = quantise(coefficients, step, coarser, transform.spread(self.is_active))
        if cells.classes.any():
            flags, front = flags + HAS_CELLS, front + transform.packed
            code_cells(stream, cells.levels, cells.classes, layers.near, transform.correlated, coarser)
        return self._prefix(step, flags, cells.centroids, coarser) + front + stream.to_bytes()

    def exact(self) -> bytes:
        """The chunk without any loss, as float32."""
        level = _noise_level(self.noise_power)
        front = PREFIX.pack(self.frames.num_frames, 0, self.peak, 1.0, 0, 0, level, 0, 0, IS_EXACT)
        return front + pack_exact(self.values)

    def estimate(self, sample: CellSample, mode: ChunkMode, step: float, coarser: int) -> Estimate:
        """Estimated size and error of the chunk, from a sample of its cells.

        Args:
            sample: Sample of the mode, from `sample`.
            mode: How the chunk is coded.
            step: Quantisation step, relative to the peak.
            coarser: Step of cells without signal relative to that of the others.
        """
        if not mode.with_noise:
            return sample.estimate(step, coarser)
        noise = self._noise_sample(with_points=mode.with_points)
        if self.is_active.all():
            return noise.estimate(step, 1)
        cells, noise = sample.estimate(step, 0), noise.estimate(step * coarser, 1)
        return Estimate(
            num_bytes=cells.num_bytes + noise.num_bytes,
            active_error=cells.active_error,
            all_error=cells.active_error + noise.all_error,
        )

    def sample(self, mode: ChunkMode, step: float) -> CellSample:
        """A sample of the coefficients of a mode, for `estimate`.

        Args:
            mode: How the chunk is coded.
            step: Step at which scatterers are subtracted, where the mode has them.
        """
        if not mode.with_points:
            if mode.with_noise:
                self._noise_coefficients(self.target, step, with_points=False)
            return self._sample(mode.transform)
        key = mode.transform, step
        if key in self._point_samples and (not mode.with_noise or True in self._noise):
            return self._point_samples[key]
        layers = self._layers(step, with_points=True)
        if mode.with_noise:
            self._noise_coefficients(layers.target, step, with_points=True)
        transform, coefficients = self._transformed(mode.transform, layers.target)
        front = PREFIX.size + len(layers.front) + len(transform.packed) + len(layers.stream.to_bytes())
        self._point_samples[key] = CellSample.of(
            coefficients,
            transform.spread(self.is_active),
            front_bytes=front,
            front_values=layers.num_values,
            front_step=step,
        )
        return self._point_samples[key]

    def _sample(self, choice: TransformChoice) -> CellSample:
        if choice not in self._samples:
            transform = self._transform(choice)
            front = PREFIX.size + len(transform.packed)
            if choice.antenna_klt:  # changes the coefficients of a cell, but not its power
                beams = self._sample(replace(choice, antenna_klt=False))
                found = beams.rotated(transform.antennas @ self.beams.conj().T, front)
            else:
                _, coefficients = self._transformed(choice, self.target)
                found = CellSample.of(coefficients, transform.spread(self.is_active), front_bytes=front)
            self._samples[choice] = found
        return self._samples[choice]

    def _noise_sample(self, *, with_points: bool) -> CellSample:
        if with_points not in self._noise_samples:
            _, coefficients = self._noise[with_points]
            self._noise_samples[with_points] = CellSample.of(coefficients, np.ones(coefficients.shape[1:], bool))
        return self._noise_samples[with_points]

    def _noise_coefficients(self, target: np.ndarray, step: float, *, with_points: bool) -> np.ndarray:
        """Coefficients of the noise layer, those of a nearby step where scatterers change with the step."""
        before = self._noise.get(with_points)
        if before is None or (with_points and abs(math.log(step / before[0])) > SAME_NOISE):
            quiet = target if self.is_active.all() else signal_filled(target, self.is_active)
            self._noise[with_points] = step, to_noise(quiet, self.beams)
        return self._noise[with_points][1]

    def _transformed(self, choice: TransformChoice, target: np.ndarray) -> tuple[ChunkTransform, np.ndarray]:
        if target is not self.target:
            transform = ChunkTransform.of(choice, target, self.beams)
            return transform, transform.forward(target)
        transform = self._transform(choice)
        if choice not in self._coefficients:
            self._coefficients = {choice: transform.forward(target)}
        return transform, self._coefficients[choice]

    def _transform(self, choice: TransformChoice) -> ChunkTransform:
        """The transform of a choice adapted to the frames; its matrices do not depend on the DCT."""
        key = choice.antenna_klt, choice.doppler_klt
        if key not in self._transforms:
            self._transforms[key] = ChunkTransform.of(choice, self.target, self.beams)
        return replace(self._transforms[key], choice=choice)

    def _layers(self, step: float, *, with_points: bool) -> CodedLayers:
        if not with_points or self.layers is None:
            return CodedLayers(target=self.target, near=np.zeros(self.target.shape[:3], np.int64), stream=Encoder())
        window, stream, layers = self.frames.fit_window(), Encoder(), self.layers
        response, axes = window.response, window.axes
        with torch.inference_mode():
            static = static_levels(layers.static, window, self.beams, step)
            layers = replace(layers, static=static_of(static, window, self.beams, step))
            steps = PointSteps.of(step, response, axes)
            coded = quantize(self._kept_points(layers, steps), steps, axes, response.num_directions, MIN_SIZE)
            points = dequantize(coded, window.num_working_frames, steps, axes, response.num_directions)
            target = self.target - rendered(replace(layers, points=points), response, axes).numpy()
        if static.any():
            code_static(stream, static)
        if len(coded):
            point_coder_of(self.frames, steps, response).code(stream, coded)
        has_gains = bool((layers.calibration != 1).any())
        return CodedLayers(
            target=target,
            near=nearness(coded, self.target.shape[:3]),
            stream=stream,
            flags=HAS_STATIC * bool(static.any()) + HAS_POINTS * bool(len(coded)) + HAS_GAINS * has_gains,
            front=pack_gains(layers.calibration) if has_gains else b"",
            num_values=int(np.count_nonzero(static)) + len(coded) * values_of_point(response),
        )

    def _kept_points(self, layers: Layers, steps: PointSteps) -> Points:
        """The scatterers worth coding; where many are dropped, the others are refined without them."""
        count = int((layers.points.amplitude.abs() / steps.amplitude >= MIN_SIZE).sum())
        kept = strongest(layers.points, count)
        if not count or count >= REFINED_BELOW * int((layers.points.amplitude != 0).sum()):
            return kept
        if self._kept is None or abs(self._kept[0] / count - 1) >= SAME_COUNT:
            window = self.frames.fit_window()
            target = torch.from_numpy(self.target) / layers.calibration
            target = target - static_cells(layers.static, window.response, window.axes)
            damping = Damping.fresh(len(target))
            points, _ = refined(kept, target, window.response, window.axes, damping, steps=REFINED_STEPS, largest=160)
            self._kept = count, points
        return self._kept[1]

    def _prefix(self, step: float, flags: int, centroids: tuple[int, int] = (0, 0), coarser: int = 1) -> bytes:
        frames, level = self.frames, _noise_level(self.noise_power)
        steps = pack_steps(coarser or 1)
        return PREFIX.pack(frames.num_frames, frames.hop, self.peak, step, *centroids, level, steps, 0, flags)


def noise_power(cube: RadarCube) -> float:
    """Noise power per cell: the median over all cells divided by the median of its distribution."""
    some = cube.values.ravel()[:: max(1, cube.values.size // 100_000)]
    power = np.square(some.real, dtype=np.float64) + np.square(some.imag, dtype=np.float64)
    return float(np.median(power)) / LN2


def split(num_frames: int, length: int) -> list[range]:
    """Divides frames into parts of about equal length.

    Args:
        num_frames: Number of frames.
        length: Maximum length of a part.
    """
    parts = -(-num_frames // length)
    bounds = [round(part * num_frames / parts) for part in range(parts + 1)]
    return [range(first, last) for first, last in pairwise(bounds)]


def some_frames(cube: RadarCube, part: Sequence[int]) -> RadarCube:
    """The part of a cube with consecutive frames.

    Args:
        cube: The cube.
        part: Numbers of the frames.
    """
    chosen = slice(part[0], part[-1] + 1)
    grid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[chosen])
    return replace(cube, values=cube.values[chosen], grid=grid)


def _noise_level(power: float) -> int:
    """Noise power in half decibels below the peak power."""
    return int(np.clip(round(-20 * math.log10(max(power, 1e-12))), 0, 255))


def _fit(encoder: ChunkEncoder, num_bytes: float) -> Layers:
    """Scatterers and static layer of a chunk, fitted where something moves."""
    window, frames = encoder.frames.fit_window(), encoder.frames.num_frames
    # a single frame cannot separate static clutter from slow motion
    each, most = POINTS_OF_FEW_FRAMES
    num_points = max(POINTS_PER_FRAME * frames, min(each * frames, most))
    stages, last_steps, growth = FIT if window.num_working_frames > FEW_FRAMES else FIT_OF_FEW_FRAMES
    recipe = FitRecipe(
        num_points=min(num_points, int(num_bytes / BYTES_PER_POINT)),
        with_static=frames > 1,
        with_calibration=True,
        stages=stages,
        last_steps=last_steps,
        growth=growth,
        least_gain=POINT_GAIN,
        most_noise=encoder.noise_power,
    )
    response, axes = window.response, window.axes
    at_rest, moving = static_response(response, axes), encoder.target.copy()
    if recipe.with_static:
        subtract_static(moving, fit_static(moving, at_rest), at_rest)
    ranges, bins = _box(moving, encoder.noise_power, with_static=recipe.with_static)
    own = replace(axes, range_bin=axes.range_bin[ranges], doppler_bin=axes.doppler_bin[bins])
    target = torch.from_numpy(encoder.target)
    layers = fitted(target[:, ranges, bins].contiguous(), replace(window, axes=own), recipe)
    static = torch.zeros(target.shape[1], target.shape[3], dtype=layers.static.dtype)
    if recipe.with_static:
        points = replace(layers.points, amplitude=-layers.points.amplitude)
        rest = response.render(points, axes, target / layers.calibration).numpy()
        static = torch.from_numpy(fit_static(rest, at_rest))
    return replace(layers, static=static)


def _box(moving: np.ndarray, noise_power: float, *, with_static: bool) -> tuple[slice, slice]:
    """Ranges and Doppler bins of a chunk (frame, range, doppler, antenna) that contain signal, with a margin."""
    power = np.square(moving.real).sum(axis=3) + np.square(moving.imag).sum(axis=3)
    antennas = moving.shape[3]
    strong = (power > (antennas + DEVIATIONS * math.sqrt(antennas) + POINT_GAIN) * noise_power).any(axis=0)
    bins = strong.any(axis=0)
    if with_static:
        bins[len(bins) // 2] = True
    return _neighbourhood(strong.any(axis=1)), _neighbourhood(bins)


def _neighbourhood(mask: np.ndarray) -> slice:
    """Slice from the first to the last set element, with a margin; everything where none is set."""
    found = np.flatnonzero(mask)
    return slice(max(0, found[0] - MARGIN), found[-1] + 1 + MARGIN) if len(found) else slice(None)
