"""Small cubes of known echoes, made by the exact sum and the project's own transforms."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.signal.cube import radar_cube

SMALL = replace(AWR1843, num_range_bins=24, num_loops=16, num_samples=128, first_range_bin=10)


def middle_s(config: RadarConfig) -> float:
    """The instant that a scatterer's range belongs to: the middle of the frame and of the chirp."""
    sampled_s = config.num_samples / config.sample_rate_hz
    return config.num_loops / 2 * config.loop_period_s + config.idle_time_s + config.adc_start_time_s + sampled_s / 2


def direction_of(azimuth_rad: float, elevation_rad: float) -> np.ndarray:
    flat = np.cos(elevation_rad)
    return np.array([np.sin(azimuth_rad) * flat, np.cos(azimuth_rad) * flat, np.sin(elevation_rad)])


def exact_point(config: RadarConfig, range_m: float, velocity_mps: float, towards: np.ndarray) -> np.ndarray:
    """Cube (range, doppler, antenna) of one point of amplitude 1, sample by sample."""

    def position(time_s: np.ndarray) -> np.ndarray:
        return (towards * (range_m + velocity_mps * (time_s[:, None] - middle_s(config))))[None]

    adc = exact_frame(position, np.ones(1, complex), config)
    return radar_cube(AdcCube(samples=adc[None].astype(np.complex64), config=config, scale=1.0)).values[0]


@lru_cache
def crowd(config: RadarConfig = SMALL, num_frames: int = 3, num_points: int = 12, noise: float = 2e-4) -> RadarCube:
    """Moving points, two static ones, and noise; new points in each frame."""
    rng = stream(5, "crowd")
    low, high = config.range_m[3], config.range_m[-4]
    still = [exact_point(config, r, 0.0, direction_of(a, 0.1)) for r, a in ((low + 0.1, -0.4), (high - 0.2, 0.5))]
    values = np.zeros((num_frames, config.num_range_bins, config.num_loops, config.num_antennas), np.complex64)
    for frame in range(num_frames):
        values[frame] = 2 * still[0] + 1j * still[1]
        for _ in range(num_points):
            towards = direction_of(rng.uniform(-0.6, 0.6), rng.uniform(-0.3, 0.3))
            amplitude = rng.uniform(0.1, 1.0) * np.exp(2j * np.pi * rng.random())
            values[frame] += amplitude * exact_point(config, rng.uniform(low, high), rng.uniform(-1.5, 1.5), towards)
    hiss = rng.normal(size=(*values.shape, 2)) * noise
    values += (hiss[..., 0] + 1j * hiss[..., 1]).astype(np.complex64)
    return RadarCube(values=values, grid=CubeGrid.of(config, num_frames), config=config, scale=1.0)


def error_db(ours: np.ndarray, truth: np.ndarray) -> float:
    return float(10 * np.log10(np.sum(np.abs(ours - truth) ** 2) / np.sum(np.abs(truth) ** 2)))
