"""mmweaver train activity."""

import json
from pathlib import Path

import pytest
import torch

from mmweaver.cli.main import main
from mmweaver.core.boards import AWR1843
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.io.npz_files import read_radar_npz
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


@pytest.mark.parametrize("target", [pytest.param("signal", marks=pytest.mark.slow), "power"])
def test_a_hypernetwork_writes_weights_that_generate_reads(
    tiny_geometry: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], target: str
):
    few = ["--steps", "1", "--batch", "1", "--validate-every", "1", "--json"]
    out = tmp_path / "run"
    words = ["train", "hypernetwork", "--data", str(tiny_geometry), "--target", target, "--out", str(out)]
    assert main([*words, *few]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert (summary["steps"], summary["target"]) == (1, target)
    made = tmp_path / "made"
    demo = ["generate", "--demo", "--weights", str(out), "--frames", "2", "--out", str(made), "--quiet"]
    assert main([*demo, "--text", "a person walks"]) == 0
    meta = json.loads((made / "meta.json").read_text())
    assert meta["method"] == f"hypernetwork, target {target}"
    assert read_radar_npz(made / "radar.npz").values.shape == (2, 64, 32, 12)
    other = {"signal": "power", "power": "signal"}[target]
    again = ["train", "hypernetwork", "--data", str(tiny_geometry), "--target", other, "--weights", str(out)]
    assert main([*again, "--out", str(tmp_path / "no"), *few]) == 2
    assert f"give --target {target}" in capsys.readouterr().out


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
