"""Going to a thing of the room."""

import dataclasses

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import Landmark, Scene
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.missing import REFUSE, STAND_IN, with_stand_ins
from mmweaver.motion.planning.placement import Conditions, place
from mmweaver.motion.planning.targets import drop_targets
from tests.motion.rooms import WINDOW_M, room, seat

DOOR = Landmark(kind="door", position_m=np.array([0.9, 2.9, -0.1]), approach_m=(0.75, 2.5), facing_rad=1.2)


def _plan(target: str) -> MotionPlan:
    walk = Step(lower="walk", target=target, clause=f"walks to the {target}", start_s=0.0, end_s=3.0)
    return MotionPlan(text=walk.clause, steps=(walk, Step(start_s=3.0, end_s=4.0)))


def _placed(scene: Scene, target: str, seed: int = 0):
    return place(_plan(target), FloorMap(scene, WINDOW_M, 1.75), SkeletonProportions(1.75), Conditions(seed=seed))[0]


@pytest.mark.parametrize("seed", range(5))
def test_the_walk_ends_at_the_door_and_faces_it(seed: int):
    scene = dataclasses.replace(room(), landmarks=(DOOR,))
    path = _placed(scene, "door", seed).path
    end = path.position_m(np.array([3.9]))[0]
    assert end == pytest.approx(DOOR.approach_m, abs=0.03)
    assert np.angle(np.exp(1j * (path.facing_rad(np.array([3.9]))[0] - DOOR.facing_rad))) == pytest.approx(0, abs=0.05)


def test_it_goes_round_what_stands_between():
    blocked = dataclasses.replace(room(boxes=((-0.6, 0.5, 1.9, 2.1),)), landmarks=(DOOR,))
    for seed in range(4):
        floor = FloorMap(blocked, WINDOW_M, 1.75)
        way = _placed(blocked, "door", seed).path.position_m(np.linspace(0, 3.9, 60))
        assert floor.can_stand(way).all()


def test_what_the_room_lacks_is_refused_with_what_it_has():
    scene = dataclasses.replace(room(seats=(seat(),)), landmarks=(DOOR, dataclasses.replace(DOOR, kind="table")))
    floor = FloorMap(scene, WINDOW_M, 1.75)
    with pytest.raises(InputError, match=r"no window .*a door, a seat, a table.*--landmark window=X,Y"):
        with_stand_ins(_plan("window"), floor, REFUSE, seed=0)
    own, (note,) = with_stand_ins(_plan("window"), floor, STAND_IN, seed=0)
    assert "no window is in the picture" in note
    assert [mark.kind for mark in own.landmarks] == ["door", "table", "window"]
    assert bool(floor.can_stand(np.array(own.landmarks[-1].approach_m)))
    assert _placed(scene, "desk").path  # a desk is a table


@pytest.mark.parametrize(
    "text", ["a person points at the door", "a person faces the door", "a person waves to the door"]
)
def test_who_points_at_a_landmark_faces_it(text: str):
    plan = plan_motion(text)
    scene = dataclasses.replace(room(), landmarks=(DOOR,))
    path = place(plan, FloorMap(scene, WINDOW_M, 1.75), SkeletonProportions(1.75), Conditions(seed=1))[0].path
    end_s = np.array([plan.duration_s])
    x, y = DOOR.position_m[:2] - path.position_m(end_s)[0]
    assert np.angle(np.exp(1j * (path.facing_rad(end_s)[0] - np.arctan2(y, x)))) == pytest.approx(0, abs=0.2)
    with pytest.raises(InputError, match="no door"):
        with_stand_ins(plan, FloorMap(room(), WINDOW_M, 1.75), REFUSE, seed=1)
    assert any("no door to face" in note for note in drop_targets(plan).notes)


def test_who_cannot_walk_there_from_a_seat_gets_up_elsewhere():
    """The sofa stands right at the table: no walk leads from one to the other."""
    table = Landmark(kind="table", position_m=np.array([0.0, 2.6, -0.7]), approach_m=(0.0, 2.0), facing_rad=1.5)
    scene = dataclasses.replace(room(seats=(seat(y_m=2.4),)), landmarks=(table,))
    plan = plan_motion("a person gets up and walks to the table")
    placed = place(plan, FloorMap(scene, WINDOW_M, 1.75), SkeletonProportions(1.75), Conditions(seed=0))[0]
    assert any("no seat" in note for note in placed.assumptions)
