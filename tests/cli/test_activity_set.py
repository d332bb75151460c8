"""mmweaver dataset --activities: a set on disk, or one line."""

import json
import shutil
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from mmweaver.datasets.activity_store import read_activity_set

SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"
ACTIVITIES = '[activities]\nwave = "a person waves"\nstand = "a person stands"\n'


def test_a_room_and_a_list_become_a_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    room = tmp_path / "room"
    shutil.copytree(SAMPLE, room)
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    arguments = ["dataset", str(tmp_path / "set"), "--room", str(room), "--activities", str(tmp_path / "a.toml")]
    assert main([*arguments, "--each", "1", "--seconds", "2", "--iq", "none", "--json", "--quiet"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["leaks"]["verdict"].startswith("leaks")
    stored = read_activity_set(tmp_path / "set")
    assert stored.label_names == ("wave", "stand")
    assert stored.iq_scale is None
    assert len(stored) == 2


def test_a_dry_run_says_the_cost_and_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    words = ["dataset", str(tmp_path / "set"), "--room", str(SAMPLE), "--activities", str(tmp_path / "a.toml")]
    assert main([*words, "--each", "4", "--iq", "none", "--dry-run", "--json"]) == 0
    cost = json.loads(capsys.readouterr().out)
    assert cost["sequences"] == sum(cost["splits"].values()) == 8
    assert not (tmp_path / "set").exists()


@pytest.mark.parametrize(
    "options",
    [["--each", "3"], ["--iq", "none"], ["--activities", "missing.toml"], ["--activities", "a.toml"],
     ["--activities", "a.toml", "--room", "missing"], ["--activities", "a.toml", "--rgb", "rgb.png"],
     ["--activities", "a.toml", "--geometry-only"], ["--from-results", "results", "--layouts", "3"]],
)  # fmt: skip
def test_what_is_missing_is_said(
    options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    monkeypatch.chdir(tmp_path)
    assert main(["dataset", "set", *options]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "set").exists()
