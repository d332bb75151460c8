"""Weights of `mmweaver train hypernetwork` as the method of a weaver, of either target."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver import Weaver
from mmweaver.core.errors import InputError
from mmweaver.models.hypernetwork import HyperNetwork
from mmweaver.models.hypernetwork_rooms import load_hypernetwork
from mmweaver.models.power_network import PowerNetwork
from mmweaver.models.weights import WeightsCard, save_weights, shipped_weights


def weights(folder: Path, recipe: str, **settings: str) -> Path:
    torch.manual_seed(0)
    signal = recipe == "paper" or settings.get("target") == "signal"
    card = WeightsCard(
        recipe=recipe, licence="MIT", dataset_sha256="", radar="awr1843", steps=1, seed=0, validation_loss=1.0,
        mmweaver_version="0", settings=settings,
    )  # fmt: skip
    save_weights(folder / "w.safetensors", HyperNetwork() if signal else PowerNetwork(), card)
    return folder / "w.safetensors"


def test_weights_of_target_signal_make_a_signal(tmp_path: Path):
    weaver = Weaver.from_pretrained(weights(tmp_path, "hypernetwork", target="signal"))
    room = weaver.sample_room()
    made = weaver.generate(room, "a person walks", frames=3, seed=1)
    again = weaver.generate(room, "a person walks", frames=3, seed=1)
    assert made.cube.values.shape == (3, 64, 32, 12)
    assert made.cube.values.any()
    assert np.array_equal(made.cube.values, again.cube.values)
    assert any("hypernetwork" in note for note in made.meta["assumed"])
    with pytest.raises(InputError, match="one person"):
        weaver.generate(room, ["a person walks", "a person waves"], frames=3)


@pytest.mark.parametrize(("recipe", "settings"), [("hypernetwork", {"target": "power"}), ("paper_power", {})])
def test_weights_of_target_power_make_a_signal(tmp_path: Path, recipe: str, settings: dict[str, str]):
    weaver = Weaver.from_pretrained(weights(tmp_path, recipe, **settings))
    made = weaver.generate(weaver.sample_room(), "a person walks", frames=2)
    assert np.isfinite(made.cube.values).all()
    assert made.cube.values.any()


def test_weights_of_earlier_recipes_are_read(tmp_path: Path):
    network, card = load_hypernetwork(weights(tmp_path, "paper"))
    assert isinstance(network, HyperNetwork)
    assert card.recipe == "paper"


def test_other_weights_are_refused():
    with pytest.raises(InputError, match="mmweaver train hypernetwork"):
        load_hypernetwork(shipped_weights())
