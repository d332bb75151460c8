"""The small diffusion: its ends, and that a network which knew the signal would lead there."""

from pathlib import Path

import torch

from mmweaver.core.boards import AWR1843
from mmweaver.models.weights import WeightsCard, save_weights
from studies.peers.diffusion_training import RECIPE, load_diffusion
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


def test_its_weights_hold_the_unit_of_signals_in_half_precision(tmp_path: Path):
    unit = torch.logspace(-7, -4, 64)
    network = SignalDiffusion(AWR1843)
    network.set_unit(unit)
    about = {"licence": "MIT", "dataset_sha256": "", "radar": "awr1843", "steps": 1, "seed": 0, "validation_loss": 1.0}
    card = WeightsCard(recipe=RECIPE, mmweaver_version="0", **about)
    save_weights(tmp_path / "weights.safetensors", network, card)
    again = SignalDiffusion(AWR1843)
    load_diffusion(tmp_path / "weights.safetensors", again)
    assert torch.allclose(again.unit, unit, rtol=0.02)
