"""mmweaver train pose and mmweaver pose, from a task file to a picture."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.io.npz_files import write_points_npz
from mmweaver.recognition import train_pose
from mmweaver.recognition.train_pose import load_estimator
from tests.training.moving_arm import moving_arm

TASK = 'radar = "iwr1443_mars"\nwindow_s = 0.8\n[activities]\narm = ["a person raises the left arm"]\n'
TASK += 'other = ["a person raises the right arm"]\n'


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Trained for two steps on drawn sequences."""
    monkeypatch.setattr(train_pose, "generate_sequences", lambda _, each, *__: [moving_arm(k) for k in range(each)])
    (tmp_path / "task.toml").write_text(TASK)
    assert main([*training_words(tmp_path), "--quiet"]) == 0
    return tmp_path / "model"


def training_words(place: Path) -> list[str]:
    words = ["train", "pose", str(place / "task.toml"), "--out", str(place / "model"), "--sequences", "3"]
    return [*words, "--steps", "2", "--batch", "2"]


def test_a_training_names_every_file_of_weights(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    files = [str(model / name) for name in ("weights.safetensors", "weights_2.safetensors")]
    assert main([*training_words(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["weights"] == files
    assert main(training_words(tmp_path)) == 0
    assert capsys.readouterr().out.startswith(", ".join(files) + ": 2 steps")


def test_from_a_task_to_poses(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    cloud = moving_arm(9, frames=20).cloud
    columns = (cloud.frame, cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps)
    points = str(tmp_path / "points.csv")
    np.savetxt(points, np.stack(columns, axis=1), delimiter=",", header="Frame,X,Y,Z,Doppler", comments="")
    assert sorted(path.name for path in model.glob("w*")) == ["weights.safetensors", "weights_2.safetensors"]
    assert len(load_estimator(model).networks) == 2
    assert main(["pose", str(model), "--points", points, "--out", str(tmp_path / "poses"), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["frames"] == summary["frames_with_points"] == 20
    with np.load(tmp_path / "poses" / "pose.npz") as held:
        assert held["joints_m"].shape == (20, 22, 3)
    assert (tmp_path / "poses" / "pose.png").stat().st_size > 5000
    write_points_npz(tmp_path / "nobody.npz", cloud.select(np.zeros(len(cloud.frame), bool)))
    assert main(["pose", str(model), "--points", str(tmp_path / "nobody.npz"), "--out", str(tmp_path / "none")]) == 2
    assert "nobody" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["train", "pose", "--out", "b"], "needs a task"),
        (["train", "pose", "t.toml", "--data", "a", "--out", "b"], "--data"),
        (["train", "activity", "t.toml", "--data", "a", "--out", "b"], "TASK.toml"),
        (["pose", "nowhere", "--points", "a", "--out", "b"], "nowhere holds no weights"),
    ],
)
def test_mistakes_are_one_line(words: list[str], message: str, capsys: pytest.CaptureFixture[str]):
    assert main(words) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
