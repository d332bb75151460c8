from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import HUPR, MMMESH, RF_GENESIS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.io.peer_arrays import detect_layout, read_cubelearn, read_hupr, read_mmmesh, read_rf_genesis
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.recordings.read_recording import read_recording
from tests.compression.echoes import direction_of, middle_s


def simulated_frame(config: RadarConfig = HUPR, azimuth_rad: float = 0.3) -> np.ndarray:
    """ADC samples (loop, tx, rx, sample) of one moving point, transmitters in the order of the configuration."""
    towards = direction_of(azimuth_rad, 0.1)

    def position(time_s: np.ndarray) -> np.ndarray:
        return (towards * (2.5 + 0.15 * (time_s[:, None] - middle_s(config))))[None]

    return exact_frame(position, np.ones(1, complex), config)


def hupr_array(adc: np.ndarray) -> np.ndarray:
    """HuPR's own processing of a frame, step by step as documented."""
    loops, _, _, samples = adc.shape
    adc = adc - adc.mean(axis=0)
    spectrum = np.fft.fft(np.fft.fft(adc, axis=3), axis=0)
    angles = np.zeros((loops, samples, 64, 8), complex)
    angles[:, :, 0:4, 0] = spectrum[:, 0].transpose(0, 2, 1)
    angles[:, :, 4:8, 0] = spectrum[:, 2].transpose(0, 2, 1)
    angles[:, :, 2:6, 1] = spectrum[:, 1].transpose(0, 2, 1)
    angles[:, :, 2:6] = np.fft.fft(angles[:, :, 2:6], axis=3)
    angles = np.fft.fft(angles, axis=2)[:, list(range(94, 30, -1))]
    angles = np.fft.fftshift(angles, axes=(0, 2, 3))[24:40]
    return np.flip(angles, axis=(2, 3))


@pytest.fixture
def hupr_frame(tmp_path: Path) -> Path:
    np.save(tmp_path / "000000000.npy", hupr_array(simulated_frame()))
    return tmp_path / "000000000.npy"


def test_hupr_angle_spectra_are_inverted(hupr_frame: Path):
    """The antennas' range-Doppler spectra are restored in the middle 16 of 64 Doppler bins."""
    adc = simulated_frame()
    spectrum = np.fft.fftshift(np.fft.fft(np.fft.fft(adc - adc.mean(axis=0), axis=3), axis=0), axes=0)
    wanted = spectrum[..., 31:95].transpose(3, 0, 1, 2).reshape(64, 64, 12) / (64 * 256)
    cube = read_hupr(hupr_frame, HUPR)
    assert cube.values.shape == (1, 64, 64, 12)
    assert np.abs(cube.values[0, :, 24:40] - wanted[:, 24:40]).max() < 1e-5 * np.abs(wanted).max()
    assert not cube.values[0, :, :24].any()


def test_a_hupr_frame_shows_the_point_at_its_place(hupr_frame: Path):
    cube = read_recording(hupr_frame).cube
    assert cube.config == HUPR
    power = np.sum(np.abs(cube.values[0]) ** 2, axis=-1)
    r, d = np.unravel_index(power.argmax(), power.shape)
    assert cube.grid.range_m[r] == pytest.approx(2.5, abs=HUPR.range_resolution_m)
    assert cube.grid.radial_velocity_mps[d] == pytest.approx(0.15, abs=HUPR.velocity_resolution_mps)
    row = cube.values[0, r, d]
    azimuth_row = np.concatenate([row[:4], row[8:]])
    step = np.angle(np.vdot(azimuth_row[:-1], azimuth_row[1:]))
    # half a wavelength from antenna to antenna
    assert step == pytest.approx(-np.pi * direction_of(0.3, 0.1)[0], abs=0.05)


def test_mmmesh_samples_in_either_shape(tmp_path: Path):
    rng = stream(0, "mmmesh")
    frames = (rng.normal(size=(2, 3, 4, 128, 256)) + 1j * rng.normal(size=(2, 3, 4, 128, 256))).astype(np.complex64)
    np.save(tmp_path / "two.npy", frames)
    np.save(tmp_path / "one.npy", frames[1])
    two, one = read_mmmesh(tmp_path / "two.npy", MMMESH), read_mmmesh(tmp_path / "one.npy", MMMESH)
    assert np.array_equal(two.samples[1:], one.samples)
    # the second to fire is transmitter 2
    assert np.array_equal(one.samples[0, :, 2], frames[1, 1].transpose(1, 0, 2))
    assert read_recording(tmp_path / "one.npy", layout="mmmesh").cube.values.shape == (1, 101, 128, 12)


def test_rf_genesis_has_its_own_timing(tmp_path: Path):
    """Chirps over the whole frame, all transmitters at once: a point that moves shows its speed and its angle."""
    config = replace(RF_GENESIS, idle_time_s=0.1 / 128 / 3 - RF_GENESIS.ramp_end_time_s)
    towards, velocity_mps = direction_of(0.3, 0.0), 0.4
    chirp_s = 0.1 / 128 * np.arange(128)
    range_m = 2.5 + velocity_mps * (chirp_s[:, None] - 0.05)
    sample_s = np.arange(256) / config.sample_rate_hz
    delay_s = 2 * range_m / 299_792_458
    beat = np.exp(2j * np.pi * (77e9 * delay_s + 60.012e12 * delay_s * (sample_s + config.adc_start_time_s)))
    lag = np.exp(-2j * np.pi / config.wavelength_m * (config.antenna_position_m @ towards)).reshape(3, 4)[[0, 2, 1]]
    np.save(tmp_path / "radar_frames.npy", lag[None, :, :, None, None] * beat[None, None, None])
    adc = read_rf_genesis(tmp_path / "radar_frames.npy", RF_GENESIS)
    assert adc.config.loop_period_s == pytest.approx(0.1 / 128)
    cube = read_recording(tmp_path / "radar_frames.npy", layout="rf_genesis").cube
    power = np.sum(np.abs(cube.values[0]) ** 2, axis=-1)
    r, d = np.unravel_index(power.argmax(), power.shape)
    assert cube.grid.range_m[r] == pytest.approx(2.5, abs=config.range_resolution_m)
    assert cube.grid.radial_velocity_mps[d] == pytest.approx(velocity_mps, abs=cube.config.velocity_resolution_mps)
    heard = cube.values[0, r, d] * lag[[0, 2, 1]].conj().ravel()
    assert np.abs(np.angle(heard / heard[0])).max() < 0.05


def test_refusals_are_clear(tmp_path: Path, hupr_frame: Path):
    def saved(name: str, values: np.ndarray) -> Path:
        np.save(tmp_path / name, values)
        return tmp_path / name

    noise = stream(1, "noise").normal(size=(16, 64, 64, 8)).astype(complex)
    (tmp_path / "empty").mkdir()
    for call, word in (
        (lambda: read_hupr(saved("a.npy", noise), HUPR), "angle spectra"),
        (lambda: read_hupr(saved("b.npy", noise.real), HUPR), r"float64.*\(16, 64, 64, 8\)"),
        (lambda: read_hupr(hupr_frame, MMMESH), "cannot have made"),
        (lambda: read_hupr(tmp_path / "empty", HUPR), "no .npy files"),
        (lambda: read_hupr(tmp_path / "none.npy", HUPR), "cannot read"),
        (lambda: detect_layout(saved("c.npy", np.zeros((5, 3, 4, 128, 256), np.complex64))), "--layout mmmesh"),
        (lambda: detect_layout(saved("d.npy", np.zeros((40, 6)))), r"\(40, 6\)"),
        (lambda: detect_layout(saved("e.npy", np.zeros((4, 5)))), "--layout"),
        (lambda: read_mmmesh(saved("f.npy", np.zeros((3, 4, 7, 256), complex)), MMMESH), "shape"),
        (lambda: read_recording(hupr_frame, layout="hupr", axes="loop,tx,rx,sample"), "not both"),
        (lambda: read_recording(hupr_frame, layout="nobody"), "not both"),
        (lambda: read_recording(tmp_path / "adc_data.bin"), "does not exist"),
    ):
        with pytest.raises(InputError, match=word):
            call()


def test_cubelearn(tmp_path: Path):
    """Real numbers, I and then Q; transmitters in firing order."""
    rng = np.random.default_rng(0)
    shape = (1, 128, 3, 4, 256)  # (frame, loop, slot, rx, sample)
    samples = rng.integers(-99, 99, shape) + 1j * rng.integers(-99, 99, shape)
    stored = np.stack([samples.real, samples.imag]).reshape(2, 1, 128, 12, 256)
    np.save(tmp_path / "sample.npy", stored.astype(np.int16))
    adc = read_cubelearn(tmp_path / "sample.npy", MMMESH)
    assert np.array_equal(adc.samples[:, :, list(MMMESH.tx_order)], samples.astype(np.complex64))
    assert detect_layout(tmp_path / "sample.npy") == "cubelearn"
    with pytest.raises(InputError, match="loop 64"):
        read_cubelearn(tmp_path / "sample.npy", replace(MMMESH, num_loops=64))
    with pytest.raises(InputError, match="--radar"):
        read_recording(tmp_path / "sample.npy")
