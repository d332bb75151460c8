"""mmweaver dataset --activities: a set on disk, or one line."""

import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.datasets import build_set
from mmweaver.datasets.activity_store import read_activity_set

SAMPLE = Path(__file__).resolve().parents[2] / "src" / "mmweaver" / "sample"
ACTIVITIES = '[activities]\nwave = "a person waves"\nstand = "a person stands"\n'


def test_a_room_and_a_list_become_a_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    room = tmp_path / "room"
    shutil.copytree(SAMPLE, room)
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    arguments = ["dataset", str(tmp_path / "set"), "--room", str(room), "--activities", str(tmp_path / "a.toml")]
    assert main([*arguments, "--per-class", "1", "--seconds", "2", "--iq", "none", "--json", "--quiet"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["leaks"]["verdict"].startswith("leaks")
    stored = read_activity_set(tmp_path / "set")
    assert stored.label_names == ("wave", "stand")
    assert stored.iq_scale is None
    assert len(stored) == 2


@pytest.mark.parametrize(("iq", "too_small"), [("float16", 0.6), ("none", 0.1)])
def test_a_disk_needs_room_for_the_set_and_its_parts(
    iq: str, too_small: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    """Measured while the parts are there, too; without signals most of so small a set is the room, which is once."""
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    words = ["--room", str(SAMPLE), "--activities", str(tmp_path / "a.toml"), "--per-class", "2", "--seconds", "1"]
    most: list[int] = []
    remove = build_set.remove

    def measured(folder: Path) -> None:
        most.append(sum(file.stat().st_size for file in folder.parent.rglob("*") if file.is_file()))
        remove(folder)

    with monkeypatch.context() as patch:
        patch.setattr(build_set, "remove", measured)
        assert main(["dataset", str(tmp_path / "set"), *words, "--iq", iq, "--quiet"]) == 0

    def begun(*_: object) -> None:
        raise InputError("there is room for it")

    monkeypatch.setattr(build_set.SetBuilder, "make", begun)
    for share, shown in ((too_small, "free"), (1.6, "there is room for it")):
        free = share * max(most)
        monkeypatch.setattr("shutil.disk_usage", lambda _, free=free: SimpleNamespace(free=free))
        assert main(["dataset", str(tmp_path / "other"), *words, "--iq", iq, "--quiet"]) == 2
        assert shown in capsys.readouterr().err


def test_a_dry_run_says_the_cost_and_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "a.toml").write_text(ACTIVITIES)
    words = ["dataset", str(tmp_path / "set"), "--room", str(SAMPLE), "--activities", str(tmp_path / "a.toml")]
    assert main([*words, "--per-class", "4", "--iq", "none", "--dry-run", "--json"]) == 0
    cost = json.loads(capsys.readouterr().out)
    assert cost["sequences"] == sum(cost["splits"].values()) == 8
    assert not (tmp_path / "set").exists()


@pytest.mark.parametrize(
    "options",
    [["--per-class", "3"], ["--iq", "none"], ["--activities", "missing.toml"], ["--activities", "a.toml"],
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
