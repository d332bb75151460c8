"""RF-Genesis' samples on their way to the firmware: noise is added after the gain, and loudness is found."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.presets import IWR1443_MARS
from mmweaver.core.records import AdcCube

pytest.importorskip("mitsuba")
CONFIG = replace(IWR1443_MARS, num_loops=8)
SHAPE = (2, CONFIG.num_loops, CONFIG.num_tx, CONFIG.num_rx, CONFIG.num_samples)


def samples_of(rms: float) -> AdcCube:
    rng = np.random.default_rng(0)
    parts = rng.standard_normal((*SHAPE, 2)).astype(np.float32) * np.float32(rms / np.sqrt(2))
    return AdcCube(samples=parts.view(np.complex64)[..., 0], config=CONFIG, scale=1.0)


def test_noise_does_not_depend_on_the_gain():
    from studies.peers.peer_clouds import received

    noise_mw = CONFIG.noise_power_mw
    adc = samples_of(1e-3 * np.sqrt(noise_mw))
    for gain_db, power in ((-200.0, 1.0), (70.0, 11.0)):
        heard = received(adc, gain_db).samples
        assert np.mean(np.abs(heard) ** 2) / noise_mw == pytest.approx(power, rel=0.05)


def test_samples_are_made_as_loud_as_ours():
    from studies.peers.peer_clouds import as_loud

    assert as_loud([samples_of(1e-9)], [samples_of(3e-6)]) == pytest.approx(69.5, abs=0.1)
