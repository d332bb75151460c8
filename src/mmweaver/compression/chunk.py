"""A few frames in one stream: static layer, scatterers, residual; read as far as wanted.

All three are cut with one step: an error of one step in any number leaves about the same energy in the cube.
"""

import math
import struct
from dataclasses import dataclass, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.cell_choice import active_cells, chosen_cells, rounded, still_joined
from mmweaver.compression.cell_coder import COARSE, COARSER, MapCoder, NumberCoder
from mmweaver.compression.entropy import BitStream, Reader, Writer
from mmweaver.compression.point_coder import PointCoder, PointSteps, nearness, points_of, quantised
from mmweaver.compression.residual_coder import ResidualCoder
from mmweaver.compression.transforms import beams_of, from_coefficients, to_coefficients
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.shapes import CubeValues
from mmweaver.dsp.point_response import Points
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.layers import Layers, no_points, rendered, static_cells, strongest
from mmweaver.fields.scatterers.refinement import Damping, refined

# frames, hop, peak, step, centroids of 1 and of more, noise, flags
FRONT = struct.Struct("<HHffBBBB")
HAS_STATIC, HAS_POINTS, HAS_RESIDUAL, HAS_GAINS, HAS_CELLS = 1, 2, 4, 8, 16
STATIC_ROUNDING = 0.4
LEAST_SIZE = 2  # steps; smaller scatterers are cheaper as residual
REFINED_STEPS = 4
SAME_DECISION = 1.5  # of the logarithm of the step: nearer steps are not tried both ways again
SAME_COUNT = 0.1  # points refined for a count that differs by less serve again
GAIN_STEPS = 64.0
LEAST_GAIN = 0.03  # learned gains that differ less from 1 stay behind


@dataclass(frozen=True, kw_only=True)
class Decoded:
    """What a chunk holds. `residual`: working frames in centred phase, or None where it was not read."""

    stretch: FitWindow
    layers: Layers
    residual: Tensor | None
    peak: float
    num_residual_values: int = 0  # numbers of the residual that are not zero

    def cube_values(self) -> CubeValues:
        """The frames of the cube, complex64."""
        with torch.inference_mode():
            working = rendered(self.layers, self.stretch.response, self.stretch.axes)
            if self.residual is not None:
                working = working + self.residual
            return self.stretch.cube_values(working * self.peak)


class ChunkEncoder:
    """Frames that were fitted once, written as finely as asked. `target` is the working frames over `peak`."""

    def __init__(self, target: Tensor, stretch: FitWindow, layers: Layers, peak: float, *, keep_noise: bool = False):
        if bool((layers.calibration - 1).abs().max() < LEAST_GAIN):
            layers = replace(layers, calibration=torch.ones_like(layers.calibration))
        self.target, self.stretch, self.peak = target, stretch, peak
        self.layers = replace(layers, calibration=_cut_gains(layers.calibration))
        self.beams = beams_of(stretch.config)
        self.is_active = None if keep_noise else still_joined(active_cells(target.numpy()))
        self._refined_points: tuple[int, Points] | None = None
        self._with_points: tuple[float, bool] | None = None

    def encoded(self, step: float) -> bytes:
        """The chunk with errors of about step / sqrt(12) a cell (of the peak) where it says anything.

        With or without scatterers, whichever is shorter: a step far below the noise is for numbers, not for echoes.
        """
        decided = self._with_points
        if decided is None or abs(math.log(step / decided[0])) > SAME_DECISION:
            both = [self._encoded(step, with_points=choice) for choice in (True, False)]
            is_better = len(both[0]) <= len(both[1])
            self._with_points = step, is_better
            return both[0] if is_better else both[1]
        return self._encoded(step, with_points=decided[1])

    def _encoded(self, step: float, *, with_points: bool) -> bytes:
        step = float(np.float32(step))
        stretch, layers = self.stretch, self.layers
        stream = Writer()
        with torch.inference_mode():
            static = self._static_levels(step)
            layers = replace(layers, static=_static_of(static, stretch, self.beams, step))
            if static.any():
                _code_static(stream, static)
            steps = PointSteps.of(step, stretch.response, stretch.axes)
            points = self._refined(layers, steps) if with_points else no_points(stretch.num_working_frames)
            coded = quantised(points, steps, stretch.axes, stretch.response.num_directions, LEAST_SIZE)
            if len(coded):
                _point_coder(stretch, steps).code(stream, coded)
            layers = replace(layers, points=_points_of(coded, stretch, steps))
            left = self.target - rendered(layers, stretch.response, stretch.axes)
            scaled = to_coefficients(left.numpy().astype(np.complex128), self.beams) / step
            parts = np.stack([scaled.real, scaled.imag])
            near = nearness(coded, _shape_of(stretch))
        classes = None if self.is_active is None else chosen_cells(parts, self.is_active)
        if classes is not None:
            parts = parts / np.where(classes == COARSE, COARSER, 1) * (classes > 0)
        levels = rounded(parts)
        if levels.any():
            _code_residual(stream, levels, classes, near)
        has_gains = bool((layers.calibration != 1).any())
        flags = HAS_STATIC * bool(static.any()) + HAS_POINTS * bool(len(coded))
        flags += HAS_GAINS * has_gains
        flags += (HAS_RESIDUAL if classes is None else HAS_CELLS) * bool(levels.any())
        front = FRONT.pack(
            stretch.num_frames, stretch.hop, self.peak, step, *_centroids(parts, levels),
            _noise_level(layers.noise_power), flags,
        )  # fmt: skip
        return front + (_packed_gains(layers.calibration) if has_gains else b"") + stream.finished()

    def _static_levels(self, step: float) -> np.ndarray:
        values = np.einsum("ra,ba->br", self.layers.static.numpy(), self.beams) / _static_step(self.stretch, step)
        return rounded(np.stack([values.real, values.imag]), STATIC_ROUNDING)[:, :, None, :, None]

    def _refined(self, layers: Layers, steps: PointSteps) -> Points:
        """The points worth writing, fitted again without the others."""
        size = layers.points.amplitude.abs() / steps.amplitude
        count = int((size >= LEAST_SIZE).sum())
        kept = strongest(layers.points, count)
        if not count:
            return kept
        if self._refined_points is not None and abs(self._refined_points[0] / count - 1) < SAME_COUNT:
            return self._refined_points[1]
        stretch = self.stretch
        target = self.target / layers.calibration - static_cells(layers.static, stretch.response, stretch.axes)
        damping = Damping.fresh(len(target))
        points = refined(kept, target, stretch.response, stretch.axes, damping, steps=REFINED_STEPS, largest=160)[0]
        self._refined_points = count, points
        return points


def decoded(data: bytes, config: RadarConfig, *, with_residual: bool = True) -> Decoded:
    """Reads a chunk; without the residual, its layers alone. Raises InputError where the chunk makes no sense."""
    try:
        return _decoded(data, config, with_residual)
    except (ValueError, IndexError, struct.error, AssertionError, OverflowError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"a chunk of the .mmw file makes no sense ({error}); compress the recording again") from None


def _decoded(data: bytes, config: RadarConfig, with_residual: bool) -> Decoded:
    num_frames, hop, peak, step, one, more, noise, flags = FRONT.unpack_from(data)
    if not (num_frames and hop < config.num_loops and step > 0 and math.isfinite(step) and math.isfinite(peak)):
        raise ValueError("impossible front")
    stretch = FitWindow.of(config, num_frames, hop)
    beams = beams_of(config)
    if flags >= 2 * HAS_CELLS or (flags & HAS_RESIDUAL and flags & HAS_CELLS):
        raise ValueError("impossible flags")
    at = FRONT.size
    gains = torch.ones(config.num_antennas, dtype=torch.complex64)
    if flags & HAS_GAINS:
        gains = _unpacked_gains(data[at : at + 2 * config.num_antennas])
        at += 2 * config.num_antennas
    stream = Reader(data[at:])
    shape = _shape_of(stretch)
    static = np.zeros((2, config.num_antennas, 1, config.num_range_bins, 1), np.int64)
    if flags & HAS_STATIC:
        _code_static(stream, static)
    points, near = no_points(shape[0]), np.zeros(shape, np.int64)
    if flags & HAS_POINTS:
        steps = PointSteps.of(step, stretch.response, stretch.axes)
        coded = _point_coder(stretch, steps).code(stream, None)
        points, near = _points_of(coded, stretch, steps), nearness(coded, shape)
    residual, num_values = None, 0
    if flags & (HAS_RESIDUAL | HAS_CELLS) and with_residual:
        levels = np.zeros((2, config.num_antennas, *shape), np.int64)
        classes = np.zeros(shape, np.int64) if flags & HAS_CELLS else None
        _code_residual(stream, levels, classes, near)
        num_values = int(np.count_nonzero(levels))
        values = _restored(levels, one, more) * step
        if classes is not None:
            values *= np.where(classes == COARSE, COARSER, 1)
        cells = from_coefficients(values[0] + 1j * values[1], beams)
        residual = torch.from_numpy(cells.astype(np.complex64))
    layers = Layers(
        points=points, static=_static_of(static, stretch, beams, step), calibration=gains,
        noise_power=10 ** (-noise / 20),
    )  # fmt: skip
    return Decoded(stretch=stretch, layers=layers, residual=residual, peak=peak, num_residual_values=num_values)


def _shape_of(stretch: FitWindow) -> tuple[int, int, int]:
    """Working frames, range cells, Doppler cells."""
    return stretch.num_working_frames, stretch.config.num_range_bins, stretch.response.num_loops


def _point_coder(stretch: FitWindow, steps: PointSteps) -> PointCoder:
    config, response = stretch.config, stretch.response
    moves = round(256 * config.frame_period_s * response.velocity_a_bin_mps / response.range_a_bin_m)
    return PointCoder(_shape_of(stretch), steps, response.num_directions, moves)


def _points_of(coded, stretch: FitWindow, steps: PointSteps) -> Points:
    frames, directions = stretch.num_working_frames, stretch.response.num_directions
    return points_of(coded, frames, steps, stretch.axes, directions)


def _code_static(stream: BitStream, levels: np.ndarray) -> None:
    ResidualCoder(levels.shape[1:]).code(stream, levels, np.zeros(levels.shape[2:], np.int64))


def _static_step(stretch: FitWindow, step: float) -> float:
    kernel = stretch.response.doppler_kernel(stretch.axes.doppler_bin)[0]
    return step / math.sqrt(stretch.num_working_frames * float(kernel.double().square().sum()))


def _static_of(levels: np.ndarray, stretch: FitWindow, beams: np.ndarray, step: float) -> Tensor:
    values = (levels[0] + 1j * levels[1])[:, 0, :, 0] * _static_step(stretch, step)
    return torch.from_numpy(np.einsum("br,ba->ra", values, beams.conj()).astype(np.complex64))


def _code_residual(stream: BitStream, levels: np.ndarray, classes: np.ndarray | None, near: np.ndarray) -> None:
    """All cells alike, or by a map of those that are open."""
    if classes is None:
        ResidualCoder(levels.shape[1:]).code(stream, levels, near)
        return
    MapCoder(classes.shape).code(stream, classes, near)
    NumberCoder(levels.shape[1:]).code(stream, levels, classes, near)


def _centroids(values: np.ndarray, levels: np.ndarray) -> tuple[int, int]:
    """How far numbers of level 1, and of more, lie above their level on average, in 1/256."""
    above = np.abs(values) - np.abs(levels)
    out = []
    for chosen in (np.abs(levels) == 1, np.abs(levels) > 1):
        mean = float(above[chosen].mean()) if chosen.any() else 0.0
        out.append(int(np.clip(round(mean * 256) + 128, 0, 255)))
    return out[0], out[1]


def _restored(levels: np.ndarray, one: int, more: int) -> np.ndarray:
    size = np.abs(levels)
    shift = np.where(size == 1, (one - 128) / 256, (more - 128) / 256)
    return np.sign(levels) * (size + shift)


def _noise_level(power: float) -> int:
    """Of the peak's power, in half decibels down."""
    return int(np.clip(round(-20 * math.log10(max(power, 1e-12))), 0, 255))


def _packed_gains(gains: Tensor) -> bytes:
    parts = torch.stack([gains.abs().log2() * GAIN_STEPS, gains.angle() / (2 * math.pi) * 256])
    parts[0] = parts[0].round().clamp(-128, 127)
    return (parts.round().to(torch.int16) & 255).to(torch.uint8).numpy().tobytes()


def _unpacked_gains(data: bytes) -> Tensor:
    parts = torch.from_numpy(np.frombuffer(data, np.int8).astype(np.float32).reshape(2, -1))
    return torch.polar(2 ** (parts[0] / GAIN_STEPS), parts[1] / 256 * 2 * math.pi)


def _cut_gains(gains: Tensor) -> Tensor:
    return gains if bool((gains == 1).all()) else _unpacked_gains(_packed_gains(gains))
