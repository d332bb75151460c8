"""What is tried where a motion finds no room."""

import dataclasses

import numpy as np
import pytest

from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.core.records import Scene
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.plan import APPROXIMATED
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.constraint_relaxation import (
    NARROW_FLOOR,
    relax_constraints,
)
from mmweaver.motion.planning.floor_map import FloorMap
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
    with pytest.raises(NoRoomError, match=r"nearest .*--range") as caught:
        _composed("a person waves", far)
    x, y = caught.value.recovery_options["nearest_place_m"]
    near_m, far_m = caught.value.recovery_options["range_m"]
    assert far_m > y > 3.6
    helped = compose(plan_motion("a person waves", 2.0), far, seed=0, range_window_m=(near_m, far_m))
    assert np.hypot(*(helped.pose.joints_m[0, 0, :2] - (x, y))) < 2.5
    with pytest.raises(NoRoomError) as caught:
        _composed("a person waves", room(boxes=FULL))
    assert caught.value.recovery_options == {}


GAP = ((-3.0, -0.22, 0.0, 6.0), (0.22, 3.0, 0.0, 6.0))
ALL_THAT_TRAVELS_OR_LIES = (
    "he stumbles and falls forward, gets up and limps away", "a child crawls to the left",
    "he jumps forward", "he hops to the left on one leg", "he does push-ups", "a person lies down on the floor",
    "a person kneels down", "she falls off the chair", "a person lies down on the bed",
)  # fmt: skip


@pytest.mark.parametrize("text", ALL_THAT_TRAVELS_OR_LIES)
def test_what_finds_no_room_is_approximated_and_said_in_its_clause(text: str):
    made = compose(plan_motion(text), room(boxes=CELL), seed=0, range_window_m=WINDOW_M)
    assert np.isfinite(made.pose.joints_m).all()
    assert any(record.status == APPROXIMATED for record in made.clauses) or any("bed" in n for n in made.assumptions)
    with pytest.raises(NoRoomError):
        compose(plan_motion(text), room(boxes=CELL), seed=0, range_window_m=WINDOW_M, may_touch=False)


def test_a_fall_goes_where_there_is_floor_and_so_does_getting_up():
    plan = plan_motion("he falls forward, then gets up")
    short = room(boxes=((-3.0, 3.0, 0.0, 1.0), (-3.0, 3.0, 3.2, 6.0), (-3.0, -1.1, 0.0, 6.0), (1.1, 3.0, 0.0, 6.0)))
    made = compose(plan, short, seed=0, range_window_m=WINDOW_M)
    styles = {step.style for step in made.plan.steps}
    assert len(styles) == 1
    assert "front" not in styles
    assert any("instead" in note for note in made.assumptions)
    assert not any("reaches beyond" in note for note in made.assumptions)


def test_in_a_gap_narrower_than_a_body_somebody_stands_and_it_is_said():
    made = _composed("a person waves", room(boxes=GAP))
    assert abs(made.pose.joints_m[0, 0, 0]) < 0.12
    assert NARROW_FLOOR in made.assumptions


def test_where_floor_is_tight_the_way_that_gets_least_into_furniture_is_taken():
    floor = FloorMap.of(room(boxes=CELL), WINDOW_M, 1.7)
    plan = plan_motion("he stumbles, then falls forward")
    tried: list[tuple[str, float]] = []

    def composed(depths: dict[str, float]):
        def compose_on(way, way_floor):
            if not way_floor.is_tight:
                raise InputError("no room")
            way_of = "there" if way.steps[0].moves else f"spot, {way.steps[1].style}"
            tried.append((way_of, depths.get(way_of, 0.5)))
            return tried[-1]

        return relax_constraints(plan, floor, compose_on, depth_m=lambda result: result[1])[1][0]

    assert composed({"there": 0.57, "spot, front": 0.01}) == "spot, front"
    assert composed({"there": 0.02}) == "there"
    assert composed({"there": 0.4, "spot, front": 0.3, "spot, left": 0.1}) == "spot, left"


def test_who_crawls_longer_than_the_floor_goes_to_and_fro():
    square = room(boxes=((-3.0, -1.6, 0.0, 6.0), (1.6, 3.0, 0.0, 6.0), (-3.0, 3.0, 4.0, 6.0)))
    made = compose(plan_motion("a person crawls for ten seconds"), square, seed=0, range_window_m=WINDOW_M)
    assert not made.assumptions
    pelvis_m = made.pose.joints_m[:, 0, :2].astype(float)
    way_m = np.linalg.norm(np.diff(pelvis_m[::12], axis=0), axis=1).sum()
    assert way_m > 1.3 * np.ptp(pelvis_m, axis=0).max()
    assert way_m > 1.5


def test_an_advised_window_is_one_that_the_radar_has():
    """The radar sees up to 5.07 m; where the free floor begins beyond, only other radars are named."""
    plan = plan_motion("a person waves", 2.0)
    for first_free_m, sees_it in ((4.3, True), (6.0, False)):
        far = room(boxes=((-3.0, 3.0, 0.0, first_free_m),), depth_m=9.0, width_m=6.0)
        with pytest.raises(NoRoomError) as caught:
            compose(plan, far, seed=0, range_window_m=WINDOW_M, farthest_m=5.07)
        window_m = caught.value.recovery_options["range_m"]
        assert (window_m is not None) == sees_it
        if sees_it:
            assert window_m[1] <= 5.07
            compose(plan, far, seed=0, range_window_m=tuple(window_m))
        else:
            assert "--range" not in str(caught.value).split("try ")[-1]
            assert caught.value.recovery_options["radars"]
