"""Radars by name or file, and their table."""

from pathlib import Path

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
