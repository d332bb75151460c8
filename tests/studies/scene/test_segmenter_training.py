"""The built-in segmenter's training."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.scene.segmentation.builtin_segmenter import GROUP_NAMES, load_network
from studies.scene.segmenter_data import SegmenterExample, make_example
from studies.scene.segmenter_training import (
    TEST_KINDS,
    TRAIN_KINDS,
    SegmenterRecipe,
    by_geometry,
    confusion,
    save_weights,
    scores,
    train,
)


@pytest.fixture(scope="module")
def example() -> SegmenterExample:
    return make_example("office", 1000)


def test_no_kind_is_in_both_splits():
    assert not set(TRAIN_KINDS) & set(TEST_KINDS)
    assert len(TRAIN_KINDS) == 8


def test_it_learns_and_its_weights_are_restored(example: SegmenterExample, tmp_path: Path):
    recipe = SegmenterRecipe(epochs=4, batch=2)
    network, losses = train([example] * 4, recipe)
    assert losses[-1] < 0.9 * losses[0]
    again, same = train([example] * 4, recipe)
    assert losses == same
    save_weights(network, tmp_path / "weights.safetensors")
    back = load_network(tmp_path / "weights.safetensors")
    import torch

    cells = torch.from_numpy(example.features[None])
    with torch.inference_mode():
        assert torch.allclose(back(cells), network(cells), atol=0.3)
        assert torch.allclose(again(cells), network(cells))


@pytest.mark.slow  # test_resuming.py stops a training of the same kind
def test_a_stopped_training_resumes_to_the_same_end(
    example: SegmenterExample, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("mmweaver.training.trainer.SAVE_EVERY_S", 0.0)
    recipe = SegmenterRecipe(epochs=3, batch=2)
    _, whole = train([example] * 4, recipe)

    def stop(line: str) -> None:
        if line.startswith("epoch   2"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train([example] * 4, recipe, tmp_path, stop)
    heard: list[str] = []
    _, losses = train([example] * 4, recipe, tmp_path, heard.append)
    assert losses == whole
    assert len(heard) == 2


def test_scores_of_perfect_and_of_constant_guesses(example: SegmenterExample):
    perfect = scores(confusion([example], lambda features: example.groups))
    assert (perfect["miou"], perfect["right"]) == (1.0, 1.0)
    wall = GROUP_NAMES.index("wall-other")
    constant = scores(confusion([example], lambda features: np.full(example.groups.shape, wall)))
    share = float((example.groups == wall).mean())
    assert constant["iou"]["wall-other"] == pytest.approx(share, abs=1e-3)
    assert constant["right"] == pytest.approx(share, abs=1e-3)


def test_geometry_alone_finds_the_floor(example: SegmenterExample):
    found = scores(confusion([example], by_geometry))
    assert found["iou"]["floor-other"] > 0.6
