"""What a board does to a signal is put into samples and measured again."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.evaluation.board_features import (
    drift,
    first_chirp,
    last_of_band,
    leakage_level,
    leakage_skirt,
    leakage_spread,
    near_band,
    noise_level,
    strongest_over_noise,
)
from mmweaver.evaluation.signal_evidence import CannotSeeError
from mmweaver.signal.windows import hann
from tests.evaluation.made_signals import RADAR, evidence, samples, still

ROOM = [still(1.0), still(1.9, 0.8, 0.2), still(2.6, 0.7, -0.3), still(3.4, 0.5)]


def test_the_if_response_is_found_in_the_noise():
    adc = samples([], frames=5, noise=1.0)
    response = np.ones(RADAR.num_samples)
    response[: RADAR.num_samples // 16] = 10 ** (-3 / 20)
    response[-RADAR.num_samples // 10 :] = 10 ** (-8 / 20)
    shaped = np.fft.ifft(np.fft.fft(adc.samples, axis=-1) * response, axis=-1)
    seen = evidence(replace(adc, samples=shaped.astype(np.complex64)))
    assert np.median(last_of_band(seen).values) == pytest.approx(-8, abs=0.5)
    assert np.median(near_band(seen).values) == pytest.approx(-3, abs=0.5)


def test_noise_is_that_of_a_sample_whatever_the_number_of_loops():
    for loops in (8, 32):
        adc = samples([still(2.0, 0.5)], noise=0.1, config=replace(RADAR, num_loops=loops))
        seen = evidence(adc)
        assert np.median(noise_level(seen).values) == pytest.approx(-20, abs=0.5)  # 0.1^2 mW
        assert np.median(strongest_over_noise(seen).values) == pytest.approx(20 * np.log10(5), abs=1)
    with pytest.raises(CannotSeeError, match="scale"):
        noise_level(evidence(replace(adc, scale=float("nan"))))


def test_leakage_level_spread_and_skirt():
    adc = samples([], noise=0.1)
    gain = 10 ** (np.linspace(-20, 0, 12).reshape(3, 4, 1) / 20)
    seen = evidence(replace(adc, samples=(adc.samples + gain).astype(np.complex64)))
    noise_of_a_chirp = 0.1**2 * (hann(128) ** 2).sum() / hann(128).sum() ** 2
    expected = 10 * np.log10((gain**2).mean() / noise_of_a_chirp)
    assert np.median(leakage_level(seen).values) == pytest.approx(expected, abs=0.5)
    assert np.median(leakage_spread(seen).values) == pytest.approx(20, abs=0.5)
    assert 0.1 < np.median(leakage_skirt(seen).values) < 0.5
    echo = samples([still(0.6, 0.5)], noise=1e-4)
    near = replace(echo, samples=(echo.samples + 1).astype(np.complex64))
    fast = np.exp(2j * np.pi * np.linspace(0, 4, 128))  # a skirt that is still there where the echo begins
    with pytest.raises(CannotSeeError, match="covers"):
        leakage_skirt(evidence(replace(near, samples=(near.samples + 0.01 * fast).astype(np.complex64))))


def test_the_first_chirp_of_a_frame():
    adc = samples(ROOM, frames=8)
    changed = adc.samples.copy()
    changed[:, 0, RADAR.tx_order[0]] *= 1.005 * np.exp(2e-3j)
    percent, mrad = first_chirp(evidence(replace(adc, samples=changed)))
    assert np.mean(percent) == pytest.approx(0.5, abs=0.05)
    assert np.mean(mrad) == pytest.approx(2.0, abs=0.5)
    percent, mrad = first_chirp(evidence(adc))
    assert np.mean(percent) == pytest.approx(0, abs=0.05)


def test_drift_of_static_cells_grows_with_range():
    adc = samples(ROOM, frames=10, noise=1e-3)
    share = 1e-6 * np.linspace(-1, 1, 10)  # of the oscillator's frequency
    turned = [replace(adc, samples=_moved(share[at], at)) for at in range(10)]
    seen = evidence(replace(adc, samples=np.concatenate([one.samples for one in turned])))
    expected = 1e3 * 4 * np.pi / RADAR.wavelength_m * np.abs(share)
    assert drift(seen).values == pytest.approx(expected, rel=0.12, abs=0.1)
    assert not drift(seen).at_most
    none = drift(evidence(adc))
    assert np.median(none.values) < 0.1
    with pytest.raises(CannotSeeError, match="frames"):
        drift(evidence(samples(ROOM, frames=3)))


def _moved(share: float, frame: int) -> np.ndarray:
    """A frame of the room seen with an oscillator that is off by a share."""
    points = [still(one.range_m(np.zeros(1))[0] * (1 + share), one.amplitude, one.right) for one in ROOM]
    return samples(points, frames=1, noise=1e-3, seed=frame).samples
