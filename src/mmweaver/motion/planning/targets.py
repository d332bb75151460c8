"""Walking to a landmark of the room, straight or around one corner, and the error if there is none."""

from collections import Counter
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import Landmark, Scene
from mmweaver.motion.language.lexicon import TARGETS
from mmweaver.motion.language.plan import APPROXIMATED, MotionPlan, Step
from mmweaver.motion.planning.floor_map import (
    FloorMap,
    bearing_rad,
    distance_m,
    distances_m,
    random_choice,
    unit_vector,
)
from mmweaver.motion.planning.trajectory import (
    RAMP_S,
    TURN_OVERHEAD_S,
    TURN_RATE_RADPS,
    NoTrajectory,
    Trajectory,
    face_along,
    preferred_speed_mps,
    signed_angle_rad,
)

Array = np.ndarray
SEATS = ("couch", "chair", "bench", "stool", "seat")  # handled by `seating`
# Words that match several kinds of landmarks.
ALIKE = {"table": ("table", "counter"), "desk": ("table",), "counter": ("counter", "table")}
_FASTEST_MPS = {"jog": 3.5}  # walking: 1.6
SHORTEST_PATH_M = 0.35  # shorter paths are not a walk
_NEAR_M = 0.45  # a walkable position within this distance of the approach counts as at the landmark
_NUM_CORNERS = 24  # corners tried
_NUM_GOALS = 6  # positions tried in a place


def kinds_of(target: str) -> tuple[str, ...]:
    """The kinds of landmarks that a word matches.

    Args:
        target: Word of the sentence, such as "desk".
    """
    return ALIKE.get(target, (target,))


def goes_to_target(step: Step) -> bool:
    """Whether a step goes to a landmark other than a seat."""
    return (bool(step.target) and step.target not in SEATS) or (step.place is not None and step.place.is_goal)


def faced_landmarks(step: Step, scene: Scene) -> list[Landmark]:
    """The landmarks that a step's body faces, seats included.

    Args:
        step: The step.
        scene: The room.

    Returns:
        Landmarks of the faced kind; empty if the step faces none or the room has none.
    """
    if step.facing not in TARGETS:
        return []
    found = [mark for mark in scene.landmarks if mark.kind in kinds_of(step.facing)]
    seats = scene.seats if not found and step.facing in SEATS else ()
    return found + [
        Landmark(kind="seat", position_m=seat.position_m, approach_m=(0.0, 0.0), facing_rad=0.0) for seat in seats
    ]


def drop_targets(plan: MotionPlan) -> MotionPlan:
    """Removes landmarks from the plan for a scene without a photo; notes report it.

    Args:
        plan: Scheduled plan.

    Returns:
        The plan with open destinations, notes and lowered clause records.
    """
    lost = [step for step in plan.steps if _goes_to_landmark(step)]
    aimed = [step for step in plan.steps if step.facing in TARGETS]
    notes = tuple(
        f"for {step.clause or step.target!r}: without a photo there is no {_lost(step)};"
        f" {'the walk leads' if step.moves else 'it is shown'} where there is room"
        for step in lost
    ) + tuple(f"for {step.clause!r}: without a photo there is no {step.facing} to face" for step in aimed)
    steps = tuple(
        replace(
            step,
            target="" if step in lost else step.target,
            place=None if step in lost else step.place,
            facing="" if step in aimed else step.facing,
        )
        for step in plan.steps
    )
    clauses = list(plan.clauses)
    for step, note in zip((*lost, *aimed), notes, strict=True):
        for number in step.clauses:
            if number < len(clauses):
                clauses[number] = clauses[number].lowered_to(APPROXIMATED, note)
    return replace(plan, steps=steps, notes=plan.notes + notes, clauses=tuple(clauses))


def _lost(step: Step) -> str:
    """The landmark or place that a step loses without a photo."""
    return step.target if step.place is None else step.place.landmark or step.place.relation


def _goes_to_landmark(step: Step) -> bool:
    is_placed = step.place is not None and bool(step.place.landmark or step.place.relation == "outside")
    return is_placed or (step.moves and goes_to_target(step))


def start_for_target(step: Step, floor: FloorMap, rng: np.random.Generator) -> Float[Array, "2"] | None:
    """Samples a start from which a walk of the step's time ends at its target.

    Args:
        step: The walk, with its time.
        floor: Floor of the room.
        rng: Random stream.

    Returns:
        Position (x, y) in metres, which may not be walkable; None without a target.
    """
    marks = _goals(floor, step, rng)
    if not marks:
        return None
    mark = random_choice(marks, rng)
    length, angle = (step.end_s - step.start_s) * rng.uniform(0.5, 1.2), rng.uniform(0, 2 * np.pi)
    return np.array(mark.approach_m) + length * unit_vector(angle)


def walk_to_target(trajectory: Trajectory, step: Step, *, first: bool) -> None:
    """Walks to the nearest landmark that can be reached in time, and turns to face it.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The walk, with its time.
        first: Whether the motion begins with this step.

    Raises:
        NoTrajectory: If none can be reached.
    """
    marks = sorted(
        _goals(trajectory.floor, step, trajectory.rng),
        key=lambda mark: distance_m(mark.approach_m, trajectory.position_m),
    )
    for mark in marks:
        goal = _standing_position_m(trajectory.floor, mark)
        corners = None if goal is None else _corners(trajectory, goal)
        if corners is not None and _lay_legs(trajectory, step, corners, mark, first=first):
            return
    raise NoTrajectory(f"no path to the {step.target or 'place'}")


def walk_along(trajectory: Trajectory, step: Step, *, first: bool) -> None:
    """Walks a given route.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The walk, with its route (x, y) in metres and its time.
        first: Whether the motion begins with this step.

    Raises:
        InputError: If the route is not free.
        NoTrajectory: If the time is too short for it.
    """
    corners = [np.array(corner, float) for corner in step.route_m]
    if not first:
        corners = corners if distance_m(corners[0], trajectory.position_m) > 0.05 else corners[1:]
    else:
        corners = corners[1:]
    position = trajectory.position_m
    for corner in corners:
        gap = corner - position
        length = float(np.hypot(*gap))
        free = trajectory.floor.free_length_m(position, bearing_rad(gap), length)
        if free < length - 1e-6:
            stop = position + gap * free / max(length, 1e-9)
            raise InputError(
                f"the path is not free between {position[0]:g},{position[1]:g} and {corner[0]:g},{corner[1]:g}: a body"
                f" gets as far as {stop[0]:.2f},{stop[1]:.2f}; choose other points, on free floor in the picture"
                " and the radar's window"
            )
        position = corner
    last = corners[-1] - (corners[-2] if len(corners) > 1 else trajectory.position_m)
    x, y = corners[-1].tolist()
    end = Landmark(kind="path", position_m=np.array([x, y, 0.0]), approach_m=(x, y), facing_rad=bearing_rad(last))
    if not _lay_legs(trajectory, step, corners, end, first=first):
        raise NoTrajectory("no time for the path")


def _goals(floor: FloorMap, step: Step, rng: np.random.Generator) -> list[Landmark]:
    """The landmarks that a step may go to; for a place, some positions in it that face the radar."""
    if step.place is None:
        return _landmarks(floor.scene, step)
    cells = floor.place_cells[step.place]
    some = cells[rng.integers(len(cells), size=_NUM_GOALS)]
    return [
        Landmark(
            kind="place", position_m=np.array([x, y, 0.0]), approach_m=(x, y), facing_rad=float(np.arctan2(-y, -x))
        )
        for x, y in some.tolist()
    ]


def _landmarks(scene: Scene, step: Step) -> list[Landmark]:
    kinds = kinds_of(step.target)
    return [mark for mark in scene.landmarks if mark.kind in kinds] if step.target else []


def _standing_position_m(floor: FloorMap, mark: Landmark) -> Float[Array, "2"] | None:
    """The landmark's approach, or the nearest walkable position (x, y) that is still at the landmark."""
    approach = np.array(mark.approach_m, dtype=float)
    if bool(floor.can_stand(approach)):
        return approach
    near = floor.nearest_walkable_m(approach)
    return near if near is not None and distance_m(near, approach) < _NEAR_M else None


def _corners(trajectory: Trajectory, goal: Float[Array, "2"]) -> list[Float[Array, "2"]] | None:
    """The goal, with one corner before it if the straight path is blocked; None if that is not enough."""
    floor, start = trajectory.floor, trajectory.position_m
    if bool(floor.are_free_ways(start[None], goal[None])[0]):
        return [goal]
    places = floor.walkable_m
    if not len(places):
        return None
    some = places[trajectory.rng.integers(len(places), size=_NUM_CORNERS)]
    some = some[np.argsort(distances_m(some, start) + distances_m(some, goal))]
    some = some[floor.are_free_ways(np.broadcast_to(start, some.shape), some)]
    some = some[floor.are_free_ways(some, np.broadcast_to(goal, some.shape))]
    return [some[0], goal] if len(some) else None


def _lay_legs(
    trajectory: Trajectory, step: Step, corners: list[Float[Array, "2"]], mark: Landmark, *, first: bool
) -> bool:
    """Lays out the legs, with times proportional to their lengths; False if they do not fit into the step."""
    gaps = np.diff(np.stack([trajectory.position_m, *corners]), axis=0)
    lengths = np.hypot(*gaps.T)
    directions = np.arctan2(gaps[:, 1], gaps[:, 0])
    turned = abs(signed_angle_rad(float(directions[-1]), mark.facing_rad))
    at_end = TURN_OVERHEAD_S + turned / TURN_RATE_RADPS if turned > 0.15 else 0.1
    spare = step.end_s - step.start_s - at_end - 0.5 * (len(corners) - 1) - (0.0 if first else 0.3)
    total = float(lengths.sum())
    if spare < 0.6 or total < SHORTEST_PATH_M:
        return False
    speed = min(preferred_speed_mps(step, trajectory.rng), _FASTEST_MPS.get(step.lower, 1.6))
    needed = total / max(spare - 0.5 * RAMP_S * (2 * len(corners) - first), 0.2)
    if needed > _FASTEST_MPS.get(step.lower, 1.6):
        return False
    speed = max(speed, needed)
    trajectory.cost += 0.6 * max(0.0, speed - needed) + 0.4 * (len(corners) - 1)
    time = step.start_s
    for leg, (length, direction) in enumerate(zip(lengths, directions, strict=True)):
        begin = face_along(trajectory, step, float(direction), time, first=first and leg == 0)
        ramps = (0.0 if first and leg == 0 else RAMP_S, RAMP_S)
        lasts = float(length) / speed + sum(ramps) / 2
        if begin + lasts > step.end_s + 0.05:
            return False
        trajectory.go(step, float(direction), float(length), (begin, begin + lasts), ramps)
        time = begin + lasts
    trajectory.turn_to(mark.facing_rad, time - 0.1)
    return True


def describe_found(scene: Scene) -> str:
    """Lists the landmarks and seats of a room for error messages."""
    counts = Counter(mark.kind for mark in scene.landmarks)
    if scene.seats:
        counts["seat"] = len(scene.seats)
    if not counts:
        return "no door, table, window or seat was found in it; say a direction instead"
    words = [f"a {kind}" if number == 1 else f"{number} {kind}s" for kind, number in sorted(counts.items())]
    return f"it has {', '.join(words)}"
