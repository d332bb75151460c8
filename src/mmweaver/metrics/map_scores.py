"""Scores of power maps in decibels: what a person sees in a spectrogram."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.metrics.ssim import ssim_map

SHOWN_DB = 50.0

PowerMaps = Float[np.ndarray, "frame range other"]


def shown_db(power: PowerMaps, peak_power: float) -> PowerMaps:
    """Decibels above the bottom of a 50 dB picture whose top is `peak_power`; 0 for what lies below the bottom.

    >>> shown_db(np.array([[[1.0, 1e-3, 1e-6]]]), 1.0).tolist()
    [[[50.0, 20.0, 0.0]]]
    """
    if not peak_power > 0:
        raise InputError("a power map that is zero everywhere has no decibels to compare with")
    lowest = peak_power * 10 ** (-SHOWN_DB / 10)
    return 10 * np.log10(np.maximum(power, lowest) / lowest)


def log_map_ssim(prediction: PowerMaps, truth: PowerMaps, *, all_cells: bool = False) -> float:
    """Mean SSIM of the 50 dB pictures over the cells where either shows something; 1 is perfect.

    The top of both pictures is the truth's peak over all frames, the data range is 50 dB. Cells that are empty in
    both are left out, for they would make all zeros look good; `all_cells` counts them too.
    """
    p, t, drawn = _pictures(prediction, truth)
    similar = ssim_map(p, t, data_range=SHOWN_DB)
    return float((similar if all_cells else similar[drawn]).mean())


def log_map_difference_db(prediction: PowerMaps, truth: PowerMaps) -> float:
    """Absolute difference of the same pictures, summed over all cells, per cell that the truth shows, in dB.

    0 is perfect. Divided by the cells that either shows, a faint glow all over the map would look better than nothing.

    >>> truth = np.array([[[1.0, 1e-3, 1e-9]]])
    >>> log_map_difference_db(truth / 10, truth), log_map_difference_db(truth * 0, truth)
    (10.0, 35.0)
    """
    p, t, _ = _pictures(prediction, truth)
    return float(np.abs(p - t).sum() / np.count_nonzero(t > 0))


def _pictures(prediction: PowerMaps, truth: PowerMaps) -> tuple[PowerMaps, PowerMaps, np.ndarray]:
    peak = float(truth.max())
    p, t = shown_db(prediction, peak), shown_db(truth, peak)
    return p, t, (p > 0) | (t > 0)
