"""Samples of a few far points whose range and amplitude change from chirp to chirp as a test wants."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.evaluation.signal_evidence import ComparedSignal, SignalEvidence
from mmweaver.signal.cube import radar_cube

RADAR = replace(AWR1843, num_samples=128, num_range_bins=48, first_range_bin=4, num_loops=16)


@dataclass(frozen=True)
class Point:
    """A far point: its range in metres at times in seconds, its amplitude and its direction cosine to the right."""

    range_m: Callable[[np.ndarray], np.ndarray]
    amplitude: float = 1.0
    right: float = 0.0


def still(range_m: float, amplitude: float = 1.0, right: float = 0.0) -> Point:
    return Point(lambda time_s: np.full_like(time_s, range_m), amplitude, right)


def samples(
    points: list[Point], *, frames: int = 4, config: RadarConfig = RADAR, noise: float = 0.01, seed: int = 0
) -> AdcCube:
    """Exact at the middle of each chirp, with white noise."""
    frame, loop = np.ogrid[:frames, : config.num_loops]
    time_s = (frame * config.frame_period_s + loop * config.loop_period_s)[:, :, None] + config.tx_delay_s
    antenna_m = config.antenna_position_m.reshape(config.num_tx, config.num_rx, 3)
    fast = np.arange(config.num_samples) / config.num_samples - 0.5
    made = np.zeros((frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples), complex)
    for point in points:
        range_m = point.range_m(time_s)
        phase = 4 * np.pi * range_m[..., None] / config.wavelength_m
        phase = phase - 2 * np.pi / config.wavelength_m * point.right * antenna_m[:, :, 0]
        beat = 2 * np.pi * range_m / config.range_resolution_m
        made += point.amplitude * np.exp(1j * (phase[..., None] + beat[..., None, None] * fast))
    rng = stream(seed, "test noise")
    made += noise / np.sqrt(2) * (rng.standard_normal(made.shape) + 1j * rng.standard_normal(made.shape))
    return AdcCube(samples=made.astype(np.complex64), config=config, scale=1.0)


def evidence(adc: AdcCube, *, with_samples: bool = True) -> SignalEvidence:
    signal = ComparedSignal(name="made", cube=radar_cube(adc), adc=adc if with_samples else None)
    return SignalEvidence(signal)
