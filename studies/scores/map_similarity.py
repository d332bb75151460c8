"""Structural similarity of maps, and of power maps as displayed, with an 11 x 11 Gaussian window.

Reference: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural
Similarity".
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.evaluation.map_scores import SHOWN_DB, PowerMaps, displays

WINDOW_SIGMA = 1.5
WINDOW_RADIUS = 5
K1, K2 = 0.01, 0.03


def ssim_map(
    prediction: Float[np.ndarray, "*stack height width"],
    truth: Float[np.ndarray, "*stack height width"],
    *,
    data_range: float,
) -> Float[np.ndarray, "*stack height width"]:
    """SSIM at each position of each map of a stack; 1 where the maps agree.

    Windows are Gaussian (sigma 1.5, 11 x 11), moments are not bias-corrected (no N / (N - 1)), and maps are padded by
    reflection, so that maps smaller than a window have a value too. `data_range` is the possible span of the maps'
    values. Raises InputError where it is not positive.

    >>> x = np.arange(12.0).reshape(1, 3, 4)
    >>> float(ssim_map(x, x, data_range=11.0).min())
    1.0
    """
    if not data_range > 0:
        raise InputError(f"SSIM needs a data range above 0, not {data_range}")
    p, t = np.asarray(prediction, np.float64), np.asarray(truth, np.float64)
    c1, c2 = (K1 * data_range) ** 2, (K2 * data_range) ** 2
    mean_p, mean_t = _smoothed(p), _smoothed(t)
    variance_p, variance_t = _smoothed(p * p) - mean_p**2, _smoothed(t * t) - mean_t**2
    covariance = _smoothed(p * t) - mean_p * mean_t
    luminance = (2 * mean_p * mean_t + c1) / (mean_p**2 + mean_t**2 + c1)
    return luminance * (2 * covariance + c2) / (variance_p + variance_t + c2)


def _smoothed(maps: np.ndarray) -> np.ndarray:
    from scipy.ndimage import correlate1d

    taps = np.exp(-0.5 * (np.arange(-WINDOW_RADIUS, WINDOW_RADIUS + 1) / WINDOW_SIGMA) ** 2)
    taps /= taps.sum()
    return correlate1d(correlate1d(maps, taps, axis=-1), taps, axis=-2)


def log_map_ssim(prediction: PowerMaps, truth: PowerMaps, *, all_cells: bool = False) -> float:
    """Mean SSIM of the 50 dB displays over the cells that are non-zero in either; 1 is perfect.

    The top of both displays is the peak of the ground truth over all frames, the data range is 50 dB. Cells empty in
    both are excluded, for they would flatter all zeros; `all_cells` includes them.
    """
    p, t = displays(prediction, truth)
    similar = ssim_map(p, t, data_range=SHOWN_DB)
    return float((similar if all_cells else similar[(p > 0) | (t > 0)]).mean())
