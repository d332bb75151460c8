"""Parts of the diffusion's study: slow time there and back, and a training of one step."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.datasets.dataset_store import read_rooms
from studies.network.learned_scores import Case
from studies.peers import diffusion_training
from studies.peers.diffusion_scores import generated
from studies.peers.diffusion_training import DiffusionRecipe, cube_of, load_diffusion, slow_time, train_diffusion
from studies.peers.signal_diffusion import SignalDiffusion
from tests.cubes import point_cube


def test_slow_time_there_and_back():
    values = point_cube().values
    assert np.allclose(cube_of(slow_time(values)), values, atol=1e-5 * np.abs(values).max())


@pytest.mark.slow  # test_signal_diffusion.py has its parts
def test_it_trains_and_makes_cubes(tiny_geometry: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(diffusion_training, "KEPT", 2)
    recipe = DiffusionRecipe(steps=1, batch_size=1, validate_every=1, validation_batches=1)
    network = SignalDiffusion(AWR1843)
    card = load_diffusion(train_diffusion(tiny_geometry, tmp_path, recipe), network)
    assert (card["recipe"], card["steps"]) == ("signal_diffusion", 1)
    room = next(room for room in read_rooms(tiny_geometry) if "validation" in room.split)
    case = Case(room, room.split.index("validation"), room, 0, "day")
    truth = room.cube(case.index)
    noisy = generated(network, is_truth_given=True, is_restored=False)(case)
    agreement = np.vdot(noisy.values, truth.values)
    assert abs(agreement) > 0.5 * np.linalg.norm(noisy.values) * np.linalg.norm(truth.values)
    torch.nn.init.normal_(network.leave.weight, std=0.01)
    made = generated(network, is_truth_given=False)(case)
    assert made.values.shape == truth.values.shape
    assert np.isfinite(made.values).all()
