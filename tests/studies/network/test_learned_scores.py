"""Scores of the learned method: energy is compared with the ground truth, baselines know the training rooms alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from studies.network.learned_scores import cases_of, energy_db, training_mean, true_cube
from tests.cubes import point_cube


def test_energy_over_the_truths():
    truth = point_cube(AWR1843, num_frames=2)
    fainter = replace(truth, values=truth.values / np.float32(10))
    assert energy_db(truth, truth) == pytest.approx(0.0)
    assert energy_db(fainter, truth) == pytest.approx(-20.0, abs=1e-3)
    assert energy_db(replace(truth, values=0 * truth.values), truth) < -200


def test_the_mean_of_training_rooms_is_theirs_alone_and_does_not_move(tiny_signals: Path):
    rooms, plan = read_rooms(tiny_signals), read_plan(tiny_signals)
    office = next(room for room in rooms if room.kind == "office")
    (case,) = cases_of(rooms, "validation", 1, plan, 0)
    cube = training_mean(rooms, plan["seed"])(case)
    first = true_cube(office, office.split.index("train"), plan["seed"]).values
    assert case.room.kind == "dining_room"
    assert cube.values == pytest.approx(np.repeat(first.mean(axis=0, keepdims=True), len(first), axis=0), rel=1e-4)
