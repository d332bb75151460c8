"""Antenna pattern and radar equation."""

from typing import Any

import numpy as np

from mmweaver.core.antenna_pattern import Pattern, pattern_grid
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.shapes import PerPoint, Points

# Chosen to pass through -3 dB at half the beamwidth and -6 dB where TI's plots of the xWR1843 show it (50, 20 degrees).
AZIMUTH_ROLL_OFF = 1.2
ELEVATION_ROLL_OFF = 1.94
FLOOR_DB = -25.0  # side lobes


def pattern(direction: Points, config: RadarConfig) -> PerPoint:
    """Amplitude pattern of one antenna relative to boresight (+y).

    Args:
        direction: Unit vectors (point, 3).
        config: The radar, for its beamwidths.

    Returns:
        Amplitude (point,), 1 at boresight.
    """
    return 10 ** (-pattern_db(direction, config) / 20)


def pattern_db(direction: Any, config: RadarConfig) -> Any:
    """Loss of one antenna in dB relative to boresight; differentiable.

    Args:
        direction: Unit vectors (..., 3), an array or a tensor.
        config: The radar, for its pattern or beamwidths.

    Returns:
        Loss (...) in dB, 0 at boresight, at most that of the side lobes.
    """
    if isinstance(direction, np.ndarray):
        xp: Any = np
    else:
        import torch as xp
    x, y, z = (direction[..., axis] for axis in range(3))
    azimuth_deg = xp.rad2deg(xp.arctan2(x, y))
    elevation_deg = xp.rad2deg(xp.arcsin(xp.clip(z, -0.999, 0.999)))
    if config.antenna_pattern:
        loss_db = _tabulated_db(azimuth_deg, elevation_deg, config.antenna_pattern, xp)
    else:
        loss_db = 3 * (xp.abs(azimuth_deg) / (config.azimuth_beamwidth_deg / 2)) ** AZIMUTH_ROLL_OFF
        loss_db = loss_db + 3 * (xp.abs(elevation_deg) / (config.elevation_beamwidth_deg / 2)) ** ELEVATION_ROLL_OFF
    # side lobes of a vertically polarised antenna vanish along its E-field, straight up and down
    side_lobes_db = -FLOOR_DB - 10 * xp.log10(xp.clip(1 - z**2, 1e-12, 1.0))
    return xp.minimum(loss_db, side_lobes_db)


def _tabulated_db(azimuth_deg: Any, elevation_deg: Any, pattern: Pattern, xp: Any) -> Any:
    """Loss (...) in dB by bilinear interpolation, that of the table's edge beyond it."""
    *axes, loss = pattern_grid(pattern)
    if xp is not np:
        loss = xp.as_tensor(loss, dtype=azimuth_deg.dtype, device=azimuth_deg.device)
    places = []
    for axis, angle in zip(axes, (azimuth_deg, elevation_deg), strict=True):
        if xp is not np:
            axis = xp.as_tensor(axis, dtype=angle.dtype, device=angle.device)
        inside = xp.clip(angle, float(axis[0]), float(axis[-1]))
        low = xp.clip(xp.searchsorted(axis, inside) - 1, 0, max(len(axis) - 2, 0))
        high = xp.clip(low + 1, 0, len(axis) - 1)
        width = axis[high] - axis[low]
        places.append((low, high, (inside - axis[low]) / xp.where(width > 0, width, xp.ones_like(width))))
    (left, right, across), (below, above, up) = places
    one, other = (loss[side, below] * (1 - up) + loss[side, above] * up for side in (left, right))
    return one * (1 - across) + other * across


def scatterer_gain(config: RadarConfig) -> float:
    """Amplitude of the echo of a scatterer of 1 m2 at 1 m on boresight.

    Divide by both leg lengths, multiply by sqrt(cross section) and by the pattern in both directions.
    Reference: the radar equation, docs/radar_primer.md, equation 10.

    Args:
        config: The radar, for its transmit power, antenna gain and wavelength.

    Returns:
        Amplitude in sqrt(mW).
    """
    power_db = config.tx_power_dbm + 2 * config.antenna_gain_dbi
    return 10 ** (power_db / 20) * config.wavelength_m / (4 * np.pi) ** 1.5


def specular_gain(config: RadarConfig) -> float:
    """Amplitude of a perfect specular reflection at a path length of 1 m on boresight.

    Reference: Friis equation, docs/radar_primer.md, equation 11.

    Args:
        config: The radar, for its transmit power, antenna gain and wavelength.

    Returns:
        Amplitude in sqrt(mW).
    """
    power_db = config.tx_power_dbm + 2 * config.antenna_gain_dbi
    return 10 ** (power_db / 20) * config.wavelength_m / (4 * np.pi)
