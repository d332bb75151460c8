"""Several people before one radar: far apart a sum, behind one another a shadow."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import PoseSequence
from mmweaver.propagation.body_model import body_of
from mmweaver.propagation.ray_traced import PeoplePaths, Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.propagation.static_paths import AS_PUBLISHED
from tests.rooms import back_wall, floor, scene_of, side_wall, standing_person

NOTHING = scene_of((floor(-8.0),))


@pytest.fixture(scope="module")
def nowhere() -> Simulator:
    """Occlusion alone: no paths from one person over another, which test_body_body_paths.py holds."""
    return Simulator(NOTHING, AWR1843, IDEAL, propagation=AS_PUBLISHED)


@pytest.fixture(scope="module")
def room() -> Simulator:
    return Simulator(scene_of((floor(), back_wall(), side_wall(1.5, "metal"))), AWR1843, IDEAL)


def person(x_m: float, y_m: float, subject: int = 0) -> PoseSequence:
    return replace(standing_person((x_m, y_m, -1.2)), subject=subject)


def echo(simulator: Simulator, *people: PoseSequence) -> np.ndarray:
    """What the people change in the samples of one frame, (loop, tx, rx, sample)."""
    adc = simulator.run(people, num_frames=1, seed=0).adc.samples[0]
    return adc - simulator.room_adc


def energy(samples: np.ndarray) -> float:
    return float((np.abs(samples) ** 2).sum())


def test_nobody_is_the_empty_room(room: Simulator):
    adc = room.run((), num_frames=2, seed=0).adc.samples
    assert np.allclose(adc, room.room_adc, atol=1e-9)


def test_two_far_apart_are_the_sum_of_both(nowhere: Simulator, room: Simulator):
    left, right = person(-0.9, 2.2), person(0.7, 1.9, subject=1)
    both, each = echo(nowhere, left, right), echo(nowhere, left) + echo(nowhere, right)
    assert energy(both - each) < 1e-6 * energy(each)
    # in a room the shadows on it overlap in places, and each stands in the way of some of the other's ghosts
    both, each = echo(room, left, right), echo(room, left) + echo(room, right)
    assert 0 < energy(both - each) < 0.1 * energy(each)


def test_who_stands_behind_another_is_dimmed(nowhere: Simulator):
    front, behind = person(0.0, 1.4), person(0.0, 2.4, subject=1)
    of_behind = echo(nowhere, front, behind) - echo(nowhere, front)
    assert energy(of_behind) < 0.1 * energy(echo(nowhere, behind))
    aside = person(0.9, 2.4, subject=1)
    of_aside = echo(nowhere, front, aside) - echo(nowhere, front)
    assert energy(of_aside) == pytest.approx(energy(echo(nowhere, aside)), rel=1e-3)


def test_ghosts_are_hidden_by_others_too(room: Simulator):
    """Somebody between a person and the metal wall beside takes that person's ghosts away."""
    seen, screen = person(0.0, 2.0), person(0.75, 1.5, subject=1)
    middle = room._joints_at_nodes(seen, np.arange(1)), room._joints_at_nodes(screen, np.arange(1))
    alone = PeoplePaths(room.room, [body_of(seen)], room.clock, [middle[0]])
    both = PeoplePaths(room.room, [body_of(seen), body_of(screen)], room.clock, list(middle))

    def over_the_wall(people: PeoplePaths) -> int:
        parts = people.each[0].parts
        wall = [part for part in parts if part.arrival and part.arrival.plane.material == "metal"]
        return sum(int(part.present.sum()) for part in wall)

    assert over_the_wall(alone) > 20
    assert over_the_wall(both) < 0.7 * over_the_wall(alone)
