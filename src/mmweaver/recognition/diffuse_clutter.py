"""What a room returns from everywhere: edges, cables, grain. Each too small to be modelled, all too many to leave out.

Such echoes rest, so they fill the column of zero velocity and raise what its CFAR takes for noise; of moving points
only the slowest drown. A still body is seen through them: where both meet in a range bin they add with their phases,
and the body's points come and go.
"""

import numpy as np
from jaxtyping import Complex

from mmweaver.core.radar_config import RadarConfig

AT_M = 2.0  # where the level is told
NEAREST_M = 0.3


def diffuse_clutter(
    config: RadarConfig, level_db: float, rng: np.random.Generator
) -> Complex[np.ndarray, "tx rx sample"]:
    """Resting echoes at every distance, alike in all chirps and frames, sqrt(mW).

    `level_db` is their power in a range bin at 2 m over the thermal noise of one chirp in that bin. It falls as 1/R^2
    (as much of the room lies in a range bin as R^2 grows, and each echo falls as 1/R^4). Phases of different antennas
    are unrelated: the echoes come from all sides.
    """
    bins = config.num_samples
    range_m = np.arange(bins) * config.range_resolution_m
    share = np.where(range_m > NEAREST_M, AT_M / np.maximum(range_m, NEAREST_M), 0.0)
    drawn = rng.standard_normal((config.num_tx, config.num_rx, bins, 2)).view(np.complex128)[..., 0] / np.sqrt(2)
    # noise of one sample has power p, and p / bins in each of the bins of a normalised spectrum
    amplitude = np.sqrt(config.noise_power_mw / bins * 10 ** (level_db / 10)) * share
    return (np.fft.ifft(drawn * amplitude, axis=-1) * bins).astype(np.complex64)
