"""Recordings read wrongly are noticed, with the likelier reading; right ones are not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.boards import ANTENNAS, AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.io.dca1000 import adc_of_words, upright, words_of, write_bin
from mmweaver.io.radar_file import load_radar
from mmweaver.io.radar_options import RadarOptions
from mmweaver.recordings.frame_boundaries import agreements
from mmweaver.recordings.plausibility import BETTER_ORDER, implausible
from mmweaver.recordings.processing import process_recording
from mmweaver.signal.cube import radar_cube

RADAR = replace(AWR1843, num_loops=16, num_samples=64, sample_rate_hz=1.13e6, first_range_bin=0, num_range_bins=64)


def room(config: RadarConfig, num_frames: int = 8, speed_mps: float = 0.9) -> AdcCube:
    """Fifteen static points, one that comes nearer, and noise, in counts; held within a chirp."""
    rng = np.random.default_rng(3)
    loop_s = np.arange(config.num_loops) * config.loop_period_s
    time_s = np.arange(num_frames)[:, None] * config.frame_period_s + loop_s
    time_s = time_s[:, :, None] + config.tx_delay_s  # (frame, loop, tx)
    samples = np.zeros((*time_s.shape, config.num_rx, config.num_samples), complex)
    fast = np.arange(config.num_samples) / config.sample_rate_hz - config.num_samples / config.sample_rate_hz / 2
    antennas = config.antenna_position_m.reshape(config.num_tx, config.num_rx, 3)
    for index in range(16):
        range_m = rng.uniform(0.4, 1.1) + 0 * time_s if index else 1.3 - speed_mps * time_s
        azimuth, elevation = rng.uniform(-0.7, 0.7), rng.uniform(-0.2, 0.2)
        towards = np.array([np.sin(azimuth), np.cos(azimuth), np.sin(elevation)])
        path_m = 2 * range_m[..., None] - antennas @ towards
        delay_s = path_m[..., None] / 299_792_458
        turns = config.centre_frequency_hz * delay_s + config.chirp_slope_hz_per_s * delay_s * fast
        samples += (300 if index else 900) * np.exp(2j * np.pi * turns)
    samples += 5 * (rng.standard_normal(samples.shape) + 1j * rng.standard_normal(samples.shape))
    return AdcCube(samples=np.rint(samples).astype(np.complex64), config=config, scale=float("nan"))


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plausible")
    write_bin(folder / "adc_data.bin", room(RADAR), counts_per_unit=1.0)
    (folder / "radar.json").write_text(RADAR.to_json())
    return folder


def read(path: Path, config: RadarConfig = RADAR, **options) -> list[str]:
    return process_recording(path, config, analyse=False, **options).meta["warnings"]


def test_a_right_reading_is_plausible(recording: Path):
    assert read(recording / "adc_data.bin") == []


def test_a_wrong_iq_order_is_noticed_and_refused(recording: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path):
    assert any("--iq-order" in text for text in read(recording / "adc_data.bin", iq_order="qi"))
    with pytest.raises(InputError, match="--iq-order"):
        read(recording / "adc_data.bin", iq_order="qi", strict=True)
    words = ["process", str(recording / "adc_data.bin"), "--radar", str(recording / "radar.json"), "--iq-order", "qi"]
    words += ["--no-pictures", "--no-analysis", "--out"]
    assert main([*words, str(tmp_path / "out")]) == 0
    assert "warning: " in capsys.readouterr().out


@pytest.mark.parametrize("written", ["iq", "qi", "interleaved"])
@pytest.mark.parametrize("read_as", ["iq", "qi", "interleaved"])
def test_the_advised_iq_order_is_the_one_that_was_written(tmp_path: Path, written: str, read_as: str):
    write_bin(tmp_path / "adc_data.bin", room(RADAR, 2), iq_order=written, counts_per_unit=1.0)
    found = read(tmp_path / "adc_data.bin", iq_order=read_as)
    assert [text.rpartition("--iq-order ")[2] for text in found] == [written] * (written != read_as)


def test_the_order_of_the_transmitters(recording: Path):
    found = read(recording / "adc_data.bin", tx_order=(2, 0, 1))
    assert len(found) == 1
    assert found[0].endswith("--tx-order 0,2,1")


@pytest.mark.parametrize("radar", ["iwr6843aop", "iwr6843ods"])
def test_transmitters_above_each_other(radar: str):
    config = replace(load_radar(radar), num_loops=8, num_samples=64, first_range_bin=0, num_range_bins=64)
    found = agreements(radar_cube(room(config, 2)))
    own = found.pop(config.tx_order)
    assert own > 0.5
    assert max(found.values()) < own - BETTER_ORDER


@pytest.mark.parametrize("lanes", [2, 4])
def test_the_other_layout_of_the_lanes(tmp_path: Path, lanes: int):
    written = replace(RADAR, lvds_lanes=lanes)
    write_bin(tmp_path / "adc_data.bin", replace(room(RADAR, 2), config=written), counts_per_unit=1.0)
    assert read(tmp_path / "adc_data.bin", written) == []
    found = read(tmp_path / "adc_data.bin", replace(RADAR, lvds_lanes=6 - lanes))
    assert len(found) == 1
    assert f"try --radar-set lanes={lanes}" in found[0]


def test_another_radars_layout(recording: Path):
    """Twice the samples, half the loops: the file has the right size."""
    other = replace(RADAR, num_samples=128, num_loops=8, sample_rate_hz=2.26e6, num_range_bins=128)
    other = replace(other, tx_position_m=RADAR.tx_position_m[:2], tx_order=(0, 1), num_loops=12)
    found = read(recording / "adc_data.bin", other)
    assert any("768 samples apart" in text for text in found)


def test_a_loop_read_twice_as_long_names_the_likelier_radar():
    """A frame of an AWR1843 as an IWR6843 with twice the samples: the number of words fits, and so do two loops."""
    adc = room(replace(RADAR, num_samples=256, sample_rate_hz=4.51e6, num_range_bins=256), 2)
    twice = replace(RADAR, num_samples=512, num_loops=8, sample_rate_hz=9e6, num_range_bins=256)
    assert implausible(adc, radar_cube(adc)) == []
    words, _ = words_of(adc, counts_per_unit=1.0)
    again = adc_of_words(words.reshape(-1), twice)
    found = implausible(again, radar_cube(again))
    assert any("3 TX x 4 RX x 256 samples" in text for text in found)


@pytest.mark.parametrize("moves", [True, False])
def test_frames_that_are_right_are_not_called_parts_of_others(moves: bool):
    adc = room(replace(RADAR, frame_period_s=0.07), 16, speed_mps=0.9 if moves else 0.0)
    assert implausible(adc, radar_cube(adc)) == []


def test_frames_that_came_at_another_rate():
    adc = room(RADAR, 3)
    own_s, slow_s = (period_s * np.arange(3) for period_s in (RADAR.frame_period_s, 0.4))
    assert implausible(adc, radar_cube(adc), frame_time_s=own_s) == []
    assert "every 400.0 ms" in implausible(adc, radar_cube(adc), frame_time_s=slow_s)[0]


def test_constant_and_clipped_frames():
    adc = room(RADAR)
    broken = adc.samples.copy()
    broken[3:5] = 0
    assert implausible(replace(adc, samples=broken), radar_cube(adc))[0].startswith("2 of 8 frames are constant")
    loud = np.clip(40 * adc.samples.real, -32768, 32767) + 1j * np.clip(40 * adc.samples.imag, -32768, 32767)
    loud = replace(adc, samples=loud.astype(np.complex64))
    assert any("clipped" in text for text in implausible(loud, radar_cube(loud)))


def test_loops_in_reverse_order():
    adc = room(RADAR)
    backwards = replace(adc, samples=np.ascontiguousarray(adc.samples[:, ::-1]))
    assert any("reverse order" in text for text in implausible(backwards, radar_cube(backwards)))


def test_somebody_who_claps_on_the_spot_is_no_reverse_order():
    """Now one hand is the strongest, now the other: where the energy is moves against its velocity."""
    adc = room(RADAR, 16)
    cube = radar_cube(adc)
    rng = np.random.default_rng(0)
    values = rng.standard_normal(cube.values.shape) + 1j * rng.standard_normal(cube.values.shape)
    speed = np.abs(cube.grid.radial_velocity_mps - 0.5).argmin()
    for frame in range(16):
        nearer, receding = frame % 4 in (1, 2), frame % 4 in (0, 1)
        values[frame, 24 if nearer else 27, speed if receding else -speed] += 1000
    clapping = replace(cube, values=values.astype(np.complex64))
    assert implausible(adc, clapping) == []


def test_what_is_too_fast_for_the_radar_is_no_reverse_order():
    slow = replace(RADAR, idle_time_s=5e-4)
    assert slow.max_velocity_mps < 0.9  # of the point that comes nearer: it is seen as going away
    adc = room(slow)
    assert implausible(adc, radar_cube(adc)) == []


@pytest.mark.parametrize("factor", [0.5, 2])
def test_frames_with_another_number_of_loops(factor: float, recording: Path):
    """Half or twice the loops: static echoes fit as well, but moving ones jump only from frame to frame."""
    other = replace(RADAR, num_loops=int(RADAR.num_loops * factor), frame_period_s=RADAR.frame_period_s * factor)
    found = read(recording / "adc_data.bin", other)
    if factor > 1:  # of eight frames too few are left to be sure
        adc = room(RADAR, 20)
        found = implausible(replace(adc, samples=adc.samples.reshape(10, 32, *adc.samples.shape[2:]), config=other),
                            radar_cube(adc))  # fmt: skip
    assert len(found) == 1
    assert f"probably have 16 loops, not {other.num_loops}" in found[0]


def test_another_boards_antennas():
    aop = RadarOptions(antennas=ANTENNAS["aop"]).applied(RADAR)
    adc = room(aop)
    assert implausible(adc, radar_cube(adc)) == []
    isk = RadarOptions(antennas=ANTENNAS["isk"]).applied(aop)
    as_isk = replace(adc, samples=upright(adc.samples, aop), config=isk)
    assert "--radar-set antennas=aop" in implausible(as_isk, radar_cube(as_isk))[0]


def test_a_sub_frame_is_checked_without_the_others(tmp_path: Path):
    config = replace(RADAR, frame_words_before=1000, frame_words_after=24)
    write_bin(tmp_path / "adc_data.bin", replace(room(RADAR), config=config), counts_per_unit=1.0)
    assert read(tmp_path / "adc_data.bin", config) == []
