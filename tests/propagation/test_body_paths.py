"""A person's paths: what they occlude, and what of them stays in memory."""

import gc
import weakref

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import PoseSequence
from mmweaver.propagation.body_model import body_of
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL
from mmweaver.propagation.visible_body import occluded_by
from tests.rooms import back_wall, floor, scene_of, side_wall, standing_person


@pytest.fixture(scope="module")
def room() -> Simulator:
    return Simulator(scene_of((floor(), back_wall(), side_wall(1.5, "metal"))), AWR1843, IDEAL)


def paths_of(person: PoseSequence, simulator: Simulator) -> BodyPaths:
    joints_m = simulator._joints_at_nodes(person, np.arange(1))
    return BodyPaths(simulator.room, body_of(person), simulator.clock, joints_m)


@pytest.mark.parametrize(
    "place_m", [(0.0, 0.5, -1.2), (0.3, 1.0, -1.2), (-1.2, 1.5, -1.2), (0.9, 0.7, -1.2), (0.4, 2.9, -1.2)]
)
def test_whatever_is_occluded_is_near_the_body(place_m: tuple[float, float, float], room: Simulator):
    paths = paths_of(standing_person(place_m), room)
    every = np.arange(len(room.room.paths))
    occluded = occluded_by(paths.posed.hulls[0], room.room.paths, every)
    assert len(occluded) > 10
    assert np.isin(occluded, paths.occludable(0)).all()


def test_furniture_hides_a_body_behind_it_and_none_in_front_of_it():
    """A metal panel in the open: 0.4 m in front of the body, 0.4 m behind it, or not there."""
    person = standing_person((0.0, 2.0, -1.2))
    shares = []
    for panels in ((back_wall(1.6, "metal"),), (back_wall(2.4, "metal"),), ()):
        simulator = Simulator(scene_of((floor(-8.0), *panels)), AWR1843, IDEAL)
        shares.append(float(paths_of(person, simulator).visible.mean()))
    hidden, before, alone = shares
    assert hidden == 0.0
    assert before == alone > 0.2


def test_a_motion_leaves_memory_without_the_garbage_collector(room: Simulator):
    gc.disable()
    try:
        paths = paths_of(standing_person((0.2, 2.0, -1.2)), room)
        assert paths.second is not None
        kept = [weakref.ref(paths), weakref.ref(paths.second), weakref.ref(paths.posed)]
        del paths
        assert [one() for one in kept] == [None, None, None]
    finally:
        gc.enable()
