"""What is alike cannot be reported apart, what differs can; statistics see the differences that matter."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.presets import AWR1843
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.models.activity_network import ActivityNetwork
from studies.network import real_or_simulated
from studies.network.cube_statistics import cube_statistics
from studies.network.learned_scores import Case
from studies.network.real_or_simulated import board_by, folds_of, real_or_simulated_scores
from studies.recognition.activity_classifier import ClassifierSettings
from tests.cubes import point_cube

ROOMS = [f"room_{index // 3}" for index in range(60)]


def _sampled(seed: int, middle: float) -> np.ndarray:
    return stream(seed, "test statistics").normal(middle, 1.0, (len(ROOMS), 12))


def test_no_room_is_learned_from_and_judged():
    folds = folds_of(ROOMS)
    assert sum(len(fold) for fold in folds) == len(set().union(*folds)) == 20


@pytest.fixture
def few_trees(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(real_or_simulated, "SETTINGS", ClassifierSettings(num_trees=60, boosting_rounds=20))


@pytest.mark.usefixtures("few_trees")
def test_alike_is_half_and_different_is_told():
    assert abs(real_or_simulated_scores(_sampled(0, 0.0), _sampled(1, 0.0), ROOMS).mean() - 0.5) < 0.15
    assert real_or_simulated_scores(_sampled(0, 0.0), _sampled(1, 2.0), ROOMS).mean() > 0.9


@pytest.mark.usefixtures("few_trees")
def test_what_is_learned_of_a_room_does_not_help_in_another():
    """Each room's true and generated cubes lie far apart, but nowhere in the same way."""
    rng = stream(0, "test offsets")
    true, made = (_sampled(seed, 0.0) / 5 + np.repeat(rng.normal(0, 3, (20, 12)), 3, axis=0) for seed in (0, 1))
    assert real_or_simulated_scores(true, made, ROOMS).mean() < 0.75


def test_statistics_see_loudness_places_and_antennas():
    torch.manual_seed(0)
    network = ActivityNetwork(AWR1843).eval()
    cube = point_cube(AWR1843, num_frames=5, noise=0.3)
    cube = replace(cube, values=cube.values * np.float32(1e-4))
    own = cube_statistics(cube, network)
    assert np.isfinite(own).all()
    assert np.array_equal(own, cube_statistics(cube, network))
    for other in (
        2 * cube.values,
        cube.values[:, ::-1].copy(),
        cube.values[..., ::-1].copy(),
        cube.values[::-1].copy(),
    ):
        assert not np.allclose(own, cube_statistics(replace(cube, values=other), network), atol=1e-3)


def test_boards_are_typical_ones_of_each_side_and_case(tiny_signals: Path):
    room = read_rooms(tiny_signals)[0]
    case, other = (Case(room, index, room, 0, "day") for index in (0, 1))
    recorded, generated = (board_by("typical", whose) for whose in ("true", "generated"))
    boards = [recorded(case), generated(case), recorded(other)]
    assert len({board.to_json() for board in boards}) == 3
    assert recorded(case).to_json() == boards[0].to_json()
    assert board_by("ideal", "true")(case).is_ideal
