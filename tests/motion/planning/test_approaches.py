"""Walks that end at seats of the room: straight, along a couch behind its table, sideways onto a chair at a table."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import Scene
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.approaches import approaches
from mmweaver.motion.planning.floor_map import FloorMap
from rooms import WINDOW_M, room, seat

BODY = SkeletonProportions(1.7)


def couch_behind_a_table() -> Scene:
    couch = replace(seat(y_m=2.7), size_m=(1.6, 0.5))
    return room(boxes=((-0.9, 0.9, 2.45, 3.2), (-0.7, 0.7, 1.55, 2.1)), seats=(couch,))


def chair_at_a_table() -> Scene:
    return room(
        boxes=((-0.2, 0.2, 2.25, 2.7), (-0.9, 0.9, 1.4, 2.2)), seats=(replace(seat(y_m=2.45), size_m=(0.4, 0.4)),)
    )


def test_one_walks_along_a_couch_behind_its_table():
    scene = couch_behind_a_table()
    floor = FloorMap.of(scene, WINDOW_M, 1.7)
    ways = approaches(floor, BODY)
    assert ways
    for way in ways:
        assert floor.clearance_at(way.sitting.feet_m) > 0.05
        if way.gate_m is not None:
            assert bool(floor.can_stand(way.gate_m))
            along = way.gate_m + np.linspace(0, 1, 20)[:, None] * (way.sitting.feet_m - way.gate_m)
            assert (floor.clearance_at(along) > 0.0).all()
    assert any(way.gate_m is not None for way in ways) or not bool(floor.can_stand(ways[0].sitting.feet_m))


def test_on_a_chair_at_a_table_one_sits_sideways():
    floor = FloorMap.of(chair_at_a_table(), WINDOW_M, 1.7)
    ways = approaches(floor, BODY)
    assert ways
    assert all(abs(way.sitting.facing_rad + np.pi / 2) > 0.8 for way in ways)


@pytest.mark.parametrize("scene", [couch_behind_a_table(), chair_at_a_table()], ids=["couch", "chair"])
def test_a_walk_ends_at_the_seat_of_the_room(scene: Scene):
    for seed in range(3):
        motion = compose(plan_motion("a person walks, then sits down"), scene, seed=seed, range_window_m=WINDOW_M)
        assert not any("stool" in note for note in motion.assumptions)
