"""The free floor of a place that the sentence names, and the steps that lead there."""

from dataclasses import replace
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.core.records import Plane, Scene
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.planning.floor_map import FloorMap, distance_m, distances_m
from mmweaver.motion.planning.targets import SEATS, describe_found, kinds_of

Array = np.ndarray
NEAR_M = 1.2  # "near": from the middle of the object
BESIDE_M, REACH_M = 0.25, 1.8  # "behind", "in front", at a side: minimum and maximum from the middle
WIDTH_M = 0.9  # half the width of that strip
BETWEEN_M, BETWEEN_SHARE = 0.5, (0.15, 0.85)  # from the line between two objects, and share along it
AT_WALL_M, NEAR_WALL_M = 0.6, 0.9  # from a wall: "against", and "near"
DOORWAY_M = 0.8  # from the middle of the door
SQUARE_RAD = 0.5  # deviation of a corner from a right angle
MEETING_M = 0.6  # extension of a wall beyond its visible end to a corner
RANGE_TOLERANCE_M = 0.2
SHARE = 1 / 3  # of the free floor that counts as left, right, far ...


def settled(plan: MotionPlan) -> MotionPlan:
    """Assigns places to the steps that can realize them: the start, or the preceding walk.

    Args:
        plan: Scheduled plan.

    Returns:
        The plan with the places moved.

    Raises:
        InputError: If no walk leads to a place.
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
    """Whether the destination of a walk is open."""
    return not (step.direction or step.target or step.arc_deg or step.place) and step.lower in ("walk", "jog")


def cells_of(place: Place, floor: FloorMap) -> Float[Array, "cell 2"]:
    """The walkable cells of a place.

    Args:
        place: Place in the sentence.
        floor: Floor of the room.

    Returns:
        Cells (x, y) in metres, (cell, 2).

    Raises:
        NoRoomError: If the place has no free floor.
        InputError: If the room lacks what the place is relative to.
    """
    cells = floor.walkable_m
    _check_possible(place)
    inside, part = np.ones(len(cells), bool), place
    while part is not None and len(cells):
        if part.relation == "between":
            inside &= _middle_place(part, floor.scene, cells)
        elif part.landmark == "wall":
            inside &= _wall_places(part, floor.scene, cells)
        elif part.landmark:
            middles = _middles(part.landmark, part, floor.scene)
            inside &= np.any([_place_at(part, middle, cells) for middle in middles], axis=0)
        else:
            inside &= _inside(part, cells)
        part = part.also
    cells = cells[inside]
    if not len(cells):
        raise NoRoomError(
            f"nobody can be {place.words}: no free floor is there in the picture and the radar's window; say another"
            " place, or leave it out"
        )
    return cells


def _check_possible(place: Place) -> None:
    """Raises InputError for places that cannot be shown in any room."""
    part: Place | None = place
    while part is not None:
        if part.relation == "under":
            raise InputError(
                f"nobody is shown {part.words}, where the radar would see little of them; say 'near the"
                f" {part.landmark}' or another place, or leave it out"
            )
        if part.relation == "outside":
            raise InputError(
                "nobody is shown outside, which the photo does not show; say a place of the room, 'to the door', or"
                " leave it out"
            )
        part = part.also


def _middles(kind: str, place: Place, scene: Scene) -> list[Float[Array, "2"]]:
    """Middles of the objects that the place is relative to. Raises InputError if the photo shows none."""
    if kind == "corner":
        found = _corners(scene)
    else:
        kinds = kinds_of(kind)
        found = [np.asarray(mark.position_m[:2], float) for mark in scene.landmarks if mark.kind in kinds]
        if kind in SEATS and not found:
            found = [np.asarray(seat.position_m[:2], float) for seat in scene.seats]
    if not found:
        what = "corner of two walls" if kind == "corner" else kind
        raise InputError(
            f"{place.words!r}: no {what} was found in the photo; {describe_found(scene)}; say another place"
        )
    return found


def _walls(place: Place, scene: Scene) -> list[Float[Array, "2 2"]]:
    """The ends (x, y) of the walls of a room. Raises InputError if the photo shows none."""
    given = [np.tile(np.asarray(mark.position_m[:2], float), (2, 1)) for mark in scene.landmarks if mark.kind == "wall"]
    walls = given or [_ends(plane) for plane in scene.planes if plane.kind == "wall"]
    if not walls:
        raise InputError(
            f"{place.words!r}: no wall was found in the photo; {describe_found(scene)}; give its position with"
            " --landmark wall=X,Y, or say another place"
        )
    return walls


def _ends(wall: Plane) -> Float[Array, "2 2"]:
    """Ends of a wall on the floor, (x, y) in metres."""
    axes = ((wall.axis_u, wall.half_size_m[0]), (wall.axis_v, wall.half_size_m[1]))
    axis, half_m = min(axes, key=lambda one: abs(float(one[0][2])))
    along = np.asarray(axis, float)[:2] * half_m
    middle = np.asarray(wall.centre_m, float)[:2]
    return np.stack([middle - along, middle + along])


def _corners(scene: Scene) -> list[Float[Array, "2"]]:
    """Corners where two walls of the photo meet, or would a little beyond their visible ends."""
    walls = [_ends(plane) for plane in scene.planes if plane.kind == "wall"]
    found = []
    for (a, b), (c, d) in combinations(walls, 2):
        one, other = b - a, d - c
        lengths = float(np.hypot(*one)), float(np.hypot(*other))
        cross = float(one[0] * other[1] - one[1] * other[0])
        if min(lengths) == 0 or abs(cross) < np.cos(SQUARE_RAD) * lengths[0] * lengths[1]:
            continue
        gap = c - a
        along = (gap[0] * other[1] - gap[1] * other[0]) / cross, (gap[0] * one[1] - gap[1] * one[0]) / cross
        beyond = [max(-share, share - 1.0) * length for share, length in zip(along, lengths, strict=True)]
        if max(beyond) <= MEETING_M:
            found.append(a + along[0] * one)
    return found


def _nearest_on(wall: Float[Array, "2 2"], points: Float[Array, "point 2"]) -> Float[Array, "point 2"]:
    """Nearest points on a wall."""
    along = wall[1] - wall[0]
    share = np.clip((points - wall[0]) @ along / max(float(along @ along), 1e-9), 0.0, 1.0)
    return wall[0] + share[:, None] * along


def _wall_places(place: Place, scene: Scene, cells: Float[Array, "cell 2"]) -> Bool[Array, " cell"]:
    """Mask of cells at, or near, one of the walls."""
    away = np.min([np.hypot(*(cells - _nearest_on(wall, cells)).T) for wall in _walls(place, scene)], axis=0)
    return away <= (AT_WALL_M if place.relation == "against" else NEAR_WALL_M)


def _middle_place(place: Place, scene: Scene, cells: Float[Array, "cell 2"]) -> Bool[Array, " cell"]:
    """Mask of cells between two objects: near the line between them, away from its ends."""
    inside = np.zeros(len(cells), bool)
    for one, other in _pairs(place, scene):
        gap = other - one
        length = max(float(np.hypot(*gap)), 1e-6)
        along = (cells - one) @ gap / length**2
        across = np.abs((cells - one) @ np.array([gap[1], -gap[0]])) / length
        inside |= (along > BETWEEN_SHARE[0]) & (along < BETWEEN_SHARE[1]) & (across < BETWEEN_M)
    return inside


def _pairs(place: Place, scene: Scene) -> list[tuple[Float[Array, "2"], Float[Array, "2"]]]:
    """Ends of each line between two objects. Raises InputError without two objects."""
    kinds = sorted((place.landmark, place.other), key=lambda kind: kind == "wall")
    if kinds[0] == "wall":
        raise InputError(f"{place.words!r} is anywhere in the room; say one thing that stands there, or leave it out")
    ones = _middles(kinds[0], place, scene)
    if kinds[1] == "wall":
        return [(one, _nearest_on(wall, one[None])[0]) for one in ones for wall in _walls(place, scene)]
    others = _middles(kinds[1], place, scene)
    if kinds[0] == kinds[1]:
        found = list(combinations(ones, 2))
    else:
        found = [(one, other) for one in ones for other in others if distance_m(one, other) > 1e-6]
    if not found:
        raise InputError(f"{place.words!r}: only one of them was found in the photo; {describe_found(scene)}")
    return found


def _place_at(place: Place, middle: Float[Array, "2"], cells: Float[Array, "cell 2"]) -> Bool[Array, " cell"]:
    """Mask of cells in the given relation to an object, seen from the radar."""
    away = middle / max(float(np.hypot(*middle)), 1e-6)
    aside = np.array([away[1], -away[0]])  # to the right in the picture
    along, across = (cells - middle) @ away, (cells - middle) @ aside
    if place.relation == "near" or place.landmark == "corner":
        near = distances_m(cells, middle)
        return near <= max(NEAR_M, float(near.min(initial=np.inf)) + 0.3) * (near.min(initial=np.inf) < 1.6)
    if place.relation == "in" and place.landmark == "door":
        return distances_m(cells, middle) <= DOORWAY_M
    if place.relation in ("behind", "front"):
        depth = along if place.relation == "behind" else -along
        return (depth > BESIDE_M) & (depth < REACH_M) & (np.abs(across) < WIDTH_M)
    depth = across if place.relation == "rightof" else -across
    return (depth > BESIDE_M) & (depth < REACH_M) & (np.abs(along) < WIDTH_M)


def _inside(place: Place, cells: Float[Array, "cell 2"]) -> Bool[Array, " cell"]:
    """Mask of cells in the named part of the free floor."""
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
    apart = distances_m(cells, middle)
    return apart <= np.quantile(apart, SHARE)
