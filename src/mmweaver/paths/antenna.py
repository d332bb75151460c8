"""One antenna's pattern, and the radar equation."""

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.shapes import PerPoint, Points

# Between -3 dB at half the beamwidth and -6 dB where TI's plots of the xWR1843 have it (50 and 20 degrees).
AZIMUTH_ROLL_OFF = 1.2
ELEVATION_ROLL_OFF = 1.94
FLOOR_DB = -25.0  # side lobes


def pattern(direction: Points, config: RadarConfig) -> PerPoint:
    """Amplitude of one antenna in unit directions (point, 3), relative to its peak straight ahead (+y)."""
    azimuth_deg = np.degrees(np.arctan2(direction[:, 0], direction[:, 1]))
    elevation_deg = np.degrees(np.arcsin(np.clip(direction[:, 2], -1, 1)))
    loss_db = 3 * (np.abs(azimuth_deg) / (config.azimuth_beamwidth_deg / 2)) ** AZIMUTH_ROLL_OFF
    loss_db += 3 * (np.abs(elevation_deg) / (config.elevation_beamwidth_deg / 2)) ** ELEVATION_ROLL_OFF
    # Side lobes of a vertically polarised antenna vanish straight up and down: no wave has its field along its way.
    side_lobes = 10 ** (FLOOR_DB / 20) * np.sqrt(np.clip(1 - direction[:, 2] ** 2, 0, 1))
    return np.maximum(10 ** (-loss_db / 20), side_lobes)


def scatterer_gain(config: RadarConfig) -> float:
    """Amplitude in sqrt(mW) of a scatterer of 1 m2 with 1 m to go and 1 m to return, straight ahead.

    Divide by both distances, multiply by sqrt(cross section) and by the pattern of both directions.
    Reference: the radar equation, docs/radar_primer.md, equation 10.
    """
    power_db = config.tx_power_dbm + 2 * config.antenna_gain_dbi
    return 10 ** (power_db / 20) * config.wavelength_m / (4 * np.pi) ** 1.5


def specular_gain(config: RadarConfig) -> float:
    """Amplitude in sqrt(mW) of a perfect mirror with a way of 1 m in all, straight ahead (Friis; equation 11)."""
    power_db = config.tx_power_dbm + 2 * config.antenna_gain_dbi
    return 10 ** (power_db / 20) * config.wavelength_m / (4 * np.pi)
