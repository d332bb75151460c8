"""mmweaver train, and generate with what it wrote."""

import json
import os
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.weaver.front_door import Weaver

pytest.importorskip("zarr")


@pytest.mark.usefixtures("blank_training_pictures")
def test_train_then_generate(tiny_signals: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data, run, out = str(tiny_signals), tmp_path / "run", tmp_path / "generated"
    assert main(["train", "weaver", "--data", data, "--out", str(run), "--steps", "2", "--batch", "1", "--json"]) == 0
    weights = json.loads(capsys.readouterr().out)["weights"]
    request = tomllib.loads((run / "request.toml").read_text())
    assert request == {"command": "train", "recipe": "weaver", "data": data, "steps": 2, "batch": 1, "seed": 0}
    words = ["generate", "--demo", "--method", "weaver", "--weights", weights, "--frames", "2", "--out", str(out)]
    words += ["--text", "a person walks towards the radar"]
    assert main([*words, "--quiet", "--no-pictures"]) == 0
    with np.load(out / "radar.npz") as radar:
        assert radar["cube"].shape == (2, 64, 32, 12)
        assert np.isfinite(radar["cube"]).all()
    meta = json.loads((out / "meta.json").read_text())
    assert meta["method"] == "weaver"
    assert list((run / "pictures").glob("*.png"))
    assert (run / "README.md").read_text().startswith("---\nlicense: mit")
    # the same by the folder, in Python
    weaver = Weaver.from_pretrained(run)
    assert (weaver.method_name, weaver.radar.name) == ("weaver", "awr1843")
    text, room = meta["text"], weaver.sample_room()
    with np.load(out / "radar.npz") as radar:
        assert np.array_equal(weaver.generate(room, text, frames=2).cube.values, radar["cube"])


def test_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    for words, message in (
        (["train", "weaver", "--data", str(tmp_path), "--out", str(tmp_path / "o")], "no data set"),
        (["generate", "--demo", "--method", "physics", "--weights", "w", "--out", str(tmp_path / "g")],
         "weights are for the method"),
        (["generate", "--demo", "--method", "weaver", "--weights", str(tmp_path / "no"), "--out", str(tmp_path / "g")],
         "does not exist"),
    ):  # fmt: skip
        assert main(words) == 2
        error = capsys.readouterr().err.strip()
        assert message in error
        assert error.count("\n") == 0
    assert not (tmp_path / "g").exists()


@pytest.mark.slow  # test_network_training.py stops it between two steps
def test_killed_and_called_again_it_ends_with_the_same_bits(
    tiny_signals: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    """A process that is killed with no chance to say good-bye."""
    from safetensors.torch import load_file

    words = ["train", "weaver", "--data", str(tiny_signals), "--steps", "6", "--batch", "1", "--save-every", "0"]
    words += ["--validate-every", "3", "--json"]
    assert main([*words, "--out", str(tmp_path / "whole")]) == 0
    whole = json.loads(capsys.readouterr().out)
    out = tmp_path / "killed"
    command = [sys.executable, "-m", "mmweaver", *words, "--out", str(out)]
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2] / "src"), "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while process.poll() is None and time.monotonic() < deadline:
        if (out / "checkpoint.pt").is_file():
            process.kill()
            break
        time.sleep(0.01)
    assert process.wait(timeout=60) != 0
    assert not (out / "weights.safetensors").exists()
    done = torch.load(out / "checkpoint.pt", weights_only=True)["done"]
    assert 1 <= done < 6
    assert main(["train", "--config", str(tmp_path / "whole" / "request.toml"), "--out", str(out), "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["validation_loss"] == whole["validation_loss"]
    for name in ("weights.safetensors", "best.safetensors"):
        one, other = load_file(out / name), load_file(tmp_path / "whole" / name)
        assert one.keys() == other.keys()
        assert all(torch.equal(tensor, other[own]) for own, tensor in one.items())
    steps = [[json.loads(line)["step"] for line in (run / "log.jsonl").read_text().splitlines()]
             for run in (out, tmp_path / "whole")]  # fmt: skip
    assert steps[0] == steps[1] == [3, 6]


def test_from_pretrained_refuses_before_any_room_is_read(tmp_path: Path):
    (tmp_path / "weights.safetensors").write_bytes(b"PK\x03\x04 a pickle in a zip")
    with pytest.raises(InputError, match="pickled"):
        Weaver.from_pretrained(tmp_path)


@pytest.mark.slow  # test_capture_training.py finds gain and parameters in this process
def test_tuning_on_own_captures_is_one_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    torch.manual_seed(0)
    start = tmp_path / "start"
    start.mkdir()
    card = WeightsCard(recipe="weaver", licence="CC-BY-4.0", dataset_sha256="", radar="awr1843", steps=0, seed=0,
                       validation_loss=0.0, mmweaver_version="0")  # fmt: skip
    save_weights(start / "weights.safetensors", WeaverNetwork(), card)
    text = "a person walks towards the radar"
    for name in ("one", "two"):
        words = ["generate", "--demo", "--text", text, "--frames", "6", "--out", str(tmp_path / name), "--quiet"]
        assert main([*words, "--no-pictures"]) == 0
    capsys.readouterr()
    words = ["train", "weaver", "--weights", str(start), "--recordings", str(tmp_path / "one"), str(tmp_path / "two")]
    assert main([*words, "--out", str(tmp_path / "tuned"), "--steps", "3", "--batch", "1", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert (summary["captures"], summary["with_joints"]) == (2, 2)
    assert summary["validation_loss"] < summary["loss_before"]
    assert "license: cc-by-4.0" in (tmp_path / "tuned" / "README.md").read_text()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "--data"), (["--recordings", "a"], "--weights"),
        (["--data", "d", "--rgb", "p.png", "--depth", "d.png"], "--rgb"),
        (["--recordings", "a", "--weights", "w", "--rgb", "p.png"], "belong together"),
        (["--data", "d", "--save-every", "-1"], "0 or more seconds"), (["--data", "d", "--device", "no"], "device"),
        (["--data", "d", "--steps", "0"], "--steps must be 1 or more"),
        (["--data", "d", "--batch", "-1"], "--batch must be 1 or more"),
        (["--data", "d", "--validate-every", "0"], "--validate-every must be 1"),
        (["--data", "d", "--learning-rate", "0"], "above 0"), (["--data", "d", "--learning-rate", "1e9"], "at most 1"),
    ],
)  # fmt: skip
def test_options_that_contradict_are_one_line(
    words: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    assert main(["train", "weaver", "--out", str(tmp_path / "out"), *words]) == 2
    error = capsys.readouterr().err.strip()
    assert message in error
    assert error.count("\n") == 0
    assert not (tmp_path / "out").exists()
