"""Scores of power maps in decibels, as displayed in a spectrogram."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError

SHOWN_DB = 50.0

PowerMaps = Float[np.ndarray, "frame range other"]


def shown_db(power: PowerMaps, peak_power: float) -> PowerMaps:
    """Converts power to decibels above the bottom of a 50 dB display.

    Args:
        power: Power maps, (frame, range, other).
        peak_power: Power at the top of the display.

    Returns:
        Level in dB from 0 (at or below the bottom) to 50 (peak).

    Raises:
        InputError: If the peak is not positive.

    >>> shown_db(np.array([[[1.0, 1e-3, 1e-6]]]), 1.0).tolist()
    [[[50.0, 20.0, 0.0]]]
    """
    if not peak_power > 0:
        raise InputError("a power map that is zero everywhere has no decibels to compare with")
    lowest = peak_power * 10 ** (-SHOWN_DB / 10)
    return 10 * np.log10(np.maximum(power, lowest) / lowest)


def log_map_difference_db(prediction: PowerMaps, truth: PowerMaps) -> float:
    """Absolute difference of two displays, summed over all cells, per nonzero cell of the ground truth.

    Divided by cells nonzero in either map, a faint background over the entire map would score better than zeros.

    Args:
        prediction: Predicted power maps, (frame, range, other).
        truth: Ground truth of the same shape, whose peak is the top of the display.

    Returns:
        Difference in dB; 0 is perfect.

    Raises:
        InputError: If the ground truth is zero everywhere.

    >>> truth = np.array([[[1.0, 1e-3, 1e-9]]])
    >>> log_map_difference_db(truth / 10, truth), log_map_difference_db(truth * 0, truth)
    (10.0, 35.0)
    """
    p, t = displays(prediction, truth)
    return float(np.abs(p - t).sum() / np.count_nonzero(t > 0))


def displays(prediction: PowerMaps, truth: PowerMaps) -> tuple[PowerMaps, PowerMaps]:
    """Both maps in dB on the 50 dB display of the ground truth."""
    peak = float(truth.max())
    return shown_db(prediction, peak), shown_db(truth, peak)
