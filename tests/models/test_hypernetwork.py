"""Sizes of the paper's hypernetwork, and the many INRs that it writes at once."""

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.inr import ModulatedINR
from mmweaver.models.hypernetwork import HyperNetwork, motion_input, unit_sqrt_mw
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.reconstruction import reconstruct


def _count(module: torch.nn.Module) -> int:
    return sum(parameter.numel() for parameter in module.parameters())


@pytest.fixture(scope="module")
def network() -> HyperNetwork:
    torch.manual_seed(0)
    return HyperNetwork().eval()


def test_parts_are_as_large_as_the_paper_states(network: HyperNetwork):
    assert _count(network.environment) == pytest.approx(2.1e6, rel=0.02)
    assert _count(network.pose) == pytest.approx(4.9e6, rel=0.04)
    assert _count(network) == pytest.approx(14.73e6, rel=0.002)


def test_it_writes_10018_numbers_for_20_frames(network: HyperNetwork):
    with torch.inference_mode():
        theta, gamma, beta = network(torch.zeros(2, 5, 120, 160), torch.zeros(2, 20, 22, 6))
    assert theta.shape == (2, 4898)
    assert gamma.shape == beta.shape == (2, 20, 4, 32)
    assert theta[0].numel() + gamma[0].numel() + beta[0].numel() == 10018


def test_a_photo_and_joints_give_the_signal_of_the_written_inr(network: HyperNetwork):
    """The cube, in sqrt(mW), is what the weights give at the coordinates of its cells."""
    image = SceneTensors.of(reconstruct(sample_photo()[0]), AWR1843).image
    joints = np.random.default_rng(0).standard_normal((4, 22, 3)).astype(np.float32)
    cube = network.field(image, AWR1843, joints, 2 * joints).cube()
    assert cube.values.shape == (4, 64, 32, 12)
    with torch.inference_mode():
        theta, gamma, beta = network(image[None], motion_input(*map(torch.from_numpy, (joints, 2 * joints)))[None])
        corner = ModulatedINR(4)(-torch.ones(1, 4, 1, 3), theta=theta[:, None], gamma=gamma, beta=beta)[0, :, 0]
    assert np.allclose(cube.values[:, 0, 0, 0], torch.view_as_complex(corner) * unit_sqrt_mw(AWR1843), rtol=1e-3)


def test_other_joints_are_refused(network: HyperNetwork):
    joints = np.zeros((4, 24, 3), np.float32)
    with pytest.raises(InputError, match="22"):
        network.field(torch.zeros(5, 120, 160), AWR1843, joints, joints)
