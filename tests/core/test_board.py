"""The board's record and file, and boards by name."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.board import Board, read_board
from mmweaver.core.boards import AWR1843, BGT60, IDEAL_BOARD, compensated, find_board, typical_board
from mmweaver.core.errors import InputError


def test_a_board_comes_back_from_its_file(tmp_path: Path):
    board = replace(typical_board(AWR1843, 3), coupling_real=np.eye(12), coupling_imag=0.01 * np.ones((12, 12)))
    file = tmp_path / "board.json"
    board.save(file)
    again = read_board(file)
    assert again.digest == board.digest
    assert again.meta() == board.meta()
    np.testing.assert_array_equal(again.leakage_level_db, board.leakage_level_db)


def test_an_ideal_board_does_nothing():
    assert IDEAL_BOARD.is_ideal
    assert Board(name="mine", notes=("nothing was seen",)).is_ideal
    assert not Board(range_bias_m=0.01).is_ideal
    assert not typical_board(AWR1843, 0).is_ideal


def test_boards_by_name(tmp_path: Path):
    assert find_board("ideal", AWR1843) is IDEAL_BOARD
    assert find_board("typical", AWR1843, 7).digest == find_board("typical:7", AWR1843, 1).digest
    assert find_board("typical", AWR1843, 8).digest != find_board("typical:7", AWR1843).digest
    typical_board(BGT60, 1).save(tmp_path / "mine.json")
    assert find_board(tmp_path / "mine.json", BGT60).name == "typical:1"
    with pytest.raises(InputError, match="1 x 3 antenna pairs"):
        find_board(tmp_path / "mine.json", AWR1843)
    for wrong in ("perfect", "typical:x", "typical:-1", "typical:99999999999"):
        with pytest.raises(InputError, match=f"(unknown board|not) '{wrong}'"):
            find_board(wrong, AWR1843)


def test_typical_boards_lie_within_the_recorded_spread():
    boards = [typical_board(AWR1843, number) for number in range(200)]
    assert 4 < np.median([abs(board.elevation_phase_deg) for board in boards]) < 12
    assert {np.sign(board.elevation_phase_deg) for board in boards} == {-1, 1}
    assert all(0 <= board.range_bias_m <= 0.1 for board in boards)
    spread_db = np.median([np.ptp(board.leakage_level_db[0]) for board in boards])
    assert 10 < spread_db < 20
    gains_db = [board.gain_db for board in boards]
    assert -8 <= min(gains_db) < -7.5
    assert -4.5 < max(gains_db) <= -4
    assert typical_board(BGT60, 0).gain_db == 0  # the one recording of real samples shows none beyond its error


def test_what_a_radar_compensates_is_no_error():
    board = compensated(typical_board(AWR1843, 0))
    assert board.range_bias_m == 0
    assert not board.channel_gain_db.size
    assert board.drift_ppm


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("[]", "no board file"),
        ('{"board_version": 2}', "board_version 2"),
        ('{"board_version": 1, "gains": 1}', "unknown key gains"),
        ('{"board_version": 1, "range_bias_m": "far"}', "range_bias_m cannot be"),
        ('{"board_version": 1, "range_bias_m": 1e9}', "within 2"),
        ('{"board_version": 1, "if_share": [0, 2], "if_gain_db": [0, 0], "if_phase_deg": [0, 0]}', "from 0 to 1"),
        ('{"board_version": 1, "if_share": [0.5, 0.2], "if_gain_db": [0, 0], "if_phase_deg": [0, 0]}', "must rise"),
        ('{"board_version": 1, "if_share": [0.5]}', "one shape"),
        (
            '{"board_version": 1, "channel_gain_db": [[1, 2], [3]], "channel_phase_deg": [[0]]}',
            "channel_gain_db cannot be",
        ),
        ('{"board_version": 1, "channel_gain_db": [1], "channel_phase_deg": [1]}', "same"),
        ('{"board_version": 1, "coupling_real": [[1, 0]], "coupling_imag": [[0, 0]]}', "square"),
        ('{"board_version": 1, "leakage_range_m": [0.1]}', "leakage_level_db"),
        ('{"board_version": 1, "leakage_range_m": [[0.1]], "leakage_level_db": [1], "leakage_phase_deg": [1]}', "list"),
        ('{"board_version": 1, "notes": 3}', "notes cannot be"),
        ('{"board_version": 1, "element_spacing_m": -1}', "above 0"),
        ('{"board_version": 1, "drift_ppm": NaN}', "JSON"),
        ("", "JSON"),
    ],
)
def test_what_is_no_board_is_refused_in_one_line(text: str, why: str, tmp_path: Path):
    file = tmp_path / "board.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=why) as caught:
        read_board(file)
    assert "\n" not in str(caught.value)
