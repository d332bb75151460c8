"""Diffuse static clutter: edges, cables, texture, each too small to model, but too many to ignore.

Such echoes are static, so they fill the zero-Doppler column and raise the noise estimate of its CFAR; of moving points
only the slowest are masked. A stationary body interferes with them: where both share a range bin they add coherently,
and the body's points come and go.
"""

import numpy as np
from jaxtyping import Complex

from mmweaver.core.radar_config import RadarConfig

AT_M = 2.0  # range at which the level is specified
NEAREST_M = 0.3


def diffuse_clutter(
    config: RadarConfig, level_db: float, rng: np.random.Generator
) -> Complex[np.ndarray, "tx rx sample"]:
    """ADC samples of static echoes at every range, identical in all chirps and frames, sqrt(mW).

    `level_db` is their power in a range bin at 2 m relative to the thermal noise of one chirp in that bin. It falls as
    1/R^2 (the clutter area of a range bin grows as R^2, and each echo falls as 1/R^4). Phases of different antennas are
    independent, for the echoes come from all directions.
    """
    bins = config.num_samples
    range_m = np.arange(bins) * config.range_resolution_m
    share = np.where(range_m > NEAREST_M, AT_M / np.maximum(range_m, NEAREST_M), 0.0)
    samples = rng.standard_normal((config.num_tx, config.num_rx, bins, 2)).view(np.complex128)[..., 0] / np.sqrt(2)
    # noise of one sample has power p, and p / bins in each of the bins of a normalised spectrum
    amplitude = np.sqrt(config.noise_power_mw / bins * 10 ** (level_db / 10)) * share
    return (np.fft.ifft(samples * amplitude, axis=-1) * bins).astype(np.complex64)
