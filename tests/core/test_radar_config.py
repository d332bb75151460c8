"""Every resolution and limit follows from the chirp; an impossible radar is refused with the reason."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, HUPR, MMMESH, PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig


def test_the_papers_radar():
    assert AWR1843.range_resolution_m == pytest.approx(0.044, abs=5e-5)
    assert (AWR1843.num_range_bins, AWR1843.num_loops, AWR1843.num_antennas) == (64, 32, 12)
    assert AWR1843.loop_period_s == pytest.approx(216e-6)
    assert AWR1843.max_velocity_mps == pytest.approx(4.39, abs=0.01)
    assert AWR1843.velocity_resolution_mps == pytest.approx(0.274, abs=0.001)


def test_published_figures_of_the_peers():
    assert MMMESH.range_resolution_m == pytest.approx(0.04293, abs=1e-5)
    assert MMMESH.max_range_m == pytest.approx(10.99, abs=0.01)
    assert HUPR.range_resolution_m == pytest.approx(0.04357, abs=1e-5)
    assert HUPR.range_m[[0, -1]] == pytest.approx([1.35, 4.10], abs=0.01)


def test_virtual_array_of_the_1843_is_eight_and_four_elevated():
    half_m = AWR1843.wavelength_m / 2
    places = np.round(AWR1843.antenna_position_m / half_m).astype(int)
    x, z = places[:, 0] - places[:, 0].min(), places[:, 2]
    assert sorted(x[z == 0]) == list(range(8))
    assert sorted(x[z == 1]) == [2, 3, 4, 5]
    assert np.allclose(AWR1843.antenna_position_m, places * half_m)


def test_the_elevated_transmitter_fires_last():
    assert AWR1843.tx_delay_s == pytest.approx([0, 144e-6, 72e-6])


@pytest.mark.parametrize("name", list(PRESETS))
def test_json_gives_the_same_radar_back(name: str):
    assert RadarConfig.from_json(PRESETS[name].to_json()) == PRESETS[name]


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"num_samples": 512}, "ramp ends"),
        ({"num_loops": 1000}, "frame period"),
        ({"chirp_slope_hz_per_s": 120e12}, "GHz"),
        ({"tx_order": (0, 1, 1)}, "tx_order"),
        ({"first_range_bin": 200}, "range bins"),
        ({"sample_rate_hz": float("nan")}, "sample_rate_hz"),
        ({"num_loops": 0}, "num_loops"),
        ({"idle_time_s": -1e-6}, "idle_time_s must be 0 to"),
        ({"rx_position_m": ()}, "receiver"),
        ({"antenna_gain_dbi": 90.0}, "antenna_gain_dbi must be"),
        ({"antenna_gain_dbi": -90.0}, "antenna_gain_dbi must be"),
        ({"noise_figure_db": 200.0}, "noise_figure_db must be"),
        ({"rx_gain_db": 300.0}, "rx_gain_db must be"),
        ({"tx_power_dbm": 200.0}, "tx_power_dbm must be"),
        ({"azimuth_beamwidth_deg": 400.0}, "azimuth_beamwidth_deg must be"),
        ({"frequency_limits_hz": (76e9, float("inf"))}, "frequency_limits_hz"),
        ({"frequency_limits_hz": (float("-inf"), 81e9)}, "frequency_limits_hz"),
        ({"frequency_limits_hz": (float("nan"), 81e9)}, "frequency_limits_hz"),
    ],
)
def test_an_impossible_radar_is_refused(change: dict, word: str):
    with pytest.raises(InputError, match=word):
        replace(AWR1843, **change)


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"schema_version": 99}', AWR1843.to_json().replace('"name"', '"nom"')]
)
def test_a_foreign_radar_file_is_refused(text: str):
    with pytest.raises(InputError):
        RadarConfig.from_json(text)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("frequency_limits_hz", [76e9]), ("tx_position_m", [[0.0, 0.0]]), ("tx_code", [[[1.0, 0.0, 0.0]]]),
        ("num_loops", 16.0), ("complex_samples", 1), ("name", 3), ("tx_order", "012"), ("idle_time_s", "7e-6"),
    ],
)  # fmt: skip
def test_a_value_of_another_type_is_refused_by_name(name: str, value: object):
    with pytest.raises(InputError, match=f"{name} cannot be"):
        RadarConfig.from_values({**AWR1843.to_values(), name: value})


def test_an_unknown_preset_lists_the_known():
    with pytest.raises(InputError, match="awr1843"):
        PRESETS["nope"]
