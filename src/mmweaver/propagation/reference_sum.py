"""The exact sum that the separable synthesis approximates: every sample, chirp and antenna pair in float64.

Slow; the reference for tests and benchmarks.
"""

from collections.abc import Callable

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.transmit_code import weights_of


def exact_frame(
    position_m: Callable[[np.ndarray], np.ndarray], amplitude: np.ndarray, config: RadarConfig
) -> np.ndarray:
    """ADC samples of one frame of moving point scatterers. Reference: docs/radar_primer.md, equation 7.

    Args:
        position_m: Maps times (time,) since the start of the frame to positions (point, time, 3) in metres; called for
            every chirp.
        amplitude: Amplitudes (point,), complex.
        config: The radar.

    Returns:
        Samples (loop, slot, rx, sample), complex128.
    """
    tx, rx = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)
    ramp_s = config.adc_start_time_s + np.arange(config.num_samples) / config.sample_rate_hz
    slope = config.chirp_slope_hz_per_s
    adc = np.zeros((config.num_loops, config.num_slots, config.num_rx, config.num_samples), complex)
    weights = weights_of(config.tx_code) if config.is_coded else np.eye(config.num_tx)  # (slot, tx)
    sent = [(m, slot, weights[slot, m]) for slot, m in np.argwhere(weights)]
    for loop in range(config.num_loops):
        for m, slot, weight in sent:
            start_s = loop * config.loop_period_s + config.tx_delay_s[slot] + config.idle_time_s
            places = position_m(start_s + ramp_s)  # (point, sample, 3)
            out = np.linalg.norm(places - tx[m], axis=-1)
            for k in range(config.num_rx):
                tau = (out + np.linalg.norm(places - rx[k], axis=-1)) / SPEED_OF_LIGHT_MPS
                turns = config.start_frequency_hz * tau + slope * ramp_s * tau - slope * tau**2 / 2
                adc[loop, slot, k] += weight * amplitude @ np.exp(2j * np.pi * turns)
    return adc
