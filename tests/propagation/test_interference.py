"""Another FMCW radar: where its chirps cross, how strong, and from which direction."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver import Weaver
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.targets import Interferer
from mmweaver.propagation.interference import IF_SHARE, InterfererChirps, interference

ONE = Interferer(place_m=(0.6, 3.0, 0.0))


def samples(one: Interferer = ONE, seed: int = 3) -> np.ndarray:
    return interference((one,), RadarPose(), AWR1843, np.arange(2), seed)


def test_bursts_last_as_long_as_the_difference_of_slopes_stays_in_the_band():
    """2 x 0.45 sample rates over the difference of slopes, at the level of Friis' equation."""
    burst = np.abs(samples()[..., 0, :])  # (frame, loop, tx, sample)
    chirps = InterfererChirps.sampled(AWR1843, 3)
    band_hz = 2 * IF_SHARE * AWR1843.sample_rate_hz
    expected = band_hz / abs(chirps.slope_hz_per_s - AWR1843.chirp_slope_hz_per_s) * AWR1843.sample_rate_hz
    lengths = (burst > 0.7 * burst.max()).sum(axis=-1)
    assert np.median(lengths[lengths > 0]) == pytest.approx(min(expected, 256), rel=0.35)
    assert 0.05 < (lengths > 0).mean() < 1
    distance_m = float(np.linalg.norm(ONE.place_m))
    friis_dbm = 22.5 + 10.5 + 20 * np.log10(AWR1843.wavelength_m / (4 * np.pi * distance_m))
    assert friis_dbm - 4 < 20 * np.log10(burst.max()) < friis_dbm  # minus the pattern at 11 degrees


def test_it_comes_from_its_direction_one_way():
    burst = samples()
    row = np.asarray(AWR1843.rx_position_m)[:, 0]
    strong = np.abs(burst[..., 0, :]) > 0.5 * np.abs(burst).max()
    phase = np.angle((burst[..., 1, :] * burst[..., 0, :].conj())[strong].sum())
    sine = -phase * AWR1843.wavelength_m / (2 * np.pi * (row[1] - row[0]))
    assert sine == pytest.approx(0.6 / np.hypot(0.6, 3.0), abs=0.01)


def test_real_samples_are_real_and_chirps_differ_by_seed():
    real = interference((ONE,), RadarPose(), replace(AWR1843, complex_samples=False), np.arange(1), 0)
    assert np.abs(real).max() > 0
    assert not real.imag.any()
    assert not np.array_equal(samples(seed=1), samples(seed=2))


@pytest.mark.parametrize("method", ["physics", "weaver"])
def test_it_raises_the_floor_of_cubes(method: str):
    weaver = Weaver(method=method)
    room = weaver.sample_room()
    floors = []
    for interferers in ((), (ONE,)):
        cube = weaver.generate(room, "nobody", frames=1, seed=0, board="ideal", interferers=interferers).cube.values
        floors.append(np.median(np.abs(cube[0, :, 3:8]) ** 2))
    assert 10 * np.log10(floors[1] / floors[0]) > 10


@pytest.mark.parametrize("words", ["1,2", "0,0,0", "1,2,3,99", "a,b,c"])
def test_wrong_interferers_are_refused(words: str):
    with pytest.raises(InputError):
        Interferer.of_words(words)
