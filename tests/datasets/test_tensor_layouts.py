"""Tensors of other projects, read back by readers that follow their published descriptions."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError
from mmweaver.datasets.tensor_layouts import (
    HUPR_JOINTS,
    hupr_frame,
    write_drai,
    write_hupr,
    write_mmmesh,
    write_rf_genesis,
)
from mmweaver.io.peer_arrays import read_hupr
from mmweaver.io.stored_result import StoredResult
from mmweaver.recordings.read_recording import read_recording
from mmweaver.signal.cube import radar_cube

HUPR = PRESETS["hupr"]
LIGHT_MPS = 299_792_458.0


def point_target(range_m: float, azimuth_deg: float, elevation_deg: float, velocity_mps: float) -> np.ndarray:
    """Samples (loop, tx, rx, sample) of one far point, from the equations of docs/radar_primer.md."""
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    unit = np.array([np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)])
    sample_s = HUPR.adc_start_time_s + np.arange(HUPR.num_samples) / HUPR.sample_rate_hz
    chirp_s = HUPR.idle_time_s + HUPR.ramp_end_time_s
    out = np.zeros((HUPR.num_loops, HUPR.num_tx, HUPR.num_rx, HUPR.num_samples), complex)
    for slot, tx in enumerate(HUPR.tx_order):
        for rx in range(HUPR.num_rx):
            offset_m = float(unit @ (np.array(HUPR.tx_position_m[tx]) + np.array(HUPR.rx_position_m[rx])))
            for loop in range(HUPR.num_loops):
                start_s = (loop * HUPR.num_tx + slot) * chirp_s
                delay_s = (2 * (range_m + velocity_mps * start_s) - offset_m) / LIGHT_MPS
                phase = HUPR.start_frequency_hz * delay_s + HUPR.chirp_slope_hz_per_s * delay_s * sample_s
                out[loop, tx, rx] = np.exp(2j * np.pi * phase)
    return out


def test_hupr_shows_a_point_where_it_is():
    """Range counts from far to near, both angles are reversed, Doppler rises: as HuPR's preprocessing leaves them."""
    frame = hupr_frame(point_target(2.5, 20.0, 0.0, 0.15), HUPR)
    assert frame.shape == (16, 64, 64, 8)
    doppler, range_bin, azimuth, _ = np.unravel_index(np.abs(frame).argmax(), frame.shape)
    range_m = HUPR.range_m[63 - range_bin]
    assert abs(range_m - 2.5) < 2 * HUPR.range_resolution_m
    assert (doppler - 8) * HUPR.velocity_resolution_mps == pytest.approx(0.15, abs=HUPR.velocity_resolution_mps)
    # reversed axis: index i has the spatial frequency (31 - i) / 64 of -sin(azimuth) / 2
    found = np.degrees(np.arcsin(-2 * (31 - azimuth) / 64))
    assert abs(found - 20.0) < 6.0  # without TDM compensation the azimuth is off by the motion between transmitters


def test_hupr_removes_what_does_not_move():
    assert np.abs(hupr_frame(point_target(2.5, 0.0, 0.0, 0.0), HUPR)).max() < 1e-6


def test_hupr_is_read_back(result: StoredResult, tmp_path: Path):
    """The reader inverts the angle FFTs: the antennas' range-Doppler cells come back."""
    write_hupr(result, tmp_path)
    cube = read_hupr(tmp_path / "hori", result.cube.config)
    adc = result.adc
    moving = adc.samples[0] - adc.samples[0].mean(axis=0)
    spectrum = np.fft.fftshift(np.fft.fft2(moving, axes=(0, 3)), axes=0) / (HUPR.num_samples * HUPR.num_loops)
    first = HUPR.first_range_bin
    expected = spectrum[24:40, ..., first : first + 64].transpose(3, 0, 1, 2).reshape(64, 16, 12)
    np.testing.assert_allclose(cube.values[0, :, 24:40], expected, atol=1e-5 * np.abs(expected).max())
    joints_m = np.load(tmp_path / "joints_m.npy")
    assert joints_m.shape == (4, 1, len(HUPR_JOINTS), 3)


def test_hupr_frames_are_what_its_network_takes(result: StoredResult, tmp_path: Path):
    """As HuPR's loader stacks them: 8 frames about one, 8 middle Doppler bins, parts, range, azimuth, elevation."""
    write_hupr(result, tmp_path)
    files = sorted((tmp_path / "hori").glob("*.npy"))
    about = np.clip(np.arange(-4, 4) + 1, 0, len(files) - 1)
    frames = np.stack([np.load(files[index]) for index in about])
    middle = frames[:, 4:12]
    parts = np.stack([middle.real, middle.imag], axis=2)
    assert parts.shape == (8, 8, 2, 64, 64, 8)
    assert np.ptp(parts, axis=(3, 4)).min() > 0, "a map of one value cannot be normalised"
    power = np.abs(frames) ** 2
    assert power[:, 4:12].sum() > power.sum() / 2, "most of a person's echoes have the velocities that are kept"


def test_samples_are_needed(result: StoredResult, tmp_path: Path):
    without = replace(result, folder=tmp_path)
    with pytest.raises(InputError, match="--bin"):
        write_hupr(without, tmp_path)


def test_rf_genesis_is_read_back(result: StoredResult, tmp_path: Path):
    write_rf_genesis(result, tmp_path)
    frames = np.load(tmp_path / "radar_frames.npy")
    config = result.cube.config
    assert frames.shape == (4, 3, 4, config.num_loops, config.num_samples)
    assert frames.dtype == np.complex128
    settings = json.loads((tmp_path / "TI1843_config.json").read_text())
    assert settings["slope"] == pytest.approx(config.chirp_slope_hz_per_s / 1e12)
    assert len(settings["tx_loc"]) == 3
    # the range of the strongest echo, from their settings alone
    spectrum = np.abs(np.fft.fft(frames[0].mean(axis=2), axis=-1)).sum(axis=(0, 1))[: config.num_samples // 2]
    resolution_m = LIGHT_MPS * settings["sample_rate"] * 1e3 / (2 * settings["slope"] * 1e12 * settings["adc_samples"])
    own = np.abs(radar_cube(result.adc).values[0]).sum(axis=(1, 2))
    first = config.first_range_bin
    strongest = first + spectrum[first : first + config.num_range_bins].argmax()
    assert abs(strongest * resolution_m - result.cube.grid.range_m[own.argmax()]) < 0.15


def test_mmmesh_points_and_samples(result: StoredResult, result_folder: Path, tmp_path: Path):
    write_mmmesh(result, tmp_path)
    frames = [np.load(file) for file in sorted((tmp_path / "points").glob("*.npy"))]
    assert sum(map(len, frames)) == len(result.points.frame)
    rows = np.concatenate(frames)
    assert rows.shape[1] == 6
    np.testing.assert_allclose(np.linalg.norm(rows[:, :3], axis=1), rows[:, 5])
    np.testing.assert_allclose(
        10 * np.log10(rows[:, 4]), np.sort(result.points.snr_db)[np.argsort(np.argsort(rows[:, 4]))], atol=1e-6
    )
    read = read_recording(tmp_path / "adc" / "000000.npy", result.cube.config, axes="tx,rx,loop,sample")
    assert read.adc is not None
    np.testing.assert_allclose(read.adc.samples[0], result.adc.samples[0])


def test_range_angle_images(result: StoredResult, tmp_path: Path):
    write_drai(result, tmp_path)
    (file,) = tmp_path.iterdir()
    assert file.name == "y_a-person-waves_e0_u0_p0_s0.npy"
    images = np.load(file)
    assert images.shape == (4, 32, 32)
    assert images.dtype == np.float32
    row = images.sum(axis=(0, 2)).argmax()
    range_m = result.cube.grid.range_m
    strongest_m = range_m[0] + (row + 0.5) / 32 * (range_m[-1] - range_m[0])
    nearest_m, farthest_m = (f(np.linalg.norm(result.poses[0].joints_m, axis=-1)) for f in (np.min, np.max))
    assert nearest_m - 0.2 < strongest_m < farthest_m + 0.2
