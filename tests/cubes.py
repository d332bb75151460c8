"""Small cubes for tests: a few moving points before a radar, with or without noise."""

from dataclasses import replace

import numpy as np

from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import radar_cube

SMALL = replace(AWR1843, num_samples=64, num_range_bins=32, first_range_bin=8, num_loops=16)


def point_adc(config: RadarConfig = SMALL, num_frames: int = 4, noise: float = 0.0, seed: int = 0) -> AdcCube:
    """One still point and two moving ones, far-field phases, exact at each chirp."""
    samples = np.zeros((num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples), complex)
    time_s = (
        np.arange(num_frames)[:, None, None] * config.frame_period_s
        + np.arange(config.num_loops)[None, :, None] * config.loop_period_s
        + config.tx_delay_s
    )
    antenna_m = config.antenna_position_m.reshape(config.num_tx, config.num_rx, 3)
    fast = np.arange(config.num_samples) / config.num_samples
    low_m, high_m = config.range_m[0], config.range_m[-1]
    points = ((0.35, 0.0, 0.0, 3.0), (0.5, 0.31, 0.25, 1.0), (0.7, -0.45, -0.4, 0.5))
    for share, speed, right, amplitude in points:
        range_m = low_m + share * (high_m - low_m) + speed * config.max_velocity_mps * time_s
        phase = 4 * np.pi * range_m[..., None] / config.wavelength_m
        phase = phase - 2 * np.pi / config.wavelength_m * right * antenna_m[:, :, 0]
        beat = range_m / config.range_resolution_m
        samples += amplitude * np.exp(1j * phase)[..., None] * np.exp(2j * np.pi * beat[..., None, None] * (fast - 0.5))
    rng = stream(seed, "test noise")
    samples += noise * (rng.standard_normal(samples.shape) + 1j * rng.standard_normal(samples.shape))
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0)


def point_cube(config: RadarConfig = SMALL, num_frames: int = 4, noise: float = 0.3, seed: int = 0) -> RadarCube:
    """The cube of `point_adc`."""
    return radar_cube(point_adc(config, num_frames, noise, seed))
