"""What an analysis reports of a recording whose movement is known."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.recordings.analysis import RecordingAnalysis, analyse_recording
from mmweaver.signal.cube import radar_cube

RADAR = replace(
    AWR1843, name="one", num_loops=128, idle_time_s=440e-6, num_samples=64, sample_rate_hz=1.13e6, frame_period_s=0.1,
    first_range_bin=0, num_range_bins=64, tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,),
)  # fmt: skip
SPEED_MPS, FAST_FRAMES = 1.0, range(6, 9)


def _recorded(num_frames: int, place_m, config=RADAR, wall: complex = 5.0) -> AdcCube:
    """A point at a distance that is a function of time, a wall at 2.2 m, and noise."""
    rng = np.random.default_rng(0)
    frames = []
    for start_s in np.arange(num_frames) * config.frame_period_s:

        def position_m(time_s: np.ndarray, start_s: float = start_s) -> np.ndarray:
            places = np.zeros((2, len(time_s), 3))
            places[0, :, 1], places[1, :, 1] = place_m(start_s + time_s), 2.2
            return places

        frames.append(exact_frame(position_m, np.array([1.0, wall]), config))
    samples = np.array(frames)
    samples += 1e-3 * (rng.standard_normal(samples.shape) + 1j * rng.standard_normal(samples.shape))
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0)


def _analysed(adc: AdcCube) -> RecordingAnalysis:
    return analyse_recording(radar_cube(adc), adc)


def test_the_fastest_movement_counts_though_it_is_short():
    begin_s, end_s = FAST_FRAMES[0] * RADAR.frame_period_s, (FAST_FRAMES[-1] + 1) * RADAR.frame_period_s
    adc = _recorded(16, lambda time_s: 1.0 + SPEED_MPS * np.clip(time_s - begin_s, 0, end_s - begin_s))
    assert _analysed(adc).meta()["fastest_mps"] == pytest.approx(SPEED_MPS, abs=4 * RADAR.velocity_resolution_mps)


def test_the_static_share_is_that_of_the_energy():
    approach = _recorded(8, lambda time_s: 1.8 - SPEED_MPS * time_s, wall=1.0)
    assert _analysed(approach).static_share == pytest.approx(0.5, abs=0.05)
    assert _analysed(_recorded(4, lambda time_s: 1.5 + 0 * time_s)).static_share > 0.99


def test_who_breathes_is_found_with_rate_and_range():
    slow = replace(RADAR, num_loops=2, frame_period_s=0.2)
    found = _analysed(_recorded(150, lambda time_s: 1.2 + 4e-3 * np.sin(2 * np.pi * 0.3 * time_s), slow)).vital_signs
    assert found is not None
    assert found.range_m == pytest.approx(1.2, abs=slow.range_resolution_m)
    assert found.breathing.is_clear
    assert found.breathing.per_minute == pytest.approx(18.0, abs=0.5)
    short = _analysed(_recorded(30, lambda time_s: 1.2 + 4e-3 * np.sin(2 * np.pi * 0.3 * time_s), slow))
    assert short.vital_signs is None
