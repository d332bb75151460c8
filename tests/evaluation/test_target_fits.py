"""Range bias and gain come back from an echo of known distance and cross section."""

import re
from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.core.board import Board
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.evaluation.calibrate import calibrate
from mmweaver.evaluation.target_fits import KnownTarget
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.antenna import scatterer_gain
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.receiver import Impairments, Receiver
from mmweaver.propagation.static_paths import scattered_paths

RADAR = replace(AWR1843, name="whole band", first_range_bin=0, num_range_bins=256)
CLEAN = Impairments(phase_noise_dbc_per_hz=None, chirp_jitter_s=0.0)


def reflector(range_m: float, dbsm: float, board: Board, scale: float = 1.0) -> AdcCube:
    """Two frames of a corner reflector before weak clutter, by a board."""
    effects = BoardEffects(board, RADAR)
    rng = np.random.default_rng(2)
    place = np.concatenate([[[0.0, range_m, 0.0]], rng.uniform((-2, 1, -1), (2, 7, 1), (60, 3))])
    size = scatterer_gain(RADAR) * np.sqrt(10 ** (dbsm / 10)) / range_m**2
    amplitude = np.concatenate([[size * np.exp(1j)], 0.003 * size * rng.normal(size=60)])
    synthesis = AdcSynthesis(effects.radar, board=effects)
    paths = effects.recorded_static(scattered_paths(place, amplitude, Interaction.DIFFUSE, effects.radar))
    static = synthesis.static(paths).expand(2, -1, -1, -1)
    moving = torch.zeros((2, RADAR.num_loops, *static.shape[1:]), dtype=torch.complex64)
    receiver = Receiver(effects.radar, CLEAN, 0, effects)
    samples = receiver.receive(moving, static, torch.zeros_like(static[0]), range(2)).numpy()
    return AdcCube(samples=samples / np.float32(1e-7 if np.isnan(scale) else scale), config=RADAR, scale=scale)


@pytest.mark.parametrize(("range_m", "bias_m"), [(2.5, 0.063), (1.71, -0.02), (4.013, 0.0)])
@pytest.mark.parametrize("scale", [1.0, np.nan], ids=["known scale", "unknown scale"])
def test_bias_and_gain_come_back(range_m: float, bias_m: float, scale: float):
    made = reflector(range_m, -3.0, Board(range_bias_m=bias_m, gain_db=-4.0), scale)
    found = calibrate(made, target=KnownTarget(range_m, -3.0))
    assert found.board.range_bias_m == pytest.approx(bias_m, abs=0.003)
    assert found.board.gain_db == pytest.approx(-4.0, abs=0.5)


def test_without_a_cross_section_the_gain_stays_unknown():
    found = calibrate(reflector(2.5, 0.0, Board(range_bias_m=0.05)), target=KnownTarget(2.5))
    assert found.board.range_bias_m == pytest.approx(0.05, abs=0.003)
    assert found.board.gain_db == 0
    assert "cross section" in found.text()


def test_a_target_that_is_not_there_is_said():
    empty = calibrate(reflector(2.5, 0.0, Board()), target=KnownTarget(9.5))
    assert empty.board.range_bias_m == 0
    assert re.search(r"range bias: no echo.* 9\.5 m", empty.text())
    outside = calibrate(reflector(2.5, 0.0, Board()), target=KnownTarget(50.0))
    assert "50 m" in outside.text()
    with pytest.raises(InputError, match=r"100 m away, not 0 m$"):
        KnownTarget(0.0)
