"""mmweaver evaluate: scores of the shipped recogniser, and one line for a folder that has none to give."""

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.cli.main import main
from mmweaver.core import repository_files


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
    assert "radhar.toml" in capsys.readouterr().out
    monkeypatch.setattr(repository_files, "WEIGHTS", tmp_path)
    assert main(words) == 2
    assert "examples/tasks/radhar.toml" in capsys.readouterr().err


def test_a_bad_folder_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    for folder, message in ((tmp_path, "holds no recordings"), (tmp_path / "none", "does not exist")):
        assert main(["evaluate", "zero-shot-activity", "--recordings", str(folder)]) == 2
        error = capsys.readouterr().err
        assert message in error
        assert error.count("\n") == 1
