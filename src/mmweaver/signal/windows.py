"""FFT windows and their noise bandwidth."""

import numpy as np
from jaxtyping import Float

MIN_HANN_LOOPS = 4  # loops; a shorter Hann window would discard a third of the chirps or more, and resolve nothing


def doppler_window(num_loops: int) -> Float[np.ndarray, " num_loops"]:
    """Window over the loops of a frame: Hann, or rectangular for fewer than four loops, which keeps all chirps.

    >>> doppler_window(2).tolist()
    [1.0, 1.0]
    """
    return hann(num_loops) if num_loops >= MIN_HANN_LOOPS else np.ones(num_loops)


def doppler_window_middle(num_loops: int) -> float:
    """Loop about which `doppler_window` is symmetric; a periodic Hann window has its zero at both ends."""
    return num_loops / 2 if num_loops >= MIN_HANN_LOOPS else (num_loops - 1) / 2


def noise_share(num_samples: int, num_loops: int) -> float:
    """Noise power per cell of the cube, for white noise of unit power per sample, after both normalised windows.

    Args:
        num_samples: Samples per chirp.
        num_loops: Loops per frame.
    """
    windows = hann(num_samples), doppler_window(num_loops)
    return float(np.prod([(window**2).sum() / window.sum() ** 2 for window in windows]))


def hann(num: int) -> Float[np.ndarray, " num"]:
    """Periodic Hann window, 0.5 - 0.5 cos(2 pi n / num); its spectrum has three bins, 1 and twice -1/2.

    Args:
        num: Length.

    >>> hann(4).round(12).tolist()
    [0.0, 0.5, 1.0, 0.5]
    >>> hann(1).tolist()
    [1.0]
    """
    if num == 1:
        return np.ones(1)
    return 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(num) / num)
