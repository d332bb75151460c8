"""How beats run through the samples of a chirp, and the sum of many of them.

A person fills some twenty range cells of some hundred: beats so close together are summed at a few instants of the
chirp, and all samples follow by interpolation. Reference: docs/radar_primer.md, equation 7.
"""

import math

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig

COARSE = 16  # samples of which the fast-time factor is made, and steps between them
BAND_CYCLES = 18.0  # within a chirp, between beats that are summed together
NUM_NODES = 48  # instants at which they are: Chebyshev points, good for 20 cycles
WORTH = 1.3  # products of matrices saved over those made, from which interpolation is quicker


class FastTime:
    """The fast-time factor of beats in one radar, exp(2 pi j (S tau + shift) t): no phase in the sampling's middle."""

    def __init__(self, config: RadarConfig):
        self.config = config
        half = (config.num_samples - 1) / 2
        sample = np.arange(config.num_samples) - config.num_samples / 2
        unit = np.cos(np.pi * (np.arange(NUM_NODES) + 0.5) / NUM_NODES)
        # shares of the sampling since its middle
        self._node = torch.from_numpy(((half * unit - 0.5) / config.num_samples).astype(np.float32))
        self._sample = torch.from_numpy(sample / config.num_samples)
        self._interpolation = torch.from_numpy(_chebyshev(unit, (sample + 0.5) / half).astype(np.complex64))

    def factor(self, delay_s: Tensor, shift_hz: Tensor | float) -> Tensor:
        """complex64 (..., sample) of delays and shifts (...) (eq. 7)."""
        num = self.config.num_samples
        cycles_a_sample = (self._cycles(delay_s, shift_hz) / num)[..., None]
        fine = phasor(cycles_a_sample * torch.arange(COARSE, device=delay_s.device))
        steps = COARSE * torch.arange(-(-num // COARSE), device=delay_s.device) - num / 2
        rough = phasor(cycles_a_sample * steps - self._square(delay_s)[..., None])
        return (rough[..., :, None] * fine[..., None, :]).flatten(-2)[..., :num]

    def bands(self, delay_s: Tensor) -> list[slice]:
        """Where rising delays (path,) are so many within a band that they are summed together."""
        cycles, found = self._cycles(delay_s, 0.0), []
        at = 0
        worth = WORTH * NUM_NODES * self.config.num_samples / max(self.config.num_samples - NUM_NODES, 1)
        end = torch.searchsorted(cycles, cycles + BAND_CYCLES)
        while at < len(cycles):
            # the fullest band that begins before the first one from here ends
            first = at + int((end - torch.arange(len(cycles)))[at : int(end[at])].argmax())
            if end[first] - first >= worth:
                found.append(slice(first, int(end[first])))
            at = int(end[first])
        return found

    def summed(self, weights: Tensor, delay_s: Tensor, shift_hz: Tensor, bands: list[slice] | None = None) -> Tensor:
        """Sums (frame, row, sample) of the factors of beats (frame, path) with weights (frame, row, path).

        `bands`: runs of paths of the only frame that lie within a band, or about so.
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
        """Sums (row, node) with weights (row, path) of beats within a band, and what makes samples of them.

        `cycles` (path,) are those in the sampling.
        """
        middle = (cycles.min() + cycles.max()) / 2
        angle = (cycles - middle).float()[:, None] * self._node - square[:, None]
        angle *= 2 * math.pi
        return weights @ torch.complex(angle.cos(), angle.sin()), self._interpolation * phasor(middle * self._sample)

    def _cycles(self, delay_s: Tensor, shift_hz: Tensor | float) -> Tensor:
        """Periods of beats within the sampling."""
        config = self.config
        return (config.chirp_slope_hz_per_s * delay_s + shift_hz) * (config.num_samples / config.sample_rate_hz)

    def _square(self, delay_s: Tensor) -> Tensor:
        """What the square of the delay turns a beat back, in periods."""
        return self.config.chirp_slope_hz_per_s * delay_s**2 / 2


def phasor(cycles: Tensor) -> Tensor:
    """exp(2 pi j cycles), complex64; wrapped in double precision first."""
    angle = (cycles - cycles.round()).to(torch.float32).mul_(2 * math.pi)
    return torch.complex(angle.cos(), angle.sin())


def _chebyshev(node: np.ndarray, at: np.ndarray) -> np.ndarray:
    """(node, place): values at Chebyshev points in [-1, 1] times this are those of the polynomial through them."""
    order = np.arange(len(node))
    basis = 2 * np.cos(order[:, None] * np.arccos(node)) / len(node)
    basis[0] /= 2
    return basis.T @ np.cos(order[:, None] * np.arccos(np.clip(at, -1, 1)))
