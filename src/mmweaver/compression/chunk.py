"""A chunk of frames in one stream: static layer, scatterers and residual, in the order in which they are decoded.

All three are quantised with one step: an error of one step in any value leaves about the same energy in the cube.
"""

import math
import struct
from dataclasses import dataclass, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.cell_choice import active_cells, choose_cells, round_levels, share_static_frames
from mmweaver.compression.cell_coder import COARSE, COARSER, MapCoder, NumberCoder
from mmweaver.compression.entropy import BitStream, Decoder, Encoder
from mmweaver.compression.point_coder import PointCoder, PointSteps, dequantize, nearness, quantize
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
PREFIX = struct.Struct("<HHffBBBB")
HAS_STATIC, HAS_POINTS, HAS_RESIDUAL, HAS_GAINS, HAS_CELLS = 1, 2, 4, 8, 16
STATIC_ROUNDING = 0.4
LEAST_SIZE = 2  # steps; weaker scatterers cost fewer bits as residual
REFINED_STEPS = 4
SAME_DECISION = 1.5  # difference of log(step) within which the choice for or against scatterers is reused
SAME_COUNT = 0.1  # relative difference in count within which refined scatterers are reused
GAIN_STEPS = 64.0
LEAST_GAIN = 0.03  # antenna gains that differ less from 1 are dropped


@dataclass(frozen=True, kw_only=True)
class DecodedChunk:
    """Content of a chunk. `residual`: working frames in centred phase, or None where it was not decoded."""

    fit_window: FitWindow
    layers: Layers
    residual: Tensor | None
    peak: float
    num_residual_values: int = 0  # non-zero residual values

    def cube_values(self) -> CubeValues:
        """The frames of the cube, complex64."""
        with torch.inference_mode():
            working = rendered(self.layers, self.fit_window.response, self.fit_window.axes)
            if self.residual is not None:
                working = working + self.residual
            return self.fit_window.cube_values(working * self.peak)


class ChunkEncoder:
    """Encodes fitted frames at any step. `target`: working frames (frame, range, doppler, antenna) over `peak`."""

    def __init__(self, target: Tensor, fit_window: FitWindow, layers: Layers, peak: float, *, keep_noise: bool = False):
        if bool((layers.calibration - 1).abs().max() < LEAST_GAIN):
            layers = replace(layers, calibration=torch.ones_like(layers.calibration))
        self.target, self.fit_window, self.peak = target, fit_window, peak
        self.layers = replace(layers, calibration=_quantize_gains(layers.calibration))
        self.beams = beams_of(fit_window.config)
        self.is_active = None if keep_noise else share_static_frames(active_cells(target.numpy()))
        self._refined_points: tuple[int, Points] | None = None
        self._with_points: tuple[float, bool] | None = None

    def encode(self, step: float) -> bytes:
        """The chunk with a quantisation error of about step / sqrt(12) per coded cell, relative to the peak.

        With or without scatterers, whichever is shorter: far below the noise, scatterers no longer pay.
        """
        decided = self._with_points
        if decided is None or abs(math.log(step / decided[0])) > SAME_DECISION:
            both = [self._encode(step, with_points=choice) for choice in (True, False)]
            is_better = len(both[0]) <= len(both[1])
            self._with_points = step, is_better
            return both[0] if is_better else both[1]
        return self._encode(step, with_points=decided[1])

    def _encode(self, step: float, *, with_points: bool) -> bytes:
        step = float(np.float32(step))
        fit_window, layers = self.fit_window, self.layers
        stream = Encoder()
        with torch.inference_mode():
            static = self._static_levels(step)
            layers = replace(layers, static=_static_of(static, fit_window, self.beams, step))
            if static.any():
                _code_static(stream, static)
            steps = PointSteps.of(step, fit_window.response, fit_window.axes)
            points = self._refined(layers, steps) if with_points else no_points(fit_window.num_working_frames)
            coded = quantize(points, steps, fit_window.axes, fit_window.response.num_directions, LEAST_SIZE)
            if len(coded):
                _point_coder(fit_window, steps).code(stream, coded)
            layers = replace(layers, points=_dequantize(coded, fit_window, steps))
            residual = self.target - rendered(layers, fit_window.response, fit_window.axes)
            scaled = to_coefficients(residual.numpy().astype(np.complex128), self.beams) / step
            parts = np.stack([scaled.real, scaled.imag])
            near = nearness(coded, _shape_of(fit_window))
        classes = None if self.is_active is None else choose_cells(parts, self.is_active)
        if classes is not None:
            parts = parts / np.where(classes == COARSE, COARSER, 1) * (classes > 0)
        levels = round_levels(parts)
        if levels.any():
            _code_residual(stream, levels, classes, near)
        has_gains = bool((layers.calibration != 1).any())
        flags = HAS_STATIC * bool(static.any()) + HAS_POINTS * bool(len(coded))
        flags += HAS_GAINS * has_gains
        flags += (HAS_RESIDUAL if classes is None else HAS_CELLS) * bool(levels.any())
        front = PREFIX.pack(
            fit_window.num_frames, fit_window.hop, self.peak, step, *_centroids(parts, levels),
            _noise_level(layers.noise_power), flags,
        )  # fmt: skip
        return front + (_pack_gains(layers.calibration) if has_gains else b"") + stream.to_bytes()

    def _static_levels(self, step: float) -> np.ndarray:
        values = np.einsum("ra,ba->br", self.layers.static.numpy(), self.beams) / _static_step(self.fit_window, step)
        return round_levels(np.stack([values.real, values.imag]), STATIC_ROUNDING)[:, :, None, :, None]

    def _refined(self, layers: Layers, steps: PointSteps) -> Points:
        """The scatterers worth coding, refined without the others."""
        size = layers.points.amplitude.abs() / steps.amplitude
        count = int((size >= LEAST_SIZE).sum())
        kept = strongest(layers.points, count)
        if not count:
            return kept
        if self._refined_points is not None and abs(self._refined_points[0] / count - 1) < SAME_COUNT:
            return self._refined_points[1]
        fit_window = self.fit_window
        target = self.target / layers.calibration - static_cells(layers.static, fit_window.response, fit_window.axes)
        damping = Damping.fresh(len(target))
        points = refined(kept, target, fit_window.response, fit_window.axes, damping, steps=REFINED_STEPS, largest=160)[
            0
        ]
        self._refined_points = count, points
        return points


def decode_chunk(data: bytes, config: RadarConfig, *, with_residual: bool = True) -> DecodedChunk:
    """Decodes a chunk; without the residual, only its layers. Raises InputError for a malformed chunk."""
    try:
        return _decode(data, config, with_residual)
    except (ValueError, IndexError, struct.error, AssertionError, OverflowError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"a chunk of the .mmw file is malformed ({error}); compress the recording again") from None


def _decode(data: bytes, config: RadarConfig, with_residual: bool) -> DecodedChunk:
    num_frames, hop, peak, step, one, more, noise, flags = PREFIX.unpack_from(data)
    if not (num_frames and hop < config.num_loops and step > 0 and math.isfinite(step) and math.isfinite(peak)):
        raise ValueError("impossible prefix")
    fit_window = FitWindow.of(config, num_frames, hop)
    beams = beams_of(config)
    if flags >= 2 * HAS_CELLS or (flags & HAS_RESIDUAL and flags & HAS_CELLS):
        raise ValueError("impossible flags")
    at = PREFIX.size
    gains = torch.ones(config.num_antennas, dtype=torch.complex64)
    if flags & HAS_GAINS:
        gains = _unpack_gains(data[at : at + 2 * config.num_antennas])
        at += 2 * config.num_antennas
    stream = Decoder(data[at:])
    shape = _shape_of(fit_window)
    static = np.zeros((2, config.num_antennas, 1, config.num_range_bins, 1), np.int64)
    if flags & HAS_STATIC:
        _code_static(stream, static)
    points, near = no_points(shape[0]), np.zeros(shape, np.int64)
    if flags & HAS_POINTS:
        steps = PointSteps.of(step, fit_window.response, fit_window.axes)
        coded = _point_coder(fit_window, steps).code(stream, None)
        points, near = _dequantize(coded, fit_window, steps), nearness(coded, shape)
    residual, num_values = None, 0
    if flags & (HAS_RESIDUAL | HAS_CELLS) and with_residual:
        levels = np.zeros((2, config.num_antennas, *shape), np.int64)
        classes = np.zeros(shape, np.int64) if flags & HAS_CELLS else None
        _code_residual(stream, levels, classes, near)
        num_values = int(np.count_nonzero(levels))
        values = _reconstruct_levels(levels, one, more) * step
        if classes is not None:
            values *= np.where(classes == COARSE, COARSER, 1)
        cells = from_coefficients(values[0] + 1j * values[1], beams)
        residual = torch.from_numpy(cells.astype(np.complex64))
    layers = Layers(
        points=points, static=_static_of(static, fit_window, beams, step), calibration=gains,
        noise_power=10 ** (-noise / 20),
    )  # fmt: skip
    return DecodedChunk(
        fit_window=fit_window, layers=layers, residual=residual, peak=peak, num_residual_values=num_values
    )


def _shape_of(fit_window: FitWindow) -> tuple[int, int, int]:
    """Numbers of working frames, range cells and Doppler cells."""
    return fit_window.num_working_frames, fit_window.config.num_range_bins, fit_window.response.num_loops


def _point_coder(fit_window: FitWindow, steps: PointSteps) -> PointCoder:
    config, response = fit_window.config, fit_window.response
    moves = round(256 * config.frame_period_s * response.velocity_a_bin_mps / response.range_a_bin_m)
    return PointCoder(_shape_of(fit_window), steps, response.num_directions, moves)


def _dequantize(coded, fit_window: FitWindow, steps: PointSteps) -> Points:
    frames, directions = fit_window.num_working_frames, fit_window.response.num_directions
    return dequantize(coded, frames, steps, fit_window.axes, directions)


def _code_static(stream: BitStream, levels: np.ndarray) -> None:
    ResidualCoder(levels.shape[1:]).code(stream, levels, np.zeros(levels.shape[2:], np.int64))


def _static_step(fit_window: FitWindow, step: float) -> float:
    kernel = fit_window.response.doppler_kernel(fit_window.axes.doppler_bin)[0]
    return step / math.sqrt(fit_window.num_working_frames * float(kernel.double().square().sum()))


def _static_of(levels: np.ndarray, fit_window: FitWindow, beams: np.ndarray, step: float) -> Tensor:
    values = (levels[0] + 1j * levels[1])[:, 0, :, 0] * _static_step(fit_window, step)
    return torch.from_numpy(np.einsum("br,ba->ra", values, beams.conj()).astype(np.complex64))


def _code_residual(stream: BitStream, levels: np.ndarray, classes: np.ndarray | None, near: np.ndarray) -> None:
    """Codes all cells, or those that a map (`classes`) opens."""
    if classes is None:
        ResidualCoder(levels.shape[1:]).code(stream, levels, near)
        return
    MapCoder(classes.shape).code(stream, classes, near)
    NumberCoder(levels.shape[1:]).code(stream, levels, classes, near)


def _centroids(values: np.ndarray, levels: np.ndarray) -> tuple[int, int]:
    """Mean offset of values from their level, for level 1 and for higher levels, in 1/256."""
    above = np.abs(values) - np.abs(levels)
    out = []
    for chosen in (np.abs(levels) == 1, np.abs(levels) > 1):
        mean = float(above[chosen].mean()) if chosen.any() else 0.0
        out.append(int(np.clip(round(mean * 256) + 128, 0, 255)))
    return out[0], out[1]


def _reconstruct_levels(levels: np.ndarray, one: int, more: int) -> np.ndarray:
    size = np.abs(levels)
    shift = np.where(size == 1, (one - 128) / 256, (more - 128) / 256)
    return np.sign(levels) * (size + shift)


def _noise_level(power: float) -> int:
    """Noise power in half decibels below the peak power."""
    return int(np.clip(round(-20 * math.log10(max(power, 1e-12))), 0, 255))


def _pack_gains(gains: Tensor) -> bytes:
    parts = torch.stack([gains.abs().log2() * GAIN_STEPS, gains.angle() / (2 * math.pi) * 256])
    parts[0] = parts[0].round().clamp(-128, 127)
    return (parts.round().to(torch.int16) & 255).to(torch.uint8).numpy().tobytes()


def _unpack_gains(data: bytes) -> Tensor:
    parts = torch.from_numpy(np.frombuffer(data, np.int8).astype(np.float32).reshape(2, -1))
    return torch.polar(2 ** (parts[0] / GAIN_STEPS), parts[1] / 256 * 2 * math.pi)


def _quantize_gains(gains: Tensor) -> Tensor:
    return gains if bool((gains == 1).all()) else _unpack_gains(_pack_gains(gains))
