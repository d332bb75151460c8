"""mmweaver train, and generate with what it wrote."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main

pytest.importorskip("zarr")
pytest.importorskip("transformers")


def test_train_then_generate(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data, run, out = str(tmp_path / "data"), tmp_path / "run", tmp_path / "woven"
    rooms = ["--rooms", "office,dining_room", "--layouts", "1", "--sequences", "3", "--frames", "3", "--quiet"]
    assert main(["dataset", data, *rooms]) == 0
    assert main(["train", "weaver", "--data", data, "--out", str(run), "--steps", "2", "--batch", "1", "--json"]) == 0
    weights = json.loads(capsys.readouterr().out)["weights"]
    words = ["generate", "--demo", "--method", "weaver", "--weights", weights, "--frames", "16", "--out", str(out)]
    assert main([*words, "--quiet"]) == 0
    with np.load(out / "radar.npz") as radar:
        assert radar["cube"].shape == (16, 64, 32, 12)
        assert np.isfinite(radar["cube"]).all()
    meta = json.loads((out / "meta.json").read_text())
    assert meta["method"] == "weaver"


def test_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    for words, told in (
        (["train", "weaver", "--data", str(tmp_path), "--out", str(tmp_path / "o")], "no data set"),
        (["generate", "--demo", "--weights", "w", "--out", str(tmp_path / "g")], "weights are for the method"),
        (["generate", "--demo", "--method", "weaver", "--weights", str(tmp_path / "no"), "--out", str(tmp_path / "g")],
         "does not exist"),
    ):  # fmt: skip
        assert main(words) == 2
        error = capsys.readouterr().err.strip()
        assert told in error
        assert error.count("\n") == 0
    assert not (tmp_path / "g").exists()
