"""The activity network reads cubes, and its file is no one else's."""

from pathlib import Path

import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_plan import ACTIVITIES
from mmweaver.models.activity_network import ACTIVITY_NAMES, ActivityNetwork, load_activity
from mmweaver.models.weights import WeightsCard, save_weights


def test_it_knows_the_activities_of_data_sets():
    assert set(ACTIVITY_NAMES) == set(ACTIVITIES)


def test_a_cube_gives_twelve_scores_whatever_its_frames():
    network = ActivityNetwork(AWR1843).eval()
    for frames in (20, 7):
        cubes = 1e-4 * torch.randn(2, frames, 64, 32, 12, dtype=torch.complex64)
        assert network(*network.maps(cubes)).shape == (2, 12)


def test_a_file_comes_back_and_others_are_refused(tmp_path: Path):
    network = ActivityNetwork(AWR1843).eval()
    card = WeightsCard(
        recipe="activity", licence="MIT", dataset_sha256="", radar="awr1843", steps=1, seed=0, validation_loss=1.0,
        mmweaver_version="0",
    )  # fmt: skip
    save_weights(tmp_path / "a.safetensors", network, card, half=False)
    again = load_activity(tmp_path / "a.safetensors", AWR1843)
    cubes = 1e-4 * torch.randn(1, 4, 64, 32, 12, dtype=torch.complex64)
    assert torch.equal(again(*again.maps(cubes)), network(*network.maps(cubes)))
    save_weights(tmp_path / "b.safetensors", network, WeightsCard(**{**card.__dict__, "recipe": "paper"}))
    with pytest.raises(InputError, match="mmweaver train activity"):
        load_activity(tmp_path / "b.safetensors", AWR1843)
