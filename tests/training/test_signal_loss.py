"""The paper's loss: its SSIM is the metric, the truth scores nothing, and zeros score well."""

import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.models.activity_network import ActivityNetwork
from mmweaver.training.signal_loss import SHARE_CSSIM, perceived, signal_loss
from studies.scores.cube_scores import complex_ssim
from tests.cubes import point_cube


def _terms(made: torch.Tensor, truth: torch.Tensor) -> dict[str, float]:
    torch.manual_seed(0)
    network = ActivityNetwork(AWR1843).eval().requires_grad_(False)
    terms = signal_loss(made, truth, torch.tensor([2.0]), network, 1e-3)
    return {name: float(term) for name, term in terms.items()}


def _truth() -> torch.Tensor:
    values = torch.from_numpy(point_cube(AWR1843, num_frames=2, noise=0.0).values)[None]
    return values / values.abs().max()


def test_the_truth_costs_nothing():
    truth = _truth()
    assert all(abs(value) < 1e-5 for value in _terms(truth, truth).values())


def test_its_similarity_is_that_of_the_metrics():
    truth = _truth()
    for made in (0.5 * truth, truth.flip(2), torch.zeros_like(truth)):
        metric = complex_ssim(made[0].numpy(), truth[0].numpy(), data_range=2.0)
        assert 1 - _terms(made, truth)["cssim"] / SHARE_CSSIM == pytest.approx(metric, abs=1e-4)


def test_wrong_phases_cost_more_than_zeros_where_waves_are_compared():
    truth = _truth()
    zeros, turned = _terms(torch.zeros_like(truth), truth), _terms(-truth, truth)
    assert turned["cssim"] > zeros["cssim"]
    assert turned["mse"] > zeros["mse"]
    assert turned["perceptual"] < zeros["perceptual"]  # which compares powers


def test_its_features_pass_slopes_to_the_cube():
    network = ActivityNetwork(AWR1843).eval().requires_grad_(False)
    patch = (1e-4 * torch.randn(2, 21, 32, 12, dtype=torch.complex64)).requires_grad_()
    torch.stack([part.square().mean() for part in perceived(network, patch)]).sum().backward()
    assert patch.grad is not None
    assert float(patch.grad.abs().sum()) > 0
