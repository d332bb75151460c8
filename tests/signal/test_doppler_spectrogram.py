"""The spectrogram over chirps shows what swings faster than frames follow each other."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.signal.doppler_spectrogram import micro_doppler

CONFIG = replace(
    AWR1843, name="stft", num_loops=128, num_samples=64, sample_rate_hz=1.13e6, first_range_bin=0, num_range_bins=64,
    tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,), frame_period_s=0.05,
)  # fmt: skip


def samples_of(config, distance_m, num_frames: int) -> AdcCube:
    """A point at a distance that is a function of time, held within a chirp, and a wall."""
    loop_s = np.arange(config.num_loops) * config.loop_period_s
    start_s = np.arange(num_frames)[:, None] * config.frame_period_s + loop_s
    fast = np.arange(config.num_samples) / config.sample_rate_hz

    def echo(range_m):
        delay_s = 2 * np.asarray(range_m)[..., None] / 299_792_458
        turns = config.centre_frequency_hz * delay_s + config.chirp_slope_hz_per_s * delay_s * fast
        return np.exp(2j * np.pi * turns)

    both = echo(distance_m(start_s)) + 10 * echo(np.full(start_s.shape, 2.3))
    samples = np.broadcast_to(both[:, :, None, None], (*start_s.shape, 1, config.num_rx, config.num_samples))
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0)


def test_a_swinging_point_draws_its_velocity():
    """2 cm at 8 Hz: up to 1 m/s, within frames of 9 ms every 50 ms."""
    adc = samples_of(CONFIG, lambda t: 1.2 + 0.02 * np.sin(2 * np.pi * 8 * t), 20)
    seen = micro_doppler(adc, window_loops=32)
    assert np.all(np.diff(seen.time_s) > 0)
    ridge_mps = seen.radial_velocity_mps[seen.power.argmax(axis=1)]
    truth_mps = 0.02 * 2 * np.pi * 8 * np.cos(2 * np.pi * 8 * seen.time_s)
    fast = np.abs(truth_mps) > 0.7
    assert np.abs(ridge_mps - truth_mps)[fast].max() < seen.radial_velocity_mps[1] - seen.radial_velocity_mps[0]
    assert seen.range_m[0] <= 1.2 <= seen.range_m[1] < 2.0  # the wall is static


def test_windows_run_on_where_frames_do():
    config = replace(CONFIG, num_loops=16, frame_period_s=16 * CONFIG.loop_period_s)
    adc = samples_of(config, lambda t: 1.2 + 0.5 * t, 40)
    seen = micro_doppler(adc, window_loops=64)
    assert seen.power.shape[1] == 64
    assert seen.radial_velocity_mps[seen.power.sum(axis=0).argmax()] == pytest.approx(0.5, abs=0.3)


def test_too_few_loops_are_refused():
    with pytest.raises(InputError, match="too few"):
        micro_doppler(samples_of(replace(CONFIG, num_loops=2), lambda t: 1.2 + 0 * t, 2))
