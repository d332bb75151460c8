"""Beats summed at a few instants of a chirp, against the plain sum of their samples."""

from itertools import pairwise

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.propagation.fast_time import BAND_CYCLES, NUM_NODES, FastTime


def beats(ranges_m: np.ndarray, seed: int = 0) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    rng = np.random.default_rng(seed)
    weights = rng.standard_normal((1, 6, len(ranges_m), 2)).astype(np.float32)
    delay_s = torch.from_numpy(2 * np.sort(ranges_m) / SPEED_OF_LIGHT_MPS)[None]
    shift_hz = torch.from_numpy(rng.uniform(-3000, 3000, delay_s.shape))
    return torch.view_as_complex(torch.from_numpy(weights)), delay_s, shift_hz


@pytest.mark.parametrize(
    ("places", "bands"),
    [(((2.0, 2.7, 300),), 1), (((1.0, 1.6, 200), (3.0, 3.6, 200), (4.0, 9.0, 30)), 2), (((0.5, 9.0, 150),), 0)],
    ids=["one body", "two bodies and their ghosts", "a room"],
)
def test_sums_at_a_few_instants_are_the_plain_sums(places: tuple, bands: int) -> None:
    rng = np.random.default_rng(1)
    ranges_m = np.concatenate([rng.uniform(first, last, count) for first, last, count in places])
    weights, delay_s, shift_hz = beats(ranges_m)
    fast = FastTime(AWR1843)
    found = fast.bands(delay_s[0])
    plain = fast.summed(weights, delay_s, shift_hz)
    assert len(found) == bands
    assert (fast.summed(weights, delay_s, shift_hz, found) - plain).abs().max() < 1e-5 * plain.abs().max()


def test_bands_are_no_wider_than_their_instants_are_good_for() -> None:
    fast = FastTime(AWR1843)
    delay_s = beats(np.random.default_rng(2).uniform(0.3, 6.0, 3000))[1][0]
    per_s = AWR1843.chirp_slope_hz_per_s * AWR1843.num_samples / AWR1843.sample_rate_hz
    found = fast.bands(delay_s)
    widths = [float(delay_s[band][-1] - delay_s[band][0]) * per_s for band in found]
    assert len(found) > 3
    assert max(widths) <= BAND_CYCLES
    assert all(first.stop <= second.start for first, second in pairwise(found))
    # an interpolating polynomial needs more instants than radians in the band
    assert np.pi / 2 * BAND_CYCLES + 15 < NUM_NODES


def test_the_factor_is_the_beat() -> None:
    delay_s = torch.tensor([1.7e-8], dtype=torch.float64)
    time_s = (np.arange(AWR1843.num_samples) - AWR1843.num_samples / 2) / AWR1843.sample_rate_hz
    slope, shift_hz = AWR1843.chirp_slope_hz_per_s, 900.0
    turns = (slope * 1.7e-8 + shift_hz) * time_s - slope * 1.7e-8**2 / 2
    assert np.abs(FastTime(AWR1843).factor(delay_s, shift_hz)[0].numpy() - np.exp(2j * np.pi * turns)).max() < 1e-5
