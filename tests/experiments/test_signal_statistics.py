"""The statistics on signals whose numbers are known."""

import numpy as np
import pytest

from mmweaver.core.presets import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.experiments.signal_statistics import DEFINITIONS, simulated, statistics

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


def test_a_louder_tone_lies_higher_over_the_noise():
    quiet, loud = (statistics(adc(level * tone(40, 6) + noise())) for level in (1.0, 10.0))
    assert loud["peak_over_median_db"] - quiet["peak_over_median_db"] == pytest.approx(20, abs=1.0)
    assert loud["moving_over_median_db"] == pytest.approx(loud["peak_over_median_db"], abs=0.5)


def test_an_empty_room_holds_still():
    found = statistics(simulated(AWR1843, 0, is_empty=True))
    walked = statistics(simulated(AWR1843, 0, is_empty=False))
    assert found["moving_over_median_db"] + 20 < walked["moving_over_median_db"]
