"""Recipe paper_power on a tiny data set: a step trains, and its weights are read back."""

from pathlib import Path

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.models.power_network import RECIPE, PowerNetwork
from mmweaver.models.weights import load_network, load_weights
from mmweaver.training.power_training import PowerRecipe, train_power, write_power_weights

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("blank_training_pictures")
TINY = PowerRecipe(steps=1, batch_size=1, frames=2, validate_every=1, validation_batches=1, warm_up_steps=1)


def test_one_step_trains_and_its_weights_are_read_back(tiny_geometry: Path, tmp_path: Path):
    trainer = train_power(tiny_geometry, tmp_path, TINY)
    network, card = load_network(write_power_weights(tmp_path, tiny_geometry, trainer))
    assert isinstance(network, PowerNetwork)
    assert (card.recipe, card.steps) == (RECIPE, 1)
    own = trainer.learner.state_dict()["network.person.layers.0.weight"]
    assert torch.allclose(network.person.layers[0].weight, own, atol=1e-3)
    page = (tmp_path / "README.md").read_text()
    assert all(row in page for row in ("this network", "initial weights", "empty maps"))
    with pytest.raises(InputError, match="give those of: mmweaver train weaver"):
        load_weights(tmp_path / "weights.safetensors")
