"""Recipe paper on a tiny data set without signals: it goes on exactly, on any device, in mixed precision."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.models.activity_network import ActivityNetwork
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.training.device import ComputeDevice, moved
from mmweaver.training.trainer import Progress
from studies.paper.paper_examples import paper_rooms, sample_paper_batch
from studies.paper.paper_network import PaperNetwork
from studies.paper.paper_training import PaperLearner, PaperRecipe, train_paper
from tests.training.tiny_data import StoppedError

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("blank_training_pictures")
RECIPE = PaperRecipe(steps=2, batch_size=2, validate_every=1, validation_batches=1)


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


@pytest.mark.slow  # test_network_training.py interrupts the same loop; test_train_paper.py trains this network once
def test_it_goes_on_where_it_stopped(tiny_geometry: Path, features: Path, tmp_path: Path):
    options = {"features": features, "save_every_s": 0.0}
    whole = train_paper(tiny_geometry, tmp_path / "whole", RECIPE, **options)
    with pytest.raises(StoppedError):
        train_paper(tiny_geometry, tmp_path / "parts", RECIPE, listener=stop_at_one, **options)
    parts = train_paper(tiny_geometry, tmp_path / "parts", RECIPE, **options)
    for (name, one), two in zip(whole.learner.state_dict().items(), parts.learner.state_dict().values(), strict=True):
        assert torch.equal(one, two), name
    assert whole.best.figures == parts.best.figures
    assert {"zeros_loss", "nmse", "energy"} <= set(whole.best.figures)
    assert not any("perceiver" in name for name in whole.learner.state_dict())
    assert len(list((tmp_path / "whole" / "pictures").glob("*.png"))) == 2


@pytest.mark.slow  # test_trainer.py does the same with a learner of two numbers
def test_a_longer_run_goes_on_and_no_other_setting_may_change(tiny_geometry: Path, features: Path, tmp_path: Path):
    train_paper(tiny_geometry, tmp_path, replace(RECIPE, steps=1), features=features)
    steps: list[int] = []
    longer = replace(RECIPE, steps=2)
    train_paper(
        tiny_geometry, tmp_path, longer, features=features, listener=lambda progress: steps.append(progress.step)
    )
    assert steps == [2]
    with pytest.raises(InputError, match="other settings"):
        train_paper(tiny_geometry, tmp_path, replace(RECIPE, steps=3, learning_rate=1e-3), features=features)


@pytest.mark.slow  # test_network_training.py: the same loop in mixed precision and on another device
def test_bf16_does_no_harm_and_nothing_stays_on_the_cpu(tiny_geometry: Path, features: Path):
    from mmweaver.models.activity_network import load_activity

    batch = sample_paper_batch(paper_rooms(tiny_geometry, "train"), 0, 0, size=2)
    torch.manual_seed(0)
    learner = PaperLearner(PaperNetwork(), load_activity(features, AWR1843), AWR1843).eval()
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


def test_weights_of_another_recipe_are_refused(tiny_geometry: Path, features: Path, tmp_path: Path):
    card = WeightsCard(recipe="paper", licence="MIT", dataset_sha256="", radar="awr1843", steps=0, seed=0,
                       validation_loss=0.0, mmweaver_version="0")  # fmt: skip
    save_weights(tmp_path / "paper.safetensors", PaperNetwork(), card)
    with pytest.raises(InputError, match="mmweaver train activity"):
        train_paper(tiny_geometry, tmp_path / "out", RECIPE, features=tmp_path / "paper.safetensors")
