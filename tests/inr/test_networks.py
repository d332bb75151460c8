import numpy as np
import pytest
import torch

from mmweaver.inr import BaseINR, ModulatedINR, PositionalEncoding


def test_the_papers_numbers():
    """51 encoded values; 4,898 shared weights, 5,120 modulations of 20 frames, 10,018 in all."""
    inr = ModulatedINR(num_frames=20)
    assert inr.sizes == (51, 32, 32, 32, 32, 2)
    assert inr.theta.numel() == 4_898
    assert inr.gamma.numel() + inr.beta.numel() == 5_120
    assert sum(parameter.numel() for parameter in inr.parameters()) == 10_018
    assert BaseINR().sizes[0] == 68


def test_the_encoding_is_the_papers_formula_with_the_raw_coordinates():
    expected = []
    for value in (0.3, -0.7, 0.11):
        expected += [value, *(np.cos(2**i * value) for i in range(8)), *(np.sin(2**i * value) for i in range(8))]
    encoded = PositionalEncoding(3)(torch.tensor([[0.3, -0.7, 0.11]]))[0].numpy()
    assert np.allclose(encoded, expected, atol=1e-5)


@pytest.mark.parametrize("num", [12, 32, 64])
def test_a_limited_encoding_ends_at_its_share_of_what_cells_resolve(num: int):
    """At Nyquist neighbouring cells, 2 / (num - 1) apart, are half a turn apart."""
    (frequencies,) = PositionalEncoding.limited([num], 0.5).frequencies
    assert frequencies[-1] * 2 / (num - 1) == pytest.approx(np.pi / 2)
    assert PositionalEncoding.limited([num], 0.0).sizes == [1]


def test_theta_is_the_weights_of_an_ordinary_network():
    inr = BaseINR(3)
    network = torch.nn.Sequential()
    for at in range(5):
        network.append(torch.nn.Linear(*inr.sizes[at : at + 2]))
        if at < 4:
            network.append(torch.nn.ReLU())
    torch.nn.utils.vector_to_parameters(inr.theta.detach(), network.parameters())
    x = torch.rand(50, 3) * 2 - 1
    assert torch.allclose(inr(x), network(inr.encoding(x)), atol=1e-5)


def test_a_fresh_modulation_is_the_identity():
    inr, base = ModulatedINR(num_frames=2), BaseINR(3)
    x = torch.rand(2, 40, 3)
    assert torch.equal(inr(x), base(x, theta=inr.theta))


def test_modulation_scales_and_shifts_before_the_activation():
    inr = ModulatedINR(num_frames=2)
    with torch.no_grad():
        inr.gamma[1, 3], inr.beta[1, 3] = 0.0, 2.0  # all that the last layer sees of the second frame is ReLU(2)
    out, (weight, bias) = inr(torch.rand(2, 5, 3)), inr.layers(inr.theta)[-1]
    expected = (2 * weight.sum(1) + bias).expand(5, 2)
    assert torch.allclose(out[1], expected, atol=1e-5)
    assert not torch.allclose(out[0], expected, atol=1e-2)


def test_weights_from_outside_replace_the_own_ones():
    """As a hypernetwork writes them: for several sequences, each with weights and modulations of its own."""
    inrs = [ModulatedINR(num_frames=3) for _ in range(2)]
    for inr in inrs:
        torch.nn.init.normal_(inr.gamma)
        torch.nn.init.normal_(inr.beta)
    x = torch.rand(2, 3, 7, 3)
    theta, gamma, beta = (torch.stack([getattr(inr, name) for inr in inrs]) for name in ("theta", "gamma", "beta"))
    together = inrs[0](x, theta=theta[:, None], gamma=gamma, beta=beta)
    assert torch.allclose(together, torch.stack([inr(own) for inr, own in zip(inrs, x, strict=True)]), atol=1e-5)


@pytest.mark.parametrize("activation", ["relu", "gauss", "sine"])
def test_axes_give_what_points_give(activation: str):
    encoding = PositionalEncoding.limited([5, 4, 3], 0.5)
    inr = ModulatedINR(num_frames=2, encoding=encoding, activation=activation, width=8, depth=2)
    torch.nn.init.normal_(inr.gamma)
    axes = [torch.linspace(-1, 1, num) for num in (5, 4, 3)]
    points = torch.cartesian_prod(*axes)
    assert torch.allclose(inr.on_axes(axes), inr(points.expand(2, -1, -1)), atol=1e-5)


def test_between_frames_modulations_are_interpolated():
    inr = ModulatedINR(num_frames=3)
    torch.nn.init.normal_(inr.gamma)
    gamma, beta = inr.modulation(torch.tensor([0.0, 0.5, 2.0, 7.0]))
    assert torch.allclose(gamma[1], (inr.gamma[0] + inr.gamma[1]) / 2, atol=1e-6)
    assert torch.equal(gamma[3], inr.gamma[2])
    assert beta.shape == (4, 4, 32)
