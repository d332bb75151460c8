from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.signal.cube import radar_cube
from studies.fields.finer_radar import centred, centring_phasor
from tests.cubes import point_cube


def turn_per_bin_rad(values: np.ndarray, axis: int) -> float:
    """Mean phase step from each cell to the next along an axis, weighted with their power."""
    values = np.moveaxis(values, axis, 0)
    return float(abs(np.angle(np.vdot(values[:-1], values[1:]))))


def test_it_is_unitary_and_invertible():
    cube = point_cube()
    there = centred(cube)
    assert np.allclose(np.abs(there.values), np.abs(cube.values), rtol=1e-5)
    back = there.values * centring_phasor(cube.config, cube.grid).conj()[None, :, :, None]
    assert np.allclose(back, cube.values, atol=1e-6 * np.abs(cube.values).max())


def test_one_scatterer_is_real_across_its_range_lobe():
    """Exactly: the periodic Hann is symmetric about sample N/2, so all bins share one phase or its opposite."""
    config = replace(AWR1843, num_loops=4)
    beat = 30.37
    tone = np.exp(2j * np.pi * beat * np.arange(256) / 256)
    samples = np.broadcast_to(tone, (1, 4, 3, 4, 256)).astype(np.complex64)
    line = centred(radar_cube(AdcCube(samples=samples, config=config, scale=1.0))).values[0, :, 2, 0]
    lobe = line[np.abs(line) > 1e-3 * np.abs(line).max()]
    sine = np.imag(lobe * np.conj(lobe[np.argmax(np.abs(lobe))])) / np.abs(lobe) / np.abs(lobe).max()
    assert len(lobe) > 3
    assert np.abs(sine).max() < 1e-3


def test_tdm_compensation_leaves_a_small_slope_across_the_doppler_lobe():
    """k-th transmitter: 2 pi k / (num_tx num_loops) per bin, less than 8 degrees for the awr1843."""
    loops, config = np.arange(32), replace(AWR1843, num_range_bins=4, first_range_bin=0)
    shift = 5.4
    time_loops = loops[:, None] + config.tx_delay_s / config.loop_period_s
    slow = np.exp(2j * np.pi * shift * time_loops / 32)
    samples = np.broadcast_to(slow[None, :, :, None, None], (1, 32, 3, 4, 256)).astype(np.complex64)
    cube = centred(radar_cube(AdcCube(samples=samples, config=config, scale=1.0)))
    for tx in range(3):
        left, right = cube.values[0, 0, 16 + 5, tx * 4], cube.values[0, 0, 16 + 6, tx * 4]
        turn = 2 * np.pi * config.tx_delay_s[tx] / config.loop_period_s / 32
        assert np.angle(right * np.conj(left)) == pytest.approx(-turn, abs=1e-3)
        assert turn < np.radians(8)
