"""The separable synthesis against the exact sum: the bounds of the project, in the range-Doppler cube."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.paths import ApparentPoint, Interaction, Paths
from mmweaver.propagation.reference_sum import exact_frame
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.propagation.visible_body import motion_through


def moving_points(count: int, speed_mps: float, acceleration_mps2: float, seed: int = 0):
    rng = np.random.default_rng(seed)
    azimuth, elevation = rng.uniform(-0.6, 0.6, count), rng.uniform(-0.4, 0.4, count)
    distance = rng.uniform(1.3, 2.3, count)
    start = np.stack(
        [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)], -1
    ) * distance[:, None]  # fmt: skip
    velocity = rng.uniform(-speed_mps, speed_mps, (count, 3))
    acceleration = rng.uniform(-acceleration_mps2, acceleration_mps2, (count, 3))
    amplitude = rng.normal(size=count) + 1j * rng.normal(size=count)

    def position(time_s: np.ndarray) -> np.ndarray:
        t = time_s[None, :, None]
        return start[:, None] + velocity[:, None] * t + acceleration[:, None] * t**2 / 2

    return position, amplitude


def range_doppler(adc: np.ndarray) -> np.ndarray:
    """(loop, tx, rx, sample) -> (doppler, tx, rx, range), Hann both ways, an FFT of its own for this test."""
    loops, samples = adc.shape[0], adc.shape[-1]
    window = np.sin(np.pi * np.arange(samples) / samples) ** 2
    slow = np.sin(np.pi * np.arange(loops) / loops) ** 2
    spectrum = np.fft.fft(adc * window, axis=-1)[..., AWR1843.first_range_bin :][..., : AWR1843.num_range_bins]
    return np.fft.fft(spectrum * slow[:, None, None, None], axis=0)


def direct_paths(position, amplitude: np.ndarray, synthesis: AdcSynthesis) -> Paths:
    """Paths (segment, path) of points in one frame, by the radar's own clock."""
    nodes_m = position(synthesis.clock.node_s).swapaxes(0, 1)[None]  # (1, node, point, 3)
    points = ApparentPoint.of(motion_through(nodes_m, synthesis.clock)[0])
    each = torch.from_numpy(np.tile(amplitude, (len(synthesis.clock.segments), 1)))
    return Paths.direct(each, points)


def error_db(speed_mps: float, acceleration_mps2: float) -> float:
    position, amplitude = moving_points(40, speed_mps, acceleration_mps2)
    synthesis = AdcSynthesis(AWR1843)
    truth = range_doppler(exact_frame(position, amplitude, AWR1843))
    ours = range_doppler(synthesis.moving(direct_paths(position, amplitude, synthesis))[0].numpy())
    return 10 * np.log10((abs(ours - truth) ** 2).sum() / (abs(truth) ** 2).sum())


@pytest.mark.parametrize(
    ("speed_mps", "acceleration_mps2", "bound_db"),
    [(0.0, 0.0, -60), (0.5, 5.0, -58), (1.0, 10.0, -58), (3.0, 30.0, -50)],
)
def test_error_of_the_cube(speed_mps: float, acceleration_mps2: float, bound_db: float):
    assert error_db(speed_mps, acceleration_mps2) <= bound_db


@pytest.mark.parametrize(("speed_mps", "acceleration_mps2"), [(0.5, 0.0), (1.5, 5.0), (3.0, 0.0), (-4.0, 20.0)])
def test_a_moving_point_leaves_no_spurs_that_the_exact_sum_has_not(speed_mps: float, acceleration_mps2: float):
    """Away from its own Doppler nothing differs by more than -64 dB of the peak: range and angle are held nowhere."""
    start = np.array([[0.3, 1.8, 0.1]])
    away = start / np.linalg.norm(start)

    def position(time_s: np.ndarray) -> np.ndarray:
        t = time_s[None, :, None]
        return start[:, None] + away * (speed_mps * t + acceleration_mps2 * t**2 / 2)

    synthesis, amplitude = AdcSynthesis(AWR1843), np.ones(1, complex)
    truth = range_doppler(exact_frame(position, amplitude, AWR1843))
    ours = range_doppler(synthesis.moving(direct_paths(position, amplitude, synthesis))[0].numpy())
    peak = (np.abs(truth) ** 2).mean(axis=(1, 2)).max()
    own = np.unravel_index((np.abs(truth) ** 2).mean(axis=(1, 2)).argmax(), (32, 64))[0]
    away_from_it = np.abs((np.arange(32) - own + 16) % 32 - 16) > 4
    difference = (np.abs(ours - truth) ** 2).mean(axis=(1, 2))[away_from_it].max()
    assert 10 * np.log10(difference / peak) < -64


def test_static_paths_against_the_exact_sum():
    """The delays of all pairs of antennas, to first order in their difference from the mean."""
    config = replace(AWR1843, num_loops=1)
    rng = np.random.default_rng(0)
    place = rng.uniform((-2, 0.7, -1), (2, 3.5, 1), (60, 3))
    amplitude = rng.normal(size=60) + 1j * rng.normal(size=60)
    truth = exact_frame(lambda time_s: np.repeat(place[:, None], len(time_s), axis=1), amplitude, config)[0]
    ours = AdcSynthesis(config).static(scattered_paths(place, amplitude, Interaction.DIFFUSE, config)).numpy()
    assert 10 * np.log10((abs(ours - truth) ** 2).sum() / (abs(truth) ** 2).sum()) < -53
