"""Maps of cubes made cell by cell."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    has_elevation,
    moving_doppler,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)

FLAT = replace(AWR1843, tx_position_m=AWR1843.tx_position_m[:1], tx_order=(0,))


def plane_wave(config: RadarConfig, at: tuple[int, int], right: float, up: float, amplitude: float = 1.0) -> RadarCube:
    """A cube with one cell filled, by the phase -2 pi / wavelength u.p of a far target."""
    values = np.zeros((1, config.num_range_bins, config.num_loops, config.num_antennas), np.complex64)
    place_m = config.antenna_position_m
    path_m = right * place_m[:, 0] + np.sqrt(1 - right**2 - up**2) * place_m[:, 1] + up * place_m[:, 2]
    values[0, at[0], at[1]] = amplitude * np.exp(-2j * np.pi / config.wavelength_m * path_m)
    return RadarCube(values=values, grid=CubeGrid.of(config, 1), config=config, scale=1.0)


def test_range_doppler_is_the_mean_over_antennas():
    cube = plane_wave(AWR1843, (5, 9), 0.3, 0.1, amplitude=2.0)
    power = range_doppler_power(cube)
    assert power[0, 5, 9] == pytest.approx(4.0)
    assert power.sum() == pytest.approx(4.0)


@pytest.mark.parametrize("config", [AWR1843, FLAT, BGT60], ids=["eight", "four", "two"])
@pytest.mark.parametrize("azimuth_deg", [-35.0, 0.0, 20.0])
def test_azimuth_peaks_where_the_wave_comes_from(config: RadarConfig, azimuth_deg: float):
    cube = plane_wave(config, (5, 2), float(np.sin(np.radians(azimuth_deg))), 0.0, amplitude=3.0)
    axis_rad = azimuth_axis_rad(num=121)
    power = range_azimuth_power(cube, axis_rad)[0]
    assert np.degrees(axis_rad[np.argmax(power[5])]) == pytest.approx(azimuth_deg, abs=0.51)
    assert power[5].max() == pytest.approx(9.0, rel=1e-3)
    assert not power[[4, 6]].any()


@pytest.mark.parametrize("elevation_deg", [-20.0, 0.0, 12.0])
@pytest.mark.parametrize("right", [-0.5, 0.0, 0.4])
def test_elevation_is_independent_of_azimuth(elevation_deg: float, right: float):
    cube = plane_wave(AWR1843, (7, 20), right, float(np.sin(np.radians(elevation_deg))))
    axis_rad = elevation_axis_rad(num=81, limit_deg=40.0)
    power = range_elevation_power(cube, axis_rad)[0]
    assert np.degrees(axis_rad[np.argmax(power[7])]) == pytest.approx(elevation_deg, abs=0.51)
    assert power[7].max() == pytest.approx(1.0, rel=1e-3)


def test_a_flat_array_has_no_elevation():
    assert has_elevation(AWR1843)
    assert not has_elevation(FLAT)
    with pytest.raises(InputError, match="elevation"):
        range_elevation_power(plane_wave(FLAT, (5, 2), 0.0, 0.0), elevation_axis_rad())


def test_moving_only_drops_zero_doppler_and_its_neighbours():
    axis_rad = azimuth_axis_rad()
    for column, is_kept in ((14, True), (15, False), (16, False), (17, False), (18, True)):
        cube = plane_wave(AWR1843, (5, column), 0.0, 0.0)
        assert bool(range_azimuth_power(cube, axis_rad, moving_only=True).any()) is is_kept
        assert bool(moving_doppler(cube)[column]) is is_kept
        assert range_azimuth_power(cube, axis_rad).any()


def test_axes_are_symmetric():
    assert np.degrees(azimuth_axis_rad(91, 60.0)[[0, 45, 90]]) == pytest.approx([-60, 0, 60])
    assert len(azimuth_axis_rad()) == 91
