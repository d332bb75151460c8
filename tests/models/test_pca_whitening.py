"""Whitened codes: what differs between samples comes out at unit spread, however small it was."""

import torch

from mmweaver.models.power_field import PcaWhitening


def _codes(samples: int) -> torch.Tensor:
    """Codes whose mean is a hundred times their spread, which lies along one direction by ten times all others."""
    torch.manual_seed(0)
    return 5 + 0.05 * torch.randn(samples, 12) * torch.tensor([1.0] + [0.1] * 11)


def test_each_component_has_unit_spread_and_none_follows_from_another():
    codes = _codes(400)
    whitening = PcaWhitening(12, 4)
    whitening.measure(codes)
    white = whitening(codes)
    assert torch.allclose(white.mean(0), torch.zeros(4), atol=1e-3)
    assert torch.allclose(torch.cov(white.T), torch.eye(4), atol=0.01)
    assert white[:, 0].abs() @ (codes[:, 0] - 5).abs() / (white[:, 0].norm() * (codes[:, 0] - 5).norm()) > 0.99


def test_directions_that_samples_do_not_show_are_left_out():
    whitening = PcaWhitening(12, 4)
    whitening.measure(_codes(3))
    assert whitening.directions.abs().sum(0).gt(0).tolist() == [True, True, False, False]
    assert whitening(5 + torch.ones(2, 12)).isfinite().all()


def test_it_is_kept_with_the_weights():
    measured, read = PcaWhitening(12, 4), PcaWhitening(12, 4)
    measured.measure(_codes(50))
    read.load_state_dict(measured.state_dict())
    assert torch.equal(read(_codes(5)), measured(_codes(5)))
