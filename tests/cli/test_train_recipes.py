"""mmweaver train activity."""

import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
import torch
from safetensors.torch import load_file

from mmweaver.cli.main import main
from mmweaver.core.boards import AWR1843
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.models.activity_network import ActivityNetwork, label_names_of, load_activity
from mmweaver.models.weights import load_into, shipped_weights
from tests.datasets.conftest import activity_set  # noqa: F401  (a fixture)

pytest.importorskip("zarr")


def test_activity_writes_weights_and_their_page(tiny_signals: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    few = ["--data", str(tiny_signals), "--steps", "2", "--batch", "1", "--json"]
    assert main(["train", "activity", "--out", str(tmp_path / "a"), *few]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["steps"] == 2
    assert "wrong" in summary["validation"]
    assert (tmp_path / "a" / "README.md").is_file()
    assert list((tmp_path / "a" / "pictures").glob("*.png"))
    assert load_into(ActivityNetwork(AWR1843), Path(summary["weights"]), recipe="activity").steps == 2


def test_a_set_of_ones_own_room_is_trained_on(
    activity_set: Path,  # noqa: F811
    tmp_path: Path, capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    few = ["--data", str(activity_set), "--steps", "2", "--batch", "2", "--json"]
    assert main(["train", "activity", "--out", str(tmp_path / "a"), *few]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert set(summary["scores"]["this network"]) == {"accuracy", "test_accuracy"}
    weights = Path(summary["weights"])
    assert label_names_of(weights) == ("waving", "walking", "squatting")
    network = load_activity(weights, AWR1843)
    stored = read_activity_set(activity_set)
    assert network(*network.maps(torch.from_numpy(stored.cube(0).values)[None])).shape == (1, 3)
    assert "held out" in (tmp_path / "a" / "README.md").read_text()


def test_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data = ["--data", str(tmp_path), "--out", str(tmp_path / "o")]
    for words, told in (
        (["train", "activity", *data], "no data set"),
        (["train", "activity", *data, "--weights", "w", "--recordings", "c"], "--recordings"),
    ):
        assert main(words) == 2
        error = capsys.readouterr().err.strip()
        assert told in error
        assert error.count("\n") == 0
    assert not (tmp_path / "o").exists()


def test_it_goes_on_from_weights_of_its_own_recipe_alone(
    tiny_signals: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    few = ["--data", str(tiny_signals), "--steps", "1", "--batch", "1", "--json"]
    assert main(["train", "activity", "--out", str(tmp_path / "a"), *few]) == 0
    assert main(["train", "activity", "--out", str(tmp_path / "b"), "--weights", str(tmp_path / "a"), *few]) == 0
    capsys.readouterr()
    words = ["train", "activity", "--out", str(tmp_path / "c"), "--weights", str(shipped_weights()), *few]
    assert main(words) == 2
    assert "mmweaver train activity" in capsys.readouterr().err


@pytest.mark.slow  # test_trainer.py does the same with a learner of two numbers
def test_two_processes_that_were_killed_end_as_two_that_were_not(tiny_geometry: Path, tmp_path: Path):
    pytest.importorskip("accelerate")
    words = ["train", "activity", "--data", str(tiny_geometry), "--steps", "16", "--batch", "2", "--save-every", "0"]
    words.append("--out")
    out = tmp_path / "killed"
    kill_when(out / "checkpoint.pt", two_processes([*words, str(out)]))
    assert 1 <= torch.load(out / "checkpoint.pt", weights_only=True)["done"] < 16
    for run in (out, tmp_path / "whole"):
        assert finished([*words, str(run), "--json"])["steps"] == 16
    one, other = load_file(out / "weights.safetensors"), load_file(tmp_path / "whole" / "weights.safetensors")
    assert all(torch.equal(tensor, other[name]) for name, tensor in one.items())


def two_processes(words: list[str]) -> list[subprocess.Popen[str]]:
    """What torchrun starts; each can be killed by itself."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    shared = {"WORLD_SIZE": "2", "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": port, "OMP_NUM_THREADS": "1"}
    shared["PYTHONPATH"] = str(Path(__file__).parents[2] / "src")
    command = [sys.executable, "-m", "mmweaver", *words]
    environments = (os.environ | shared | {"RANK": rank, "LOCAL_RANK": rank} for rank in "01")
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return [subprocess.Popen(command, env=environment, **pipes) for environment in environments]


def finished(words: list[str]) -> dict:
    """What the one process that speaks told."""
    ends = [process.communicate(timeout=300) for process in two_processes(words)]
    assert ends[1][0] == "", ends[1]
    assert ends[0][0], ends[0][1][-2000:]
    return json.loads(ends[0][0])


def kill_when(file: Path, processes: list[subprocess.Popen[str]]) -> None:
    """Both are killed as soon as a file is there."""
    deadline = time.monotonic() + 240
    while processes[0].poll() is None and not file.is_file() and time.monotonic() < deadline:
        time.sleep(0.02)
    for process in processes:
        process.kill()
        process.communicate(timeout=60)
