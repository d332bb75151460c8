"""Share of a cell's antenna signal that is one plane wave: 1 for one far scatterer, less for several."""

import numpy as np

from mmweaver.core.radar_config import RadarConfig


def plane_waves(config: RadarConfig) -> np.ndarray:
    """Steering vectors over the front hemisphere.

    Args:
        config: The radar.

    Returns:
        Unit-norm vectors (antenna, direction), complex, on a grid of 61 by 15 direction cosines.
    """
    across, up = np.meshgrid(np.linspace(-0.95, 0.95, 61), np.linspace(-0.7, 0.7, 15))
    direction = np.stack([across.ravel(), np.zeros(across.size), up.ravel()])
    turns = config.antenna_position_m @ direction / config.wavelength_m
    return np.exp(-2j * np.pi * turns) / np.sqrt(config.num_antennas)


def best_wave_share(signal: np.ndarray, waves: np.ndarray) -> np.ndarray:
    """Share of each cell's energy in its best plane wave.

    Args:
        signal: Values (cell, antenna), complex.
        waves: Steering vectors of `plane_waves`.

    Returns:
        Share (cell,) from 0 to 1; 0 for an empty cell.
    """
    best = (np.abs(signal.conj() @ waves) ** 2).max(axis=1)
    return best / np.maximum((np.abs(signal) ** 2).sum(axis=1), 1e-300)
