"""Receiver noise of a radar cube, sampled directly in its cells, without ADC samples or FFTs.

The transform of white noise is white, and the Hann window, whose spectrum is 1/2 and twice -1/4, mixes each bin with
its two neighbours. It is therefore sufficient to sample the stored bins and one more at either end.
"""

import numpy as np
import torch

from mmweaver.core.radar_config import RadarConfig
from mmweaver.signal.windows import MIN_HANN_LOOPS, doppler_window

MIXED_POWER = 1.5  # sum of the squares of 1, -1/2, -1/2


def cell_noise(rng: np.random.Generator, config: RadarConfig, num_frames: int) -> np.ndarray:
    """Unit-power noise of frames that share no chirps.

    Args:
        rng: Random stream.
        config: The radar.
        num_frames: Number of frames.

    Returns:
        Noise (frame, range, doppler, antenna), complex64.
    """
    shape = (num_frames, config.num_range_bins, config.num_loops, config.num_antennas)
    out = np.empty(shape, np.complex64)
    samples = torch.empty(_num_sampled_bins(config), config.num_loops, 2 * config.num_antennas)
    generator = torch.Generator().manual_seed(int(rng.integers(1 << 62)))  # three times as fast as numpy's
    mixes_loops = config.num_loops >= MIN_HANN_LOOPS
    power = 2 * MIXED_POWER * (MIXED_POWER if mixes_loops else 1.0)
    for frame in out:  # one at a time stays in the cache
        lines = _range_bins(samples.normal_(generator=generator).numpy(), config)
        if mixes_loops:
            lines = lines - 0.5 * _neighbours(lines)
        np.multiply(lines, np.float32(power**-0.5), out=frame.view(np.float32))
    return out


def overlapping_noise(rng: np.random.Generator, config: RadarConfig, num_frames: int, hop: int) -> np.ndarray:
    """As `cell_noise`, of frames `hop` loops apart, which share the noise of their chirps."""
    loops = config.num_loops
    shape = (_num_sampled_bins(config), loops + hop * (num_frames - 1), 2 * config.num_antennas)
    lines = np.ascontiguousarray(_range_bins(rng.standard_normal(shape, dtype=np.float32), config)).view(np.complex64)
    window = doppler_window(loops)
    window = (window / np.sqrt(2 * MIXED_POWER * np.sum(window**2))).astype(np.float32)
    cut = np.stack([lines[:, hop * at :][:, :loops] for at in range(num_frames)])
    return np.fft.fft(cut * window[:, None], axis=2).astype(np.complex64)


def _neighbours(lines: np.ndarray) -> np.ndarray:
    """Sum of the two cyclic neighbours of each Doppler bin (range, doppler, value)."""
    out = np.empty_like(lines)
    np.add(lines[:, :-2], lines[:, 2:], out=out[:, 1:-1])
    np.add(lines[:, 1], lines[:, -1], out=out[:, 0])
    np.add(lines[:, -2], lines[:, 0], out=out[:, -1])
    return out


def _num_sampled_bins(config: RadarConfig) -> int:
    """Range bins that are sampled: those stored, and one more at either end where there is one."""
    return min(config.num_range_bins + 2, config.num_samples)


def _range_bins(white: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Mixes white bins as the range window does.

    Args:
        white: White noise (sampled, ...) of `_num_sampled_bins` bins.
        config: The radar.

    Returns:
        The stored bins (range, ...), with 3/2 of the power.
    """
    if len(white) < config.num_range_bins + 2:  # all bins, or all but one, are stored: neighbours are cyclic
        white = white[np.arange(-1, config.num_range_bins + 1) % config.num_samples]
    return white[1:-1] - 0.5 * (white[:-2] + white[2:])
