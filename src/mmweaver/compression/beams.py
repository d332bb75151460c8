"""Unitary transform of the array's antennas to beams."""

import numpy as np
from jaxtyping import Complex

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.virtual_array import SAME_PLACE_WAVELENGTHS


def beams_of(config: RadarConfig) -> Complex[np.ndarray, "beam antenna"]:
    """Unitary beamforming matrix: a DFT per row of the array, boresight in the middle, rows from low to high.

    Args:
        config: The radar, for its antenna positions.

    Returns:
        Matrix (beam, antenna), complex128.
    """
    position_m = config.antenna_position_m
    height = np.round(position_m[:, 2] / (SAME_PLACE_WAVELENGTHS * config.wavelength_m))
    beams = np.zeros((config.num_antennas, config.num_antennas), complex)
    first = 0
    for level in np.unique(height):
        row = np.flatnonzero(height == level)
        row = row[np.argsort(position_m[row, 0], kind="stable")]
        num = len(row)
        cycles = np.outer(np.arange(num) - num // 2, np.arange(num)) / num
        beams[first : first + num, row] = np.exp(-2j * np.pi * cycles) / np.sqrt(num)
        first += num
    return beams
