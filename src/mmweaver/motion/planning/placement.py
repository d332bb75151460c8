"""Placement of a plan in the room: many start positions are tried, and their trajectories sorted by cost."""

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
from mmweaver.motion.planning.curved_and_lateral_paths import (
    check_floor_space,
    is_curved_or_lateral,
    lay_curved_or_lateral,
    turn_by,
)
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.occluded_geometry import occluded_along
from mmweaver.motion.planning.seating import (
    STOOL_HEIGHT_M,
    Sitting,
    any_variation,
    fitting,
    preferred,
    random_subset,
    reachable,
    stool_at,
    stool_fits,
    stool_note,
    usable_seats,
    usual_variation,
)  # fmt: skip
from mmweaver.motion.planning.separation import is_clear_of
from mmweaver.motion.planning.targets import check_targets, goes_to_target, start_for_target, walk_to_target
from mmweaver.motion.planning.trajectory import (
    NoTrajectory,
    Trajectory,
    face_along,
    ramps_of,
    signed_angle_rad,
    walk_anywhere,
    walk_circle,
    walk_straight,
)

Array = np.ndarray
TRIES, ENOUGH = 500, 60  # candidates tried, and found, at most
CLOSEST_FEET_M = 0.05  # clearance in front of a seat for somebody who gets up
_OCCLUDED_COST, _OCCLUDED_SITTING_COST = 4.0, 1.5  # of a trajectory, or seat, that the camera does not see
_NUM_OCCLUSION_TESTS = 12  # along a trajectory
_SEAT_RADIUS_M = 0.65  # within it a position counts as sitting
_NEAR_START_M = 1.0  # a seat so near to the requested start is the one meant
_SEAT_DIRECTION_RAD = 0.9  # a seat lies in the direction of the sentence up to this angle
_SEAT_SPEED_MPS = {"jog": (0.45, 2.6)}  # natural speeds of a walk that ends at a seat
_WALK_TO_SEAT_MPS = (0.45, 1.6)


@dataclass(frozen=True, kw_only=True)
class Placement:
    """The path of the root, the moves and the seat height of each step, and what was assumed."""

    path: RootPath
    moves: tuple[tuple[Move, ...], ...]
    seat_height_m: tuple[float, ...]
    seats_m: tuple[tuple[float, float], ...]  # where the person sits
    assumptions: tuple[str, ...]


def place(
    plan: MotionPlan, floor: FloorMap, body: SkeletonProportions, *, seed: int, start_m: tuple[float, float] | None,
    others: tuple[PoseSequence, ...] = (), attempt: int = 0,
) -> list[Placement]:  # fmt: skip
    """Placements of the whole plan that are free and in view all along, and clear of `others`; the best first.

    `start_m` fixes where the person starts, (x, y). Attempts 1 and 2 sample other placements, with more ways to sit: 1
    leaves out some of the seats, 2 all of them unless the sentence names one that the room has. Raises InputError where
    the start is not free or out of view, where there is no room, or where the room lacks what a step goes to.
    """
    check_targets(plan, floor.scene)
    if not floor.walkable.any() and not (usable_seats(floor, body) and _starts_seated(plan)):
        raise InputError(_no_floor(floor))
    if start_m is not None:
        floor.check_start(start_m)
    rng = stream(seed, "motion", f"placement {attempt}" if attempt else "placement")
    trajectories: list[Trajectory] = []
    for _ in range(TRIES):
        try:
            trajectory = _candidate(plan, floor, body, rng, start_m, attempt=attempt)
        except NoTrajectory:
            continue
        if others and not _is_clear_of(trajectory, plan, others):
            continue
        trajectories.append(trajectory)
        if len(trajectories) >= ENOUGH:
            break
    if not trajectories:
        raise InputError(_no_room(plan, floor, start_m))
    order = np.argsort(
        [trajectory.cost for trajectory in trajectories] + _occlusion_costs(trajectories, plan, floor), kind="stable"
    )
    return [_placement(trajectories[k]) for k in order]


def _occlusion_costs(trajectories: list[Trajectory], plan: MotionPlan, floor: FloorMap) -> Float[Array, " trajectory"]:
    """Cost of trajectories, and of seats, that the camera does not see: what stands there is not known."""
    time_s = np.linspace(0.0, plan.steps[-1].end_s, _NUM_OCCLUSION_TESTS)
    tracks_m = np.array([trajectory.path().position_m(time_s) for trajectory in trajectories])
    cost = np.full(tracks_m.shape[:2], _OCCLUDED_COST)
    for trajectory, costs, track_m in zip(trajectories, cost, tracks_m, strict=True):
        for seat in trajectory.seats_m:
            costs[np.hypot(*(track_m - np.array(seat)).T) < _SEAT_RADIUS_M] = _OCCLUDED_SITTING_COST
    return (cost * occluded_along(floor.scene, tracks_m)).max(axis=1)


def _placement(trajectory: Trajectory) -> Placement:
    return Placement(
        path=trajectory.path(),
        moves=tuple(tuple(moves) for moves in trajectory.moves),
        seat_height_m=tuple(trajectory.seat_height_m),
        seats_m=tuple(trajectory.seats_m),
        assumptions=tuple(dict.fromkeys(trajectory.notes)),
    )


def _is_clear_of(trajectory: Trajectory, plan: MotionPlan, others: tuple[PoseSequence, ...]) -> bool:
    time_s = np.arange(0.0, plan.steps[-1].end_s + 1e-9, 0.05)
    track_m = trajectory.path().position_m(time_s)
    return all(is_clear_of(track_m, time_s, other) for other in others)


def _starts_seated(plan: MotionPlan) -> bool:
    return plan.steps[0].lower in ("sit", "sit_down", "stand_up")


def _candidate(
    plan: MotionPlan,
    floor: FloorMap,
    body: SkeletonProportions,
    rng: np.random.Generator,
    start_m: tuple[float, float] | None,
    *,
    attempt: int,
) -> Trajectory:
    """One candidate: a start, and every step laid out from there. Raises NoTrajectory."""
    seats = usable_seats(floor, body)
    if attempt:
        named = next((step.seat for step in plan.steps if step.seat), "")
        is_there = named and bool(fitting(seats, named, floor.scene))
        left = [] if attempt > 1 and not is_there else random_subset(preferred(seats, named, floor.scene), rng)
        seats = [any_variation(seat, rng) for seat in left]
    else:
        seats = [usual_variation(seat, rng) for seat in seats]
    trajectory, sitting = _start(plan, floor, body, rng, start_m, seats)
    for k, step in enumerate(plan.steps):
        trajectory.moves.append([])
        following = plan.steps[k + 1] if k + 1 < len(plan.steps) else None
        if step.moves:
            wanted_seats = preferred(seats, following.seat if following else step.seat, floor.scene)
            target = _seat_ahead(trajectory, step, following, wanted_seats)
            _lay_move(trajectory, step, target, first=k == 0, last=following is None)
            sitting = target if following is not None and following.lower == "sit_down" else None
        elif step.lower == "turn" and step.turn_deg:
            turn_by(trajectory, step)
        elif step.lower == "turn" or (step.facing and step.upper not in ("point", "look_around")):
            _lay_turn(trajectory, step, rng, first=k == 0)
        check_floor_space(trajectory, step, body)
        trajectory.from_seat = trajectory.from_seat or step.lower == "stand_up"
        if step.lower == "sit_down" and k:
            sitting = sitting or _stool_at_end(
                trajectory, body, rng, previous=plan.steps[k - 1], none_at_all=not floor.scene.seats
            )
            trajectory.turn_to(sitting.facing_rad, step.start_s - 0.3)
        trajectory.seat_height_m.append(sitting.height_m if sitting else STOOL_HEIGHT_M)
        if sitting is not None:
            trajectory.seats_m.append((float(sitting.seat_m[0]), float(sitting.seat_m[1])))
            trajectory.cost += sitting.cost
        if not step.moves and step.lower not in ("sit", "sit_down", "stand_up"):
            wanted = max(CLEARANCE_M[step.lower], CLEARANCE_M.get(step.upper, 0.0))
            trajectory.cost += 2.0 * max(0.0, wanted - float(floor.clearance_at(trajectory.position_m)))
            trajectory.cost += float(floor.cost_at(trajectory.position_m))
    trajectory.cost += float(rng.uniform(0, 0.5))
    return trajectory


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
            # Getting up needs room in front of the seat, where a table may stand.
            usable = [seat for seat in usable if floor.clearance_at(seat.feet_m) > CLOSEST_FEET_M]
        return _start_seated(floor, body, rng, start_m, usable)
    spot = np.array(start_m, dtype=float) if start_m is not None else _random_start(plan, floor, rng, seats)
    facing = float(np.arctan2(-spot[1], -spot[0]) + np.clip(rng.normal(0, 0.2), -0.4, 0.4))
    if any(step.posture in ("floor", "knees") for step in plan.steps):
        facing = float(rng.uniform(-np.pi, np.pi))  # wherever the floor is free
    if first.facing and first.upper not in ("point", "look_around"):
        facing = _facing_rad(first.facing, spot) + float(rng.normal(0, 0.05))
    return Trajectory(floor=floor, rng=rng, position_m=spot, heading_rad=facing), None


def _random_start(
    plan: MotionPlan, floor: FloorMap, rng: np.random.Generator, seats: list[Sitting]
) -> Float[Array, "2"]:
    """A random position (x, y) in metres; for a walk to a seat often one from which it ends there."""
    first = plan.steps[0]
    if first.moves and goes_to_target(first) and rng.random() < 0.8:
        spot = start_for_target(first, floor, rng)
        if spot is not None:
            return spot
    to_seat = first.direction == "seat" or (len(plan.steps) > 1 and plan.steps[1].lower == "sit_down")
    if first.moves and seats and to_seat and rng.random() < 0.7:
        sitting = seats[int(rng.integers(len(seats)))]
        length = (first.end_s - first.start_s) * rng.uniform(0.6, 1.3)
        angle = rng.uniform(0, 2 * np.pi)
        return sitting.feet_m - length * np.array([np.cos(angle), np.sin(angle)])
    cells = floor.cell_centres_m[floor.walkable]
    spot = cells[int(rng.integers(len(cells)))]
    return spot + rng.uniform(-0.3, 0.3, 2) * floor.cell_m


def _start_seated(
    floor: FloorMap,
    body: SkeletonProportions,
    rng: np.random.Generator,
    start_m: tuple[float, float] | None,
    seats: list[Sitting],
) -> tuple[Trajectory, Sitting]:
    """Starts on a seat of the scene, near the requested start; else on a stool, roughly facing the radar."""
    cost, notes = 0.0, []
    near = [s for s in seats if start_m is None or np.hypot(*(s.seat_m - start_m)) < _NEAR_START_M]
    if near:
        sitting = near[int(rng.integers(len(near)))]
        cost += float(floor.cost_at(sitting.seat_m)) + (0.0 if floor.clearance_at(sitting.feet_m) > 0 else 2.0)
    else:
        cells = floor.cell_centres_m[floor.walkable]
        if not len(cells):
            raise NoTrajectory("no free floor")
        spot = np.array(start_m, dtype=float) if start_m else cells[int(rng.integers(len(cells)))]
        facing = float(np.arctan2(-spot[1], -spot[0]) + np.clip(rng.normal(0, 0.3), -0.6, 0.6))
        sitting = stool_at(spot, facing, body)
        if not stool_fits(sitting, floor):
            raise NoTrajectory("no room for a stool")
        notes.append(stool_note(sitting, none_at_all=not floor.scene.seats))
        cost += float(floor.cost_at(spot)) + 2.0 * max(0.0, 0.5 - float(floor.clearance_at(spot)))
    trajectory = Trajectory(
        floor=floor, rng=rng, position_m=sitting.feet_m, heading_rad=sitting.facing_rad, cost=cost, notes=notes
    )
    return trajectory, sitting


def _seat_ahead(trajectory: Trajectory, step: Step, following: Step | None, seats: list[Sitting]) -> Sitting | None:
    """The seat that a walk ends at: reachable, in the given direction, at a natural speed."""
    if not (following is not None and following.lower == "sit_down") and step.direction != "seat":
        return None
    for sitting in seats:
        gap = sitting.feet_m - trajectory.position_m
        towards = float(np.arctan2(gap[1], gap[0]))
        given_rad = _direction_rad(trajectory, step)
        lasts = max(step.end_s - step.start_s - 0.35, 0.1)
        speed = float(np.hypot(*gap)) / lasts
        slowest, fastest = _SEAT_SPEED_MPS.get(step.lower, _WALK_TO_SEAT_MPS)
        fits = slowest <= speed <= fastest
        if (
            fits
            and (given_rad is None or abs(signed_angle_rad(given_rad, towards)) < _SEAT_DIRECTION_RAD)
            and reachable(trajectory.floor, trajectory.position_m, sitting)
        ):
            return sitting
    return None


def _lay_move(trajectory: Trajectory, step: Step, target: Sitting | None, *, first: bool, last: bool) -> None:
    if target is None and goes_to_target(step):
        walk_to_target(trajectory, step, first=first)
        return
    if target is None and is_curved_or_lateral(step):
        lay_curved_or_lateral(trajectory, step, _direction_rad(trajectory, step), first=first, last=last)
        return
    if target is not None:
        gap = target.feet_m - trajectory.position_m
        direction = float(np.arctan2(gap[1], gap[0]))
        begin = face_along(trajectory, step, direction, step.start_s, first=first)
        ramps = (ramps_of(step.end_s - begin, first=first, last=False)[0], 0.45)
        trajectory.go(step, direction, float(np.hypot(*gap)), (begin, step.end_s), ramps)
        return
    trajectory.cost += 3.0 * (step.direction == "seat")
    direction = _direction_rad(trajectory, step)
    if step.direction == "circle":
        walk_circle(trajectory, step, first=first, last=last)
    elif direction is None:
        if step.direction == "seat" and not any("stool" in note or "no seat" in note for note in trajectory.notes):
            trajectory.notes.append(
                f"for {step.clause!r} no seat of the photo can be reached; the walk ends where there is room"
            )
        walk_anywhere(trajectory, step, first=first, last=last)
    else:
        walk_straight(trajectory, step, direction, first=first, last=last)


def _direction_rad(trajectory: Trajectory, step: Step) -> float | None:
    """The direction that the sentence gives, with a few degrees of variation; None where it gives none."""
    x, y = trajectory.position_m
    jitter = float(np.clip(trajectory.rng.normal(0, 0.06), -0.15, 0.15))
    if step.direction in ("left", "right"):
        return jitter + (np.pi if step.direction == "left" else 0.0)
    if step.direction == "towards":
        return float(np.arctan2(-y, -x)) + 0.3 * jitter
    if step.direction == "away":
        return float(np.arctan2(y, x)) + 0.3 * jitter
    if step.direction == "forwards" and trajectory.moves[:-1]:
        return trajectory.heading_rad
    if step.direction == "backwards":
        return trajectory.heading_rad + np.pi
    if step.direction == "back":
        back_to = trajectory.last_direction_rad
        return back_to + np.pi if back_to is not None else trajectory.heading_rad + np.pi
    return None


def _facing_rad(facing: str, spot: Float[Array, "2"]) -> float:
    if facing in ("left", "right"):
        return np.pi if facing == "left" else 0.0
    away = float(np.arctan2(spot[1], spot[0]))
    return away if facing == "away" else away + np.pi


def _lay_turn(trajectory: Trajectory, step: Step, rng: np.random.Generator, *, first: bool) -> None:
    """Turns to the left or right of the person, around, or to face something (`step.facing`)."""
    if step.facing:
        if first and step.lower != "turn":
            return  # the start faces that direction already
        if first:
            trajectory.start_heading_rad = trajectory.heading_rad = trajectory.heading_rad + float(
                rng.choice([-1.0, 1.0]) * rng.uniform(1.2, 2.2)
            )
        heading = _facing_rad(step.facing, trajectory.position_m)
    else:
        quarter = float(np.pi / 2 + rng.normal(0, 0.08))
        about = float(rng.choice([-1.0, 1.0]) * (np.pi - abs(rng.normal(0, 0.06)) - 0.01))
        heading = trajectory.heading_rad + {"left": quarter, "right": -quarter}.get(step.direction, about)
    trajectory.turn_to(heading, step.start_s)


def _stool_at_end(
    trajectory: Trajectory, body: SkeletonProportions, rng: np.random.Generator, *, previous: Step, none_at_all: bool
) -> Sitting:
    """A stool at the end of a walk, a quarter turn away at most, or behind somebody who stands."""
    to_radar = float(np.arctan2(-trajectory.position_m[1], -trajectory.position_m[0]))
    options = (
        [trajectory.heading_rad]
        if not previous.moves
        else [trajectory.heading_rad + np.pi / 2, trajectory.heading_rad - np.pi / 2]
    )
    options.sort(key=lambda angle: abs(signed_angle_rad(angle, to_radar)))
    for facing in options:
        stool = stool_at(trajectory.position_m, facing + float(rng.normal(0, 0.08)), body)
        if stool_fits(stool, trajectory.floor):
            trajectory.cost += 3.0
            trajectory.notes.append(stool_note(stool, none_at_all=none_at_all))
            return stool
    raise NoTrajectory("no room for a stool")


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
    cells = floor.cell_centres_m[floor.walkable]
    some = cells[:: max(1, len(cells) // 40)]
    longest = max(
        (floor.free_length_m(place, float(angle), 4.0) for place in some for angle in np.arange(8) * np.pi / 4),
        default=0.0,
    )
    return (
        f"there is no room{what}{from_there}: in the picture and the radar's window {len(cells) * floor.cell_m**2:.1f}"
        f" m2 of floor are free, the longest straight path is about {longest:.1f} m; try fewer frames, 'slowly',"
        " another direction or another start (--at)"
    )
