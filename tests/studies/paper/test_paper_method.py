"""The paper's network as a method: its field is what its hypernetwork writes."""

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.reconstruction import reconstruct
from studies.paper.paper_method import load_paper, paper_field, paper_method, unit_sqrt_mw
from studies.paper.paper_network import PaperNetwork

CARD = WeightsCard(
    recipe="paper", licence="MIT", dataset_sha256="", radar="awr1843", steps=1, seed=0, validation_loss=1.0,
    mmweaver_version="0",
)  # fmt: skip


@dataclass(frozen=True)
class _Case:
    room: SimpleNamespace
    joints: tuple[np.ndarray, np.ndarray]


def _weights(folder: Path) -> Path:
    torch.manual_seed(0)
    save_weights(folder / "w.safetensors", PaperNetwork(), CARD)
    return folder / "w.safetensors"


def test_a_photo_and_joints_give_a_cube_in_sqrt_mw(tmp_path: Path):
    file = _weights(tmp_path)
    joints = np.random.default_rng(0).standard_normal((4, 22, 3)).astype(np.float32)
    case = _Case(SimpleNamespace(photo=sample_photo()[0], config=AWR1843), (joints, joints))
    cube = paper_method(file)(case)
    assert cube.values.shape == (4, 64, 32, 12)
    field = paper_field(load_paper(file), reconstruct(sample_photo()[0]), AWR1843, joints, joints)
    assert field.num_values == 4898 + 4 * 256
    assert field.amplitude == unit_sqrt_mw(AWR1843)
    assert np.allclose(cube.values, field.cube().values)
    assert cube.values.any()


def test_other_joints_are_refused(tmp_path: Path):
    network = load_paper(_weights(tmp_path))
    joints = np.zeros((4, 24, 3), np.float32)
    with pytest.raises(InputError, match="22"):
        paper_field(network, reconstruct(sample_photo()[0]), AWR1843, joints, joints)
