"""A scatterer at a known range, velocity, azimuth and elevation comes back, through samples made by the exact sum."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmweaver.core.boards import AWR1843, BGT60, HUPR, MMMESH
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import radar_cube, remove_static, remove_static_adc
from mmweaver.signal.points import point_cloud
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    moving_doppler,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)


def direction(azimuth_deg: float, elevation_deg: float) -> np.ndarray:
    azimuth, elevation = np.radians(azimuth_deg), np.radians(elevation_deg)
    return np.array([np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)])


def exact_adc(config: RadarConfig, position_m: np.ndarray, velocity_mps: np.ndarray, noise: float = 0.0) -> AdcCube:
    """One frame of one scatterer of amplitude 1, per sample, chirp and antenna pair; at `position_m` mid-frame."""
    fast_s = config.adc_start_time_s + np.arange(config.num_samples) / config.sample_rate_hz
    chirp_s = np.arange(config.num_loops)[:, None] * config.loop_period_s + config.tx_delay_s[None, :]
    time_s = chirp_s[:, :, None, None] + fast_s - config.active_time_s / 2
    place_m = position_m + time_s[..., None] * velocity_mps
    tx_m = np.linalg.norm(place_m - np.array(config.tx_position_m)[None, :, None, None], axis=-1)
    rx_m = np.linalg.norm(place_m - np.array(config.rx_position_m)[None, None, :, None], axis=-1)
    delay_s = (tx_m + rx_m) / SPEED_OF_LIGHT_MPS
    slope = config.chirp_slope_hz_per_s
    turns = config.start_frequency_hz * delay_s + slope * delay_s * fast_s - slope * delay_s**2 / 2
    samples = np.exp(2j * np.pi * turns)
    if noise:
        draw = stream(0, "test noise")
        samples += noise * (draw.standard_normal(samples.shape) + 1j * draw.standard_normal(samples.shape))
    if not config.complex_samples:
        samples = samples.real + 0j
    return AdcCube(samples=samples[None], config=config, scale=1.0)


def seen(points: PointCloud) -> tuple[float, float, float, float]:
    """Range, radial velocity, azimuth and elevation (degrees) of the strongest point."""
    at = int(np.argmax(points.snr_db))
    x, y, z = (float(axis[at]) for axis in (points.x_m, points.y_m, points.z_m))
    range_m = float(np.sqrt(x**2 + y**2 + z**2))
    return (
        range_m, float(points.radial_velocity_mps[at]), float(np.degrees(np.arctan2(x, y))),
        float(np.degrees(np.arcsin(z / range_m))),
    )  # fmt: skip


@settings(max_examples=25, deadline=None)
@given(
    range_m=st.floats(0.9, 3.3),
    velocity_mps=st.floats(-4.2, 4.2),
    azimuth_deg=st.floats(-50, 50),
    elevation_deg=st.floats(-30, 30),
)
def test_a_point_comes_back(range_m: float, velocity_mps: float, azimuth_deg: float, elevation_deg: float):
    towards = direction(azimuth_deg, elevation_deg)
    adc = exact_adc(AWR1843, range_m * towards, velocity_mps * towards, noise=0.05)
    got = seen(point_cloud(radar_cube(adc)))
    assert got[0] == pytest.approx(range_m, abs=AWR1843.range_resolution_m / 2)
    assert got[1] == pytest.approx(velocity_mps, abs=AWR1843.velocity_resolution_mps / 2)
    assert got[2] == pytest.approx(azimuth_deg, abs=1.5)  # a tenth of the beam width
    assert got[3] == pytest.approx(elevation_deg, abs=1.5)


@pytest.mark.parametrize("config", [MMMESH, HUPR], ids=lambda config: config.name)
def test_other_radars_see_it_too(config: RadarConfig):
    towards = direction(21.0, -9.0)
    adc = exact_adc(config, 2.0 * towards, -0.7 * towards, noise=0.05)
    got = seen(point_cloud(radar_cube(adc)))
    assert got == pytest.approx((2.0, -0.7, 21.0, -9.0), abs=0.3)
    assert got[0] == pytest.approx(2.0, abs=config.range_resolution_m / 2)
    assert got[1] == pytest.approx(-0.7, abs=config.velocity_resolution_mps / 2)


def test_without_tdm_compensation_a_moving_target_shows_at_a_wrong_angle():
    """The reference case: azimuth -24.6 is seen at -24.7 with compensation and -20.3 without, fired 0, 1, 2."""
    config = replace(AWR1843, tx_order=(0, 1, 2))
    towards = direction(-24.6, -10.3)
    adc = exact_adc(config, 1.68 * towards, -2.5 * towards)
    right = seen(point_cloud(radar_cube(adc)))
    axis_rad = azimuth_axis_rad(1801)
    wrong_map = range_azimuth_power(radar_cube(adc, compensate_tdm=False), axis_rad)[0]
    wrong_deg = float(np.degrees(axis_rad[np.unravel_index(np.argmax(wrong_map), wrong_map.shape)[1]]))
    assert right == pytest.approx((1.68, -2.5, -24.6, -10.3), abs=0.5)
    # u_x = sin(az) cos(el) is what the horizontal row sees
    assert wrong_deg == pytest.approx(-20.3, abs=1.0)


def test_signs_of_the_three_maps():
    """Right, up and receding are positive."""
    towards = direction(25.0, 15.0)
    cube = radar_cube(exact_adc(AWR1843, 2.02 * towards, 1.5 * towards))
    azimuth_rad, elevation_rad = azimuth_axis_rad(241), elevation_axis_rad(161)
    at_range, at_doppler = np.unravel_index(np.argmax(range_doppler_power(cube)[0]), (64, 32))
    assert cube.grid.range_m[at_range] == pytest.approx(2.02, abs=AWR1843.range_resolution_m / 2)
    assert cube.grid.radial_velocity_mps[at_doppler] == pytest.approx(1.5, abs=AWR1843.velocity_resolution_mps / 2)
    for power, axis_rad, truth_deg in (
        (range_azimuth_power(cube, azimuth_rad)[0], azimuth_rad, 25.0 * np.cos(np.radians(15.0))),
        (range_elevation_power(cube, elevation_rad)[0], elevation_rad, 15.0),
    ):
        peak = np.unravel_index(np.argmax(power), power.shape)
        assert peak[0] == at_range
        assert np.degrees(axis_rad[peak[1]]) == pytest.approx(truth_deg, abs=1.5)


def test_a_tone_keeps_its_amplitude():
    """A target in the middle of a cell shows its amplitude, 1, at every antenna."""
    config = replace(AWR1843, num_loops=8)
    cube = radar_cube(exact_adc(config, np.array([0.0, config.range_m[20], 0.0]), np.zeros(3)))
    assert np.abs(cube.values[0, 20, 4]) == pytest.approx(1.0, abs=0.02)


def test_a_real_sampled_radar_sees_range_and_amplitude():
    config = replace(BGT60, num_loops=16)
    cube = radar_cube(exact_adc(config, np.array([0.0, config.range_m[14], 0.0]), np.zeros(3)))
    assert cube.values.shape == (1, 32, 16, 3)
    assert np.unravel_index(np.argmax(np.abs(cube.values[0, :, :, 2])), (32, 16)) == (14, 8)
    assert np.abs(cube.values[0, 14, 8]) == pytest.approx(1.0, abs=0.05)


def test_a_static_scene_has_zero_doppler_and_vanishes_with_its_mean():
    places = [(0.4, 1.5, 0.3), (-1.0, 2.5, -0.5), (0.0, 3.0, 0.0)]
    samples = sum(exact_adc(AWR1843, np.array(place), np.zeros(3)).samples for place in places)
    adc = AdcCube(samples=np.asarray(samples), config=AWR1843, scale=1.0)
    cube = radar_cube(adc)
    energy = range_doppler_power(cube)
    assert energy[:, :, moving_doppler(cube)].sum() < 1e-10 * energy.sum()
    for removed in (remove_static(cube), radar_cube(remove_static_adc(adc))):
        assert range_doppler_power(removed).sum() < 1e-10 * energy.sum()
    assert remove_static(cube, "none") is cube


def test_a_mover_outlives_static_removal():
    still = exact_adc(AWR1843, np.array([0.0, 2.0, 0.0]), np.zeros(3))
    mover = exact_adc(AWR1843, np.array([0.5, 2.5, 0.0]), np.array([0.0, 2.0, 0.0]))
    both = AdcCube(samples=100 * still.samples + mover.samples, config=AWR1843, scale=1.0)
    alone, cleaned = radar_cube(mover).values, remove_static(radar_cube(both)).values
    assert np.linalg.norm(cleaned - alone) < 0.02 * np.linalg.norm(alone)


def test_two_people_in_one_range_doppler_cell_are_two_points():
    right, left = direction(30.0, 0.0), direction(-30.0, 0.0)
    samples = sum(exact_adc(AWR1843, 2.0 * at, 1.0 * at, noise=0.02).samples for at in (right, left))
    points = point_cloud(radar_cube(AdcCube(samples=np.asarray(samples), config=AWR1843, scale=1.0)))
    strongest = np.argsort(-points.snr_db)[:2]
    azimuth_deg = np.degrees(np.arctan2(points.x_m, points.y_m))[strongest]
    assert sorted(azimuth_deg) == pytest.approx([-30.0, 30.0], abs=2.0)


def test_a_body_gives_tens_of_points_that_lie_on_it():
    """120 scatterers with the extent of a walking person, 40 dB over the noise of a cell."""
    draw = stream(0, "test body")
    middle, half = np.array([0.3, 2.0, -0.1]), np.array([0.25, 0.12, 0.8])
    samples = np.zeros((1, 32, 3, 4, 256), complex)
    for _ in range(120):
        part = draw.uniform(-1, 1, 3)
        speed = np.array([0.0, -1.0 + 1.5 * draw.uniform(-1, 1) * abs(part[2]), 0.0])
        phase = np.exp(2j * np.pi * draw.random())
        samples += phase * exact_adc(AWR1843, middle + part * half, speed).samples
    samples += 10 * (draw.standard_normal(samples.shape) + 1j * draw.standard_normal(samples.shape))
    cube = radar_cube(AdcCube(samples=samples, config=AWR1843, scale=1.0))
    points = point_cloud(cube)
    assert 15 <= len(points.frame) <= 128
    place_m = np.stack([points.x_m, points.y_m, points.z_m], axis=1)
    near = np.abs(place_m - middle) < half + np.array([0.35, 0.15, 0.6])  # plus the beam's width
    assert near.all(axis=1).mean() > 0.8
