"""The small diffusion: its ends, and that a network which knew the signal would lead there."""

import torch

from mmweaver.core.presets import AWR1843
from studies.peers.signal_diffusion import SignalDiffusion, levels, mixed, sampled


def test_it_goes_from_signal_to_noise():
    signal, noise = torch.randn(2, 2, 32, 3, 2, dtype=torch.complex64, generator=torch.Generator().manual_seed(0))
    assert torch.allclose(mixed(signal, noise, torch.zeros(2)), signal)
    assert torch.allclose(mixed(signal, noise, torch.ones(2)), noise, atol=1e-6)
    level, _ = levels(torch.tensor([0.5]), 32)
    assert level[0, 0] < 0.8 * level[0, 16]  # the window closes from both ends: a blurred spectrum


def test_sampling_ends_at_what_the_network_restores():
    truth = torch.randn(2, 32, 64, 12, dtype=torch.complex64, generator=torch.Generator().manual_seed(1))

    class Knows(SignalDiffusion):
        def forward(self, noisy, time, motion, picture):
            return truth

    made = sampled(Knows(AWR1843), torch.zeros_like(truth), 1.0, torch.zeros(2, 132), torch.zeros(2, 960))
    assert torch.allclose(made, truth, atol=1e-4)


def test_it_has_one_to_two_million_parameters():
    assert 1e6 < sum(parameter.numel() for parameter in SignalDiffusion(AWR1843).parameters()) < 2e6
