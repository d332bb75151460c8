"""Where in the room a plan is acted out: many starts are tried, the best way is taken."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.activities import CLEARANCE_M
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.planning.curved_and_lateral_paths import check_floor, is_other, lay_other, turn_by
from mmweaver.motion.planning.floor_map import BODY_RADIUS_M, FloorMap
from mmweaver.motion.planning.occluded_geometry import occluded_along
from mmweaver.motion.planning.seating import (
    STOOL_HEIGHT_M,
    Sitting,
    as_it_can_be,
    as_it_may_be,
    fitting,
    preferred,
    reachable,
    seats_of,
    some_of,
    stool_at,
    stool_fits,
    stool_note,
)  # fmt: skip
from mmweaver.motion.planning.separation import is_clear_of
from mmweaver.motion.planning.targets import check_targets, goes_to_thing, start_for, walk_to_target
from mmweaver.motion.planning.trajectory import (
    NoTrajectory,
    Trajectory,
    angle_between,
    face_along,
    ramps_of,
    walk_anywhere,
    walk_circle,
    walk_straight,
)

Array = np.ndarray
TRIES, ENOUGH = 500, 60
CLOSEST_FEET_M = 0.05
_HIDDEN_COST, _HIDDEN_SITTING_COST, _LOOKS, _SEAT_M = 4.0, 1.5, 12, 0.65


@dataclass(frozen=True, kw_only=True)
class Placement:
    """The way of the root, the moves and the seat's height of each step, and what was assumed."""

    path: RootPath
    moves: tuple[tuple[Move, ...], ...]
    seat_height_m: tuple[float, ...]
    seats_m: tuple[tuple[float, float], ...]  # where the person sits
    assumptions: tuple[str, ...]


def place(
    plan: MotionPlan, floor: FloorMap, body: SkeletonProportions, *, seed: int, start_m: tuple[float, float] | None,
    others: tuple[PoseSequence, ...] = (), attempt: int = 0,
) -> list[Placement]:  # fmt: skip
    """Finds ways for the whole plan that are free and in view all along, and clear of `others`; the best first.

    `start_m` fixes where the person starts. `attempt` draws others, with more ways to sit: 1 leaves out some seats, 2
    all where the room has none that the sentence names. Raises InputError where the start is not free or out
    of view, where there is no room, or where the room lacks what a step goes to, saying what there is.
    """
    check_targets(plan, floor.scene)
    if not floor.walkable.any() and not (seats_of(floor, body) and _starts_seated(plan)):
        raise InputError(_no_floor(floor))
    if start_m is not None:
        _check_start(floor, start_m)
    rng = stream(seed, "motion", f"placement {attempt}" if attempt else "placement")
    ways: list[Trajectory] = []
    for _ in range(TRIES):
        try:
            way = _try(plan, floor, body, rng, start_m, attempt=attempt)
        except NoTrajectory:
            continue
        if others and not _is_clear_of(way, plan, others):
            continue
        ways.append(way)
        if len(ways) >= ENOUGH:
            break
    if not ways:
        raise InputError(_no_room(plan, floor, start_m))
    order = np.argsort([way.cost for way in ways] + _hidden_costs(ways, plan, floor), kind="stable")
    return [_placement(ways[k]) for k in order]


def _hidden_costs(ways: list[Trajectory], plan: MotionPlan, floor: FloorMap) -> Float[Array, " way"]:
    """Against ways, and feet before seats, behind things: the camera does not see what stands there."""
    tracks_m = np.array([way.path().position_m(np.linspace(0.0, plan.steps[-1].end_s, _LOOKS)) for way in ways])
    cost = np.full(tracks_m.shape[:2], _HIDDEN_COST)
    for way, costs, track_m in zip(ways, cost, tracks_m, strict=True):
        for seat in way.seats_m:
            costs[np.hypot(*(track_m - np.array(seat)).T) < _SEAT_M] = _HIDDEN_SITTING_COST
    return (cost * occluded_along(floor.scene, tracks_m)).max(axis=1)


def _placement(way: Trajectory) -> Placement:
    return Placement(
        path=way.path(),
        moves=tuple(tuple(moves) for moves in way.moves),
        seat_height_m=tuple(way.seat_height_m),
        seats_m=tuple(way.seats_m),
        assumptions=tuple(dict.fromkeys(way.notes)),
    )


def _is_clear_of(way: Trajectory, plan: MotionPlan, others: tuple[PoseSequence, ...]) -> bool:
    time_s = np.arange(0.0, plan.steps[-1].end_s + 1e-9, 0.05)
    track_m = way.path().position_m(time_s)
    return all(is_clear_of(track_m, time_s, other) for other in others)


def _starts_seated(plan: MotionPlan) -> bool:
    return plan.steps[0].lower in ("sit", "sit_down", "stand_up")


def _try(
    plan: MotionPlan,
    floor: FloorMap,
    body: SkeletonProportions,
    rng: np.random.Generator,
    start_m: tuple[float, float] | None,
    *,
    attempt: int,
) -> Trajectory:
    """One candidate: a start, and every step laid out from there."""
    seats = seats_of(floor, body)
    if attempt:
        named = next((step.seat for step in plan.steps if step.seat), "")
        is_there = named and bool(fitting(seats, named, floor.scene))
        left = [] if attempt > 1 and not is_there else some_of(preferred(seats, named, floor.scene), rng)
        seats = [as_it_can_be(seat, rng) for seat in left]
    else:
        seats = [as_it_may_be(seat, rng) for seat in seats]
    way, sitting = _start(plan, floor, body, rng, start_m, seats)
    for k, step in enumerate(plan.steps):
        way.moves.append([])
        following = plan.steps[k + 1] if k + 1 < len(plan.steps) else None
        if step.moves:
            wanted_seats = preferred(seats, following.seat if following else step.seat, floor.scene)
            target = _seat_ahead(way, step, following, wanted_seats)
            _lay_move(way, step, target, first=k == 0, last=following is None)
            sitting = target if following is not None and following.lower == "sit_down" else None
        elif step.lower == "turn" and step.turn_deg:
            turn_by(way, step)
        elif step.lower == "turn" or (step.facing and step.upper not in ("point", "look_around")):
            _lay_turn(way, step, rng, first=k == 0)
        check_floor(way, step, body)
        way.from_seat = way.from_seat or step.lower == "stand_up"
        if step.lower == "sit_down" and k:
            sitting = sitting or _stool_here(
                way, body, rng, previous=plan.steps[k - 1], none_at_all=not floor.scene.seats
            )
            way.turn_to(sitting.facing_rad, step.start_s - 0.3)
        way.seat_height_m.append(sitting.height_m if sitting else STOOL_HEIGHT_M)
        if sitting is not None:
            way.seats_m.append((float(sitting.seat_m[0]), float(sitting.seat_m[1])))
            way.cost += sitting.cost
        if not step.moves and step.lower not in ("sit", "sit_down", "stand_up"):
            wanted = max(CLEARANCE_M[step.lower], CLEARANCE_M.get(step.upper, 0.0))
            way.cost += 2.0 * max(0.0, wanted - float(floor.clearance_at(way.place)))
            way.cost += float(floor.dislike_at(way.place))
    way.cost += float(rng.uniform(0, 0.5))
    return way


def _start(
    plan: MotionPlan,
    floor: FloorMap,
    body: SkeletonProportions,
    rng: np.random.Generator,
    start_m: tuple[float, float] | None,
    seats: list[Sitting],
) -> tuple[Trajectory, Sitting | None]:
    first = plan.steps[0]
    if _starts_seated(plan):
        usable = preferred(seats, first.seat, floor.scene)
        if any(step.lower not in ("sit", "sit_down") for step in plan.steps):
            # Who gets up needs room before the seat: not where a table is.
            usable = [seat for seat in usable if floor.clearance_at(seat.feet_m) > CLOSEST_FEET_M]
        return _start_seated(floor, body, rng, start_m, usable)
    spot = np.array(start_m, dtype=float) if start_m is not None else _random_start(plan, floor, rng, seats)
    facing = float(np.arctan2(-spot[1], -spot[0]) + np.clip(rng.normal(0, 0.2), -0.4, 0.4))
    if any(step.posture in ("floor", "knees") for step in plan.steps):
        facing = float(rng.uniform(-np.pi, np.pi))  # whichever way the floor is free
    if first.facing and first.upper not in ("point", "look_around"):
        facing = _facing_rad(first.facing, spot) + float(rng.normal(0, 0.05))
    return Trajectory(floor=floor, rng=rng, place=spot, heading_rad=facing), None


def _random_start(
    plan: MotionPlan, floor: FloorMap, rng: np.random.Generator, seats: list[Sitting]
) -> Float[Array, "2"]:
    """A cell at random; where a walk shall end at a seat, often one from which it would."""
    first = plan.steps[0]
    if first.moves and goes_to_thing(first) and rng.random() < 0.8:
        spot = start_for(first, floor, rng)
        if spot is not None:
            return spot
    to_seat = first.direction == "seat" or (len(plan.steps) > 1 and plan.steps[1].lower == "sit_down")
    if first.moves and seats and to_seat and rng.random() < 0.7:
        sitting = seats[int(rng.integers(len(seats)))]
        length = (first.end_s - first.start_s) * rng.uniform(0.6, 1.3)
        angle = rng.uniform(0, 2 * np.pi)
        return sitting.feet_m - length * np.array([np.cos(angle), np.sin(angle)])
    cells = floor.places_m[floor.walkable]
    spot = cells[int(rng.integers(len(cells)))]
    return spot + rng.uniform(-0.3, 0.3, 2) * floor.cell_m


def _start_seated(
    floor: FloorMap,
    body: SkeletonProportions,
    rng: np.random.Generator,
    start_m: tuple[float, float] | None,
    seats: list[Sitting],
) -> tuple[Trajectory, Sitting]:
    """On a seat of the scene, near the start asked for; else on a stool, looking about at the radar."""
    cost, notes = 0.0, []
    near = [s for s in seats if start_m is None or np.hypot(*(s.seat_m - start_m)) < 1.0]
    if near:
        sitting = near[int(rng.integers(len(near)))]
        cost += float(floor.dislike_at(sitting.seat_m)) + (0.0 if floor.clearance_at(sitting.feet_m) > 0 else 2.0)
    else:
        cells = floor.places_m[floor.walkable]
        if not len(cells):
            raise NoTrajectory("no free floor")
        spot = np.array(start_m, dtype=float) if start_m else cells[int(rng.integers(len(cells)))]
        facing = float(np.arctan2(-spot[1], -spot[0]) + np.clip(rng.normal(0, 0.3), -0.6, 0.6))
        sitting = stool_at(spot, facing, body)
        if not stool_fits(sitting, floor):
            raise NoTrajectory("no room for a stool")
        notes.append(stool_note(sitting, none_at_all=not floor.scene.seats))
        cost += float(floor.dislike_at(spot)) + 2.0 * max(0.0, 0.5 - float(floor.clearance_at(spot)))
    way = Trajectory(floor=floor, rng=rng, place=sitting.feet_m, heading_rad=sitting.facing_rad, cost=cost, notes=notes)
    return way, sitting


def _seat_ahead(way: Trajectory, step: Step, following: Step | None, seats: list[Sitting]) -> Sitting | None:
    """The seat that a walk shall end at: reachable, in the direction said, at a speed that is natural."""
    if not (following is not None and following.lower == "sit_down") and step.direction != "seat":
        return None
    for sitting in seats:
        gap = sitting.feet_m - way.place
        towards = float(np.arctan2(gap[1], gap[0]))
        said = _direction_rad(way, step)
        lasts = max(step.end_s - step.start_s - 0.35, 0.1)
        speed = float(np.hypot(*gap)) / lasts
        fits = 0.45 <= speed <= (2.6 if step.lower == "jog" else 1.6)
        if (
            fits
            and (said is None or abs(angle_between(said, towards)) < 0.9)
            and reachable(way.floor, way.place, sitting)
        ):
            return sitting
    return None


def _lay_move(way: Trajectory, step: Step, target: Sitting | None, *, first: bool, last: bool) -> None:
    if target is None and goes_to_thing(step):
        walk_to_target(way, step, first=first)
        return
    if target is None and is_other(step):
        lay_other(way, step, _direction_rad(way, step), first=first, last=last)
        return
    if target is not None:
        gap = target.feet_m - way.place
        direction = float(np.arctan2(gap[1], gap[0]))
        begin = face_along(way, step, direction, step.start_s, first=first)
        ramps = (ramps_of(step.end_s - begin, first=first, last=False)[0], 0.45)
        way.go(step, direction, float(np.hypot(*gap)), (begin, step.end_s), ramps)
        return
    way.cost += 3.0 * (step.direction == "seat")
    direction = _direction_rad(way, step)
    if step.direction == "circle":
        walk_circle(way, step, first=first, last=last)
    elif direction is None:
        if step.direction == "seat" and not any("stool" in note or "no seat" in note for note in way.notes):
            way.notes.append(
                f"for {step.clause!r} no seat of the photo can be reached; the walk ends where there is room"
            )
        walk_anywhere(way, step, first=first, last=last)
    else:
        walk_straight(way, step, direction, first=first, last=last)


def _direction_rad(way: Trajectory, step: Step) -> float | None:
    """The direction said, with a few degrees of variation; None where any will do."""
    x, y = way.place
    jitter = float(np.clip(way.rng.normal(0, 0.06), -0.15, 0.15))
    if step.direction in ("left", "right"):
        return jitter + (np.pi if step.direction == "left" else 0.0)
    if step.direction == "towards":
        return float(np.arctan2(-y, -x)) + 0.3 * jitter
    if step.direction == "away":
        return float(np.arctan2(y, x)) + 0.3 * jitter
    if step.direction == "forwards" and way.moves[:-1]:
        return way.heading_rad
    if step.direction == "backwards":
        return way.heading_rad + np.pi
    if step.direction == "back":
        back_to = way.last_direction_rad
        return back_to + np.pi if back_to is not None else way.heading_rad + np.pi
    return None


def _facing_rad(facing: str, spot: Float[Array, "2"]) -> float:
    if facing in ("left", "right"):
        return np.pi if facing == "left" else 0.0
    away = float(np.arctan2(spot[1], spot[0]))
    return away if facing == "away" else away + np.pi


def _lay_turn(way: Trajectory, step: Step, rng: np.random.Generator, *, first: bool) -> None:
    """A turn to where is said: left and right are the person's own, 'to the radar' is the radar's place."""
    if step.facing:
        if first and step.lower != "turn":
            return  # the start faces there already
        if first:
            way.start_heading_rad = way.heading_rad = way.heading_rad + float(
                rng.choice([-1.0, 1.0]) * rng.uniform(1.2, 2.2)
            )
        heading = _facing_rad(step.facing, way.place)
    else:
        quarter = float(np.pi / 2 + rng.normal(0, 0.08))
        about = float(rng.choice([-1.0, 1.0]) * (np.pi - abs(rng.normal(0, 0.06)) - 0.01))
        heading = way.heading_rad + {"left": quarter, "right": -quarter}.get(step.direction, about)
    way.turn_to(heading, step.start_s)


def _stool_here(
    way: Trajectory, body: SkeletonProportions, rng: np.random.Generator, *, previous: Step, none_at_all: bool
) -> Sitting:
    """A stool beside the end of a walk, so that the person turns at most a quarter, or behind who stands."""
    to_radar = float(np.arctan2(-way.place[1], -way.place[0]))
    options = [way.heading_rad] if not previous.moves else [way.heading_rad + np.pi / 2, way.heading_rad - np.pi / 2]
    options.sort(key=lambda angle: abs(angle_between(angle, to_radar)))
    for facing in options:
        stool = stool_at(way.place, facing + float(rng.normal(0, 0.08)), body)
        if stool_fits(stool, way.floor):
            way.cost += 3.0
            way.notes.append(stool_note(stool, none_at_all=none_at_all))
            return stool
    raise NoTrajectory("no room for a stool")


def _check_start(floor: FloorMap, start_m: tuple[float, float]) -> None:
    spot = np.array(start_m, dtype=float)
    if bool(floor.can_stand(spot)):
        return
    near = floor.nearest_place(spot)
    if not bool(floor.sees(spot)):
        low, high = floor.range_window_m
        why = f"is outside the radar's window ({low:.2f} to {high:.2f} m, within 40 degrees and the picture)"
    else:
        why = f"is not free: a body needs {BODY_RADIUS_M:g} m around it"
    hint = "there is no free place" if near is None else f"the nearest free place is {near[0]:.2f},{near[1]:.2f}"
    raise InputError(f"the start {spot[0]:g},{spot[1]:g} {why}; {hint}")


def _no_floor(floor: FloorMap) -> str:
    low, high = floor.range_window_m
    return (
        f"there is no room for a person: no free floor is in the picture between {low:.2f} and {high:.2f} m from the"
        " radar; take a radar with a longer range window (--radar) or a photo with more floor"
    )


def _no_room(plan: MotionPlan, floor: FloorMap, start_m: tuple[float, float] | None) -> str:
    from_there = f" from {start_m[0]:g},{start_m[1]:g}" if start_m else ""
    going = [step.clause for step in plan.steps if step.moves]
    what = f" for {going[0]!r}" if going else ""
    cells = floor.places_m[floor.walkable]
    some = cells[:: max(1, len(cells) // 40)]
    longest = max(
        (floor.free_length_m(place, float(angle), 4.0) for place in some for angle in np.arange(8) * np.pi / 4),
        default=0.0,
    )
    return (
        f"there is no room{what}{from_there}: in the picture and the radar's window {len(cells) * floor.cell_m**2:.1f}"
        f" m2 of floor are free, the longest straight way is about {longest:.1f} m; try fewer frames, 'slowly', another"
        " direction or another start (--at)"
    )
