"""The level of people over noise, on made signals of known level."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.records import AdcCube
from studies.physics.echo_gain import chest_level_db, gain_row, moving_level_db

WHOLE = replace(AWR1843, first_range_bin=0, num_range_bins=256)


def made(config, amplitude: float, range_bin: float, turns_a_loop: float, frames: int) -> AdcCube:
    """A tone in noise of power 1 a sample."""
    rng = np.random.default_rng(0)
    shape = (frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    noise = (rng.normal(size=shape) + 1j * rng.normal(size=shape)) / np.sqrt(2)
    phase = range_bin * np.arange(config.num_samples) / config.num_samples
    phase = phase + turns_a_loop * np.arange(config.num_loops)[:, None, None, None]
    samples = noise + amplitude * np.exp(2j * np.pi * phase)
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=np.nan)


def test_an_echo_of_half_the_amplitude_has_six_decibels_less():
    strong, weak = (moving_level_db(made(WHOLE, amplitude, 60, 0.2, 1)) for amplitude in (3.0, 1.5))
    assert strong - weak == pytest.approx(20 * np.log10(2), abs=0.3)
    chests = [chest_level_db(made(BGT60, amplitude, 12, 0.0, 4)) for amplitude in (3.0, 1.5)]
    assert chests[0] - chests[1] == pytest.approx(20 * np.log10(2), abs=0.5)


def test_movement_elsewhere_does_not_count():
    alone = made(WHOLE, 3.0, 60, 0.2, 1)
    wave = np.exp(2j * np.pi * (90 * np.arange(256) / 256 + 0.3 * np.arange(32)[:, None, None, None]))
    both = replace(alone, samples=(alone.samples + 1.5 * wave).astype(np.complex64))
    assert moving_level_db(both) == pytest.approx(moving_level_db(alone), abs=0.1)


def test_the_gain_is_what_is_missing():
    row = gain_row("x", 50.0, [56.0, 58.0, 60.0])
    assert row["metrics"]["echo_gain"]["value"] == -8.0
    low, high = row["metrics"]["echo_gain"]["interval_95"]
    assert -10 < low < -8 < high < -6
