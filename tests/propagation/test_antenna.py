"""The pattern: full ahead, half the power at half the beamwidth, nothing straight up or down."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.antenna_pattern import read_pattern
from mmweaver.core.boards import AWR1843, PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.io.radar_file import load_radar
from mmweaver.propagation.antenna import pattern, pattern_db


def level_db(azimuth_deg: float, elevation_deg: float, radar: RadarConfig = AWR1843) -> float:
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    way = [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)]
    return 20 * np.log10(pattern(np.array([way]), radar)[0] + 1e-12)


@pytest.mark.parametrize(
    ("azimuth_deg", "elevation_deg", "expected_db"),
    [(0, 0, 0), (28, 0, -3), (-28, 0, -3), (0, 14, -3), (0, -14, -3), (50, 0, -6), (0, 20, -6)],
)
def test_beamwidths(azimuth_deg: float, elevation_deg: float, expected_db: float):
    assert level_db(float(azimuth_deg), float(elevation_deg)) == pytest.approx(expected_db, abs=0.1)


def test_nothing_goes_straight_down_and_little_backwards():
    assert level_db(0.0, -90.0) < -100
    assert level_db(180.0, 0.0) == pytest.approx(-25, abs=0.1)


@pytest.mark.parametrize(
    ("board", "gain_dbi", "eirp_dbm", "azimuth_deg", "elevation_deg"),
    [("iwr6843isk", 7.0, 19.0, 60, 21), ("iwr6843aop", 5.2, 15.0, 65, 65), ("iwr6843ods", 5.0, 17.0, 60, 60)],
)
def test_boards_have_their_own_antennas(
    board: str, gain_dbi: float, eirp_dbm: float, azimuth_deg: float, elevation_deg: float
):
    """Gain, EIRP of a transmitter, and half fields of view at -6 dB, as published."""
    radar = PRESETS[board]
    assert radar.antenna_gain_dbi == gain_dbi
    assert radar.tx_power_dbm + gain_dbi == pytest.approx(eirp_dbm)
    assert level_db(azimuth_deg, 0, radar) == pytest.approx(-6, abs=0.1)
    for side in (-1, 1):
        assert level_db(0, side * elevation_deg, radar) == pytest.approx(-6, abs=0.1)


def test_an_aop_pitched_by_45_degrees_loses_what_its_pattern_says():
    """cos^1.6 of 45 degrees: 2.4 dB one way; an xWR1843 there shows its side lobes alone."""
    assert level_db(0, 45, PRESETS["iwr6843aop"]) == pytest.approx(16 * np.log10(np.cos(np.radians(45))), abs=0.05)
    assert level_db(0, 45) < -20


def test_a_pattern_of_ones_own(tmp_path: Path):
    file = tmp_path / "antenna.csv"
    file.write_text("azimuth,elevation,dB\n-60,0,-8\n0,0,6\n60,0,-4\n0,-30,3\n0,30,0\n")
    radar = load_radar(f"awr1843#pattern={file}")
    assert level_db(30, 0, radar) == pytest.approx(-5)  # half way from 6 to -4 dB
    assert level_db(-60, 30, radar) == pytest.approx(-14 - 6)
    assert RadarConfig.from_json(radar.to_json()) == radar
    way = np.array([[0.3, 0.9, 0.2], [-0.5, 0.8, -0.1]])
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    assert pattern_db(torch.from_numpy(way), radar).numpy() == pytest.approx(pattern_db(way, radar))
    for text, why in (("0,0,0\n10,0,-1\n0,10,-1\n10,10\n", "line 4"), ("0,0,0\n10,5,-1\n", "holes"), ("", "pattern")):
        file.write_text(text)
        with pytest.raises(InputError, match=why):
            read_pattern(file)
    with pytest.raises(InputError, match="holes"):
        replace(AWR1843, antenna_pattern=((0.0, 0.0, 0.0), (10.0, 5.0, -1.0)))


def test_the_awr2944_samples_real_values():
    radar = PRESETS["awr2944evm"]
    assert not radar.complex_samples
    assert radar.num_unambiguous_range_bins == radar.num_samples // 2 == radar.num_range_bins
    assert radar.max_range_m == pytest.approx(PRESETS["xwr1443boost"].max_range_m, rel=1e-6)
