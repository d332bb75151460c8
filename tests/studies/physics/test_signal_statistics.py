"""The statistics on signals whose numbers are known."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.records import AdcCube
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.signal.cube import radar_cube
from studies.physics.signal_statistics import (
    DEFINITIONS,
    antenna_phase_deg,
    quarters,
    recorded_breath,
    rows,
    slow_frame,
    statistics,
    walker,
)  # fmt: skip

SHAPE = (1, 32, 3, 4, 256)


def adc(samples: np.ndarray) -> AdcCube:
    return AdcCube(samples=np.ascontiguousarray(samples, np.complex64), config=AWR1843, scale=1.0)


def noise(seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.normal(size=SHAPE) + 1j * rng.normal(size=SHAPE)


def tone(range_bin: float, doppler_bin: float) -> np.ndarray:
    sample, loop = np.arange(256), np.arange(32)
    wave = np.exp(2j * np.pi * range_bin * sample / 256) * np.exp(2j * np.pi * doppler_bin * loop / 32)[:, None]
    return np.broadcast_to(wave[None, :, None, None, :], SHAPE)


def test_what_rests_is_static_and_what_moves_is_not():
    assert statistics(adc(tone(40, 0) + 1e-3 * noise()))["static_share"] == pytest.approx(1, abs=1e-3)
    assert statistics(adc(tone(40, 6) + 1e-3 * noise()))["static_share"] == pytest.approx(0, abs=1e-2)


def test_noise_alone_is_flat():
    found = statistics(adc(noise()))
    assert set(found) == set(DEFINITIONS)
    assert abs(found["floor_slope_db"]) < 0.5
    assert found["peak_over_median_db"] < 6
    assert 0.03 < found["top_1_percent"] < 0.08
    assert found["doppler_spread_mps"] > 7


def test_phases_of_a_board_are_found_whatever_the_angle():
    row = azimuth_row(AWR1843.antenna_position_m, AWR1843.wavelength_m)
    place = np.asarray(AWR1843.antenna_position_m)
    wave = np.exp(2j * np.pi / AWR1843.wavelength_m * 0.3 * place[:, 0])
    wrong_deg = np.zeros(len(place))
    wrong_deg[row] = 8 * (-1.0) ** np.arange(len(row))
    still = tone(40, 0)

    def found(phase_deg: np.ndarray) -> float:
        antennas = (wave * np.exp(1j * np.radians(phase_deg))).reshape(1, 1, 3, 4, 1)
        degrees = antenna_phase_deg(radar_cube(adc(still * antennas)))
        assert degrees is not None
        return degrees

    assert found(np.zeros(len(place))) < 1.2  # cells beside the peak are turned back for a speed that is none
    assert found(wrong_deg) == pytest.approx(8, abs=0.7)


def test_quarters_are_the_frame_in_four():
    whole = adc(tone(40, 8) + 0.1 * noise())
    parts = quarters(whole)
    assert [part.samples.shape[1] for part in parts] == [8] * 4
    assert np.array_equal(np.concatenate([part.samples for part in parts], axis=1), whole.samples)
    assert statistics(parts[0])["static_share"] == pytest.approx(0, abs=0.1)


def test_frames_become_loops():
    samples = np.arange(5)[:, None, None, None, None] * np.ones((5, 8, 1, 3, 64), np.complex64)
    one = slow_frame(AdcCube(samples=samples.astype(np.complex64), config=BGT60, scale=1.0))
    assert one.samples.shape == (1, 5, 1, 3, 64)
    assert one.config.loop_period_s == pytest.approx(BGT60.frame_period_s)
    assert np.array_equal(one.samples[0, :, 0, 0, 0].real, np.arange(5))


def test_rows_hold_the_spread_of_both():
    recording = walker(AWR1843, 3)
    real, made = rows("a walker", recording, walker, (0, 1))
    assert real["metrics"].keys() == made["metrics"].keys() == DEFINITIONS.keys()
    one = made["metrics"]["peak_over_median_db"]
    assert one["lowest_highest"][0] <= one["value"] <= one["lowest_highest"][1]
    assert real["metrics"]["static_share"]["quarters"][0] < real["metrics"]["static_share"]["quarters"][1]


def test_the_recorded_breath_is_slow(real_data: Path):
    found = statistics(recorded_breath(real_data))
    assert found["doppler_spread_mps"] < 0.05
    assert found["static_share"] > 0.9
    assert "antenna_phase_deg" not in found  # its row has two antennas
