"""Sizes of the paper's network, and the many INRs it writes at once."""

import pytest
import torch

from studies.paper.paper_inr import InrShape, evaluate
from studies.paper.paper_network import Hypernetwork, PaperNetwork, evaluate_each
from studies.paper.positional_encoding import positional_encoding


def _count(module: torch.nn.Module) -> int:
    return sum(parameter.numel() for parameter in module.parameters())


def test_parts_are_as_large_as_the_paper_says():
    network = PaperNetwork()
    assert _count(network.environment) == pytest.approx(2.1e6, rel=0.05)
    assert _count(network.pose) == pytest.approx(4.9e6, rel=0.05)
    assert _count(network) == pytest.approx(14.73e6, rel=0.05)


def test_it_writes_10018_numbers_for_20_frames():
    network = PaperNetwork().eval()
    with torch.inference_mode():
        theta, gamma, beta = network(torch.zeros(2, 5, 120, 160), torch.zeros(2, 20, 22, 6))
    assert theta.shape == (2, 4898)
    assert gamma.shape == beta.shape == (2, 20, 4, 32)
    assert theta[0].numel() + gamma[0].numel() + beta[0].numel() == 10018


def test_many_at_once_equal_one_at_a_time():
    torch.manual_seed(0)
    network = Hypernetwork()
    theta, gamma, beta = network(torch.randn(2, 512), torch.randn(2, 3, 512))
    x = torch.rand(2, 3, 7, 3) * 2 - 1
    encoded = torch.stack([torch.stack([positional_encoding(frame) for frame in one]) for one in x])
    together = evaluate_each(theta, gamma, beta, encoded, InrShape())
    for sequence in range(2):
        for frame in range(3):
            alone = evaluate(
                InrShape(), theta[sequence], x[sequence, frame],
                gamma[sequence, frame].expand(7, -1, -1), beta[sequence, frame].expand(7, -1, -1),
            )  # fmt: skip
            assert torch.allclose(together[sequence, frame], alone, atol=1e-4)
