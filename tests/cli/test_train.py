"""mmweaver train, and generate with what it wrote."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from mmweaver.cli.main import main
from mmweaver.core.errors import InputError
from mmweaver.weaver.front_door import Weaver

pytest.importorskip("zarr")


@pytest.mark.usefixtures("blank_training_pictures")
def test_train_then_generate(tiny_signals: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    data, run, out = str(tiny_signals), tmp_path / "run", tmp_path / "generated"
    assert main(["train", "weaver", "--data", data, "--out", str(run), "--steps", "1", "--batch", "1", "--json"]) == 0
    weights = json.loads(capsys.readouterr().out)["weights"]
    request = tomllib.loads((run / "request.toml").read_text())
    assert request == {"command": "train", "recipe": "weaver", "data": data, "steps": 1, "batch": 1, "seed": 0}
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


def test_from_pretrained_refuses_before_any_room_is_read(tmp_path: Path):
    (tmp_path / "weights.safetensors").write_bytes(b"PK\x03\x04 a pickle in a zip")
    with pytest.raises(InputError, match="pickled"):
        Weaver.from_pretrained(tmp_path)


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
