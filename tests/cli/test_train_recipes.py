"""mmweaver train activity."""

import json
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import torch

from mmweaver.cli.main import main
from mmweaver.core.presets import AWR1843
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.models.activity_network import ActivityNetwork, label_names_of, load_activity
from mmweaver.models.weights import load_into
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
