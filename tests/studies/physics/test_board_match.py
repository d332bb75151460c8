from dataclasses import replace

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.records import AdcCube
from studies.physics import board_match
from tests.calibration.test_calibrate import RADAR, cluttered_room


def test_halves_share_nothing():
    samples = np.arange(2 * 8 * 12 * 256).reshape(2, 8, 3, 4, 256).astype(np.complex64)
    adc = AdcCube(samples=samples, config=replace(RADAR, num_loops=8), scale=1.0)
    for one in (adc, replace(adc, samples=samples[:1])):
        first, second = board_match.halves(one)
        assert first.samples.size == second.samples.size == one.samples.size // 2
        assert first.config.num_loops == first.samples.shape[1]
        assert not np.intersect1d(first.samples.real, second.samples.real).size


def test_a_filter_is_measured_where_it_is():
    share = np.array([0.0, 0.9, 0.95, 1.0])
    board = Board(if_share=share, if_gain_db=np.array([0.0, 0.0, -8.0, -8.0]), if_phase_deg=np.zeros(4))
    found = board_match.features_of(cluttered_room(board, frames=2))
    assert abs(found["if_last_of_band"] + 8.0) < 0.5
    assert abs(found["if_near_band"]) < 0.5
