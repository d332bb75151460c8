"""A recording by a board with every error, corrected, is the recording of an ideal board."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.board import Board
from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.board_correction import corrected
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.signal.cube import radar_cube
from tests.propagation.test_board_effects import every_error
from tests.propagation.test_cube_rendering import BPM, sampled

WHOLE = {"first_range_bin": 4, "num_range_bins": 100}


def error_db(got: np.ndarray, wanted: np.ndarray) -> float:
    return 20 * float(np.log10(np.linalg.norm(got - wanted) / np.linalg.norm(wanted)))


def recorded(board: Board, config: RadarConfig) -> AdcCube:
    """Two frames of a room and somebody who walks, by a board, without noise."""
    effects = BoardEffects(board, config)
    synthesis = AdcSynthesis(effects.radar, board=effects)
    moving = effects.recorded_moving(sampled(config, 0.7, 0.0), np.array([0, 40]), 1)
    rng = np.random.default_rng(1)
    place = rng.uniform((-1.0, 0.8, -0.5), (1.0, 2.6, 0.5), (60, 3))
    if config.max_range_m < 1:  # within its range, and nobody walks there
        place, moving = 0.22 * place, moving[:, :0]
    static = effects.recorded_static(
        scattered_paths(place, rng.normal(size=60) + 0j, Interaction.DIFFUSE, effects.radar)
    )
    samples = synthesis.moving(moving) + synthesis.static(static)
    if len(board.leakage_range_m):
        samples = samples + synthesis.leakage(*effects.leakage)
    samples[:, 0, effects.first_slot] *= effects.first_chirp
    values = samples.numpy()
    return AdcCube(samples=values if config.complex_samples else values.real + 0j, config=config, scale=1.0)


def spectrum(adc: AdcCube, built: RadarConfig) -> np.ndarray:
    """Of every range bin but the nearest ones, where tones end at the edge of the band."""
    return radar_cube(replace(adc, config=replace(built, **WHOLE))).values


@pytest.mark.parametrize("scale", [1.0, np.nan], ids=["known scale", "unknown scale"])
def test_every_error_is_taken_away(scale: float):
    # louder leakage, as on a board: it must be found in a recording of unknown scale
    board = replace(every_error(AWR1843), drift_ppm=0.0, noise_figure_db=None)
    board = replace(board, leakage_level_db=board.leakage_level_db + 70.0)
    wanted = recorded(Board(element_spacing_m=board.element_spacing_m), AWR1843)
    raw = recorded(board, AWR1843)
    fixed = corrected(replace(raw, scale=scale), board)
    assert fixed.left_in == ()
    assert set(fixed.corrected) == {
        "first chirp", "leakage", "antenna errors", "IF response", "range bias", "element spacing",
    }  # fmt: skip
    built = BoardEffects(board, AWR1843).radar
    assert fixed.adc.config.tx_position_m == built.tx_position_m
    ideal = spectrum(wanted, AWR1843)
    assert error_db(spectrum(raw, AWR1843), ideal) > -3
    assert error_db(spectrum(fixed.adc, AWR1843), ideal) < -30


def test_real_samples_lose_if_response_and_range_bias():
    board = Board(
        if_share=np.array([0.0, 0.1, 0.5]), if_gain_db=np.array([-9.0, -1.0, 0.0]), if_phase_deg=np.zeros(3),
        range_bias_m=0.06,
    )  # fmt: skip
    raw, wanted = recorded(board, BGT60), recorded(Board(), BGT60)
    fixed = corrected(raw, board).adc
    assert not fixed.samples.imag.any()
    shown = slice(6, 28)  # a bias moves what is at either end of the band out of it
    before, after, ideal = (radar_cube(one).values[:, shown] for one in (raw, fixed, wanted))
    assert error_db(before, ideal) > 0
    assert error_db(after, ideal) < -40


def test_what_cannot_be_taken_away_is_said():
    board = every_error(BPM)
    fixed = corrected(recorded(board, BPM), board)
    assert [line.split(":")[0] for line in fixed.left_in] == ["leakage", "antenna errors", "drift"]
    other = Board(
        leakage_range_m=np.zeros(1), leakage_level_db=np.zeros((1, 3, 4)), leakage_phase_deg=np.zeros((1, 3, 4))
    )
    rng = np.random.default_rng(5)
    noise = (rng.normal(size=(2, 8, 3, 4, 256)) + 1j * rng.normal(size=(2, 8, 3, 4, 256))).astype(np.complex64)
    nothing = corrected(AdcCube(samples=noise, config=replace(AWR1843, num_loops=8), scale=np.nan), other)
    assert nothing.corrected == ()
    assert nothing.left_in[0].startswith("leakage")
    assert np.array_equal(nothing.adc.samples, noise)


def test_boards_that_cannot_be_undone_are_refused():
    coupled = Board(name="wet", coupling_real=np.ones((12, 12)), coupling_imag=np.zeros((12, 12)))
    raw = recorded(Board(), AWR1843)
    with pytest.raises(InputError, match="'wet' couples"):
        corrected(raw, coupled)
    with pytest.raises(InputError, match=r"2 x 4.*3 x 4"):
        corrected(raw, Board(channel_gain_db=np.zeros((2, 4)), channel_phase_deg=np.zeros((2, 4))))
