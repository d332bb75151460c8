"""What is tried where a motion finds no room: going elsewhere, floor that is only assumed, walking on the spot."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.core.presets import PRESETS
from mmweaver.core.records import Scene
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.planning.floor_map import FloorMap

Result = TypeVar("Result")
_ON_THE_SPOT = ("walk", "jog", "limp", "stagger")  # gaits that can be shown on the spot
_SAYS_AHEAD = frozenset({"forward", "forwards", "ahead", "straight", "advances", "advancing"})
_ANY_WINDOW_M = (0.2, 30.0)
_MOST_RADARS = 3
_MUCH_MORE = 2.0  # times the free floor: what a longer window must show to be of help
ASSUMED_FLOOR = (
    "the photo shows no free floor for this: the person stands where floor is assumed, behind furniture or before what"
    " fills the picture, and may be occluded"
)


def with_more_room(
    plan: MotionPlan, floor: FloorMap, compose_on: Callable[[MotionPlan, FloorMap], Result]
) -> tuple[MotionPlan, Result, tuple[str, ...]]:
    """The first of several ways to compose a plan that finds room: the plan then, its result, and notes.

    In this order: as it is; walking on elsewhere than ahead; on floor that is only assumed; walking on the spot. Raises
    the error of the first way, with ways on where no floor is free at all.
    """
    first_error: InputError | None = None
    for way, way_floor, notes in _ways(plan, floor):
        try:
            return way, compose_on(way, way_floor), notes
        except InputError as error:
            first_error = first_error or error
    assert first_error is not None
    if isinstance(first_error, NoRoomError):
        raise NoRoomError(str(first_error), ways_on=ways_on(floor)) from None
    raise first_error


def _ways(plan: MotionPlan, floor: FloorMap) -> Iterator[tuple[MotionPlan, FloorMap, tuple[str, ...]]]:
    yield plan, floor, ()
    elsewhere, turned_notes = going_on_elsewhere(plan)
    if turned_notes:
        yield elsewhere, floor, turned_notes
    assumed = FloorMap.of(floor.scene, floor.range_window_m, floor.height_m, with_assumed=True)
    more = bool((assumed.walkable & ~floor.walkable).any())
    if more:
        yield plan, assumed, (ASSUMED_FLOOR,)
    still, still_notes = on_the_spot(plan)
    if still_notes:
        yield still, floor, still_notes
        if more:
            yield still, assumed, (*still_notes, ASSUMED_FLOOR)


def going_on_elsewhere(plan: MotionPlan) -> tuple[MotionPlan, tuple[str, ...]]:
    """The plan with walks that only go on ('walks on', after a turn) led where there is room, and notes on them."""
    walks = [
        step for step in plan.steps[1:]
        if step.lower in ("walk", "jog") and step.direction == "forwards" and not _SAYS_AHEAD & set(step.clause.split())
    ]  # fmt: skip
    notes = tuple(
        f"there is no room to go on ahead for {step.clause or step.name!r}: the person turns to where there is room"
        for step in walks
    )
    steps = tuple(replace(step, direction="") if step in walks else step for step in plan.steps)
    return replace(plan, steps=steps), notes


def on_the_spot(plan: MotionPlan) -> tuple[MotionPlan, tuple[str, ...]]:
    """The plan with walks in a direction shown on the spot, and notes on them; walks to a seat or landmark stay."""
    walks = [
        step for step in plan.steps if step.moves and step.lower in _ON_THE_SPOT and not step.target
        and step.direction != "seat" and step.place is None and not step.route_m
    ]  # fmt: skip
    gaits = {"jog": "runs"}
    notes = tuple(
        f"there is no room for {step.clause or step.name!r}: the person {gaits.get(step.lower, 'walks')} on the spot"
        for step in walks
    )
    steps = tuple(
        replace(step, lower="jog" if step.lower == "jog" else "march", direction="spot", count=0, arc_deg=0.0)
        if step in walks else step
        for step in plan.steps
    )  # fmt: skip
    return replace(plan, steps=steps), notes


def ways_on(floor: FloorMap) -> dict[str, Any]:
    """Where there would be room: the nearest free place, the range window it needs, and presets that have it.

    Empty where the photo shows no floor at any distance, or hardly more than in the window.
    """
    anywhere = FloorMap.of(floor.scene, _ANY_WINDOW_M, floor.height_m, with_assumed=True)
    if np.count_nonzero(anywhere.walkable) < _MUCH_MORE * np.count_nonzero(floor.walkable):
        return {}
    place = anywhere.nearest_walkable_m(np.zeros(2))
    if place is None:
        return {}
    near_m, far_m = window_about(floor.scene, floor.height_m, place, floor.range_window_m)
    radars = [
        name for name in PRESETS
        if PRESETS[name].range_m[0] <= near_m and PRESETS[name].range_m[-1] >= far_m
    ]  # fmt: skip
    return {
        "nearest_place_m": [round(float(part), 2) for part in place],
        "range_m": [near_m, far_m],
        "radars": radars[:_MOST_RADARS],
    }


def window_about(
    scene: Scene, height_m: float, place_m: np.ndarray, window_m: tuple[float, float]
) -> tuple[float, float]:
    """The range window in metres, as wide as the given one at least, that holds a person at a place (x, y)."""
    heights_m = scene.floor_z_m + height_m * np.array([0.0, 0.5, 1.0])
    slant_m = np.sqrt(float(place_m @ place_m) + heights_m**2)
    near_m, far_m = float(slant_m.min()) - 0.3, float(slant_m.max()) + 0.3
    return round(max(min(near_m, window_m[0]), 0.2), 1), round(max(far_m, window_m[1]), 1)
