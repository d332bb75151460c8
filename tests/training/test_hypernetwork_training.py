"""Recipe hypernetwork on a tiny data set without signals: it goes on exactly, on any device, in mixed precision."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.models.activity_network import ActivityNetwork
from mmweaver.models.environment_encoder import Z_ENV
from mmweaver.models.hypernetwork import HyperNetwork
from mmweaver.models.hypernetwork_rooms import load_hypernetwork
from mmweaver.models.power_network import PowerNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import WeightsCard, load_weights, save_weights, shipped_weights
from mmweaver.training.device import ComputeDevice, moved
from mmweaver.training.hypernetwork_training import (
    HypernetworkRecipe,
    SignalLearner,
    initial_power_network,
    measure_codes,
    train_hypernetwork,
    write_hypernetwork_weights,
)
from mmweaver.training.network_examples import examples, reflected_scene
from mmweaver.training.signal_examples import sample_signal_batch, signal_rooms
from mmweaver.training.trainer import Progress
from tests.training.tiny_data import StoppedError

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("blank_training_pictures")
RECIPE = HypernetworkRecipe.for_target("signal", steps=2, batch_size=2, validate_every=1, validation_batches=1)
POWER = HypernetworkRecipe(
    steps=1, batch_size=1, frames=2, validate_every=1, validation_batches=1, warm_up_steps=1
)  # fmt: skip


@pytest.fixture(scope="module")
def features(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("activity") / "weights.safetensors"
    torch.manual_seed(0)
    card = WeightsCard(recipe="activity", licence="MIT", dataset_sha256="", radar="awr1843", steps=0, seed=0,
                       validation_loss=0.0, mmweaver_version="0")  # fmt: skip
    save_weights(file, ActivityNetwork(AWR1843), card)
    return file


def stop_at_one(progress: Progress) -> None:
    if progress.step == 1:
        raise StoppedError


@pytest.mark.slow  # test_network_training.py interrupts the same loop
def test_it_goes_on_where_it_stopped(tiny_geometry: Path, features: Path, tmp_path: Path):
    options = {"features": features, "save_every_s": 0.0}
    whole = train_hypernetwork(tiny_geometry, tmp_path / "whole", RECIPE, **options)
    with pytest.raises(StoppedError):
        train_hypernetwork(tiny_geometry, tmp_path / "parts", RECIPE, listener=stop_at_one, **options)
    parts = train_hypernetwork(tiny_geometry, tmp_path / "parts", RECIPE, **options)
    for (name, one), two in zip(whole.learner.state_dict().items(), parts.learner.state_dict().values(), strict=True):
        assert torch.equal(one, two), name
    assert whole.best.figures == parts.best.figures
    assert {"zeros_loss", "nmse", "energy"} <= set(whole.best.figures)
    assert not any("perceiver" in name for name in whole.learner.state_dict())
    assert len(list((tmp_path / "whole" / "pictures").glob("*.png"))) == 2


@pytest.mark.slow  # test_trainer.py does the same with a learner of two numbers
def test_a_longer_run_goes_on_and_no_other_setting_may_change(tiny_geometry: Path, features: Path, tmp_path: Path):
    train_hypernetwork(tiny_geometry, tmp_path, replace(RECIPE, steps=1), features=features)
    steps: list[int] = []
    longer = replace(RECIPE, steps=2)
    train_hypernetwork(
        tiny_geometry, tmp_path, longer, features=features, listener=lambda progress: steps.append(progress.step)
    )
    assert steps == [2]
    with pytest.raises(InputError, match="other settings"):
        train_hypernetwork(tiny_geometry, tmp_path, replace(RECIPE, steps=3, learning_rate=1e-3), features=features)


@pytest.mark.slow  # test_network_training.py: the same loop in mixed precision and on another device
def test_bf16_does_no_harm_and_nothing_stays_on_the_cpu(tiny_geometry: Path, features: Path):
    from mmweaver.models.activity_network import load_activity

    batch = sample_signal_batch(signal_rooms(tiny_geometry, "train"), 0, 0, size=2)
    torch.manual_seed(0)
    learner = SignalLearner(HyperNetwork(), load_activity(features, AWR1843), AWR1843).eval()
    exact = sum(float(term.detach()) for term in learner(batch).values())
    with torch.inference_mode(), ComputeDevice(precision="bf16").arithmetic():
        mixed = learner(batch)
    assert all(term.dtype == torch.float32 for term in mixed.values())
    assert sum(float(term) for term in mixed.values()) == pytest.approx(exact, rel=0.02)
    learner.train().to("meta")
    torch.stack(list(learner(moved(batch, torch.device("meta"))).values())).sum().backward()
    gradients = [parameter.grad for parameter in learner.parameters()]
    assert {gradient.device.type for gradient in gradients if gradient is not None} == {"meta"}
    assert all(gradient is not None for gradient in gradients)  # several processes would wait for one that is missing


def test_weights_of_another_recipe_are_no_features(tiny_geometry: Path, tmp_path: Path):
    with pytest.raises(InputError, match="mmweaver train activity"):
        train_hypernetwork(tiny_geometry, tmp_path / "out", RECIPE, features=shipped_weights())


def test_one_step_of_target_signal_trains_and_its_weights_are_read_back(tiny_geometry: Path, tmp_path: Path):
    trainer = train_hypernetwork(tiny_geometry, tmp_path, replace(RECIPE, steps=1))
    network, card = load_hypernetwork(write_hypernetwork_weights(tmp_path, tiny_geometry, trainer))
    assert isinstance(network, HyperNetwork)
    assert (card.recipe, card.steps, card.settings["target"]) == ("hypernetwork", 1, "signal")
    assert card.settings["learning_rate"] == 1e-4
    torch.manual_seed(0)
    assert not torch.equal(network.theta.weight, HyperNetwork().theta.weight.half().float())
    page = (tmp_path / "README.md").read_text()
    assert "| all zeros |" in page
    assert list((tmp_path / "pictures").glob("*.png"))


def test_one_step_of_target_power_trains_and_its_weights_are_read_back(tiny_geometry: Path, tmp_path: Path):
    trainer = train_hypernetwork(tiny_geometry, tmp_path, POWER)
    network, card = load_hypernetwork(write_hypernetwork_weights(tmp_path, tiny_geometry, trainer))
    assert isinstance(network, PowerNetwork)
    assert (card.recipe, card.steps, card.settings["target"]) == ("hypernetwork", 1, "power")
    own = trainer.learner.state_dict()["network.person.layers.0.weight"]
    assert torch.allclose(network.person.layers[0].weight, own, atol=1e-3)
    assert _is_the_encoder_of_weaver(network)
    page = (tmp_path / "README.md").read_text()
    assert all(row in page for row in ("this network", "initial weights", "empty maps"))


def _is_the_encoder_of_weaver(network: PowerNetwork) -> bool:
    weaver, _ = load_weights(shipped_weights())
    own, known = network.environment.state_dict(), weaver.environment.state_dict()
    return all(torch.equal(own[name], known[name]) for name in known)


@pytest.mark.slow  # test_one_step_of_target_power_trains_and_its_weights_are_read_back trains it
def test_what_the_hypernetwork_reads_differs_between_rooms(tiny_geometry: Path, tmp_path: Path):
    """Codes differ by a few percent of their mean, whitened ones by more than their mean."""
    network = train_hypernetwork(tiny_geometry, tmp_path, POWER).learner.network
    one, *_ = examples(tiny_geometry, "train")
    scene = SceneTensors.stack([one.scene])
    both = [network.environment(view.image)[0] for view in (scene, reflected_scene(scene))]
    raw, white = (
        (part[0] - part[1]).norm() / part[0].norm() for part in (both, [network.env_whitening(z) for z in both])
    )
    assert raw < 0.2
    assert white > 1


def test_without_codes_the_same_is_written_for_every_room():
    network = initial_power_network(POWER)
    measure_codes(network, [])
    codes = 5 * torch.randn(2, Z_ENV)
    assert torch.equal(*network.room_writer(network.env_whitening(codes)))
