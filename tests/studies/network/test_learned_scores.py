"""Scores of the learned method: what has collapsed is named, energy is compared with the ground truth."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.presets import AWR1843
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from studies.network.learned_scores import _row, cases_of, energy_db, training_mean
from studies.report.cell_formats import cell
from tests.cubes import point_cube


def test_energy_over_the_truths():
    truth = point_cube(AWR1843, num_frames=2)
    fainter = replace(truth, values=truth.values / np.float32(10))
    assert energy_db(truth, truth) == pytest.approx(0.0)
    assert energy_db(fainter, truth) == pytest.approx(-20.0, abs=1e-3)
    assert energy_db(replace(truth, values=0 * truth.values), truth) < -200


def test_a_row_whose_energy_is_gone_says_so():
    for energy, reported in ((-35.0, "paper, collapsed: 35 dB too little energy"), (-1.0, "paper")):
        values = {"ra_ssim": np.array([0.1, 0.3]), "energy_db": np.array([energy, energy])}
        row = _row("paper", values, ["office_0", "office_1"], "test_room")
        assert cell("{method}{metrics.energy_db:collapse}", row) == reported


def test_the_mean_of_training_rooms_is_theirs_alone_and_does_not_move(tiny_signals: Path):
    rooms, plan = read_rooms(tiny_signals), read_plan(tiny_signals)
    office = next(room for room in rooms if room.kind == "office")
    (case,) = cases_of(rooms, "validation", 1, plan, 0)
    cube = training_mean(rooms)(case)
    first = office.cube(office.split.index("train")).values
    assert case.room.kind == "dining_room"
    assert cube.values == pytest.approx(np.repeat(first.mean(axis=0, keepdims=True), len(first), axis=0), rel=1e-4)
