"""Radars by name or file, and their table."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, PRESETS
from mmweaver.core.errors import InputError
from mmweaver.io.radar_file import describe_radar, load_radar


@pytest.mark.parametrize("name", list(PRESETS))
def test_presets_and_their_json(tmp_path: Path, name: str):
    assert load_radar(name) is PRESETS[name]
    path = tmp_path / "mine.JSON"
    path.write_text(PRESETS[name].to_json())
    assert load_radar(str(path)) == PRESETS[name]


@pytest.mark.parametrize("name", ["awr1834", "", "none.cfg", "none.json", "/"])
def test_the_error_of_an_unknown_name_lists_the_known_ones(name: str):
    with pytest.raises(InputError, match=", ".join(PRESETS)):
        load_radar(name)


def test_the_error_of_another_file_lists_the_formats(tmp_path: Path):
    (tmp_path / "radar.xml").write_text("<radar/>")
    with pytest.raises(InputError, match=r"\.cfg nor \.json"):
        load_radar(str(tmp_path / "radar.xml"))


def test_the_table_of_the_papers_radar():
    text = describe_radar(AWR1843)
    for fact in (
        "77.000 to 80.901 GHz", "60.012 MHz/us", "256 complex at 4.510 Msps", "3 TX x 4 RX = 12", "0, 2, 1",
        "14.3 deg", "4.40 cm", "up to 11.26 m", "0.70 to 3.48 m (bins 16 to 79)", "0.274 m/s", "+-4.39 m/s",
        "64 range x 32 Doppler x 12 antennas", "elevation                  yes", "10.00 per second",
    ):  # fmt: skip
        assert fact in text


def test_a_configuration_of_rf_genesis_that_we_write_is_the_same_radar(tmp_path: Path):
    from mmweaver.core.boards import MMMESH
    from mmweaver.datasets.tensor_layouts import rf_genesis_settings

    (tmp_path / "TI1843_config.json").write_text(json.dumps(rf_genesis_settings(MMMESH)))
    read = load_radar(str(tmp_path / "TI1843_config.json"))
    for name in ("start_frequency_hz", "chirp_slope_hz_per_s", "num_samples", "sample_rate_hz", "num_loops"):
        assert getattr(read, name) == pytest.approx(getattr(MMMESH, name)), name
    fired = np.array(MMMESH.tx_position_m)[list(MMMESH.tx_order)]
    assert np.allclose(np.array(read.tx_position_m), fired, atol=2e-5)


def test_json_of_something_else_is_named(tmp_path: Path):
    (tmp_path / "package.json").write_text('{"name": "x"}')
    with pytest.raises(InputError, match=r"no radar that is known.*Infineon"):
        load_radar(str(tmp_path / "package.json"))
