"""The same echoes through both syntheses, on every device there is."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.presets import AWR1843
from mmweaver.paths.adc_synthesis import EchoRows, FrameClock, synthesise
from mmweaver.paths.adc_synthesis_torch import TorchSynthesis
from mmweaver.paths.receiver import Impairments, Receiver
from mmweaver.paths.static_paths import StaticEchoes, path_lengths_m, static_adc

DEVICES = ["cpu", *(["cuda"] if torch.cuda.is_available() else [])]


def rows(rng: np.random.Generator, clock: FrameClock, count: int) -> EchoRows:
    """Echoes anywhere within 4 m, as fast as limbs; half of them over a wall on one way."""
    start, speed = rng.uniform((-2, 0.7, -1), (2, 3.5, 1), (count, 3)), rng.normal(0, 2, (count, 3))
    out = start[:, None] + speed[:, None] * clock.node_s[None, :, None]
    is_mixed = rng.random(count) < 0.5
    back = np.where(is_mixed[:, None, None], out * np.array([-1.0, 1.0, 1.0]), out)
    amplitude = rng.normal(size=count) + 1j * rng.normal(size=count)
    return EchoRows(out_m=out, back_m=back, amplitude=amplitude, is_mixed=is_mixed)


def error(got: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.sqrt((np.abs(got - wanted) ** 2).sum() / (np.abs(wanted) ** 2).sum()))


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("config", [AWR1843, replace(AWR1843, num_loops=5, num_samples=100)])
def test_moving_echoes_agree_to_single_precision(device: str, config):
    """Measured 3e-7; frames of other numbers of rows, one of them empty."""
    rng, clock = np.random.default_rng(0), FrameClock(config)
    frames = [rows(rng, clock, count) for count in (300, 0, 40)]
    got = TorchSynthesis(clock, device).moving(frames).cpu().numpy()
    for one, samples in zip(frames, got, strict=True):
        wanted = synthesise(one, clock)
        assert error(samples, wanted) < 3e-6 if len(one) else not samples.any()


@pytest.mark.parametrize("device", DEVICES)
def test_resting_echoes_agree_to_single_precision(device: str):
    rng = np.random.default_rng(1)
    frames = []
    for count in (2500, 10):
        place = rng.uniform((-2, 0.7, -1), (2, 3.5, 1), (count, 3))
        frames.append(
            StaticEchoes(
                way_m=path_lengths_m(place, AWR1843), amplitude=rng.normal(size=count) + 0j, first_m=place, last_m=place
            )
        )
    got = TorchSynthesis(FrameClock(AWR1843), device).resting(frames).cpu().numpy()
    for one, samples in zip(frames, got, strict=True):
        assert error(samples, static_adc(one, AWR1843)) < 3e-6


@pytest.mark.parametrize("device", DEVICES)
def test_noise_drawn_on_the_device_is_of_the_same_kind(device: str):
    impairments = Impairments(quantise=False)
    receiver = Receiver(AWR1843, impairments, seed=3)
    shape = (3, AWR1843.num_loops, AWR1843.num_tx, AWR1843.num_rx, AWR1843.num_samples)
    silent = torch.zeros(shape, dtype=torch.complex64, device=device)
    still, rate = silent[:, 0], torch.full(shape[2:], 1e9, dtype=torch.complex64, device=device)
    synthesis, frames = TorchSynthesis(FrameClock(AWR1843), device), np.arange(3)
    streamed, drawn = (
        synthesis.received(silent, still, rate, receiver, frames, drawn_here=here).cpu().numpy()
        for here in (False, True)
    )
    for part in (np.real, np.imag):
        assert np.std(part(drawn)) == pytest.approx(np.std(part(streamed)), rel=0.02)
    assert np.abs(np.mean(drawn)) < 0.05 * np.std(drawn)
