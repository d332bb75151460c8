"""Recipe activity on a tiny data set: it resumes exactly, shares its batches, and its files are read back."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.training.activity_training import (
    TRAIN_MAPS,
    TRAIN_SPLITS,
    VALIDATION_MAPS,
    ActivityRecipe,
    activity_examples,
    train_activity,
)

pytest.importorskip("zarr")
RECIPE = ActivityRecipe(steps=4, batch_size=2, validate_every=2)


@pytest.fixture(scope="module")
def maps(tiny_geometry: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The cached log maps of the data set, which cost more than a training of four steps."""
    folder = tmp_path_factory.mktemp("maps")
    activity_examples(tiny_geometry, ("validation",), folder / VALIDATION_MAPS)
    activity_examples(tiny_geometry, TRAIN_SPLITS, folder / TRAIN_MAPS)
    return folder


def with_maps(maps: Path, out: Path) -> Path:
    """A folder for a training that finds its maps there."""
    return Path(shutil.copytree(maps, out, dirs_exist_ok=True))


def test_maps_are_computed_once_per_data_set(
    tiny_geometry: Path, tiny_signals: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    train_activity(tiny_geometry, tmp_path, replace(RECIPE, steps=1))

    def none_more(*words: object) -> None:
        raise AssertionError("made again")

    monkeypatch.setattr("mmweaver.training.activity_training.compute_log_maps", none_more)
    again = train_activity(tiny_geometry, tmp_path, replace(RECIPE, steps=1))
    assert again.step == 1
    with pytest.raises(InputError, match="other settings"):
        train_activity(tiny_geometry, tmp_path, replace(RECIPE, steps=2))
    (tmp_path / "checkpoint.pt").unlink()
    with pytest.raises(AssertionError, match="made again"):
        train_activity(tiny_signals, tmp_path, replace(RECIPE, steps=1))


def test_sequences_can_be_picked_by_label(tiny_geometry: Path):
    every = activity_examples(tiny_geometry, TRAIN_SPLITS)
    some = activity_examples(tiny_geometry, TRAIN_SPLITS, pick=lambda label: np.flatnonzero(label == label[0]))
    assert set(some.label.tolist()) == {int(every.label[0])}
    assert torch.equal(some.doppler[0], every.doppler[0])


def test_two_shares_have_the_gradient_of_the_whole_batch(tiny_geometry: Path, maps: Path, tmp_path: Path):
    initial = train_activity(tiny_geometry, with_maps(maps, tmp_path), replace(RECIPE, steps=0, batch_size=4))
    learner = initial.learner.eval()  # nothing dropped by chance
    gradients = []
    for shares in ([(0, 1)], [(0, 2), (1, 2)]):
        learner.zero_grad()
        for share in shares:
            loss = learner(initial._train(3, share))["cross_entropy"] / len(shares)
            loss.backward()
        gradients.append(torch.cat([p.grad.flatten() for p in learner.parameters() if p.grad is not None]))
    assert torch.allclose(*gradients, atol=1e-6)


def test_a_folder_without_data_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="no data set"):
        train_activity(tmp_path, tmp_path / "out", RECIPE)
