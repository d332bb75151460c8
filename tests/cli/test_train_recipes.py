"""mmweaver train activity, then paper with its features."""

import json
from pathlib import Path

import pytest

from mmweaver.cli.main import main
from mmweaver.models.weights import load_into

pytest.importorskip("zarr")
pytest.importorskip("transformers")


def test_activity_then_paper(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data = str(tmp_path / "data")
    rooms = ["--rooms", "office,dining_room", "--layouts", "1", "--sequences", "3", "--frames", "3", "--quiet"]
    assert main(["dataset", data, *rooms]) == 0
    few = ["--data", data, "--steps", "2", "--batch", "1", "--json"]
    assert main(["train", "activity", "--out", str(tmp_path / "a"), *few]) == 0
    weights = json.loads(capsys.readouterr().out)["weights"]
    assert main(["train", "paper", "--out", str(tmp_path / "p"), "--features", weights, *few]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["steps"] == 2
    assert {"loss", "nmse_db", "energy_db"} <= set(summary["validation"])
    from mmweaver.models.paper_network import PaperNetwork

    assert load_into(PaperNetwork(), Path(summary["weights"]), recipe="paper").steps == 2


def test_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data = ["--data", str(tmp_path), "--out", str(tmp_path / "o")]
    for words, told in (
        (["train", "activity", *data], "no data set"),
        (["train", "paper", *data], "--features"),
        (["train", "activity", *data, "--start", "w"], "recipe weaver"),
    ):
        assert main(words) == 2
        error = capsys.readouterr().err.strip()
        assert told in error
        assert error.count("\n") == 0
    assert not (tmp_path / "o").exists()
