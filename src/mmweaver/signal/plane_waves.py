"""How much of a cell's antennas is one plane wave: of one far scatterer all of it, of several less."""

import numpy as np

from mmweaver.core.radar_config import RadarConfig


def plane_waves(config: RadarConfig) -> np.ndarray:
    """Steering vectors (antenna, direction) of unit norm over the front."""
    across, up = np.meshgrid(np.linspace(-0.95, 0.95, 61), np.linspace(-0.7, 0.7, 15))
    direction = np.stack([across.ravel(), np.zeros(across.size), up.ravel()])
    turns = config.antenna_position_m @ direction / config.wavelength_m
    return np.exp(-2j * np.pi * turns) / np.sqrt(config.num_antennas)


def best_wave_share(signal: np.ndarray, waves: np.ndarray) -> np.ndarray:
    """Share of each cell's energy in its best plane wave, (cell,), from values (cell, antenna); 0 of an empty cell."""
    best = (np.abs(signal.conj() @ waves) ** 2).max(axis=1)
    return best / np.maximum((np.abs(signal) ** 2).sum(axis=1), 1e-300)
