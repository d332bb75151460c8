"""The pattern: full ahead, half the power at half the beamwidth, nothing straight up or down."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.antenna import pattern


def level_db(azimuth_deg: float, elevation_deg: float) -> float:
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    way = [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)]
    return 20 * np.log10(pattern(np.array([way]), AWR1843)[0] + 1e-12)


@pytest.mark.parametrize(
    ("azimuth_deg", "elevation_deg", "expected_db"),
    [(0, 0, 0), (28, 0, -3), (-28, 0, -3), (0, 14, -3), (0, -14, -3), (50, 0, -6), (0, 20, -6)],
)
def test_beamwidths(azimuth_deg: float, elevation_deg: float, expected_db: float):
    assert level_db(float(azimuth_deg), float(elevation_deg)) == pytest.approx(expected_db, abs=0.1)


def test_nothing_goes_straight_down_and_little_backwards():
    assert level_db(0.0, -90.0) < -100
    assert level_db(180.0, 0.0) == pytest.approx(-25, abs=0.1)
