"""Chunks of versions 1 and 2 of the .mmw format: read for ever, written no more."""

import math
import struct

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.cell_coder import COARSE, COARSER, MapCoder, NumberCoder
from mmweaver.compression.chunk import DecodedChunk
from mmweaver.compression.chunk_frames import ChunkFrames
from mmweaver.compression.entropy import BitStream, Decoder
from mmweaver.compression.point_coder import PointCoder, PointSteps, dequantize, nearness
from mmweaver.compression.residual_coder import ResidualCoder
from mmweaver.compression.static_levels import static_of
from mmweaver.compression.transforms import beams_of, from_coefficients
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.dsp.point_response import Points
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.layers import Layers, no_points

# frames, hop, peak, step, centroids of 1 and of more, noise, flags
PREFIX = struct.Struct("<HHffBBBB")
HAS_STATIC, HAS_POINTS, HAS_RESIDUAL, HAS_GAINS, HAS_CELLS = 1, 2, 4, 8, 16
GAIN_STEPS = 64.0


def decode_old_chunk(data: bytes, config: RadarConfig, *, with_residual: bool = True) -> DecodedChunk:
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
    residual: np.ndarray | None = None
    num_values = 0
    if flags & (HAS_RESIDUAL | HAS_CELLS) and with_residual:
        levels = np.zeros((2, config.num_antennas, *shape), np.int64)
        classes = np.zeros(shape, np.int64) if flags & HAS_CELLS else None
        _code_residual(stream, levels, classes, near)
        num_values = int(np.count_nonzero(levels))
        values = _reconstruct_levels(levels, one, more) * step
        if classes is not None:
            values *= np.where(classes == COARSE, COARSER, 1)
        cells = from_coefficients(values[0] + 1j * values[1], beams)
        residual = cells.astype(np.complex64)
    layers = Layers(
        points=points, static=static_of(static, fit_window, beams, step), calibration=gains,
        noise_power=10 ** (-noise / 20),
    )  # fmt: skip
    return DecodedChunk(
        frames=ChunkFrames(config=config, num_frames=num_frames, hop=hop), layers=layers, residual=residual, peak=peak,
        noise_power=layers.noise_power, num_residual_values=num_values,
    )  # fmt: skip


def _shape_of(fit_window: FitWindow) -> tuple[int, int, int]:
    """Numbers of working frames, range cells and Doppler cells."""
    return fit_window.num_working_frames, fit_window.config.num_range_bins, fit_window.response.num_loops


def _point_coder(fit_window: FitWindow, steps: PointSteps) -> PointCoder:
    config, response = fit_window.config, fit_window.response
    moves = round(256 * config.frame_period_s * response.velocity_a_bin_mps / response.range_a_bin_m)
    return PointCoder(_shape_of(fit_window), steps, response.num_directions, moves, by_rows=True)


def _dequantize(coded, fit_window: FitWindow, steps: PointSteps) -> Points:
    frames, directions = fit_window.num_working_frames, fit_window.response.num_directions
    return dequantize(coded, frames, steps, fit_window.axes, directions)


def _code_static(stream: BitStream, levels: np.ndarray) -> None:
    ResidualCoder(levels.shape[1:]).code(stream, levels, np.zeros(levels.shape[2:], np.int64))


def _code_residual(stream: BitStream, levels: np.ndarray, classes: np.ndarray | None, near: np.ndarray) -> None:
    """Codes all cells, or those that a map (`classes`) opens."""
    if classes is None:
        ResidualCoder(levels.shape[1:]).code(stream, levels, near)
        return
    MapCoder(classes.shape).code(stream, classes, near)
    NumberCoder(levels.shape[1:]).code(stream, levels, classes, near)


def _reconstruct_levels(levels: np.ndarray, one: int, more: int) -> np.ndarray:
    size = np.abs(levels)
    shift = np.where(size == 1, (one - 128) / 256, (more - 128) / 256)
    return np.sign(levels) * (size + shift)


def _unpack_gains(data: bytes) -> Tensor:
    parts = torch.from_numpy(np.frombuffer(data, np.int8).astype(np.float32).reshape(2, -1))
    return torch.polar(2 ** (parts[0] / GAIN_STEPS), parts[1] / 256 * 2 * math.pi)
