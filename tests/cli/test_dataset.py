"""mmweaver dataset on the command line."""

import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from tests.datasets.test_generate_rooms import contents

pytest.importorskip("zarr")
REFERENCE = "office,living_room,lab,kitchen,library,bedroom,dining_room,meeting_room,classroom,workshop"


def test_a_small_set_and_going_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    words = ["dataset", str(tmp_path / "d"), "--rooms", "office", "--layouts", "1", "--sequences", "1", "--frames", "3"]
    assert main([*words, "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert (shown["rooms_made"], shown["sequences_made"]) == (1, 1)
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["rooms_already_there"] == 1
    assert main(["dataset", "--config", str(tmp_path / "d" / "request.toml"), str(tmp_path / "again"), "--quiet"]) == 0
    assert contents(tmp_path / "again") == contents(tmp_path / "d")


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (["--rooms", "castle"], "unknown kind of room"),
        (["--layouts", "0"], "--layouts must be 1 to"),
        (["--frames", "0"], "--frames must be 1 to"),
        (["--radar", "x"], "x"),
        (["--workers", "0", "--dry-run"], "--workers must be 1 to"),
    ],
)
def test_bad_requests_make_nothing(words: list[str], shown: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["dataset", str(tmp_path / "d"), *words]) == 2
    assert shown in capsys.readouterr().err
    assert not (tmp_path / "d").exists()


def test_the_cost_is_printed_beforehand(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    words = [
        "dataset",
        str(tmp_path / "d"),
        *["--layouts", "10", "--sequences", "120", "--workers", "4", "--rooms"],
        REFERENCE,
    ]
    assert main([*words, "--dry-run"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("12,000 sequences in 100 rooms to generate (train ")
    assert "24.2 GB" in shown
    assert main([*words, "--dry-run", "--json", "--geometry-only"]) == 0
    cost = json.loads(capsys.readouterr().out)
    assert cost["sequences"] == sum(cost["splits"].values()) == 12_000
    assert set(cost["splits"]) == {"train", "validation", "test_room", "test_layout", "test_person", "test_activity"}
    assert cost["disk_bytes"] < 1e9
    assert not (tmp_path / "d").exists()
