"""Features of a known target are where the target is."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.features import (
    dynamic_range_angle,
    micro_doppler_db,
    range_azimuth_db,
    range_doppler_db,
    range_elevation_db,
)

RANGE_M, VELOCITY_MPS, AZIMUTH_RAD = 2.0, 1.2, np.radians(25.0)
LIGHT_MPS = 299_792_458.0


@pytest.fixture(scope="module")
def cube() -> RadarCube:
    """One far point that moves away, by the primer's equations, with amplitude 1e-4."""
    config = AWR1843
    unit = np.array([np.sin(AZIMUTH_RAD), np.cos(AZIMUTH_RAD), 0.0])
    chirp_s = config.idle_time_s + config.ramp_end_time_s
    sample_s = config.adc_start_time_s + np.arange(config.num_samples) / config.sample_rate_hz
    samples = np.zeros((2, config.num_loops, config.num_tx, config.num_rx, config.num_samples), np.complex64)
    for frame in range(2):
        for slot, tx in enumerate(config.tx_order):
            start_s = frame * config.frame_period_s + (np.arange(config.num_loops) * config.num_tx + slot) * chirp_s
            for rx in range(config.num_rx):
                offset_m = unit @ (np.array(config.tx_position_m[tx]) + np.array(config.rx_position_m[rx]))
                delay_s = ((2 * (RANGE_M + VELOCITY_MPS * start_s) - offset_m) / LIGHT_MPS)[:, None]
                phase = config.start_frequency_hz * delay_s + config.chirp_slope_hz_per_s * delay_s * sample_s
                samples[frame, :, tx, rx] = 1e-4 * np.exp(2j * np.pi * phase)
    return radar_cube(AdcCube(samples=samples, config=config, scale=1.0))


def test_range_doppler(cube: RadarCube):
    power = range_doppler_db(cube)
    _, range_bin, doppler = np.unravel_index(power[:1].argmax(), power[:1].shape)
    assert abs(cube.grid.range_m[range_bin] - RANGE_M) < 1.5 * cube.config.range_resolution_m
    assert abs(cube.grid.radial_velocity_mps[doppler] - VELOCITY_MPS) < cube.config.velocity_resolution_mps
    assert power.max() == pytest.approx(-80, abs=3)  # 1e-8 mW, less the scalloping of two Hann windows


def test_range_azimuth(cube: RadarCube):
    power = range_azimuth_db(cube, moving=True)
    _, _, azimuth = np.unravel_index(power.argmax(), power.shape)
    assert np.linspace(-60, 60, 91)[azimuth] == pytest.approx(25, abs=2)


def test_dynamic_range_angle(cube: RadarCube):
    images = dynamic_range_angle(cube)
    assert images.shape == (2, 32, 32)
    _, row, column = np.unravel_index(images[:1].argmax(), images[:1].shape)
    range_m = cube.grid.range_m
    assert range_m[0] + (row + 0.5) / 32 * np.ptp(range_m) == pytest.approx(RANGE_M, abs=0.1)
    assert np.linspace(-60, 60, 32)[column] == pytest.approx(25, abs=4)


@pytest.mark.parametrize("window_loops", [None, 8, 16])
def test_micro_doppler(cube: RadarCube, window_loops: int | None):
    power = micro_doppler_db(cube, window_loops=window_loops)
    loops = cube.config.num_loops
    width = window_loops or loops
    windows = 1 if window_loops is None else (loops - width) // (width // 2) + 1
    assert power.shape == (2 * windows, width)
    step_mps = cube.config.velocity_resolution_mps * loops / width
    found = (power.argmax(axis=1) - width // 2) * step_mps
    np.testing.assert_allclose(found, VELOCITY_MPS, atol=step_mps)


def test_elevation_needs_an_array_with_elevation(cube: RadarCube):
    assert range_elevation_db(cube).shape == (2, 64, 61)
    level_m = cube.grid.antenna_position_m * np.array([1.0, 1.0, 0.0])
    row = replace(cube, grid=replace(cube.grid, antenna_position_m=level_m))
    with pytest.raises(InputError, match=r"awr1843.*elevation"):
        range_elevation_db(row)


def test_an_unknown_scale_is_taken_as_one(cube: RadarCube):
    np.testing.assert_array_equal(range_doppler_db(replace(cube, scale=float("nan"))), range_doppler_db(cube))
