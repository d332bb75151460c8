"""Fine-tuning on captures: it learns the room, leaves echoes of unknown people, estimates the gain of a recording."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.tensor_files import sha256_of
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import load_weights
from mmweaver.training.capture_training import (
    STATIC_HEADS,
    CaptureLearner,
    CaptureRecipe,
    estimate_gain,
    tune,
    write_tuned,
)
from mmweaver.training.captures import Capture, read_capture, rooms_of
from mmweaver.weaver.front_door import Weaver

pytestmark = pytest.mark.usefixtures("blank_training_pictures")
RECIPE = CaptureRecipe(steps=6, batch_size=1, frames=2, validate_every=3, validation_batches=1, warm_up_steps=1,
                       learning_rate=1e-3)  # fmt: skip


@pytest.fixture(scope="module")
def captures(tmp_path_factory: pytest.TempPathFactory) -> list[Capture]:
    weaver, found = Weaver("physics"), []
    room = weaver.sample_room()
    for seed in (1, 2):
        out = tmp_path_factory.mktemp("captures") / f"take{seed}"
        weaver.generate(room, "a person walks towards the radar", frames=6, seed=seed).save(out, pictures=False)
        found.append(read_capture(out))
    return found


@pytest.fixture(scope="module")
def start() -> dict[str, torch.Tensor]:
    """All surfaces of the room 6.5 dB too strong."""
    torch.manual_seed(3)
    network = WeaverNetwork()
    with torch.no_grad():
        network.get_parameter("point.4.bias").fill_(1.5)
    return network.state_dict()


def test_which_parameters_are_tuned(captures):
    for everything in (False, True):
        learner = CaptureLearner(WeaverNetwork(), captures[0].cube.config, 1e-12, everything=everything)
        tuned = {name.split(".")[0] for name, one in learner.network.named_parameters() if one.requires_grad}
        assert tuned >= set(STATIC_HEADS)
        assert ("pose" in tuned) is everything


@pytest.mark.slow  # test_which_parameters_are_tuned; tests/cli/test_train.py tunes
def test_without_joints_only_static_clutter_changes(captures, start, tmp_path: Path):
    empty = [replace(capture, pose=None) for capture in captures]
    tuned = tune(empty, tmp_path, replace(RECIPE, steps=12, learning_rate=1e-2), start=start)
    assert tuned.trainer.best.value < 0.9 * tuned.loss_before
    assert tuned.held_out is not None
    file = write_tuned(tmp_path, tuned, start=start)
    state = tuned.trainer.learner.state_dict()
    changed = {name.split(".")[1] for name, tensor in state.items()
               if not torch.equal(tensor, start[name.removeprefix("network.")])}  # fmt: skip
    assert changed == {"point", "face"}
    card = load_weights(file)[1]
    assert card.tuned_from == sha256_of(start)
    page = (tmp_path / "README.md").read_text()
    assert re.search(r"\b1 captures .*\b0 .*joints", page)
    assert card.tuned_from in page


@pytest.mark.slow  # test_trainer.py: the best weights are those left
def test_weights_that_do_not_improve_are_not_used(captures, start, tmp_path: Path):
    """Steps far too large: the initial weights stay the best."""
    tuned = tune(captures, tmp_path, replace(RECIPE, learning_rate=3.0, largest_gradient=1e9), start=start)
    assert tuned.trainer.best.value == pytest.approx(tuned.loss_before)
    assert all(torch.equal(tensor, start[name.removeprefix("network.")])
               for name, tensor in tuned.trainer.learner.state_dict().items())  # fmt: skip


@pytest.mark.slow  # test_which_parameters_are_tuned; tests/cli/test_train.py tunes on captures with joints
def test_with_joints_all_is_tuned(captures, start, tmp_path: Path):
    tuned = tune(captures, tmp_path, RECIPE, start=start)
    assert tuned.trainer.best.value < tuned.loss_before
    state = tuned.trainer.learner.state_dict()
    assert not torch.equal(state["network.pose.merge.weight"], start["pose.merge.weight"])
    assert tuned.gain == 1.0


def test_the_gain_of_counts_is_estimated(captures, start):
    network = WeaverNetwork()
    network.load_state_dict(start)
    (room,) = rooms_of(captures[:1])
    own = estimate_gain(network, [room])
    assert 0.05 < own < 20
    assert estimate_gain(network, [room.calibrated(1000.0)]) == pytest.approx(own / 1000, rel=1e-3)


@pytest.mark.slow  # test_the_gain_of_counts_is_estimated
def test_captures_in_counts_are_calibrated(captures, start, tmp_path: Path):
    """A single capture, in ADC counts."""
    cube = captures[0].cube
    values = (cube.values * np.float32(1e4)).astype(np.complex64)
    counts = replace(captures[0], cube=replace(cube, values=values, scale=float("nan")))
    tuned = tune([counts], tmp_path, RECIPE, start=start)
    assert tuned.held_out is None
    assert tuned.gain < 1e-2
    assert np.isfinite(tuned.trainer.best.value)
