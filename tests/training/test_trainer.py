"""The training loop: exact after interruptions, with two processes, and with non-finite gradients."""

import json
import os
import socket
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.training.device import ComputeDevice
from mmweaver.training.trainer import Progress
from tests.training.toy_learner import RECIPE, ToyLearner, draw, trainer

SCRIPT = Path(__file__).with_name("toy_learner.py")


def weights(out: Path) -> dict[str, torch.Tensor]:
    return torch.load(out / "checkpoint.pt", weights_only=True)["parts"]["network"]


def test_it_learns_logs_and_saves_pictures(tmp_path: Path):
    made = trainer(tmp_path, replace(RECIPE, steps=200, validate_every=50))
    reported: list[Progress] = []
    made.run(reported.append)
    assert made.best.value < 0.2 * reported[0].loss
    rows = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [row["step"] for row in rows] == [50, 100, 150, 200]
    assert rows[0]["learning_rate"] > rows[-1]["learning_rate"] >= 0
    assert len(list((tmp_path / "pictures").glob("*.png"))) == 4
    assert made.validation_loss() == pytest.approx(made.best.value)  # the best weights are those left


def environment(**more: str) -> dict[str, str]:
    roots = [str(Path(__file__).parents[2]), str(Path(__file__).parents[2] / "src")]
    return os.environ | {"PYTHONPATH": os.pathsep.join(roots), "OMP_NUM_THREADS": "1"} | more


def two_processes_equal_one(two: Path, one: Path) -> None:
    trainer(one).run()
    both = weights(two)
    for name, tensor in weights(one).items():
        assert torch.allclose(tensor, both[name], atol=1e-6), name
    rows = [[json.loads(line) for line in (out / "log.jsonl").read_text().splitlines()] for out in (one, two)]
    assert [row["step"] for row in rows[1]] == [4, 8]  # one process wrote
    for first, second in zip(*rows, strict=True):
        assert first["loss"] == pytest.approx(second["loss"], rel=1e-5)
        assert first["validation"] == pytest.approx(second["validation"], rel=1e-5)


@pytest.mark.slow  # three processes that import torch
def test_two_processes_equal_one_with_the_same_batch(tmp_path: Path):
    """Without the launcher, which is a third process that imports torch."""
    pytest.importorskip("accelerate")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        shared = {"WORLD_SIZE": "2", "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": str(free.getsockname()[1])}
    command = [sys.executable, str(SCRIPT), str(tmp_path / "two")]
    started = [
        subprocess.Popen(command, env=environment(**shared, RANK=rank, LOCAL_RANK=rank), stderr=subprocess.PIPE)
        for rank in "01"
    ]
    errors = [process.communicate(timeout=120)[1] for process in started]
    assert [process.returncode for process in started] == [0, 0], errors
    two_processes_equal_one(tmp_path / "two", tmp_path / "one")


def test_an_indivisible_batch_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="multiple"):
        trainer(tmp_path, compute=ComputeDevice(share=(0, 3)))


def test_non_finite_steps_are_skipped_and_many_end_the_run(tmp_path: Path):
    def bad(from_step: int, to_step: int):
        def sample(step, share):
            x, y = draw(step, share)
            return x, y * float("nan") if from_step <= step < to_step else y

        return sample

    made = trainer(tmp_path / "some", train=bad(2, 4))
    made.run()
    assert all(torch.isfinite(tensor).all() for tensor in made.learner.state_dict().values())
    with pytest.raises(InputError, match="not finite"):
        trainer(tmp_path / "all", replace(RECIPE, steps=100), train=bad(2, 100)).run()


def test_unavailable_devices_and_precisions_are_refused():
    for words, says in ((("nonsense", "auto"), "device"), (("cpu", "int4"), "precision")):
        with pytest.raises(InputError, match=says):
            ComputeDevice.chosen(*words)
    assert ComputeDevice.chosen("cpu").precision == "float32"
    assert isinstance(ToyLearner(), torch.nn.Module)
