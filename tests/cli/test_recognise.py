"""mmweaver recognise: train, score and run from the command line."""

import io
import json
import sys
from pathlib import Path

import pytest

pytest.importorskip("sklearn")

from mmweaver.cli.main import main
from mmweaver.cli.recognise_text import confused_lines
from mmweaver.recognition import train_recogniser as training
from mmweaver.recognition.recogniser import load_recogniser
from tests.recognition.small_recogniser import drawn_sequences, write_recordings
from tests.recognition.test_train_recogniser import TASK


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    """Trained on drawn sequences."""
    monkeypatch.setattr(
        training, "generate_sequences", lambda recipe, each, *_: drawn_sequences(recipe.task.recordings, each)
    )
    (tmp_path / "task.toml").write_text(TASK.format(more=""))
    words = ["recognise", "train", str(tmp_path / "task.toml"), "--out", str(tmp_path / "model"), "--sequences", "4"]
    assert main(words) == 0
    assert "generated people held out" in capsys.readouterr().out
    return tmp_path / "model"


def test_train_score_and_run(model: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch):
    people = drawn_sequences(load_recogniser(model).settings, 2, first=30)
    write_recordings(model.parent / "people", people)
    folder = str(model.parent / "people")
    assert main(["recognise", "score", str(model), "--recordings", folder, "--json"]) == 0
    scores = json.loads(capsys.readouterr().out)
    assert {"window", "three_windows", "recording", "classes", "chance", "distance", "warning"} <= set(scores)
    assert main(["evaluate", "zero-shot-activity", "--weights", str(model), "--recordings", folder, "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert {name: again[name] for name in scores} == scores
    assert again["generated_windows"] > 0
    assert main(["recognise", "score", str(model), "--recordings", folder]) == 0
    assert "balanced accuracy" in capsys.readouterr().out
    one = next((model.parent / "people" / "rest").glob("*.npz"))
    pictures = ["--pictures", str(model.parent / "pictures"), "--without", "all", "--json"]
    assert main(["recognise", "score", str(model), "--recordings", folder, *pictures]) == 0
    kept = json.loads(capsys.readouterr().out)
    assert all(row["removed"] == {} for row in kept["removed"])
    assert kept["pictures"] == []
    assert kept["confidence"]["coverage"][0]["accuracy"] == pytest.approx(kept["confidence"]["accuracy"], abs=1e-3)
    assert main(["recognise", "run", str(model), "--points", str(one), "--json"]) == 0
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [line["label"] for line in lines] == ["rest"] * 4
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"Frame,X,Y,Z,Doppler\n0,0,2,0,0\n25,0,2,0,0\n")))
    assert main(["recognise", "run", str(model), "--points", "-"]) == 0
    assert "0.0 s" in capsys.readouterr().out
    assert main(["recognise", "run", str(model), "--points", str(one), "--abstain", "1.0"]) == 0
    assert "  ?  " in capsys.readouterr().out


def test_the_largest_confusions_of_generated_people_are_named():
    labels, confusion = ("lie", "run", "walk"), [[9, 0, 1], [0, 4, 6], [0, 1, 9]]
    (line,) = confused_lines(labels, confusion)
    assert line.endswith("run for walk (60%), walk for run (10%), lie for walk (10%)")
    assert confused_lines(labels, [[20, 0, 1], [0, 9, 0], [0, 0, 9]]) == []


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["train", "task.toml"], "needs --out"),
        (["score", "model", "--points", "a"], "needs --recordings"),
        (["run", "model", "--points", "a", "--out", "b"], "--out"),
        (["run", "nowhere", "--points", "a"], "nowhere does not exist; give a folder of mmweaver recognise train"),
        (["train", "nowhere.toml", "--out", "b"], "nowhere.toml"),
        (["run", "model", "--points", "a", "--pictures", "b"], "--pictures"),
    ],
)
def test_mistakes_are_one_line(words: list[str], message: str, capsys: pytest.CaptureFixture[str]):
    assert main(["recognise", *words]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
