"""A made board comes back from signals that were simulated with it, within stated tolerances."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

import mmweaver
from mmweaver.core.board import Board
from mmweaver.core.boards import AWR1843, typical_board
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.evaluation.antenna_fits import fit_channels
from mmweaver.evaluation.calibrate import Calibration, calibrate
from mmweaver.evaluation.receiver_fits import skirt_end
from mmweaver.evaluation.signal_evidence import ComparedSignal, SignalEvidence
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.board_correction import corrected
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.receiver import Impairments, Receiver
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.signal.cube import radar_cube

RADAR = replace(AWR1843, name="whole band", first_range_bin=0, num_range_bins=256)
FRAMES = 16


def cluttered_room(board: Board, config: RadarConfig = RADAR, frames: int = FRAMES, room: int = 8) -> AdcCube:
    """An empty room of 220 scatterers from 1.2 m on, recorded with a board and with noise, but no clock errors.

    Another `room` has other scatterers, and the board drifts otherwise.
    """
    rng = np.random.default_rng(room)
    effects = BoardEffects(board, config)
    azimuth, elevation = rng.uniform(-0.9, 0.9, 220), rng.uniform(-0.3, 0.3, 220)
    towards = np.stack(
        [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)], -1
    )
    distance = np.linspace(1.2, 9.0, 220)[:, None]
    amplitude = 2e-5 * (rng.normal(size=220) + 1j * rng.normal(size=220))
    paths = effects.recorded_static(scattered_paths(towards * distance, amplitude, Interaction.DIFFUSE, effects.radar))
    synthesis = AdcSynthesis(effects.radar, board=effects)
    static = synthesis.static(paths) + synthesis.leakage(*effects.leakage)
    carrier_over_slope_s = config.centre_frequency_hz / config.chirp_slope_hz_per_s
    drift = torch.from_numpy(effects.drift(np.arange(frames), room)).to(torch.complex64)
    receiver = Receiver(effects.radar, Impairments(phase_noise_dbc_per_hz=None, chirp_jitter_s=0.0), 0, effects)
    drift_rate = synthesis.static_rate(paths) * carrier_over_slope_s + synthesis.leakage(*effects.leakage_rate)
    still = static + drift[:, None, None, None] * drift_rate
    moving = torch.zeros((frames, config.num_loops, *still.shape[1:]), dtype=torch.complex64)
    samples = receiver.receive(moving, still, torch.zeros_like(static), range(frames)).numpy()
    return AdcCube(samples=samples, config=config, scale=1.0)


def evidence_of(adc: AdcCube) -> SignalEvidence:
    return SignalEvidence(ComparedSignal(name="made", cube=radar_cube(adc), adc=adc))


@pytest.fixture(scope="module")
def board() -> Board:
    return replace(
        typical_board(RADAR, 4), range_bias_m=0.0, elevation_phase_deg=0.0, drift_ppm=1.5, element_spacing_m=None,
        noise_figure_db=12.0, first_chirp_amplitude_percent=0.6, first_chirp_phase_mrad=2.5,
    )  # fmt: skip


@pytest.fixture(scope="module")
def found(board: Board) -> Calibration:
    return calibrate(cluttered_room(board), name="made")


def test_the_receiver_comes_back(board: Board, found: Calibration):
    share = np.concatenate([np.arange(2, 12), np.arange(12, 250, 4)]) / 256
    level_db = [np.interp(share, one.if_share, one.if_gain_db) for one in (board, found.board)]
    difference_db = level_db[1] - level_db[0]
    assert np.sqrt((difference_db**2).mean()) < 0.3
    assert np.abs(difference_db).max() < 1.2  # at the steep end of the band, where a knot is a hundredth of it
    assert found.board.noise_figure_db == pytest.approx(12.0, abs=0.25)


def test_the_leakage_comes_back(board: Board, found: Calibration):
    own, there = found.board, board
    shown = there.leakage_range_m < 0.4
    count = int(shown.sum())
    assert len(own.leakage_range_m) >= count

    def amplitudes(one: Board) -> np.ndarray:
        return 10 ** (one.leakage_level_db[:count] / 20) * np.exp(1j * np.radians(one.leakage_phase_deg[:count]))

    error = np.linalg.norm(amplitudes(own) - amplitudes(there)) / np.linalg.norm(amplitudes(there))
    assert error < 0.05


def test_antennas_come_back_but_for_a_direction(board: Board, found: Calibration):
    gain_db = board.channel_gain_db - board.channel_gain_db.mean()
    assert np.sqrt(((found.board.channel_gain_db - gain_db) ** 2).mean()) < 0.35
    places = RADAR.antenna_position_m[:, [0, 2]]
    design = np.column_stack([np.ones(12), places])
    phase = board.channel_phase_deg.ravel()
    phase = phase - design @ np.linalg.lstsq(design, phase, rcond=None)[0]
    error = found.board.channel_phase_deg.ravel() - phase
    assert np.sqrt((error**2).mean()) < max(3.0, 0.35 * phase.std())


def test_what_changes_over_time_comes_back(found: Calibration):
    assert found.board.first_chirp_amplitude_percent == pytest.approx(0.6, abs=0.12)  # its noise is 0.05
    assert found.board.first_chirp_phase_mrad == pytest.approx(2.5, abs=1.0)  # 0.4
    drift = BoardEffects(Board(drift_ppm=1.5), RADAR).drift(np.arange(FRAMES), 8)
    shown = float(re.search(r"drift: ([\d.]+) ppm rms within", found.text())[1])
    assert shown == pytest.approx(1e6 * drift.std(), rel=0.25)


def test_stated_errors_of_antennas_hold_the_truth_as_often_as_they_say():
    within, within_twice = [], []
    for room in range(8):
        board = replace(typical_board(RADAR, room), elevation_phase_deg=0.0, element_spacing_m=None)
        found = fit_channels([evidence_of(cluttered_room(board, frames=2, room=room))])
        gain_db = board.channel_gain_db - board.channel_gain_db.mean()
        amiss_db = np.abs(found.fields["channel_gain_db"] - gain_db)
        within.append(amiss_db < found.errors["channel_gain_db"])
        within_twice.append(amiss_db < 2 * found.errors["channel_gain_db"])
    assert 0.55 < np.mean(within) < 0.85  # a standard error holds 0.68
    assert np.mean(within_twice) > 0.9


def test_it_says_what_it_could_not_see(found: Calibration, tmp_path: Path):
    text = found.text()
    assert text.index("not seen") < text.index("range bias: ")
    assert any(note.startswith("gain of echoes") for note in found.board.notes)
    assert set(found.to_values()) == {"board", "errors", "found", "not_seen", "warnings"}
    found.board.save(tmp_path / "made.json")
    assert mmweaver.Weaver(radar=RADAR).request("a person stands", board=tmp_path / "made.json").board.name == "made"


def test_transmitters_that_were_read_in_another_order_are_no_errors_of_the_board(board: Board, found: Calibration):
    assert not found.warnings
    made = cluttered_room(board, frames=2)
    misread = calibrate(replace(made, samples=made.samples[:, :, [0, 2, 1]]))
    assert "--tx-order" in misread.text().splitlines()[0]
    assert misread.to_values()["warnings"]


def test_an_ideal_board_shows_no_errors():
    found = calibrate(cluttered_room(Board(), frames=8))
    assert np.abs(found.board.if_gain_db).max() < 1.0
    assert not found.board.drift_ppm
    assert abs(found.board.first_chirp_amplitude_percent) < 0.05
    if found.board.channel_gain_db.size:
        assert np.abs(found.board.channel_gain_db).max() < 0.8


def test_a_recording_is_corrected_by_the_board_that_it_was_calibrated_from(board: Board, found: Calibration):
    made = cluttered_room(board, frames=4)
    as_strong = replace(Board(), noise_figure_db=12.0, gain_db=board.gain_db)  # an empty room does not show the gain
    ideal = radar_cube(cluttered_room(as_strong, frames=4)).values
    raw, mended = (radar_cube(one).values for one in (made, corrected(made, found.board).adc))
    near, room = slice(0, 8), slice(30, 200)  # 0 to 0.3 m, 1.3 to 8.8 m
    loops = RADAR.num_loops // 2

    def amiss_db(values: np.ndarray, bins: slice) -> float:
        error = values[:, bins, loops] - ideal[:, bins, loops]
        return float(20 * np.log10(np.linalg.norm(error) / np.linalg.norm(ideal[:, bins, loops])))

    # what is linear in an antenna's place is a direction, and stays
    assert amiss_db(mended, room) < amiss_db(raw, room) - 2
    before, after = (np.abs(values[:, near, loops]).max() for values in (raw, mended))
    assert after < 0.1 * before


def test_where_a_skirt_ends():
    range_m = np.arange(100) * 0.05
    falling = 1e4 * 10 ** (-range_m * 8)
    assert skirt_end(falling, 1.0, range_m)[1].endswith("noise of a cell")
    wall = falling + 3e3 * np.exp(-(((range_m - 0.6) / 0.05) ** 2))
    end, how = skirt_end(wall, 1.0, range_m)
    assert range_m[end] < 0.6
    assert "echo at" in how


def test_what_cannot_be_calibrated_is_refused():
    with pytest.raises(InputError, match="which recordings"):
        calibrate()
    other = replace(RADAR, name="other", num_samples=128, num_range_bins=128)
    ideal = Board()
    with pytest.raises(InputError, match="one at a time"):
        calibrate(cluttered_room(ideal, frames=1), cluttered_room(ideal, other, frames=1))
