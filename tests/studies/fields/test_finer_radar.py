from dataclasses import replace

import numpy as np
import pytest

from mmweaver.compression.signal_field import coordinates_on, finer_grid
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, PoseSequence
from mmweaver.signal.cube import adc_from_cube, radar_cube
from studies.fields.finer_radar import (
    interpolated,
    middle_delay_s,
    more_antennas,
    more_bandwidth,
    more_loops,
    spectrum_on,
    starting_later,
)
from studies.scores.cube_scores import nmse_db
from tests.cubes import SMALL, point_adc


@pytest.mark.parametrize("factor", [1.5, 2.0, 4.0])
def test_finer_radars_keep_axes_and_centre(factor: float):
    wide, long = more_bandwidth(AWR1843, factor), more_loops(AWR1843, factor)
    assert wide.bandwidth_hz == pytest.approx(factor * AWR1843.bandwidth_hz)
    assert wide.centre_frequency_hz == pytest.approx(AWR1843.centre_frequency_hz)
    assert long.velocity_resolution_mps == pytest.approx(AWR1843.velocity_resolution_mps / factor)
    assert long.max_velocity_mps == pytest.approx(AWR1843.max_velocity_mps)
    native = finer_grid(radar_grid(AWR1843), n_r=factor, n_d=factor)
    assert np.allclose(wide.range_m, native.range_m)
    assert np.allclose(long.radial_velocity_mps, native.radial_velocity_mps)


def radar_grid(config):
    from mmweaver.core.records import CubeGrid

    return CubeGrid.of(config, 1)


def test_denser_antennas_lie_on_the_line_of_the_old_ones():
    dense = more_antennas(AWR1843, 2.0)
    antenna = coordinates_on(radar_grid(AWR1843), radar_grid(dense))[3]
    assert dense.num_antennas == 21
    assert set(np.arange(12.0)) <= set(np.round(antenna, 6))


def test_a_factor_without_whole_bins_is_refused():
    with pytest.raises(InputError, match="no whole number"):
        more_bandwidth(AWR1843, 1.3)


def test_the_spectrum_is_the_cube_at_its_cells_and_zero_padding_between():
    adc = point_adc(noise=0.1)
    cube = radar_cube(adc)
    assert nmse_db(spectrum_on(adc, cube.grid), cube.values) < -100
    padded = replace(SMALL, num_samples=128, sample_rate_hz=2 * SMALL.sample_rate_hz, first_range_bin=16)
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(64) / 64)
    profile = np.fft.fft(adc.samples * (window / window.sum()), 128, axis=-1)[..., 16:80]
    one_loop = replace(SMALL, num_loops=1)
    grid = finer_grid(radar_grid(one_loop), n_r=2.0)
    first = AdcCube(samples=adc.samples[:1, 5:6], config=one_loop, scale=1.0)
    expected = profile[0, 5].reshape(12, 64).T
    assert padded.num_range_bins == 32
    assert np.allclose(spectrum_on(first, grid)[0, :, 0], expected, atol=1e-5)


def test_lines_meet_the_cells_and_need_centring_between_them():
    adc = point_adc()
    cube = radar_cube(adc)
    grid = finer_grid(cube.grid, n_r=2.0, n_d=2.0)
    truth = spectrum_on(adc, grid)
    raw, smooth = (interpolated(cube, grid, is_centred=is_centred) for is_centred in (False, True))
    for values in (raw, smooth):
        assert np.allclose(values[:, ::2, ::2], cube.values, atol=1e-5 * np.abs(cube.values).max())
    assert nmse_db(raw, truth) > -3
    assert nmse_db(smooth, truth) < -10
    assert nmse_db(spectrum_on(adc_from_cube(cube), grid), truth) < -30


def test_middles_coincide():
    finer = more_loops(SMALL, 4.0)
    delay_s = middle_delay_s(SMALL, finer)
    assert delay_s + SMALL.active_time_s / 2 == pytest.approx(finer.active_time_s / 2)
    pose = PoseSequence(time_s=np.arange(3.0), joints_m=np.zeros((3, 22, 3)), height_m=1.7)
    assert starting_later(pose, 0.5).time_s.tolist() == [-0.5, 0.5, 1.5]
