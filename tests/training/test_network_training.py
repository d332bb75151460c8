"""Training on a tiny data set: it resumes exactly, and its files are read back."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import load_weights
from mmweaver.training.device import ComputeDevice, moved
from mmweaver.training.network_examples import RoomExamples, examples, sample_batch
from mmweaver.training.network_training import NetworkLearner, TrainingRecipe, train, write_weights
from tests.training.tiny_data import StoppedError

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("blank_training_pictures")
RECIPE = TrainingRecipe(steps=3, batch_size=1, frames=2, validate_every=2, validation_batches=1, warm_up_steps=1)


@pytest.fixture(scope="module")
def rooms(tiny_signals: Path) -> list[RoomExamples]:
    return examples(tiny_signals, "train")


@pytest.mark.slow  # test_resuming.py: any training goes on where it stopped
def test_interrupted_training_equals_an_uninterrupted_one(
    tiny_signals: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("mmweaver.training.trainer.SAVE_EVERY_S", 0.0)
    whole = train(tiny_signals, tmp_path / "whole", RECIPE)

    def stop(progress):
        if progress.step == 2:
            raise StoppedError

    with pytest.raises(StoppedError):
        train(tiny_signals, tmp_path / "parts", RECIPE, listener=stop)
    steps: list[int] = []
    parts = train(tiny_signals, tmp_path / "parts", RECIPE, listener=lambda progress: steps.append(progress.step))
    assert steps == [2, 3]  # the step that was not saved is done again
    for (name, one), two in zip(whole.learner.state_dict().items(), parts.learner.state_dict().values(), strict=True):
        assert torch.equal(one, two), name
    assert whole.best.value == parts.best.value
    network, card = load_weights(write_weights(tmp_path / "whole", tiny_signals, whole))
    assert card.steps == 3
    assert torch.allclose(network.part, whole.learner.network.part, atol=1e-3)
    with pytest.raises(InputError, match="steps 3, not 4"):
        train(tiny_signals, tmp_path / "parts", replace(RECIPE, steps=4))


def test_a_folder_without_data_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="no data set"):
        train(tmp_path, tmp_path / "out", RECIPE)


def test_everything_moves_to_the_device_that_was_chosen(rooms: list[RoomExamples]):
    """The meta device computes nothing and refuses to meet tensors of the CPU, as a GPU would."""
    batch = sample_batch(rooms, 0, 0, size=1, frames=2)
    learner = NetworkLearner(WeaverNetwork(), rooms[0].room.config).to("meta")
    terms = learner(moved(batch, torch.device("meta")))
    torch.stack(list(terms.values())).sum().backward()
    assert {parameter.grad.device.type for parameter in learner.parameters() if parameter.grad is not None} == {"meta"}


def test_bf16_trains(rooms: list[RoomExamples]):
    batch = sample_batch(rooms, 0, 0, size=1, frames=2)
    torch.manual_seed(0)
    learner = NetworkLearner(WeaverNetwork(), rooms[0].room.config).eval()
    exact = sum(float(term.detach()) for term in learner(batch).values())
    with torch.inference_mode(), ComputeDevice(precision="bf16").arithmetic():
        mixed = learner(batch)
    assert all(term.dtype == torch.float32 for term in mixed.values())
    assert sum(float(term) for term in mixed.values()) == pytest.approx(exact, rel=5e-3)


def test_processes_share_a_batch(rooms: list[RoomExamples]):
    whole = sample_batch(rooms, 0, 5, size=4, frames=2)
    parts = [sample_batch(rooms, 0, 5, size=4, frames=2, share=(rank, 2)) for rank in (0, 1)]
    for rank, part in enumerate(parts):
        assert torch.equal(part.joints_m, whole.joints_m[rank::2])
        assert torch.equal(part.targets.maps.range_doppler, whole.targets.maps.range_doppler[rank::2])
