"""What recipes activity and paper leave: weights that are read again, and their page."""

from pathlib import Path

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.models.activity_network import load_activity
from mmweaver.models.paper_method import load_paper
from mmweaver.models.weights import read_card
from mmweaver.training.activity_training import ActivityRecipe, train_activity
from mmweaver.training.paper_training import PaperRecipe, train_paper
from mmweaver.training.recipe_weights import write_recipe_weights

pytest.importorskip("zarr")


def test_weights_are_read_again_and_their_page_tells_the_floor(tiny_signals: Path, tmp_path: Path):
    data = tiny_signals
    judge = train_activity(data, tmp_path / "a", ActivityRecipe(steps=2, batch_size=2, validate_every=2))
    features = write_recipe_weights(tmp_path / "a", data, judge)
    assert load_activity(features, AWR1843) is not None
    page = (tmp_path / "a" / "README.md").read_text()
    assert "| chance | 0.0833 |" in page
    assert "# mmweaver activity" in page
    with pytest.raises(InputError, match="mmweaver train paper"):
        load_paper(features)
    recipe = PaperRecipe(steps=2, batch_size=2, validate_every=2, validation_batches=1)
    paper = train_paper(data, tmp_path / "p", recipe, features=features)
    file = write_recipe_weights(tmp_path / "p", data, paper)
    weight = "network.hypernetwork.theta.weight"
    own = load_paper(file).state_dict()[weight.removeprefix("network.")]
    assert torch.allclose(own, paper.learner.state_dict()[weight], atol=1e-3)
    card = read_card(file)
    assert (card.recipe, card.steps, card.settings["learning_rate"]) == ("paper", 2, 1e-4)
    page = (tmp_path / "p" / "README.md").read_text()
    assert "| all zeros |" in page
    count = sum(name == "train" for room in read_rooms(data) for name in room.split)
    assert f"{count} sequences of 1 rooms, {4 / count:.1f} passes" in page  # two steps of two
