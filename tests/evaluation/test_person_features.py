"""Moving points with known echoes behind them, and a seated person with known slow time."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.evaluation.person_features import behind_body, seated_slow_time
from mmweaver.evaluation.signal_evidence import CannotSeeError
from tests.evaluation.made_signals import RADAR, Point, evidence, samples, still

BREATHS_HZ, SECONDS = 0.3, 10.0
SLOW = replace(RADAR, num_loops=8, num_samples=64, num_range_bins=24, first_range_bin=0, frame_period_s=0.04)


def walking(range_m: float, amplitude: float) -> Point:
    return Point(lambda time_s: range_m + 0.9 * time_s, amplitude)


def breathing(range_m: float, amplitude: float, times: float = 1.0, tremor_m: float = 0.0) -> Point:
    def place(time_s: np.ndarray) -> np.ndarray:
        chest_m = 1e-3 * np.sin(2 * np.pi * BREATHS_HZ * time_s) + tremor_m * np.sin(2 * np.pi * 4.0 * time_s)
        return range_m + times * chest_m

    return Point(place, amplitude)


@pytest.mark.parametrize(("behind_m", "near_m", "far_m"), [(0.8, 0.6, 1.0), (1.5, 1.0, 2.0)])
def test_energy_behind_a_walking_body(behind_m: float, near_m: float, far_m: float):
    adc = samples([still(1.2, 3.0), walking(1.6, 1.0), walking(1.6 + behind_m, 0.1)], noise=0.02)
    found = behind_body(evidence(adc), near_m, far_m)
    assert found.values == pytest.approx(-20, abs=1.0)
    assert not found.at_most
    alone = behind_body(evidence(samples([walking(1.6, 1.0)], noise=0.02)), near_m, far_m)
    assert alone.at_most
    assert np.median(alone.values) < -30


def test_slow_time_of_a_seated_person():
    frames = int(SECONDS / SLOW.frame_period_s)
    tremor_m = 1e-3 * 10 ** (-23 / 20)
    adc = samples([breathing(0.9, 1.0, tremor_m=tremor_m)], frames=frames, config=SLOW, noise=0.003)
    seen = evidence(adc)
    assert seated_slow_time(seen, 3.0, 5.0).values == pytest.approx(-23, abs=1.0)
    assert np.all(seated_slow_time(seen, 7.0, 10.0).values < -33)
    with pytest.raises(CannotSeeError, match=r"12\.5 Hz"):
        seated_slow_time(seen, 11.0, 14.0)
    with pytest.raises(CannotSeeError, match="no seated person"):
        seated_slow_time(evidence(samples([still(0.9)], frames=frames, config=SLOW)), 3.0, 5.0)
    with pytest.raises(CannotSeeError, match="needs 8 s"):
        seated_slow_time(evidence(samples([breathing(0.9, 1.0)], frames=40, config=SLOW)), 3.0, 5.0)
