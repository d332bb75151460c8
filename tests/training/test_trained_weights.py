"""Weights and model card of recipe activity."""

from pathlib import Path

import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.models.activity_network import load_activity
from mmweaver.training.activity_training import TRAIN_SPLITS, ActivityRecipe, train_activity, write_activity_weights

pytest.importorskip("zarr")


def test_weights_are_read_back_and_the_model_card_has_the_baseline(tiny_signals: Path, tmp_path: Path):
    data = tiny_signals
    trainer = train_activity(data, tmp_path / "a", ActivityRecipe(steps=2, batch_size=2, validate_every=2))
    features = write_activity_weights(tmp_path / "a", data, trainer)
    assert load_activity(features, AWR1843) is not None
    page = (tmp_path / "a" / "README.md").read_text()
    assert "| chance | 0.0833 |" in page
    assert "# mmweaver activity" in page
    count = sum(name in TRAIN_SPLITS for room in read_rooms(data) for name in room.split)
    assert f"{count} sequences in 1 rooms, {4 / count:.1f} epochs" in page  # two steps of two
