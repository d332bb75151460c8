"""The free floor of a place that the sentence names, and the steps that lead there."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.core.records import Scene
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.targets import SEATS, kinds_of, what_was_found

Array = np.ndarray
NEAR_M = 1.2  # from the middle of what one stands near
BESIDE_M, REACH_M = 0.25, 1.8  # from the middle of what one stands behind, in front or at a side of: least and most
WIDTH_M = 0.9  # half the width of that strip
RANGE_TOLERANCE_M = 0.2
SHARE = 1 / 3  # of the free floor that is left, right, far ...


def settled(plan: MotionPlan) -> MotionPlan:
    """The plan with places at the steps that can obey them: where the person starts, or the walk before goes.

    Raises InputError for a place that nobody walks to.
    """
    steps = list(plan.steps)
    for k, step in enumerate(steps):
        if step.place is None or step.moves or k == 0:
            continue
        moving = [j for j in range(k) if steps[j].moves]
        if not moving:
            steps[0] = replace(steps[0], place=steps[0].place or step.place)
        elif _is_open(steps[moving[-1]]):
            steps[moving[-1]] = replace(steps[moving[-1]], place=step.place)
        elif steps[moving[-1]].place != step.place:
            raise InputError(
                f"{step.clause!r} is {step.place.words}, but {steps[moving[-1]].clause!r} goes elsewhere; say"
                f" 'walks, then ...' without a direction, or leave out the place"
            )
    return replace(plan, steps=tuple(steps))


def _is_open(step: Step) -> bool:
    """Whether the sentence leaves open where a walk goes."""
    return not (step.direction or step.target or step.arc_deg or step.place) and step.lower in ("walk", "jog")


def cells_of(place: Place, floor: FloorMap) -> Float[Array, "cell 2"]:
    """The walkable cells (x, y) of a place, in metres.

    Raises NoRoomError where the room has none, InputError where it lacks what the place is relative to.
    """
    cells = floor.walkable_m
    inside, part = np.ones(len(cells), bool), place
    while part is not None and len(cells):
        if part.landmark:
            inside &= np.any([_at(part, middle, cells) for middle in _middles(part, floor.scene)], axis=0)
        else:
            inside &= _within(part, cells)
        part = part.also
    cells = cells[inside]
    if not len(cells):
        raise NoRoomError(
            f"nobody can be {place.words}: no free floor is there in the picture and the radar's window; say another"
            " place, or leave it out"
        )
    return cells


def _middles(place: Place, scene: Scene) -> list[Float[Array, "2"]]:
    """Middles of what the place is relative to. Raises InputError where the photo shows none."""
    if place.landmark in SEATS:
        found = [np.asarray(seat.position_m[:2], float) for seat in scene.seats]
    else:
        kinds = kinds_of(place.landmark)
        found = [np.asarray(mark.position_m[:2], float) for mark in scene.landmarks if mark.kind in kinds]
    if not found:
        raise InputError(
            f"{place.words!r}: no {place.landmark} was found in the photo; {what_was_found(scene)}; give its position"
            f" with --landmark {kinds_of(place.landmark)[0]}=X,Y, or say another place"
        )
    return found


def _at(place: Place, middle: Float[Array, "2"], cells: Float[Array, "cell 2"]) -> Bool[Array, " cell"]:
    """Which cells stand in the relation to something with its middle there, seen from the radar."""
    away = middle / max(float(np.hypot(*middle)), 1e-6)
    aside = np.array([away[1], -away[0]])  # to the right in the picture
    along, across = (cells - middle) @ away, (cells - middle) @ aside
    if place.relation == "near":
        near = np.hypot(*(cells - middle).T)
        return near <= max(NEAR_M, float(near.min(initial=np.inf)) + 0.3) * (near.min(initial=np.inf) < 1.6)
    if place.relation in ("behind", "front"):
        depth = along if place.relation == "behind" else -along
        return (depth > BESIDE_M) & (depth < REACH_M) & (np.abs(across) < WIDTH_M)
    depth = across if place.relation == "rightof" else -across
    return (depth > BESIDE_M) & (depth < REACH_M) & (np.abs(along) < WIDTH_M)


def _within(place: Place, cells: Float[Array, "cell 2"]) -> Bool[Array, " cell"]:
    """Which cells are in the named part of the free floor."""
    x, y = cells.T
    if place.relation == "range":
        return np.abs(np.hypot(x, y) - place.distance_m) < RANGE_TOLERANCE_M
    if place.relation == "left":
        return (x <= np.quantile(x, SHARE)) & (x < 0.1)
    if place.relation == "right":
        return (x >= np.quantile(x, 1 - SHARE)) & (x > -0.1)
    if place.relation == "far":
        return y >= np.quantile(y, 1 - SHARE)
    if place.relation == "close":
        return y <= np.quantile(y, SHARE)
    middle = (cells.max(axis=0) + cells.min(axis=0)) / 2
    apart = np.hypot(*(cells - middle).T)
    return apart <= np.quantile(apart, SHARE)
