"""Beat signals over the samples of a chirp, and weighted sums of many of them.

A person covers some twenty of a hundred range cells. Beats that close together are summed at a few instants of the
chirp, and all samples follow by Chebyshev interpolation. Reference: docs/radar_primer.md, equation 7.
"""

import math

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig

COARSE = 16  # the fast-time factor is a product of one over 16 samples and one over steps of 16 samples
BAND_CYCLES = 18.0  # largest difference in cycles per chirp of beats that are summed together
NUM_NODES = 48  # Chebyshev points at which they are summed, sufficient for 20 cycles
WORTH = 1.3  # ratio of multiplications saved to those added, above which interpolation is faster


class FastTime:
    """Fast-time factors exp(2 pi j (S tau + shift) t) of beats in one radar; the phase is zero in mid-sampling."""

    def __init__(self, config: RadarConfig):
        """Prepares the interpolation.

        Args:
            config: The radar, for its chirp slope and sampling.
        """
        self.config = config
        half = (config.num_samples - 1) / 2
        sample = np.arange(config.num_samples) - config.num_samples / 2
        unit = np.cos(np.pi * (np.arange(NUM_NODES) + 0.5) / NUM_NODES)
        # time since the middle of the sampling, as a share of its duration
        self._node = torch.from_numpy(((half * unit - 0.5) / config.num_samples).astype(np.float32))
        self._sample = torch.from_numpy(sample / config.num_samples)
        self._interpolation = torch.from_numpy(_chebyshev(unit, (sample + 0.5) / half).astype(np.complex64))

    def factor(self, delay_s: Tensor, shift_hz: Tensor | float) -> Tensor:
        """Fast-time factors, with the residual video phase (eq. 7).

        Args:
            delay_s: Delays (...) in seconds.
            shift_hz: Doppler shifts (...) in Hz.

        Returns:
            Factors (..., sample), complex64.
        """
        num = self.config.num_samples
        cycles_a_sample = (self._cycles(delay_s, shift_hz) / num)[..., None]
        fine = phasor(cycles_a_sample * torch.arange(COARSE, device=delay_s.device))
        steps = COARSE * torch.arange(-(-num // COARSE), device=delay_s.device) - num / 2
        rough = phasor(cycles_a_sample * steps - self._square(delay_s)[..., None])
        return (rough[..., :, None] * fine[..., None, :]).flatten(-2)[..., :num]

    def bands(self, delay_s: Tensor) -> list[slice]:
        """Runs of delays that are close enough to be summed together, where that is faster.

        Args:
            delay_s: Delays (path,) in seconds, increasing.

        Returns:
            Disjoint slices of the paths, in order.
        """
        cycles, found = self._cycles(delay_s, 0.0), []
        at = 0
        worth = WORTH * NUM_NODES * self.config.num_samples / max(self.config.num_samples - NUM_NODES, 1)
        end = torch.searchsorted(cycles, cycles + BAND_CYCLES)
        while at < len(cycles):
            # the fullest band that begins before the end of the first one
            first = at + int((end - torch.arange(len(cycles)))[at : int(end[at])].argmax())
            if end[first] - first >= worth:
                found.append(slice(first, int(end[first])))
            at = int(end[first])
        return found

    def summed(self, weights: Tensor, delay_s: Tensor, shift_hz: Tensor, bands: list[slice] | None = None) -> Tensor:
        """Weighted sums of fast-time factors.

        Args:
            weights: Weights (frame, row, path), complex64.
            delay_s: Delays (frame, path) in seconds.
            shift_hz: Doppler shifts (frame, path) in Hz.
            bands: Runs of paths as `bands` gives them, for a single frame. By default every factor is computed exactly.

        Returns:
            Sums (frame, row, sample), complex64.
        """
        if not bands:
            return weights @ self.factor(delay_s, shift_hz)
        rows, cycles, square = weights[0], self._cycles(delay_s, shift_hz)[0], self._square(delay_s[0]).float()
        factors = [self._band_factor(rows[:, band], cycles[band], square[band]) for band in bands]
        ends = [0, *(end for band in bands for end in (band.start, band.stop)), len(cycles)]
        for alone in map(slice, ends[::2], ends[1::2]):
            factors.append((rows[:, alone], self.factor(delay_s[0, alone], shift_hz[0, alone])))
        left, right = zip(*factors, strict=True)
        return (torch.cat(left, dim=1) @ torch.cat(right))[None]

    def _band_factor(self, weights: Tensor, cycles: Tensor, square: Tensor) -> tuple[Tensor, Tensor]:
        """Sums (row, node) of beats within a band, and the matrix that interpolates them to samples.

        `cycles` (path,) are the cycles of the beats during the sampling.
        """
        middle = (cycles.min() + cycles.max()) / 2
        angle = (cycles - middle).float()[:, None] * self._node - square[:, None]
        angle *= 2 * math.pi
        return weights @ torch.complex(angle.cos(), angle.sin()), self._interpolation * phasor(middle * self._sample)

    def _cycles(self, delay_s: Tensor, shift_hz: Tensor | float) -> Tensor:
        """Cycles of beats during the sampling."""
        config = self.config
        return (config.chirp_slope_hz_per_s * delay_s + shift_hz) * (config.num_samples / config.sample_rate_hz)

    def _square(self, delay_s: Tensor) -> Tensor:
        """Residual video phase in cycles, which is subtracted."""
        return self.config.chirp_slope_hz_per_s * delay_s**2 / 2


def phasor(cycles: Tensor) -> Tensor:
    """exp(2 pi j cycles) as complex64; cycles are wrapped in double precision first."""
    angle = (cycles - cycles.round()).to(torch.float32).mul_(2 * math.pi)
    return torch.complex(angle.cos(), angle.sin())


def _chebyshev(node: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Interpolation matrix (node, place) from values at Chebyshev points in [-1, 1] to those of their polynomial."""
    order = np.arange(len(node))
    basis = 2 * np.cos(order[:, None] * np.arccos(node)) / len(node)
    basis[0] /= 2
    return basis.T @ np.cos(order[:, None] * np.arccos(np.clip(at, -1, 1)))
