"""Rate-distortion choice of the residual cells that are coded, and how finely (encoder side)."""

import numpy as np
from jaxtyping import Float, Int

from mmweaver.compression.cell_coder import CLOSED, COARSE, COARSER, FINE
from mmweaver.compression.transforms import static_bins
from mmweaver.core.shapes import CubeValues, RangeDopplerMask

ACTIVE_DB = 12.0  # above the noise floor, as in metrics.cells
ROUNDING = 0.36  # values are rounded up from 1 - ROUNDING: small levels cost more bits than they save distortion
PRICE = 0.18  # Lagrange multiplier: squared steps per bit
ZERO_BITS, SIGN_AND_SIZE_BITS, OCTAVE_BITS, OPEN_BITS = 0.35, 3.0, 1.6, 3.0


def active_cells(values: CubeValues) -> RangeDopplerMask:
    """Cells whose antenna-averaged power exceeds the median by 12 dB; all cells if there are none.

    Cells that are exactly zero, such as Doppler bins missing from a file, are excluded from the median.
    """
    power = np.mean(np.abs(values) ** 2, axis=-1)
    some = power[power > 0]
    is_active = power > (np.median(some) if len(some) else 0.0) * 10 ** (ACTIVE_DB / 10)
    return is_active if is_active.any() else np.ones_like(is_active)


def share_static_frames(is_active: RangeDopplerMask) -> RangeDopplerMask:
    """Extends the mask to DCT coefficients: a static Doppler cell active in one frame is active in all."""
    out = is_active.copy()
    static = static_bins(is_active.shape[2])
    out[:, :, static] = is_active[:, :, static].any(axis=0)
    return out


def choose_cells(
    parts: Float[np.ndarray, "2 beam frame range doppler"], is_active: RangeDopplerMask
) -> Int[np.ndarray, "frame range doppler"]:
    """Class of each cell: FINE if active, COARSE if not, CLOSED where coding costs more than it gains.

    `parts` holds real and imaginary coefficients in units of the fine step.
    """
    fine = _is_worthwhile(parts) & is_active
    coarse = _is_worthwhile(parts / COARSER) & ~is_active
    return np.where(fine, FINE, np.where(coarse, COARSE, CLOSED)).astype(np.int64)


def _is_worthwhile(parts: np.ndarray) -> np.ndarray:
    size = np.abs(parts)
    level = np.floor(size + ROUNDING)
    gain = np.sum(size**2 - (size - level) ** 2, axis=(0, 1))
    some = SIGN_AND_SIZE_BITS + OCTAVE_BITS * np.log2(np.maximum(level, 1))
    bits = np.sum(np.where(level > 0, some, ZERO_BITS), axis=(0, 1)) + OPEN_BITS
    return gain > PRICE * bits


def round_levels(values: np.ndarray, rounding: float = ROUNDING) -> np.ndarray:
    """Integer levels (same shape) with a dead zone: magnitudes are rounded up from 1 - `rounding`."""
    return (np.sign(values) * np.floor(np.abs(values) + rounding)).astype(np.int64)
