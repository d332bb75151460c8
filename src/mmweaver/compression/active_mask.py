"""Cells that contain signal (encoder side)."""

import numpy as np

from mmweaver.core.shapes import CubeValues, RangeDopplerMask

ACTIVE_DB = 12.0  # above the noise floor, as in metrics.cells


def active_mask(values: CubeValues, min_power: float | None = None) -> RangeDopplerMask:
    """Marks the cells that contain signal.

    Args:
        values: Cube (frame, range, doppler, antenna).
        min_power: Threshold on the power averaged over the antennas; by default 12 dB above its median.

    Returns:
        Mask (frame, range, doppler); all cells where none exceeds the threshold.
    """
    power = cell_power(values)
    is_active = power > (active_power(power) if min_power is None else min_power)
    return is_active if is_active.any() else np.ones_like(is_active)


def cell_power(values: CubeValues) -> np.ndarray:
    """Antenna-averaged power (frame, range, doppler), float64, since squares of 1e-30 underflow in float32."""
    return np.mean(np.square(values.real, dtype=np.float64) + np.square(values.imag, dtype=np.float64), axis=-1)


def active_power(power: np.ndarray) -> float:
    """Threshold 12 dB above the median of cell powers.

    Cells that are exactly zero, such as Doppler bins missing from a file, are excluded from the median.
    """
    some = power[power > 0]
    return float(np.median(some) if len(some) else 0.0) * 10 ** (ACTIVE_DB / 10)
