"""Fine-tuning on captures: it learns the room, leaves echoes of unknown people, estimates the gain of a recording."""

import pytest
import torch

from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.training.capture_training import (
    STATIC_HEADS,
    CaptureLearner,
    CaptureRecipe,
    estimate_gain,
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


def test_the_gain_of_counts_is_estimated(captures, start):
    network = WeaverNetwork()
    network.load_state_dict(start)
    (room,) = rooms_of(captures[:1])
    own = estimate_gain(network, [room])
    assert 0.05 < own < 20
    assert estimate_gain(network, [room.calibrated(1000.0)]) == pytest.approx(own / 1000, rel=1e-3)
