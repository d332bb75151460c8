"""mmweaver evaluate: scores of a frozen recogniser, and one line for a folder that has none to give."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.cli.main import main
from mmweaver.core import repository_files
from mmweaver.recognition.activity_classifier import ActivityClassifier
from mmweaver.recognition.frozen_activity import Frozen


@pytest.fixture
def recordings(tmp_path: Path) -> Path:
    """Two made-up recordings of 2.5 s: somebody who goes away, and somebody who stands."""
    frame = np.repeat(np.arange(75), 3)
    for name, speed in (("walk_1", 0.615), ("boxing_1", 0.0)):
        points = np.zeros((225, 8), np.float32)
        points[:, 0] = 1.0 + speed * frame / 30
        points[:, 4] = speed
        np.savez(tmp_path / f"{name}.npz", frame=frame, pts=points)
    return tmp_path


@pytest.fixture
def few_trees(monkeypatch: pytest.MonkeyPatch) -> None:
    """Trained within a second, on a few of the windows."""

    def train(frozen: Frozen) -> ActivityClassifier:
        few = replace(frozen.training, features=frozen.training.features[::23], labels=frozen.training.labels[::23])
        return few.train(replace(frozen.classifier, num_trees=5, boosting_rounds=2, repetitions=1))

    monkeypatch.setattr(Frozen, "train", train)


@pytest.mark.usefixtures("few_trees")
def test_scores_are_printed(recordings: Path, capsys: pytest.CaptureFixture[str]):
    words = ["evaluate", "zero-shot-activity", "--recordings", str(recordings), "--frozen", "development", "--json"]
    assert main(words) == 0
    scores = json.loads(capsys.readouterr().out)
    assert scores["recordings"] == scores["window"]["n"] == 2
    assert scores["classes"] == ["boxing", "jack", "jump", "squats", "walk"]
    assert np.sum(scores["window"]["confusion"]) == 2
    assert scores["generated_windows"] > 500
    assert main(["evaluate", "zero-shot-activity", "--recordings", str(recordings), "--frozen", "blind"]) == 0
    text = capsys.readouterr().out
    for word in ("2 recordings", "balanced accuracy", "chance 0.200", "squats"):
        assert word in text


@pytest.mark.slow  # with fewer trees: test_scores_are_printed
@pytest.mark.parametrize("frozen", ["development", "blind"])
def test_the_whole_recogniser_knows_a_walk(frozen: str, recordings: Path, capsys: pytest.CaptureFixture[str]):
    words = ["evaluate", "zero-shot-activity", "--recordings", str(recordings), "--frozen", frozen, "--json"]
    assert main(words) == 0
    scores = json.loads(capsys.readouterr().out)
    walk = scores["classes"].index("walk")
    assert scores["window"]["confusion"][walk][walk] == 1


def test_without_a_model_it_is_the_shipped_task_file(
    recordings: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    words = ["evaluate", "zero-shot-activity", "--recordings", str(recordings)]
    assert main([*words, "--json"]) == 0
    scores = json.loads(capsys.readouterr().out)
    assert (scores["task_file"], scores["recordings"]) == ("radhar.toml", 2)
    walk = scores["classes"].index("walk")
    assert scores["window"]["confusion"][walk][walk] == 1
    assert main(words) == 0
    assert "of the task file radhar.toml" in capsys.readouterr().out
    monkeypatch.setattr(repository_files, "WEIGHTS", tmp_path)
    assert main(words) == 2
    assert "the recogniser of examples/tasks/radhar.toml is in the repository" in capsys.readouterr().err


def test_a_bad_folder_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    for folder, message in ((tmp_path, "holds no recordings"), (tmp_path / "none", "does not exist")):
        assert main(["evaluate", "zero-shot-activity", "--recordings", str(folder)]) == 2
        error = capsys.readouterr().err
        assert message in error
        assert error.count("\n") == 1
