"""Recipe paper_power on a tiny data set: a step trains, and its weights are read back."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver import Weaver
from mmweaver.core.errors import InputError
from mmweaver.models.environment_encoder import Z_ENV
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.training.network_examples import examples, reflected_scene
from mmweaver.training.network_training import NetworkLearner
from studies.paper.power_method import PowerFields, load_power
from studies.paper.power_network import RECIPE, PowerNetwork
from studies.paper.power_training import PowerRecipe, train_power, write_power_weights

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("blank_training_pictures")
TINY = PowerRecipe(steps=1, batch_size=1, frames=2, validate_every=1, validation_batches=1, warm_up_steps=1)


def test_one_step_trains_and_its_weights_are_read_back(tiny_geometry: Path, tmp_path: Path):
    trainer = train_power(tiny_geometry, tmp_path, TINY)
    network, card = load_power(write_power_weights(tmp_path, tiny_geometry, trainer))
    assert isinstance(network, PowerNetwork)
    assert (card.recipe, card.steps) == (RECIPE, 1)
    own = trainer.learner.state_dict()["network.person.layers.0.weight"]
    assert torch.allclose(network.person.layers[0].weight, own, atol=1e-3)
    assert _is_the_encoder_of_weaver(network)
    page = (tmp_path / "README.md").read_text()
    assert all(row in page for row in ("this network", "initial weights", "empty maps"))
    with pytest.raises(InputError, match="mmweaver train weaver"):
        load_weights(tmp_path / "weights.safetensors")
    weaver = Weaver(PowerFields(tmp_path / "weights.safetensors"))
    made = weaver.generate(weaver.sample_room(), "a person walks", frames=2)
    assert np.isfinite(made.cube.values).all()


def _is_the_encoder_of_weaver(network: PowerNetwork) -> bool:
    weaver, _ = load_weights(shipped_weights())
    own, known = network.environment.state_dict(), weaver.environment.state_dict()
    return all(torch.equal(own[name], known[name]) for name in known)


def test_what_the_hypernetwork_reads_differs_between_rooms_and_poses(tiny_geometry: Path, tmp_path: Path):
    """Codes differ by a few percent of their mean, whitened ones by more than their mean."""
    network = _trained(tiny_geometry, tmp_path, TINY)
    (one, *_), mirrored = examples(tiny_geometry, "train"), reflected_scene
    scene = SceneTensors.stack([one.scene])
    both = [network.environment(view.image)[0] for view in (scene, mirrored(scene))]
    raw, white = (
        (part[0] - part[1]).norm() / part[0].norm() for part in (both, [network.env_whitening(z) for z in both])
    )
    assert raw < 0.2
    assert white > 1


def test_without_codes_the_same_is_written_for_every_room(tiny_geometry: Path, tmp_path: Path):
    network = _trained(tiny_geometry, tmp_path, replace(TINY, reads_codes=False))
    codes = 5 * torch.randn(2, Z_ENV)
    assert torch.equal(*network.room_writer(network.env_whitening(codes)))


def _trained(data: Path, out: Path, recipe: PowerRecipe) -> PowerNetwork:
    learner = train_power(data, out, recipe).learner
    assert isinstance(learner, NetworkLearner)
    assert isinstance(learner.network, PowerNetwork)
    return learner.network
