"""Which cells of a residual are worth their bits, and how finely: the writer's side of the map of open cells."""

import numpy as np
from jaxtyping import Float, Int

from mmweaver.compression.cell_coder import CLOSED, COARSE, COARSER, FINE
from mmweaver.compression.transforms import still_bins
from mmweaver.core.shapes import CubeValues, RangeDopplerMask

ACTIVE_DB = 12.0  # above the noise floor, as in metrics.cells
ROUNDING = 0.36  # a number is rounded up from 1 - this: small ones cost more than they are worth
PRICE = 0.18  # of a bit, in squared steps
ZERO_BITS, SIGN_AND_SIZE_BITS, OCTAVE_BITS, OPEN_BITS = 0.35, 3.0, 1.6, 3.0


def active_cells(values: CubeValues) -> RangeDopplerMask:
    """Cells 12 dB above the median power, mean over the antennas; all where there are none.

    Cells of exactly zero, as in Doppler bins that a file leaves out, do not count for the median.
    """
    power = np.mean(np.abs(values) ** 2, axis=-1)
    some = power[power > 0]
    is_active = power > (np.median(some) if len(some) else 0.0) * 10 ** (ACTIVE_DB / 10)
    return is_active if is_active.any() else np.ones_like(is_active)


def still_joined(is_active: RangeDopplerMask) -> RangeDopplerMask:
    """The same over coefficients: where frames are turned into cosines, active in one frame is active in all."""
    out = is_active.copy()
    still = still_bins(is_active.shape[2])
    out[:, :, still] = is_active[:, :, still].any(axis=0)
    return out


def chosen_cells(
    parts: Float[np.ndarray, "2 beam frame range doppler"], is_active: RangeDopplerMask
) -> Int[np.ndarray, "frame range doppler"]:
    """The class of each cell of numbers in fine steps: FINE where they hold signal, COARSE elsewhere, if it pays."""
    fine = _pays(parts) & is_active
    coarse = _pays(parts / COARSER) & ~is_active
    return np.where(fine, FINE, np.where(coarse, COARSE, CLOSED)).astype(np.int64)


def _pays(parts: np.ndarray) -> np.ndarray:
    size = np.abs(parts)
    level = np.floor(size + ROUNDING)
    gain = np.sum(size**2 - (size - level) ** 2, axis=(0, 1))
    some = SIGN_AND_SIZE_BITS + OCTAVE_BITS * np.log2(np.maximum(level, 1))
    bits = np.sum(np.where(level > 0, some, ZERO_BITS), axis=(0, 1)) + OPEN_BITS
    return gain > PRICE * bits


def rounded(values: np.ndarray, rounding: float = ROUNDING) -> np.ndarray:
    """Whole numbers, rounded up from 1 - `rounding`."""
    return (np.sign(values) * np.floor(np.abs(values) + rounding)).astype(np.int64)
