"""Fallbacks if a motion finds no room, from the smallest to the largest change, and recovery options.

Going on elsewhere; floor that is only assumed; walking on the spot; all other travelling movements on the spot, and
falls in another direction; finally, lying where furniture is touched least.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Float

from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.core.records import Scene
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.plan import FALLING_ON, MotionPlan, Shape, Step, Way
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.named_places import cells_of
from mmweaver.motion.planning.targets import SEATS

Result = TypeVar("Result")
_WALKS = ("walk", "jog", "limp", "stagger")  # gaits with an on-the-spot variant
# On-the-spot replacement of travelling movements, and its verb; all others march ("walks").
_ON_THE_SPOT = {
    "jog": ("jog", "runs"),
    "stumble": ("stumble", "stumbles"),
    "crawl": ("crawl", "crawls"),
    "hop": ("hop", "hops"),
    "hop_one_leg": ("hop_one_leg", "hops"),
    "leap": ("jump", "jumps"),
    "forward_roll": ("squat", "squats"),
    "walking_lunge": ("lunge", "lunges"),
}
_FALL_STYLES = {"back": "backwards", "left": "to the left", "right": "to the right", "front": "forwards"}
_FALLEN = ("fall", "lie", "roll_over", "get_up")  # steps of a fall, which share their direction
_SAYS_AHEAD = frozenset({"forward", "forwards", "ahead", "straight", "advances", "advancing"})
DEEP_M = 0.03  # penetration on a tight floor beyond which other fallbacks are tried first
_ANY_NEAR_M, _ANY_FAR_M = 0.2, 30.0
_MAX_RADARS = 3
_MUCH_MORE = 2.0  # factor by which a longer window must increase the free floor to be suggested
ASSUMED_FLOOR = (
    "the photo shows no free floor for this: the person stands where floor is assumed, behind furniture or before what"
    " fills the picture, and may be occluded"
)
NARROW_FLOOR = (
    "no free floor is as wide as a body: the person stands in a gap that is deep enough for the trunk, and may touch"
    " what is next to it"
)
Option = tuple[MotionPlan, FloorMap, tuple[str, ...]]


def relax_constraints(
    plan: MotionPlan,
    floor: FloorMap,
    compose_on: Callable[[MotionPlan, FloorMap], Result],
    *,
    may_touch: bool = True,
    depth_m: Callable[[Result], float] = lambda _: 0.0,
    farthest_m: float = math.inf,
) -> tuple[MotionPlan, Result, tuple[str, ...]]:
    """Composes a plan by the first of several fallbacks that finds room.

    In order: unchanged; walking on in another direction; on assumed floor; walking on the spot; with `may_touch`, all
    travelling movements on the spot, falls in another direction, and finally kneeling or lying where furniture is
    touched least. Of these last ones, the first whose penetration is at most DEEP_M, else the one with the least.

    Args:
        plan: Scheduled plan.
        floor: Floor of the room.
        compose_on: Composes a plan on a floor; raises InputError if there is no room.
        may_touch: Whether fallbacks that may touch furniture are tried.
        depth_m: Penetration of a result into furniture, metres.
        farthest_m: Maximum range in metres with all range bins, for the recovery options.

    Returns:
        The relaxed plan, its result, and notes on the changes.

    Raises:
        InputError: The error of the unchanged plan if no fallback succeeds; with recovery options if floor is missing.
    """
    first_error: InputError | None = None
    deep: list[tuple[MotionPlan, Result, tuple[str, ...]]] = []
    for way, way_floor, notes in _ways(plan, floor, may_touch=may_touch):
        try:
            found = way, compose_on(way, way_floor), notes
        except InputError as error:
            first_error = first_error or error
            continue
        if not way_floor.is_tight or depth_m(found[1]) <= DEEP_M:
            return found
        deep.append(found)
    if deep:
        return min(deep, key=lambda one: depth_m(one[1]))
    assert first_error is not None
    if isinstance(first_error, NoRoomError):
        raise NoRoomError(str(first_error), recovery_options=recovery_options(floor, plan, farthest_m)) from None
    raise first_error


def _ways(plan: MotionPlan, floor: FloorMap, *, may_touch: bool) -> Iterator[Option]:
    yield plan, floor, ()
    elsewhere, turned_notes = going_on_elsewhere(plan)
    if turned_notes:
        yield elsewhere, floor, turned_notes
    assumed = _like(floor, with_assumed=True)
    floors: list[tuple[FloorMap, tuple[str, ...]]] = [(floor, ())] + [(assumed, (ASSUMED_FLOOR,))] * bool(
        (assumed.walkable & ~floor.walkable).any()
    )
    walks_still = on_the_spot(plan, _walks_somewhere)
    all_still = on_the_spot(plan, _travels)
    plans = [(plan, ()), walks_still] + [all_still] * may_touch
    plans = [one for k, one in enumerate(plans) if not k or one[1] != plans[k - 1][1]]
    falls = [  # first with walks that lead somewhere, last on the spot
        [
            (other, (*notes, *fall_notes))
            for style in _FALL_STYLES
            for other, fall_notes in [falling(step_plan, style)]
            if may_touch and fall_notes
        ]
        for step_plan, notes in (plans[0], plans[-1])[: len(plans)]
    ]
    plans = [plans[0], *falls[0], *plans[1:], *(falls[1] if len(falls) > 1 else [])]
    for one, notes in plans:
        for some_floor, floor_notes in floors:
            if one is not plan or some_floor is not floor:
                yield one, some_floor, (*notes, *floor_notes)
    wide = [one for one in floors if one[0].walkable.any()]
    narrow = [(floor, (NARROW_FLOOR,)), (assumed, (ASSUMED_FLOOR, NARROW_FLOOR))]
    for one, notes in plans * may_touch:
        for some_floor, floor_notes in wide or narrow:
            yield one, _like(some_floor, is_tight=True), (*notes, *floor_notes)


def going_on_elsewhere(plan: MotionPlan) -> tuple[MotionPlan, tuple[str, ...]]:
    """Frees the direction of walks that only continue ('walks on', after a turn).

    Args:
        plan: Scheduled plan.

    Returns:
        The changed plan, and a note per changed walk.
    """
    ahead = [step for step in plan.steps[1:] if step.lower in ("walk", "jog") and step.direction == Way.FORWARDS]
    walks = [step for step in ahead if not _SAYS_AHEAD & {*step.clause.split()}]
    notes = tuple(
        f"there is no room to go on ahead for {step.clause or step.name!r}: the person turns to where there is room"
        for step in walks
    )
    steps = tuple(replace(step, direction=None) if step in walks else step for step in plan.steps)
    return replace(plan, steps=steps), notes


def _like(floor: FloorMap, *, with_assumed: bool = False, is_tight: bool = False) -> FloorMap:
    return FloorMap.of(
        floor.scene,
        floor.range_window_m,
        floor.height_m,
        with_assumed=with_assumed or floor.with_assumed,
        is_tight=is_tight,
    )


def _walks_somewhere(step: Step) -> bool:
    """Whether a step is a walk without a destination in the room."""
    return step.moves and step.lower in _WALKS and not step.target and step.direction != Way.SEAT and _is_free(step)


def _travels(step: Step) -> bool:
    """Whether a step may be replaced on the spot: it travels, but to no place or landmark other than a seat."""
    return step.moves and (not step.target or step.target in SEATS) and _is_free(step)


def _is_free(step: Step) -> bool:
    return step.place is None and not step.route_m


def on_the_spot(plan: MotionPlan, is_meant: Callable[[Step], bool]) -> tuple[MotionPlan, tuple[str, ...]]:
    """Replaces steps by their on-the-spot variants.

    Args:
        plan: Scheduled plan.
        is_meant: Selects the steps.

    Returns:
        The changed plan, and a note per changed step.
    """
    steps, notes = [], []
    for step in plan.steps:
        if is_meant(step):
            lower, does = _ON_THE_SPOT.get(step.lower, ("march", "walks"))
            notes.append(f"there is no room for {step.clause or step.name!r}: the person {does} on the spot")
            step = replace(step, lower=lower, direction=Shape.SPOT, count=0, arc_deg=0.0, target="")
        steps.append(step)
    return replace(plan, steps=tuple(steps)), tuple(notes)


def falling(plan: MotionPlan, style: str) -> tuple[MotionPlan, tuple[str, ...]]:
    """Redirects the falls of a plan; lying after a fall and getting up follow.

    Args:
        plan: Scheduled plan.
        style: back, left, right or front.

    Returns:
        The changed plan, and a note per redirected fall.
    """
    steps, notes, fallen = [], [], False
    for number, step in enumerate(plan.steps):
        if step.style == FALLING_ON and number + 1 < len(plan.steps) and plan.steps[number + 1].style != style:
            step = replace(step, style="")  # a stumble goes on into a fall of its own direction only
        falls_otherwise = step.lower == "fall" and step.style != style
        fallen = falls_otherwise or (fallen and step.lower in _FALLEN and step.lower != "fall")
        steps.append(replace(step, style=style) if fallen else step)
        if falls_otherwise:
            notes.append(
                f"there is no floor for {step.clause or step.name!r}: the person falls {_FALL_STYLES[style]} instead"
            )
    return replace(plan, steps=tuple(steps)), tuple(notes)


def recovery_options(floor: FloorMap, plan: MotionPlan, farthest_m: float = math.inf) -> dict[str, Any]:
    """Suggests where there would be room: the nearest free position, its range window, and radar presets that cover it.

    If the room lacks floor at a place that the plan names, the nearest position of that place.

    Args:
        floor: Floor of the room in the current range window.
        plan: Scheduled plan.
        farthest_m: Maximum range of the radar in metres.

    Returns:
        `nearest_place_m`, `range_m` (None if beyond the radar) and `radars`; empty if the photo shows no such floor at
        any distance, or hardly more than in the window.
    """
    place = None
    for reach_m in dict.fromkeys((min(farthest_m, _ANY_FAR_M), _ANY_FAR_M)):
        if place is None and reach_m > _ANY_NEAR_M:
            place, is_own = _nearest_place(floor, plan, (_ANY_NEAR_M, reach_m)), reach_m <= farthest_m
    if place is None:
        return {}
    near_m, far_m = window_about(floor.scene, floor.height_m, place, floor.range_window_m)
    radars = [name for name in PRESETS if PRESETS[name].range_m[0] <= near_m and PRESETS[name].range_m[-1] >= far_m][
        :_MAX_RADARS
    ]
    if not (is_own or radars):
        return {}
    return {
        "nearest_place_m": [round(float(part), 2) for part in place],
        "range_m": [near_m, far_m if far_m <= farthest_m else math.floor(100 * farthest_m) / 100] if is_own else None,
        "radars": radars,
    }


def _nearest_place(floor: FloorMap, plan: MotionPlan, window_m: tuple[float, float]) -> Float[np.ndarray, "2"] | None:
    """The free position nearest to the radar in another window, if that window shows much more floor."""
    anywhere = FloorMap.of(floor.scene, window_m, floor.height_m, with_assumed=True)
    named = [step.place for step in plan.steps if step.place is not None and not len(_cells_if_any(step.place, floor))]
    if not named and np.count_nonzero(anywhere.walkable) < _MUCH_MORE * np.count_nonzero(floor.walkable):
        return None
    places_m = _cells_if_any(named[0], anywhere) if named else anywhere.walkable_m
    return places_m[np.argmin(np.hypot(*places_m.T))] if len(places_m) else None


def _cells_if_any(place: Place, floor: FloorMap) -> Float[np.ndarray, "cell 2"]:
    """The walkable cells of a place; empty if the room has none."""
    try:
        return cells_of(place, floor)
    except NoRoomError:
        return np.zeros((0, 2))


def window_about(
    scene: Scene, height_m: float, place_m: np.ndarray, window_m: tuple[float, float]
) -> tuple[float, float]:
    """Range window that covers a person at a position.

    Args:
        scene: The room.
        height_m: Height of the body in metres.
        place_m: Position (x, y) in metres.
        window_m: Window that is extended.

    Returns:
        Nearest and farthest slant range in metres, at least as wide as `window_m`.
    """
    heights_m = scene.floor_z_m + height_m * np.array([0.0, 0.5, 1.0])
    slant_m = np.sqrt(float(place_m @ place_m) + heights_m**2)
    near_m, far_m = float(slant_m.min()) - 0.3, float(slant_m.max()) + 0.3
    return round(max(min(near_m, window_m[0]), 0.2), 1), round(max(far_m, window_m[1]), 1)
