"""Channel calibration as applied by a board's firmware: one complex factor per antenna pair, and a range bias."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.records import AdcCube


@dataclass(frozen=True, kw_only=True)
class ChannelCalibration:
    """Factors by which the firmware multiplies recorded samples, and the range bias of the board.

    Attributes:
        factors: Complex factors, (tx, rx).
        range_bias_m: Measured minus true range in metres.
        turns_receivers: Whether the factors also correct receivers with inverted feed (`rx_inverted`), which samples in
            an `AdcCube` already have corrected. Default: False.
    """

    factors: np.ndarray
    range_bias_m: float
    turns_receivers: bool = False

    def compensated(self, adc: AdcCube) -> AdcCube:
        """Corrects recorded samples as the firmware does.

        Args:
            adc: Recorded samples.

        Returns:
            Samples without channel errors and range bias.
        """
        return self._applied(adc, self.factors, -self.range_bias_m)

    def recorded(self, adc: AdcCube) -> AdcCube:
        """Applies the board's errors to ideal samples; inverse of `compensated`.

        Args:
            adc: Ideal samples.

        Returns:
            Samples as this board would record them.
        """
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
