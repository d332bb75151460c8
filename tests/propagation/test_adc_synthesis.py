"""Samples of paths: what the equation says, on every device there is, whatever the other frames hold."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843, HUPR
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.paths import ApparentPoint, Interaction, Paths, ScenePaths, StaticPaths
from mmweaver.propagation.receiver import Impairments, Receiver
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.propagation.static_paths import scattered_paths
from tests.physics.test_reference_sum import direct_paths, moving_points

DEVICES = ["cpu", *(["cuda"] if torch.cuda.is_available() else [])]


def sampled_paths(rng: np.random.Generator, count: int) -> Paths:
    """Paths within 4 m, as fast as limbs; half of them over a wall on one way."""
    motion = np.stack([rng.uniform((-2, 0.7, -1), (2, 3.5, 1), (count, 3)), rng.normal(0, 2, (count, 3)),
                       rng.normal(0, 10, (count, 3))], axis=1)  # fmt: skip
    is_reciprocal = rng.random(count) < 0.5
    image = np.where(is_reciprocal[:, None, None], motion * np.array([-1.0, 1.0, 1.0]), motion)
    amplitude = torch.from_numpy(rng.normal(size=count) + 1j * rng.normal(size=count))
    direct = Paths.direct(amplitude, ApparentPoint.of(motion))
    return replace(direct, arrival=ApparentPoint.of(image), is_reciprocal=torch.from_numpy(is_reciprocal))


def error_db(got: np.ndarray, wanted: np.ndarray) -> float:
    ratio = (np.abs(got - wanted) ** 2).sum() / (np.abs(wanted) ** 2).sum()
    return 10 * float(np.log10(max(ratio, 1e-30)))


def exact_samples(paths: Paths, config: RadarConfig) -> np.ndarray:
    """Samples (loop, tx, rx, sample) of paths (path,), one sample at a time."""
    tx, rx = (torch.tensor(place, dtype=torch.float64) for place in (config.tx_position_m, config.rx_position_m))
    clock = AdcSynthesis(config).clock
    ramp_s = np.arange(config.num_samples) / config.sample_rate_hz - config.num_samples / config.sample_rate_hz / 2
    adc = np.zeros((config.num_loops, config.num_tx, config.num_rx, config.num_samples), complex)
    for loop in range(config.num_loops):
        for m in range(config.num_tx):
            time = torch.from_numpy(clock.chirp_s[loop, m] - clock.middle_s[0] + ramp_s)
            ends = [end.positions_m(time).movedim(-1, 0) for end in (paths.departure, paths.arrival)]
            for k in range(config.num_rx):
                for order, there in ((ends, torch.ones(len(paths))), (ends[::-1], paths.is_reciprocal)):
                    tau = ((order[0] - tx[m]).norm(dim=-1) + (order[1] - rx[k]).norm(dim=-1)) / SPEED_OF_LIGHT_MPS
                    at_sample = torch.from_numpy(ramp_s)
                    cycles = (config.centre_frequency_hz + config.chirp_slope_hz_per_s * at_sample) * tau
                    cycles -= config.chirp_slope_hz_per_s * tau**2 / 2
                    adc[loop, m, k] += (
                        (there * paths.amplitude) @ torch.exp(2j * torch.pi * cycles).to(torch.complex64)
                    ).numpy()
    return adc


def test_both_orders_of_a_path_over_a_wall_add_up():
    """Against every sample on its own; at several m/s to first order in a block."""
    config = replace(AWR1843, num_loops=6, num_samples=64, first_range_bin=0)
    paths = sampled_paths(np.random.default_rng(0), 30)
    got = AdcSynthesis(config).moving(paths[None])[0].numpy()
    assert error_db(got, exact_samples(paths, config)) < -30


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("config", [AWR1843, replace(AWR1843, num_loops=5, num_samples=100)])
def test_padding_and_other_frames_change_nothing(device: str, config: RadarConfig):
    rng = np.random.default_rng(0)
    frames = [sampled_paths(rng, count) for count in (300, 0, 40)]
    together = AdcSynthesis(config, device).moving(Paths.padded(frames)).cpu().numpy()
    alone = AdcSynthesis(config)
    for one, samples in zip(frames, together, strict=True):
        if len(one):
            assert error_db(samples, alone.moving(one[None])[0].numpy()) < -110
        else:
            assert not samples.any()


def test_long_frames_are_exact_by_segments():
    """Chirps of 62 ms, limbs at 1 m/s and 20 m/s2: no polynomial of one frame would do."""
    config = replace(HUPR, num_samples=32, num_range_bins=16, first_range_bin=0)
    synthesis = AdcSynthesis(config)
    assert len(synthesis.clock.segments) == 7
    position, amplitude = moving_points(5, 1.0, 20.0)
    wanted = exact_frame(position, amplitude, config)
    assert error_db(synthesis.moving(direct_paths(position, amplitude, synthesis))[0].numpy(), wanted) < -30


@pytest.mark.parametrize("device", DEVICES)
def test_static_paths_are_the_sum_and_occluded_ones_are_part_of_it(device: str):
    rng = np.random.default_rng(1)
    place = rng.uniform((-2, 0.7, -1), (2, 3.5, 1), (2500, 3))
    paths = scattered_paths(place, rng.normal(size=2500) + 0j, Interaction.DIFFUSE, AWR1843)
    synthesis = AdcSynthesis(AWR1843, device)
    samples = synthesis.static(paths).cpu().numpy()
    moving = Paths.direct(
        paths.amplitude[None], ApparentPoint.of(np.pad(place[None, :, None], ((0, 0), (0, 0), (0, 2), (0, 0))))
    )
    assert error_db(synthesis.moving(moving)[0, 0].cpu().numpy(), samples) < -45
    occluded = torch.zeros(2, 2500, dtype=torch.uint8)
    occluded[0, 100:400] = 1
    occluded[1] = 1
    hidden = synthesis.occluded(ScenePaths(static=paths, moving=Paths.none(), occluded=occluded)).cpu().numpy()
    assert error_db(hidden[1], samples) < -100
    assert error_db(hidden[0], synthesis.static(paths[100:400]).cpu().numpy()) < -100


def test_static_rate_is_the_derivative():
    place = np.random.default_rng(2).uniform((-1, 0.7, -1), (1, 3.0, 1), (50, 3))
    paths = scattered_paths(place, np.ones(50), Interaction.DIFFUSE, AWR1843)
    synthesis, step_s = AdcSynthesis(AWR1843), 1e-10
    # a delay of the sampling turns each beat by its frequency
    later = StaticPaths.of(
        (paths.amplitude * torch.exp(2j * torch.pi * AWR1843.chirp_slope_hz_per_s * step_s
                                     * paths.length_m.mean(dim=(1, 2)) / SPEED_OF_LIGHT_MPS)).numpy(),
        paths.length_m.numpy(), place, place, Interaction.DIFFUSE,
    )  # fmt: skip
    difference = (synthesis.static(later) - synthesis.static(paths)).numpy() / step_s
    assert error_db(synthesis.static_rate(paths).numpy(), difference) < -20


@pytest.mark.parametrize("device", DEVICES)
def test_noise_sampled_on_the_device_is_of_the_same_kind(device: str):
    impairments = Impairments(quantise=False)
    receiver = Receiver(AWR1843, impairments, seed=3)
    shape = (3, AWR1843.num_loops, AWR1843.num_tx, AWR1843.num_rx, AWR1843.num_samples)
    silent = torch.zeros(shape, dtype=torch.complex64, device=device)
    still, rate = silent[:, 0].clone(), torch.full(shape[2:], 1e9, dtype=torch.complex64, device=device)
    streamed, sampled = (
        receiver.receive(silent.clone(), still, rate, range(3), on_device=here).cpu().numpy() for here in (False, True)
    )
    for part in (np.real, np.imag):
        assert np.std(part(sampled)) == pytest.approx(np.std(part(streamed)), rel=0.02)
    assert np.abs(np.mean(sampled)) < 0.05 * np.std(sampled)
