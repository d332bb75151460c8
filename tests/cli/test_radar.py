"""mmweaver radar prints what people and --radar read."""

import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from mmweaver.core.boards import PRESETS
from mmweaver.core.radar_config import RadarConfig


@pytest.mark.parametrize("name", list(PRESETS))
def test_the_json_is_the_radar_again(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["radar", name, "--json"]) == 0
    text = capsys.readouterr().out
    assert RadarConfig.from_json(text) == PRESETS[name]
    (tmp_path / "radar.json").write_text(text)
    assert main(["radar", str(tmp_path / "radar.json"), "--json"]) == 0
    assert capsys.readouterr().out == text


def test_people_read_resolutions_and_limits(capsys: pytest.CaptureFixture[str]):
    assert main(["radar", "awr1843"]) == 0
    text = capsys.readouterr().out
    for word in ("4.40 cm", "0.274 m/s", "4.39 m/s", "12 virtual antennas"):
        assert word in text


def test_without_a_radar_every_preset_is_listed(capsys: pytest.CaptureFixture[str]):
    assert main(["radar"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[1:]] == list(PRESETS)
    assert main(["radar", "--json"]) == 0
    presets = json.loads(capsys.readouterr().out)
    assert {name: RadarConfig.from_json(json.dumps(one)) for name, one in presets.items()} == dict(PRESETS)


def test_a_chosen_range_is_part_of_the_radar(capsys: pytest.CaptureFixture[str]):
    assert main(["radar", "awr1843", "--range", "0.3,8", "--json"]) == 0
    config = RadarConfig.from_json(capsys.readouterr().out)
    assert (config.first_range_bin, config.num_range_bins) == (7, 176)
    assert main(["radar", "awr1843", "--range", "0.3,80"]) == 2
    assert "11.2" in capsys.readouterr().err


def test_an_unknown_radar_lists_the_known(capsys: pytest.CaptureFixture[str]):
    assert main(["radar", "nope"]) == 2
    assert "awr1843" in capsys.readouterr().err
