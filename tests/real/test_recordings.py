"""Real recordings through our own signal processing. What is known of them: shared/data/README.md."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import BGT60, halfwave_positions
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.io.dca1000 import read_bin
from mmweaver.io.mmwave_studio import read_mmwave_studio
from mmweaver.io.raw_npy import read_adc_npy
from mmweaver.signal.cube import radar_cube, remove_static, remove_static_adc
from mmweaver.signal.points import point_cloud
from mmweaver.signal.spectra import azimuth_axis_rad, moving_doppler, range_azimuth_power, range_doppler_power


def two_people_radar(tx_order: tuple[int, ...] = (0, 1)) -> RadarConfig:
    """2 TX x 4 RX in one row, 60 MHz/us, 128 samples at 2.5 Msps, 128 loops; idle and ramp end are not known.

    Virtual antennas run from right to left: with them the other way round all azimuths change sign. The recording
    says nothing about its board's orientation; this one gives the signs that its README states.
    """
    middle_hz = 77e9 + 60e12 * (6e-6 + 128 / 2.5e6 / 2)
    return RadarConfig(
        name="two_people", start_frequency_hz=77e9, chirp_slope_hz_per_s=60e12, idle_time_s=7e-6,
        adc_start_time_s=6e-6, ramp_end_time_s=60e-6, num_samples=128, sample_rate_hz=2.5e6, num_loops=128,
        frame_period_s=0.1, tx_position_m=halfwave_positions(((0.0, 0.0), (-4.0, 0.0)), middle_hz),
        rx_position_m=halfwave_positions(((0.0, 0.0), (-1.0, 0.0), (-2.0, 0.0), (-3.0, 0.0)), middle_hz),
        tx_order=tx_order, num_range_bins=128,
    )  # fmt: skip


def two_people(real_data: Path, tx_order: tuple[int, ...] = (0, 1)) -> RadarCube:
    path = real_data / "radar" / "openradar_two_people" / "adc_frame_loops_vrx_samples_c64.npy"
    return radar_cube(read_adc_npy(path, two_people_radar(tx_order), "loop,vrx,sample"))


def test_the_two_people_stand_at_2_93_m(real_data: Path):
    cube = two_people(real_data)
    power = range_doppler_power(remove_static(cube))[0]
    for side in (cube.grid.radial_velocity_mps < 0, cube.grid.radial_velocity_mps > 0):
        profile = power[:, side & moving_doppler(cube)].sum(axis=1)
        assert cube.grid.range_m[np.argmax(profile)] == pytest.approx(2.93, abs=2 * cube.config.range_resolution_m)
    whole = power[:, moving_doppler(cube)].sum(axis=1)
    assert cube.grid.range_m[np.argmax(whole)] == pytest.approx(2.93, abs=0.5 * cube.config.range_resolution_m)


def test_the_two_people_at_minus_15_and_8_degrees(real_data: Path):
    """One walks towards the radar and one away, so each is a cluster of its own in velocity."""
    points = point_cloud(two_people(real_data), moving_only=True)
    range_m = np.sqrt(points.x_m**2 + points.y_m**2 + points.z_m**2)
    azimuth_deg = np.degrees(np.arctan2(points.x_m, points.y_m))
    for sign, truth_deg in ((-1, -15.0), (1, 8.0)):
        person = (np.sign(points.radial_velocity_mps) == sign) & (np.abs(range_m - 2.93) < 0.2)
        assert person.sum() >= 5
        mean_deg = np.average(azimuth_deg[person], weights=10 ** (points.snr_db[person] / 10))
        assert mean_deg == pytest.approx(truth_deg, abs=3.0)


def test_the_first_four_antennas_belong_to_the_first_transmitter(real_data: Path):
    """The other order tears each person's lobe apart: the beam of eight is less sharp."""
    sharpness = []
    for tx_order in ((0, 1), (1, 0)):
        cube = two_people(real_data, tx_order)
        at = int(np.argmax(range_doppler_power(cube)[0][:, moving_doppler(cube)].sum(axis=1)))
        away = replace(cube, values=cube.values * (cube.grid.radial_velocity_mps > 0)[:, None].astype(np.float32))
        lobe = range_azimuth_power(away, azimuth_axis_rad(), moving_only=True)[0, at]
        sharpness.append(lobe.max() / lobe.mean())
    assert sharpness[0] > 1.3 * sharpness[1]


def test_the_wall_of_the_two_people_stands_still_at_5_2_m(real_data: Path):
    cube = two_people(real_data)
    profile = np.abs(cube.values[0, :, 64]).mean(axis=1)
    far = cube.grid.range_m > 1.0
    assert cube.grid.range_m[far][np.argmax(profile[far])] == pytest.approx(5.2, abs=0.05)
    left = range_doppler_power(remove_static(cube))[0, far, 64].max()
    assert left < 1e-3 * range_doppler_power(cube)[0, far, 64].max()


def test_the_breathing_person(real_data: Path):
    """The range bin that changes most from frame to frame, and the beat of its phase over the frames."""
    path = real_data / "radar" / "bgt60_breathing" / "breathing_radar_uint16_256x3x8x64.npy"
    cube = radar_cube(read_adc_npy(path, BGT60, "frame,rx,loop,sample"))
    still = cube.values[:, :, BGT60.num_loops // 2]
    change = np.abs(still - still.mean(axis=0)).mean(axis=(0, 2))
    at = 2 + int(np.argmax(change[2:]))  # bins 0 and 1 hold the leakage
    assert cube.grid.range_m[at] == pytest.approx(0.33, abs=BGT60.range_resolution_m / 2)
    phase = np.unwrap(np.angle(still[:, at]), axis=0)
    phase -= phase.mean(axis=0)
    padded = 4096
    spectrum = np.abs(np.fft.rfft(phase * np.hanning(len(phase))[:, None], padded, axis=0)).mean(axis=1)
    frequency_hz = np.fft.rfftfreq(padded, BGT60.frame_period_s)
    breath = (frequency_hz > 0.1) & (frequency_hz < 0.7)
    peak_hz = frequency_hz[breath][np.argmax(spectrum[breath])]
    assert peak_hz == pytest.approx(0.24, abs=0.01)
    displacement_m = np.ptp(phase, axis=0) * BGT60.wavelength_m / (4 * np.pi)
    assert ((displacement_m > 1e-3) & (displacement_m < 3e-2)).all()


@pytest.fixture(scope="module")
def static_room(real_data: Path) -> tuple[Path, RadarConfig]:
    folder = real_data / "radar" / "iwr6843_dca1000"
    config = read_mmwave_studio(folder / "mmwaveDevice.mmwave.json")
    return folder, replace(config, first_range_bin=0, num_range_bins=config.num_samples)


def test_the_bin_is_one_frame_of_its_set_up(static_room: tuple[Path, RadarConfig]):
    folder, config = static_room
    assert (config.num_tx, config.num_rx, config.num_loops, config.num_samples) == (3, 4, 85, 512)
    assert config.range_resolution_m == pytest.approx(0.039, abs=0.0005)
    assert read_bin(folder / "adc_data_example.bin", config).samples.shape == (1, 85, 3, 4, 512)


def test_its_room_stands_still(static_room: tuple[Path, RadarConfig]):
    folder, config = static_room
    adc = read_bin(folder / "adc_data_example.bin", config)
    power = range_doppler_power(radar_cube(adc))
    assert power[:, :, ~moving_doppler(radar_cube(adc))].sum() > 0.97 * power.sum()
    assert range_doppler_power(radar_cube(remove_static_adc(adc))).sum() < 0.01 * power.sum()


def test_its_set_up_names_the_iq_order_that_does_not_mirror_range(static_room: tuple[Path, RadarConfig]):
    """Leakage and near clutter are the strongest of any indoor scene: I first has them at the near end."""
    folder, config = static_room
    iq_order = config.lvds_iq_order
    assert iq_order == "iq"
    near = {}
    for order in ("iq", "qi"):
        cube = radar_cube(read_bin(folder / "adc_data_example.bin", config, iq_order=order))
        profile = range_doppler_power(cube)[0].sum(axis=1)
        near[order] = profile[cube.grid.range_m < 5.0].sum() / profile.sum()
    assert near["iq"] > 0.9
    assert near["qi"] < 0.1
