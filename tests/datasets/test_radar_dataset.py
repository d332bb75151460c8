"""The data set for PyTorch: keys, shapes, splits, workers, and a network that learns from it."""

from pathlib import Path

import numpy as np
import pytest
import torch
from torch.utils.data import DataLoader

from mmweaver.core.errors import InputError
from mmweaver.datasets.activity_store import read_activity_set
from mmweaver.datasets.radar_dataset import FEATURES, RadarDataset, collate
from mmweaver.signal.features import range_doppler_db
from tests.datasets.conftest import activity_set  # noqa: F401  (a fixture)


def test_an_item_has_all_features(activity_set: Path):  # noqa: F811
    data = RadarDataset(activity_set, FEATURES)
    item = data[0]
    assert list(item) == list(FEATURES)
    assert item["iq"].dtype == torch.complex64
    assert item["iq"].shape == (20, 64, 32, 12)
    assert item["rd"].shape == (20, 64, 32)
    assert item["drai"].shape == (20, 32, 32)
    assert item["pose"].shape == (20, 22, 3)
    assert item["points"].shape[1] == 6
    assert isinstance(item["label"], int)
    assert data.label_names == ("waving", "walking", "squatting")


def test_features_are_those_of_the_cube(activity_set: Path):  # noqa: F811
    stored = read_activity_set(activity_set)
    np.testing.assert_array_equal(RadarDataset(stored, ("rd",))[3]["rd"].numpy(), range_doppler_db(stored.cube(3)))


def test_splits_hold_out_people(activity_set: Path):  # noqa: F811
    stored = read_activity_set(activity_set)
    people = {
        split: set(stored.columns["subject"][RadarDataset(stored, split=split).indices]) for split in ("train", "test")
    }
    assert people["train"]
    assert people["test"]
    assert not people["train"] & people["test"]
    places = {
        split: set(stored.columns["place"][RadarDataset(stored, split=split, by="place").indices])
        for split in ("train", "test")
    }
    assert not places["train"] & places["test"]


def test_workers_give_the_same_batches(activity_set: Path):  # noqa: F811
    data = RadarDataset(activity_set, ("micro_doppler", "points", "label"))
    alone = list(DataLoader(data, batch_size=6, collate_fn=collate))
    shared = list(DataLoader(data, batch_size=6, collate_fn=collate, num_workers=1))
    assert len(alone) == 3
    for one, two in zip(alone, shared, strict=True):
        assert set(one) == {"micro_doppler", "points", "points_mask", "label"}
        for name in one:
            assert torch.equal(one[name], two[name])
    assert (alone[0]["points_mask"].sum(dim=1) > 0).all()


@pytest.mark.parametrize("wrong", [{"features": ("sound",)}, {"split": "exam"}, {"by": "frame"}, {"features": ()}])
def test_unknown_names_are_refused(activity_set: Path, wrong: dict):  # noqa: F811
    with pytest.raises(InputError, match="unknown"):
        RadarDataset(activity_set, **wrong)


def test_a_data_set_of_rooms_has_the_same_reader(tiny_signals: Path):
    data = RadarDataset(tiny_signals, ("rd", "points", "pose", "label"))
    assert len(data) > 1
    item = data[1]
    assert item["rd"].shape[1:] == (64, 32)
    assert item["pose"].shape[1:] == (22, 3)
    assert len(item["points"])
    assert data.label_names[item["label"]] == data.set.columns["label_name"][1]
    train = RadarDataset(tiny_signals, ("label",), split="train")
    assert 0 < len(train) <= len(data)
    with pytest.raises(InputError, match="one split"):
        RadarDataset(tiny_signals, ("label",), by="subject")


def test_xarray_opens_it_with_coordinates(activity_set: Path, recwarn: pytest.WarningsRecorder):  # noqa: F811
    xarray = pytest.importorskip("xarray")
    with xarray.open_zarr(activity_set / "sequences.zarr") as opened:
        near = opened.iq.sel(range=2.0, method="nearest")
        assert abs(float(near.range) - 2.0) < 0.05
        assert opened.label_name.dims == ("sequence",)
        assert set(opened.label_name.values) == {"waving", "walking", "squatting"}
        assert opened.split.dims == opened.subject.dims == opened.text.dims == ("sequence",)
    assert not [str(one.message) for one in recwarn if "zarr" in str(one.message).lower()]
