"""mmWave SDK .cfg files, good and bad."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import ANTENNAS
from mmweaver.core.errors import InputError
from mmweaver.core.transmit_code import weights_of
from mmweaver.core.virtual_array import AntennaTable, azimuth_row, has_elevation
from mmweaver.io.radar_options import RadarOptions
from mmweaver.io.ti_cfg import read_ti_cfg

AOP, BOOST_1642, ISK, ODS = (ANTENNAS[name] for name in ("aop", "boost1642", "isk", "ods"))

# TI's best range resolution profile for three transmitters, the elevated one last.
BEST_RANGE = """
% ***************************************************************
% Created for SDK ver:03.02
sensorStop
flushCfg
dfeDataOutputMode 1
channelCfg 15 7 0
adcCfg 2 1
adcbufCfg -1 0 1 1 1
profileCfg 0 77 267 7 57.14 0 0 70 1 256 5209 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4   % TX2
chirpCfg 2 2 0 0 0 0 0 2
frameCfg 0 2 16 0 100 1 0
lowPower 0 0
bpmCfg -1 0 0 1
sensorStart
"""


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "best_range.cfg"
    path.write_text(text)
    return path


def test_the_best_range_profile(tmp_path: Path):
    config = read_ti_cfg(written(tmp_path, BEST_RANGE))
    assert config.name == "best_range"
    assert config.range_resolution_m == pytest.approx(0.04357, abs=1e-5)
    assert config.max_velocity_mps == pytest.approx(1.0, abs=0.03)
    assert config.velocity_resolution_mps == pytest.approx(0.125, abs=0.004)
    assert (config.num_loops, config.num_tx, config.num_rx, config.tx_order) == (16, 3, 4, (0, 2, 1))
    assert (config.frame_period_s, config.rx_gain_db, config.complex_samples) == (0.1, 30.0, True)
    assert (config.first_range_bin, config.num_range_bins) == (0, 256)  # all of it
    assert config.range_m[-1] == pytest.approx(11.11, abs=0.01)
    assert has_elevation(config)
    assert read_ti_cfg(tmp_path / "best_range.cfg").lvds_iq_order == "qi"


def test_an_iwr1443_profile_with_two_transmitters(tmp_path: Path):
    """Transmitters 0 and 2 become 0 and 1: eight antennas in a row. It ends at 77 + 58 x 0.068 = 80.94 GHz."""
    config = read_ti_cfg(
        written(
            tmp_path,
            "channelCfg 15 5 0\nadcCfg 2 1\nadcbufCfg 0 0 1 1\nprofileCfg 0 77 7 7 58 0 0 68 1 256 5500 0 0 30\n"
            "chirpCfg 0 0 0 0 0 0 0 4\nchirpCfg 1 1 0 0 0 0 0 1\nframeCfg 0 1 32 0 33.333 1 0\n",
        )
    )
    assert config.tx_order == (1, 0)
    assert config.num_antennas == 8
    steps = np.diff(np.sort(config.antenna_position_m[:, 0])) / (config.wavelength_m / 2)
    assert steps == pytest.approx(np.ones(7))
    assert not has_elevation(config)
    assert config.frame_period_s == pytest.approx(0.033333)
    assert read_ti_cfg(tmp_path / "best_range.cfg").lvds_iq_order == "iq"


def test_a_60_ghz_profile_real_samples_and_fewer_receivers(tmp_path: Path):
    text = BEST_RANGE.replace("channelCfg 15 7", "channelCfg 3 7").replace("adcCfg 2 1", "adcCfg 2 0")
    config = read_ti_cfg(written(tmp_path, text.replace("0 77 267", "0 60 267")))
    assert config.frequency_limits_hz == (57e9, 64e9)
    assert config.num_rx == 2
    assert not config.complex_samples


def test_chirps_repeated_in_the_list_are_loops(tmp_path: Path):
    text = BEST_RANGE.replace("chirpCfg 2 2 0 0 0 0 0 2", "chirpCfg 2 2 0 0 0 0 0 1\nchirpCfg 3 3 0 0 0 0 0 4")
    config = read_ti_cfg(written(tmp_path, text.replace("frameCfg 0 2 16", "frameCfg 0 3 16")))
    assert (config.num_tx, config.num_loops, config.tx_order) == (2, 32, (0, 1))
    text = BEST_RANGE.replace("chirpCfg 0 0 0", "chirpCfg 0 63 0").replace("frameCfg 0 2 16", "frameCfg 0 63 2")
    config = read_ti_cfg(written(tmp_path, text.replace("chirpCfg 1 1", "% ").replace("chirpCfg 2 2", "% ")))
    assert (config.num_tx, config.num_loops) == (1, 128)


def test_a_ramp_that_ends_past_the_band_is_accepted_with_a_note(tmp_path: Path):
    """60 GHz + 40.04 us x 100 MHz/us: TI's own visualizer writes such files."""
    text = BEST_RANGE.replace("0 77 267 7 57.14 0 0 70 1 256 5209", "0 60 43 7 40.04 0 0 100 1 224 7000")
    config = read_ti_cfg(written(tmp_path, text))
    assert len(config.notes) == 1
    assert "4 MHz past 64 GHz" in config.notes[0]
    assert read_ti_cfg(written(tmp_path, BEST_RANGE)).notes == ()


def test_bpm_of_the_azimuth_pair_beside_tdm(tmp_path: Path):
    """TI's 3D People Tracking: chirps 0 and 2 are the pair, chirp 1 the elevated transmitter alone."""
    text = (
        BEST_RANGE.replace("0 0 1\n", "0 0 5\n", 1)
        .replace("0 0 4   % TX2", "0 0 2")
        .replace("2 2 0 0 0 0 0 2", "2 2 0 0 0 0 0 5")
    )
    config = read_ti_cfg(written(tmp_path, text.replace("bpmCfg -1 0 0 1", "bpmCfg -1 1 0 2")))
    assert np.allclose(weights_of(config.tx_code), [[1, 0, 1], [0, 1, 0], [1, 0, -1]])
    assert (config.num_slots, config.num_antennas, config.num_loops) == (3, 12, 16)
    assert np.allclose(config.antenna_position_m, read_ti_cfg(written(tmp_path, BEST_RANGE)).antenna_position_m)


# of public code for the AWR2544: six chirps a loop, two empty Doppler bands
DOPPLER_DIVISION = """channelCfg 15 15 0 0 0
adcCfg 2 0
adcbufCfg -1 1 0 1 1
profileCfg 0 77 7 7 20.81 0 0 8.883 0 256 30000 0 0 164
chirpCfg 0 5 0 0 0 0 0 15
frameCfg 0 5 128 0 256 50 1 0
procChainCfg 1 0 530 0 1
ddmPhaseShiftAntOrder 0 2 3 1
"""


def test_doppler_division_turns_each_transmitter_at_its_own_rate(tmp_path: Path):
    config = read_ti_cfg(written(tmp_path, DOPPLER_DIVISION))
    weights = weights_of(config.tx_code)
    assert (config.num_slots, config.num_loops, config.num_antennas) == (6, 128, 16)
    assert config.frame_period_s == pytest.approx(0.05)  # behind the number of samples
    for tx, multiple in zip((0, 2, 3, 1), range(4), strict=True):
        expected = np.exp(2j * np.pi * multiple * np.arange(6) / 6)
        assert np.abs(np.angle(weights[:, tx] / expected, deg=True)).max() < 5.625 / 2
    assert np.linalg.cond(weights) < 1.05


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [("Order 0 2 3 1", "Order 0 2 3 3", "name each"), ("Order 0 2 3 1", "Order 0 2 3", "name each"),
     ("frameCfg 0 5", "frameCfg 0 2", r"4 transmitters.*3")],
)  # fmt: skip
def test_impossible_doppler_division_is_refused(tmp_path: Path, old: str, new: str, said: str):
    with pytest.raises(InputError, match=said):
        read_ti_cfg(written(tmp_path, DOPPLER_DIVISION.replace(old, new)))


def test_all_transmitters_at_once_are_one_beam(tmp_path: Path):
    text = BEST_RANGE.replace("chirpCfg 0 0 0 0 0 0 0 1", "chirpCfg 0 0 0 0 0 0 0 5").replace(
        "frameCfg 0 2 16", "frameCfg 0 0 16"
    )
    config = read_ti_cfg(written(tmp_path, text))
    assert (config.num_tx, config.num_slots, config.num_antennas) == (2, 1, 4)


def test_a_fourth_transmitter_is_the_awr2944(tmp_path: Path):
    text = BEST_RANGE.replace("channelCfg 15 7", "channelCfg 15 15").replace(
        "frameCfg 0 2", "chirpCfg 3 3 0 0 0 0 0 8\nframeCfg 0 3"
    )
    config = read_ti_cfg(written(tmp_path, text))
    assert (config.num_tx, config.tx_order) == (4, (0, 2, 1, 3))
    row = azimuth_row(config.antenna_position_m, config.wavelength_m)
    assert len(row) == 12
    steps = np.diff(config.antenna_position_m[row, 0]) / (config.wavelength_m / 2)
    assert steps == pytest.approx(np.ones(11))


def test_the_profiles_phase_shifters_steer_the_beam(tmp_path: Path):
    """As TI's long-range people detection does, a direction a sub-frame; samples turn against the shifter."""
    text = BEST_RANGE.replace("57.14 0 0 70", f"57.14 0 {16 << 10 | 32 << 18} 70").replace(
        "chirpCfg 0 0 0 0 0 0 0 1", "chirpCfg 0 0 0 0 0 0 0 7"
    )
    config = read_ti_cfg(written(tmp_path, text.replace("frameCfg 0 2 16", "frameCfg 0 0 16")))
    assert np.allclose(weights_of(config.tx_code), [[1, -1j, -1]])
    assert not read_ti_cfg(written(tmp_path, text.replace("0 0 7\n", "0 0 1\n"))).is_coded  # of one alone: nothing


SUB_FRAMES = """dfeDataOutputMode 3
channelCfg 15 5 0
adcCfg 2 1
adcbufCfg -1 0 1 1 1
profileCfg 0 60 7 2 16 0 0 250 1 128 9200 0 0 30
profileCfg 1 60 7 3 25 0 0 150 1 256 12000 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
chirpCfg 2 2 1 0 0 0 0 1
advFrameCfg 2 0 0 1 0
subFrameCfg 0 0 0 2 32 50 0 1 1 50
subFrameCfg 1 0 2 1 64 30 0 1 1 30
"""


def test_each_sub_frame_is_a_radar_of_its_own(tmp_path: Path):
    path = written(tmp_path, SUB_FRAMES)
    first, second = (read_ti_cfg(path, RadarOptions(sub_frame=index)) for index in range(2))
    assert (first.num_tx, first.num_loops, first.num_samples) == (2, 32, 128)
    assert (second.num_tx, second.num_loops, second.num_samples) == (1, 64, 256)
    assert first.frame_period_s == second.frame_period_s == pytest.approx(0.08)
    assert (first.frame_words_before, first.frame_words_after) == (0, 64 * 4 * 256 * 2)
    assert (second.frame_words_before, second.frame_words_after) == (2 * 32 * 4 * 128 * 2, 0)
    for sub_frame, words in ((None, "0 to 1: --radar-set subframe=N"), (2, "0 to 1, not 2")):
        with pytest.raises(InputError, match=words):
            read_ti_cfg(path, RadarOptions(sub_frame=sub_frame))
    with pytest.raises(InputError, match="--radar-set subframe="):
        read_ti_cfg(written(tmp_path, BEST_RANGE), RadarOptions(sub_frame=0))


@pytest.mark.parametrize(
    ("lines", "board", "lanes"),
    [
        ("% Platform:xWR68xx_AOP\n", AOP, 2),
        ("% Platform:xWR68xx\ncompRangeBiasAndRxChanPhase 0" + 6 * " 1 0 -1 0" + "\n", AOP, 2),
        ("compRangeBiasAndRxChanPhase 0.1" + 3 * " 1 0 -1 0 -1 0 1 0" + "\n", ODS, 2),
        ("% Platform:xWR18xx\ncompRangeBiasAndRxChanPhase 0" + 6 * " 1 0 -1 0" + "\n", ISK, 2),
        ("compRangeBiasAndRxChanPhase 0" + 3 * " 1 0 -1 0.1 1 0 -1 0" + "\n", ISK, 2),
        ("% Platform:xWR16xx\n", BOOST_1642, 2),
        ("% Platform:xWR14xx\n", ISK, 4),
        ("antGeometry0 -1 -1 0 0 -3 -3 -2 -2 -1 -1 0 0\nantGeometry1 -1 0 -1 0 -3 -2 -3 -2 -3 -2 -3 -2\n"
         "antPhaseRot 1 -1 1 -1 1 -1 1 -1 1 -1 1 -1\n", AOP, 2),
        ("antGeometry0 0 0 -1 -1 -2 -2 -3 -3 -2 -2 -3 -3\nantGeometry1 0 -1 -1 0 0 -1 -1 0 -2 -3 -3 -2\n"
         "antPhaseRot 1 -1 -1 1 1 -1 -1 1 1 -1 -1 1\n", ODS, 2),
        ("antGeometry0 0 -1 -2 -3 -2 -3 -4 -5 -4 -5 -6 -7\nantGeometry1 -1 -1 -1 -1 0 0 0 0 -1 -1 -1 -1\n", ISK, 2),
    ],
    ids=["AOP named", "AOP's phases", "ODS's phases", "named otherwise", "measured phases", "1642 named", "1443 named",
         "AOP's geometry", "ODS's geometry", "ISK's geometry"],
)  # fmt: skip
def test_the_board_of_a_cfg(tmp_path: Path, lines: str, board: AntennaTable, lanes: int):
    """Named in a comment, or by the lines that TI's people tracking has for its board."""
    text = BEST_RANGE if len(board.tx_halfwaves) == 3 else BEST_RANGE.replace("frameCfg 0 2", "frameCfg 0 0")
    config = read_ti_cfg(written(tmp_path, lines + text))
    fired = [tx for tx in range(len(board.tx_halfwaves)) if tx < config.num_tx]
    half_m = config.wavelength_m / 2
    wanted = np.array([np.add(board.tx_halfwaves[tx], one) for tx in fired for one in board.rx_halfwaves])
    found = config.antenna_position_m[:, [0, 2]] / half_m
    assert np.allclose(found - found[0], wanted - wanted[0], atol=1e-6)
    assert (config.rx_inverted, config.lvds_lanes) == (board.rx_inverted, lanes)


def test_few_samples_keep_all_their_bins(tmp_path: Path):
    config = read_ti_cfg(written(tmp_path, BEST_RANGE.replace("1 256 5209", "1 48 2000")))
    assert (config.first_range_bin, config.num_range_bins) == (0, 48)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("profileCfg", "%", ["lacks profileCfg"]),
        ("frameCfg", "%", ["lacks frameCfg"]),
        ("channelCfg 15 7 0\nadcCfg 2 1\n", "", ["lacks channelCfg, adcCfg"]),
        (BEST_RANGE, "", ["lacks channelCfg, adcCfg, profileCfg, chirpCfg, frameCfg"]),
        ("0 30\n", "\n", ["line 10", "profileCfg has 12", "needs 14"]),
        ("70 1 256", "fast 1 256", ["line 10", "not a number", "fast"]),
        ("70 1 256", "nan 1 256", ["line 10", "finite"]),
        ("1 256 5209", "1 256.5 5209", ["line 10", "whole"]),
        ("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 0 0 0 0 0", ["mask 0", "some of the 3"]),
        ("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 0 0 0 0 16", ["mask 16"]),
        ("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 0 0 0 0 8", ["channel mask 7"]),
        ("0 0 4   % TX2\nchirpCfg 2 2 0 0 0 0 0 2", "0 0 7\nchirpCfg 2 2 0 0 0 0 0 7", ["cannot be decoded"]),
        ("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 0 5 0 0 4", ["line 12", "slope", "identical"]),
        ("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 1 0 0 0 0 4", ["profiles [0, 1]"]),
        ("chirpCfg 1 1 0", "chirpCfg 1 99999999999 0", ["line 12", "0 to 511"]),
        ("chirpCfg 1 1 0 0 0 0 0 4", "", ["chirp 1", "not defined"]),
        ("profileCfg 0", "profileCfg 3", ["profile 0", "not defined"]),
        ("channelCfg 15 7", "channelCfg 15 5", ["channel mask 5"]),
        ("channelCfg 15 7", "channelCfg 0 7", ["receiver mask"]),
        ("adcCfg 2 1", "adcCfg 2 7", ["line 8", "ADC format 7"]),
        ("0 77 267", "0 24 267", ["24 GHz"]),
        ("57.14", "52", ["ramp ends"]),
        ("57.14", "63", ["GHz"]),
        ("frameCfg 0 2 16 0 100", "frameCfg 0 2 200 0 100", ["frame period"]),
        ("frameCfg 0 2 16", "frameCfg 0 2 0", ["num_loops"]),
        ("1 256 5209", "1 0 5209", ["above 0"]),
        ("bpmCfg -1 0 0 1", "bpmCfg -1 1 0 7", ["line 16", "chirp 7"]),
        ("lowPower 0 0", "advFrameCfg 1 0 0 1 0\nsubFrameCfg 0 0 0 1 1 1 0 2 1 100", ["line 16", "several bursts"]),
        ("lowPower 0 0", "contModeCfg 77 5209 0 0 0 0 0 1 256", ["line 15", "continuous mode"]),
        ("lowPower 0 0", "chirpComnCfg 15 5 0 128 1 34 3", ["line 15", "xWRL"]),
    ],
)
def test_a_bad_file_is_refused_with_the_reason(tmp_path: Path, old: str, new: str, words: list[str]):
    assert old in BEST_RANGE
    path = written(tmp_path, BEST_RANGE.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_ti_cfg(path)
    text = str(caught.value)
    assert "\n" not in text
    assert text.startswith(str(path))
    for word in words:
        assert word in text
