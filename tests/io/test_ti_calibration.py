"""A board's channel errors are compensated in recordings, and put into simulated samples."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.io.dca1000 import bytes_of_frame, write_bin
from mmweaver.io.radar_file import load_radar
from mmweaver.io.ti_calibration import read_ti_calibration
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.recordings.read_recording import read_recording
from mmweaver.signal.cube import radar_cube
from tests.captures import CFG, radar_of_cfg

BIAS_M = 0.09


def factors() -> np.ndarray:
    """Of all twelve pairs of the board; two transmitters fire."""
    rng = np.random.default_rng(5)
    return (rng.uniform(0.8, 1.2, 12) * np.exp(1j * rng.uniform(-2, 2, 12))).round(5)


def cfg_with(tmp_path: Path, pairs: np.ndarray, bias_m: float = BIAS_M) -> Path:
    numbers = " ".join(f"{one.real:.5f} {one.imag:.5f}" for one in pairs)
    path = tmp_path / "board.cfg"
    path.write_text(CFG.replace("sensorStart", f"compRangeBiasAndRxChanPhase {bias_m} {numbers}\nsensorStart"))
    return path


def test_pairs_of_the_transmitters_that_fire(tmp_path: Path):
    calibration = read_ti_calibration(str(cfg_with(tmp_path, factors())))
    assert np.allclose(calibration.factors, factors().reshape(3, 4)[[0, 2]])
    assert calibration.range_bias_m == BIAS_M


def centre_m(cube: RadarCube) -> float:
    """Where the energy of the strongest range bins lies."""
    power = (np.abs(cube.values[0, :, cube.config.num_loops // 2]) ** 2).sum(axis=1)
    near = np.abs(cube.grid.range_m - cube.grid.range_m[power.argmax()]) < 0.5
    return float((power * cube.grid.range_m)[near].sum() / power[near].sum())


def test_a_recorded_point_is_where_it_is_and_a_plane_wave(tmp_path: Path):
    """A board that measures 9 cm too far with unequal channels; its .cfg makes it right."""
    path, config = cfg_with(tmp_path, factors()), radar_of_cfg(tmp_path)
    place = np.array([0.3, 1.4, 0.0])
    samples = exact_frame(lambda t: np.broadcast_to(place, (1, len(t), 3)), np.array([1000.0 + 0j]), config)[None]
    ideal = AdcCube(samples=samples.astype(np.complex64), config=config, scale=float("nan"))
    board = read_ti_calibration(str(path)).recorded(ideal)
    write_bin(tmp_path / "adc_data.bin", board, counts_per_unit=1.0)
    raw = read_recording(tmp_path / "adc_data.bin", tmp_path / "made.cfg").cube
    mended = read_recording(tmp_path / "adc_data.bin", path)
    truth = radar_cube(ideal)
    assert centre_m(raw) - centre_m(truth) == pytest.approx(BIAS_M, abs=0.01)
    assert centre_m(mended.cube) == pytest.approx(centre_m(truth), abs=0.005)
    error = np.linalg.norm(mended.adc.samples - ideal.samples) / np.linalg.norm(ideal.samples)
    assert error < 2e-3  # whole counts
    assert mended.calibration is not None


def test_an_aop_whose_line_turns_receivers_is_turned_once(tmp_path: Path):
    """TI's visualizer writes 1 0 -1 0 for the AOP; people tracking writes ones, and antPhaseRot."""
    places = "antGeometry0 -1 -1 0 0 -3 -3 -2 -2 -1 -1 0 0\nantGeometry1 -1 0 -1 0 -3 -2 -3 -2 -3 -2 -3 -2\n"
    tracking = f"{places}antPhaseRot 1 -1 1 -1 1 -1 1 -1 1 -1 1 -1\nsensorStart"
    turns = np.tile([1, -1], 6)
    for pairs, more in (
        (turns, "% Platform:xWR68xx_AOP"),
        (np.ones(12), "% Platform:xWR68xx_AOP"),
        (np.ones(12), tracking),
    ):
        path = cfg_with(tmp_path, pairs, 0.0)
        path.write_text(f"{more.splitlines()[0]}\n" + path.read_text().replace("sensorStart", more))
        config = load_radar(str(path))
        assert config.rx_inverted == (1, 3)
        words = np.full(bytes_of_frame(config) // 2, 100, "<i2")  # the converter's counts
        words.tofile(tmp_path / "adc_data.bin")
        samples = read_recording(tmp_path / "adc_data.bin", path).adc.samples
        assert np.array_equal(samples[0, 0, 0, :, 0].real, [100, -100, 100, -100])


def test_nothing_to_compensate(tmp_path: Path):
    assert read_ti_calibration("awr1843") is None
    assert read_ti_calibration(str(cfg_with(tmp_path, np.ones(12), 0.0))) is None
    (tmp_path / "plain.cfg").write_text(CFG)
    assert read_ti_calibration(str(tmp_path / "plain.cfg")) is None
    with pytest.raises(InputError, match="needs 12"):
        read_ti_calibration(str(cfg_with(tmp_path, factors()[:8])))
    without = factors()
    without[0] = 0.0
    with pytest.raises(InputError, match="factor of zero"):
        read_ti_calibration(str(cfg_with(tmp_path, without)))


def test_the_inverse_is_exact(tmp_path: Path):
    calibration = read_ti_calibration(str(cfg_with(tmp_path, factors())))
    config = replace(radar_of_cfg(tmp_path), num_loops=2)
    rng = np.random.default_rng(0)
    shape = (1, 2, 2, 4, config.num_samples)
    samples = (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)).astype(np.complex64)
    adc = AdcCube(samples=samples, config=config, scale=1.0)
    assert np.allclose(calibration.compensated(calibration.recorded(adc)).samples, samples, atol=1e-5)
