"""The built-in segmenter's training: what is measured, and that it learns."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.scene.builtin_segmenter import GROUP_NAMES, load_network
from mmweaver.training.segmenter import (
    TEST_KINDS,
    TRAIN_KINDS,
    Example,
    Recipe,
    by_geometry,
    confusion,
    make_example,
    save_weights,
    scores,
    train,
)

pytest.importorskip("torch")
pytest.importorskip("safetensors")


@pytest.fixture(scope="module")
def example() -> Example:
    return make_example("office", 1000)


def test_no_kind_is_in_both_parts():
    assert not set(TRAIN_KINDS) & set(TEST_KINDS)
    assert len(TRAIN_KINDS) == 8


def test_scores_of_perfect_and_of_constant_guesses(example: Example):
    perfect = scores(confusion([example], lambda features: example.groups))
    assert (perfect["miou"], perfect["right"]) == (1.0, 1.0)
    wall = GROUP_NAMES.index("wall-other")
    constant = scores(confusion([example], lambda features: np.full(example.groups.shape, wall)))
    share = float((example.groups == wall).mean())
    assert constant["iou"]["wall-other"] == pytest.approx(share, abs=1e-3)
    assert constant["right"] == pytest.approx(share, abs=1e-3)


def test_geometry_alone_finds_the_floor(example: Example):
    found = scores(confusion([example], by_geometry))
    assert found["iou"]["floor-other"] > 0.6


def test_it_learns_and_its_weights_come_back(example: Example, tmp_path: Path):
    recipe = Recipe(epochs=6, batch=2)
    network, losses = train([example] * 4, recipe)
    assert losses[-1] < 0.8 * losses[0]
    again, same = train([example] * 4, recipe)
    assert losses == same
    save_weights(network, tmp_path / "weights.safetensors")
    back = load_network(tmp_path / "weights.safetensors")
    import torch

    cells = torch.from_numpy(example.features[None])
    with torch.inference_mode():
        assert torch.allclose(back(cells), network(cells), atol=0.3)
        assert torch.allclose(again(cells), network(cells))
