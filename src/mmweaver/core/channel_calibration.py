"""The channel errors that a board's firmware compensates: a factor for each antenna pair, and a range bias."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.records import AdcCube


@dataclass(frozen=True, kw_only=True)
class ChannelCalibration:
    """Factors (tx, rx) by which recorded samples are multiplied, and the range that a board measures too much.

    `turns_receivers`: the factors undo the receivers that the board feeds from the other side, too (rx_inverted),
    which samples in an `AdcCube` already are.
    """

    factors: np.ndarray
    range_bias_m: float
    turns_receivers: bool = False

    def compensated(self, adc: AdcCube) -> AdcCube:
        """Recorded samples without the board's errors, as its firmware would have them."""
        return self._applied(adc, self.factors, -self.range_bias_m)

    def recorded(self, adc: AdcCube) -> AdcCube:
        """Ideal samples as this board would record them; `compensated` takes the errors away again."""
        return self._applied(adc, 1 / self.factors, self.range_bias_m)

    def _applied(self, adc: AdcCube, factors: np.ndarray, farther_m: float) -> AdcCube:
        config = adc.config
        beat_hz = 2 * config.chirp_slope_hz_per_s * farther_m / SPEED_OF_LIGHT_MPS
        turn = np.exp(2j * np.pi * beat_hz * np.arange(config.num_samples) / config.sample_rate_hz)
        if self.turns_receivers and config.rx_inverted:
            factors = factors.copy()
            factors[:, list(config.rx_inverted)] *= -1
        samples = adc.samples * (factors[:, :, None] * turn).astype(np.complex64)
        return replace(adc, samples=samples)
