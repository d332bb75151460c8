"""What is tried where a motion finds no room."""

import dataclasses

import numpy as np
import pytest

from mmweaver.core.errors import NoRoomError
from mmweaver.core.records import Scene
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.more_room import going_on_elsewhere
from tests.motion.rooms import WINDOW_M, room

FULL = ((-3.0, 3.0, 0.0, 6.0),)
CELL = ((-3.0, -0.4, 0.0, 6.0), (0.4, 3.0, 0.0, 6.0), (-3.0, 3.0, 0.0, 1.6), (-3.0, 3.0, 2.4, 6.0))


def _composed(text: str, scene: Scene) -> Motion:
    return compose(plan_motion(text, 2.0), scene, seed=0, range_window_m=WINDOW_M)


def _with_assumed(scene: Scene, low_y_m: float, high_y_m: float) -> Scene:
    free = scene.free_space
    assumed = np.broadcast_to(((free.y_m > low_y_m) & (free.y_m < high_y_m))[:, None], free.is_free.shape)
    return dataclasses.replace(scene, free_space=dataclasses.replace(free, is_assumed=assumed & ~free.is_free))


def test_assumed_floor_is_used_only_where_there_is_no_other_and_said():
    made = _composed("a person waves", _with_assumed(room(boxes=FULL), 1.8, 2.8))
    assert 1.8 < made.pose.joints_m[0, 0, 1] < 2.8
    assert any("floor is assumed" in note for note in made.assumptions)
    open_room = _composed("a person waves", _with_assumed(room(boxes=((-3.0, 3.0, 0.0, 1.6),)), 0.5, 1.6))
    assert not any("floor is assumed" in note for note in open_room.assumptions)


def test_a_walk_that_finds_no_room_is_shown_on_the_spot_and_said():
    made = _composed("a person walks to the left", room(boxes=CELL))
    pelvis = made.pose.joints_m[:, 0, :2]
    assert np.ptp(pelvis, axis=0).max() < 0.3
    assert made.pose.joints_m[:, 7, 2].max() - made.pose.joints_m[:, 7, 2].min() > 0.03, "the feet step"
    assert any("on the spot" in note for note in made.assumptions)


def test_an_error_names_the_nearest_place_the_window_it_needs_and_radars():
    far = room(boxes=((-3.0, 3.0, 0.0, 3.6),), depth_m=8.0, width_m=6.0)
    with pytest.raises(NoRoomError, match=r"nearest free place is .*try --range") as caught:
        _composed("a person waves", far)
    x, y = caught.value.ways_on["nearest_place_m"]
    near_m, far_m = caught.value.ways_on["range_m"]
    assert far_m > y > 3.6
    helped = compose(plan_motion("a person waves", 2.0), far, seed=0, range_window_m=(near_m, far_m))
    assert np.hypot(*(helped.pose.joints_m[0, 0, :2] - (x, y))) < 2.5
    with pytest.raises(NoRoomError) as caught:
        _composed("a person waves", room(boxes=FULL))
    assert caught.value.ways_on == {}


def test_who_has_no_room_to_walk_on_ahead_turns_and_it_is_said():
    corridor = room(boxes=((-3.0, -0.4, 0.0, 6.0), (0.4, 3.0, 0.0, 6.0), (-3.0, 3.0, 0.0, 1.6), (-3.0, 3.0, 3.6, 6.0)))
    plan = plan_motion("a person walks, stops, waves and walks on", 6.0)
    made = compose(plan, corridor, seed=0, range_window_m=WINDOW_M)
    assert [note for note in made.assumptions if "no room to go on ahead for 'walks on'" in note]
    assert made.plan.steps[-1].moves
    assert going_on_elsewhere(plan_motion("a person walks, stops, then walks forward", 6.0))[1] == ()
