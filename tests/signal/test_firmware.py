"""The firmware's point cloud: known targets, the device's grid, clutter removal, limits."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import BGT60, IWR1443_MARS, IWR1443_RADHAR
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareCfar, FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.firmware import firmware_points, firmware_spectrum, range_step_m

Target = tuple[float, float, float, float, float]  # x, y, z in m, radial velocity in m/s, amplitude in counts


def targets_adc(config: RadarConfig, *targets: Target, noise: float = 1.0, frames: int = 1) -> AdcCube:
    """Far targets in ADC counts over white noise."""
    time_s = np.arange(config.num_loops)[:, None] * config.loop_period_s + config.tx_delay_s
    antenna_m = config.antenna_position_m.reshape(config.num_tx, config.num_rx, 3)
    rng = stream(0, "firmware test")
    shape = (frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    samples = noise * (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2)
    sample_s = np.arange(config.num_samples) / config.sample_rate_hz
    for x, y, z, speed, amplitude in targets:
        range_m = np.linalg.norm([x, y, z])
        way_m = range_m + speed * time_s
        phase = 4 * np.pi * way_m[..., None] - 2 * np.pi * (antenna_m @ np.array([x, y, z]) / range_m)
        beat = 2 * config.chirp_slope_hz_per_s * range_m / 299792458.0
        tone = np.exp(2j * np.pi * beat * sample_s)
        samples += amplitude * np.exp(1j * phase / config.wavelength_m)[..., None] * tone
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=float("nan"))


def around(cloud, x: float, y: float, z: float, within_m: float = 0.25) -> np.ndarray:
    return np.hypot(np.hypot(cloud.x_m - x, cloud.y_m - y), cloud.z_m - z) < within_m


@pytest.mark.parametrize("config", [IWR1443_RADHAR, IWR1443_MARS], ids=lambda c: c.name)
@pytest.mark.parametrize(("x", "z"), [(0.0, 0.0), (0.7, 0.3), (-0.9, -0.4)])
def test_a_target_is_reported_within_a_bin(config: RadarConfig, x: float, z: float):
    speed = 2 * config.velocity_resolution_mps
    cloud = firmware_points(targets_adc(config, (x, 2.0, z, speed, 30.0)))
    best = np.argmax(cloud.intensity)
    range_m = np.sqrt(x**2 + 4 + z**2)
    found_m = np.sqrt(cloud.x_m**2 + cloud.y_m**2 + cloud.z_m**2)[best]
    step_m = 299_792_458 * config.sample_rate_hz / (2 * config.chirp_slope_hz_per_s * 256)
    assert abs(found_m - range_m) < 0.6 * step_m
    assert abs(cloud.x_m[best] - x) < range_m / 32
    assert abs(cloud.z_m[best] - z) < 0.1
    assert cloud.radial_velocity_mps[best] == pytest.approx(speed, abs=1e-6)


def test_the_device_grid():
    """As in the recordings: RadHAR's ranges on a grid of 4.09 cm, MARS' of 2.93 cm, and their velocity steps."""
    assert range_step_m(IWR1443_RADHAR) == pytest.approx(0.0409, abs=5e-5)
    assert IWR1443_RADHAR.range_resolution_m == pytest.approx(0.0436, abs=5e-5)
    assert IWR1443_RADHAR.range_m[-1] == pytest.approx(5.447, abs=1e-3)
    assert IWR1443_RADHAR.radial_velocity_mps[[0, -1]] == pytest.approx([-4.917, 4.303], abs=4e-3)
    assert range_step_m(IWR1443_MARS) == pytest.approx(0.0293, abs=5e-5)
    assert IWR1443_MARS.velocity_resolution_mps == pytest.approx(0.356, abs=5e-4)
    cloud = firmware_points(targets_adc(IWR1443_MARS, (0.4, 1.8, 0.2, 0.36, 30.0), (-0.3, 2.4, 0.0, -0.71, 30.0)))
    range_m = cloud.range_bin * range_step_m(IWR1443_MARS)
    assert np.abs(np.sqrt(cloud.x_m**2 + cloud.y_m**2 + cloud.z_m**2) - range_m).max() < 2e-3
    cosine = cloud.x_m / range_m * 32
    assert np.abs(cosine - np.rint(cosine)).max() < 0.02


def test_static_clutter_is_at_zero_velocity_and_clutter_removal_removes_it():
    walls = [(x, y, 0.0, 0.0, 300.0) for x, y in ((0.2, 1.5), (-1.0, 2.2), (0.8, 3.0), (0.0, 4.0))]
    person = (0.3, 2.0, 0.1, 1.23, 30.0)
    adc = targets_adc(IWR1443_RADHAR, *walls, person, frames=3)
    cloud = firmware_points(adc)
    moving = cloud.radial_velocity_mps != 0
    assert set(cloud.frame) == {0, 1, 2}
    for x, y, z, _, _ in walls:
        assert (around(cloud, x, y, z) & ~moving).sum() >= 3
    assert moving.sum() >= 3
    assert around(cloud, *person[:3])[moving].all()
    cleaned = firmware_points(adc, FirmwareSettings(static_removal=True))
    assert len(cleaned.frame) >= 3
    assert (cleaned.radial_velocity_mps != 0).all()
    assert around(cleaned, *person[:3]).all()


def test_two_targets_of_one_cell_are_two_objects_with_beamforming_on():
    config, speed = IWR1443_MARS, IWR1443_MARS.velocity_resolution_mps
    range_m = 60 * range_step_m(config)
    places = [(range_m * np.sin(a), range_m * np.cos(a), 0.0) for a in (-0.5, 0.5)]
    adc = targets_adc(config, *((*place, speed, 30.0 * share) for place, share in zip(places, (1.0, 0.8), strict=True)))
    alone = firmware_points(adc, FirmwareSettings(second_peak=None))
    both = firmware_points(adc, FirmwareSettings(second_peak=0.5))
    assert around(alone, *places[0]).any()
    assert not around(alone, *places[1]).any()
    assert around(both, *places[0]).any()
    assert around(both, *places[1]).any()
    assert len(both.frame) == 2 * len(alone.frame)


def test_the_list_is_filled_from_zero_velocity_upwards():
    """As the device's: not the strongest, but the first in its own order, and the elevated row leaves room for 64."""
    every = FirmwareSettings(
        range_cfar=FirmwareCfar(threshold=0), group_range=False, group_doppler=False, second_peak=None
    )
    cloud = firmware_points(targets_adc(IWR1443_RADHAR, noise=20.0), every)
    assert len(cloud.frame) == 64
    assert cloud.radial_velocity_mps.min() == 0
    assert (np.diff(cloud.doppler_bin) >= 0).all()
    few = firmware_points(targets_adc(IWR1443_RADHAR, noise=20.0), replace(every, most_objects=5))
    assert len(few.frame) == 5
    flat = replace(IWR1443_RADHAR, tx_position_m=IWR1443_RADHAR.tx_position_m[::2], tx_order=(0, 1))
    cloud = firmware_points(targets_adc(flat, noise=20.0), every)
    assert len(cloud.frame) == 100
    assert (cloud.z_m == 0).all()


def test_counts_are_those_of_the_16_bit_chain():
    """A tone of 100 counts on a bin: 168 samples times the Blackman's mean over 4, then 1 (Hann) over 16 loops."""
    config = IWR1443_MARS
    step_m = 0.0292766  # c x 3.5 Msps / (2 x 70 MHz/us x 256)
    adc = targets_adc(config, (0.0, 50 * step_m, 0.0, 0.0, 100.0), noise=0.0)
    spectrum = firmware_spectrum(adc, FirmwareSettings())
    assert spectrum.shape == (1, 256, 16, 12)
    assert np.abs(spectrum[0, 50, 8]) == pytest.approx(100 * (168 * 0.42 - 0.42) / 4 * 15 / 16, rel=0.02)
    assert np.array_equal(spectrum, np.rint(spectrum.real) + 1j * np.rint(spectrum.imag))
    cloud = firmware_points(adc)
    assert cloud.intensity.max() == pytest.approx(np.abs(spectrum[0, 50, 8, 0]), rel=0.01)
    loud = replace(adc, samples=adc.samples * 1000)
    assert np.abs(firmware_spectrum(loud, FirmwareSettings()).real).max() <= 32767


def test_a_scale_gives_the_same_counts():
    adc = targets_adc(IWR1443_MARS, (0.0, 2.0, 0.0, 0.7, 100.0))
    count = IWR1443_MARS.adc_count_sqrt_mw
    scaled = AdcCube(samples=(adc.samples * np.float32(count)).astype(np.complex64), config=adc.config, scale=1.0)
    one, other = firmware_points(adc), firmware_points(scaled)
    assert other.x_m == pytest.approx(one.x_m)
    assert other.intensity == pytest.approx(one.intensity, abs=1.5)


def test_a_cube_gives_the_targets_of_its_samples():
    config = IWR1443_MARS
    adc = targets_adc(config, (0.4, 1.9, 0.1, 0.71, 60.0))
    cloud = firmware_points(radar_cube(adc))
    best = np.argmax(cloud.intensity)
    assert around(cloud, 0.4, 1.9, 0.1)[best]
    assert cloud.radial_velocity_mps[best] == pytest.approx(0.71, abs=0.01)


def test_zero_signals_have_no_points_and_other_radars_are_refused():
    silent = targets_adc(IWR1443_MARS, noise=0.0, frames=2)
    assert len(firmware_points(silent).frame) == 0
    bgt = AdcCube(samples=np.zeros((1, 8, 1, 3, 64), np.complex64), config=BGT60, scale=1.0)
    with pytest.raises(InputError, match="use --points cfar"):
        firmware_points(bgt)
