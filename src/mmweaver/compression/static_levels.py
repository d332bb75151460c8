"""Levels of a chunk's static layer: a row of beams for each range, as they are coded before the scatterers."""

import math

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.entropy import BitStream
from mmweaver.compression.level_coder import LevelCoder
from mmweaver.compression.level_size import estimated_bits
from mmweaver.fields.scatterers.fit_window import FitWindow

STATIC_ROUNDING = 0.4


def static_levels(static: Tensor, window: FitWindow, beams: np.ndarray, step: float) -> np.ndarray:
    """Levels (part, beam, 1, range, 1) of a static layer (range, antenna)."""
    values = np.einsum("ra,ba->br", static.numpy(), beams) / _static_step(window, step)
    parts = np.stack([values.real, values.imag])
    levels = np.sign(parts) * np.floor(np.abs(parts) + STATIC_ROUNDING)
    return levels.astype(np.int64)[:, :, None, :, None]


def code_static(stream: BitStream, levels: np.ndarray) -> None:
    """Encodes levels, or fills them in when decoding."""
    every = np.ones(levels.shape[2:], np.int64)
    LevelCoder(levels.shape[1:]).code(stream, levels.reshape(2, len(levels[0]), -1), every)


def static_bits(levels: np.ndarray) -> float:
    """About the bits of `code_static`."""
    if not levels.any():
        return 0.0
    every = np.ones(levels.shape[2:], np.int64)
    weights = np.ones(levels.shape[1])
    return estimated_bits(LevelCoder(levels.shape[1:]), levels.reshape(2, len(weights), -1), every, weights)


def _static_step(window: FitWindow, step: float) -> float:
    kernel = window.response.doppler_kernel(window.axes.doppler_bin)[0]
    return step / math.sqrt(window.num_working_frames * float(kernel.double().square().sum()))


def static_of(levels: np.ndarray, window: FitWindow, beams: np.ndarray, step: float) -> Tensor:
    """The static layer (range, antenna) of levels, as a decoder has it."""
    values = (levels[0] + 1j * levels[1])[:, 0, :, 0] * _static_step(window, step)
    return torch.from_numpy(np.einsum("br,ba->ra", values, beams.conj()).astype(np.complex64))
