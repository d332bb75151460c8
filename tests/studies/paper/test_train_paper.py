"""Training the paper's network by one command: weights that are read again, and their page."""

import json
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.models.weights import read_card
from mmweaver.training.activity_training import ActivityRecipe, train_activity, write_activity_weights
from studies.paper.paper_method import load_paper
from studies.run import main

pytest.importorskip("zarr")
ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def features(tiny_geometry: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("features")
    trainer = train_activity(tiny_geometry, out, ActivityRecipe(steps=1, batch_size=1, validate_every=1))
    return write_activity_weights(out, tiny_geometry, trainer)


def words(data: Path, features: Path, out: Path, *more: str) -> list[str]:
    few = ["--steps", "2", "--batch", "2", "--validate-every", "2", "--validation-batches", "1", "--quiet"]
    return ["run", "train_paper", "--data", str(data), "--features", str(features), "--out", str(out), *few, *more]


@pytest.mark.slow  # test_paper_training.py takes its steps, test_paper_method.py reads its weights
def test_weights_are_read_again_and_their_page_gives_the_baseline(
    tiny_geometry: Path, features: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    assert main(words(tiny_geometry, features, tmp_path)) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["steps"] == 2
    assert {"zeros_loss", "nmse", "energy"} <= set(summary["validation"])
    file = tmp_path / "weights.safetensors"
    assert sum(tensor.numel() for tensor in load_paper(file).state_dict().values()) > 1e7
    card = read_card(file)
    assert (card.recipe, card.steps, card.settings["learning_rate"]) == ("paper", 2, 1e-4)
    page = (tmp_path / "README.md").read_text()
    assert "| all zeros |" in page
    assert "python -m studies run paper_scores" in page
    count = sum(name == "train" for room in read_rooms(tiny_geometry) for name in room.split)
    assert f"{count} sequences in 1 rooms, {4 / count:.1f} epochs" in page  # two steps of two
    assert list((tmp_path / "pictures").glob("*.png"))


@pytest.mark.slow  # a training
def test_weights_of_another_recipe_are_refused(
    tiny_geometry: Path, features: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    with pytest.raises(InputError, match="python -m studies run train_paper"):
        load_paper(features)
    assert main(words(tiny_geometry, features, tmp_path, "--from", str(features))) == 2
    assert "recipe 'activity'" in capsys.readouterr().err


@pytest.mark.slow  # tests/training/test_trainer.py does the same with a learner of two numbers
def test_two_processes_train_it(tiny_geometry: Path, features: Path, tmp_path: Path):
    """The fast test of two processes is in tests/training/test_trainer.py, of the same loop."""
    pytest.importorskip("accelerate")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    shared = {"WORLD_SIZE": "2", "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": port, "OMP_NUM_THREADS": "1"}
    shared["PYTHONPATH"] = os.pathsep.join([str(ROOT / "src"), str(ROOT)])
    command = [sys.executable, "-m", "studies", *words(tiny_geometry, features, tmp_path)]
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    started = [
        subprocess.Popen(command, env=os.environ | shared | {"RANK": rank, "LOCAL_RANK": rank}, **pipes)
        for rank in "01"
    ]
    ends = [process.communicate(timeout=300) for process in started]
    assert ends[1][0] == "", ends[1]
    assert ends[0][0], ends[0][1][-2000:]
    rows = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [row["step"] for row in rows] == [2]  # one process wrote
    assert rows[0]["validation"] == json.loads(ends[0][0])["validation_loss"]
