"""Paths to a seat: straight, along the front of it past a table, or from the side onto a chair at one.

They depend on the room alone, so they are computed once per floor map and cached.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Scene
from mmweaver.motion.animation.assemble import assembled_controls, solved
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import Step
from mmweaver.motion.planning.body_samples import BodySamples
from mmweaver.motion.planning.collision import CollisionMap
from mmweaver.motion.planning.floor_map import FloorMap, distance_m, random_choice, unit_vector
from mmweaver.motion.planning.seating import (
    Sitting,
    are_reachable,
    preferred,
    pulled_out,
    turned,
    usable_seats,
)
from mmweaver.motion.planning.trajectory import (
    TURN_OVERHEAD_S,
    TURN_RATE_RADPS,
    NoTrajectory,
    Trajectory,
    face_along,
    ramps_of,
    signed_angle_rad,
)

Array = np.ndarray
CLOSEST_FEET_M = 0.05  # clearance in front of a seat to sit down or get up
_NARROW_M = 0.05  # clearance between couch and table for legs that pass there
_TURNS_RAD = (0.0, 0.3, 0.6, 0.9, 1.2, 1.4)  # angles from straight ahead at which one may sit
_TURN_COST, _SHIFT_COST, _NARROW_COST = 0.4, 0.3, 0.5
_LITTLE_M = 0.05  # shift on a seat, to a side, ahead or back
_SEAT_WIDTH_M, _SHIFT_M = 0.6, 0.3  # width of one sitter, and spacing of the places tried on a couch
_LONGEST_NARROW_M, _GATE_STEP_M = 1.2, 0.1
_OFF_FRONT_RAD = (0.0, 0.5)  # angle between a narrow path and the seat's front
_WAYS_A_SEAT, _MAX_STARTS = 4, 200
_SPEEDS_MPS = {"jog": (1.2, 3.6)}  # natural speeds of a walk that ends at a seat
_WALK_MPS = (0.45, 1.6)
_DEFAULT_HEIGHT_M, _SITS_DOWN_S = 1.7, 1.6  # of the body with which the seats of a room are tested
_DEEPEST_M, _MARGIN_M, _DEEP_COST_PER_M = 0.03, 0.02, 30.0  # tolerated penetration into objects near a seat
_MAX_TESTED = 24  # ways to sit on one seat tested in detail
_PULLED_M, _PULLED_TURNS_RAD = (0.15, 0.3, 0.45, 0.6), (0.0, -0.3, 0.3, -0.6, 0.6)  # for chairs that are pulled out
_DIRECTION_RAD = 0.9  # a seat lies in the direction of the sentence up to this angle


@dataclass(frozen=True, kw_only=True)
class Approach:
    """How to sit on a seat, and where walks to it may start.

    Attributes:
        sitting: The way to sit.
        gate_m: Start (x, y) in metres of a narrow path along the seat; None if the path is straight.
        starts_m: Walkable places with a free straight path to the gate, or to the seat, (start, 2) metres.
    """

    sitting: Sitting
    gate_m: Float[Array, "2"] | None
    starts_m: Float[Array, "start 2"]

    @property
    def corners_m(self) -> list[Float[Array, "2"]]:
        """Corners (x, y) of the walk in metres, the last one in front of the seat."""
        return [self.sitting.feet_m] if self.gate_m is None else [self.gate_m, self.sitting.feet_m]

    def scaled_to(self, body: SkeletonProportions) -> "Approach":
        """The same approach for a body of another size: its pelvis is on the seat."""
        return replace(self, sitting=self.sitting.fitted_to(body))


def approaches(floor: FloorMap, body: SkeletonProportions) -> list[Approach]:
    """Paths to the usable seats of a room on which a body is clear of everything else; cached with the room.

    Args:
        floor: Floor of the room.
        body: Bone lengths, to which the approaches are scaled.
    """
    usual = FloorMap.of(floor.scene, floor.range_window_m, _DEFAULT_HEIGHT_M, with_assumed=floor.with_assumed)
    if not usual.seat_approaches:
        one = SkeletonProportions(_DEFAULT_HEIGHT_M)
        ways = [way for seat in usable_seats(usual, one) for way in _ways_to(seat, usual, one)]
        usual.seat_approaches.append(ways)
    return [way.scaled_to(body) for way in usual.seat_approaches[0]]


def fitting_approaches(ways: Sequence[Approach], word: str, scene: Scene) -> list[Approach]:
    """Filters approaches by the word for a seat.

    Args:
        ways: Approaches to all seats.
        word: Word of the sentence, such as "couch"; "" for any.
        scene: The room.

    Returns:
        Approaches to matching seats; all of them if none matches.
    """
    kept = {id(sitting) for sitting in preferred([way.sitting for way in ways], word, scene)}
    return [way for way in ways if id(way.sitting) in kept]


def approach_from(
    trajectory: Trajectory, step: Step, ways: Sequence[Approach], given_rad: float | None
) -> Approach | None:
    """The first approach open to a walk from the current position: free, in the given direction, at a natural speed.

    Args:
        trajectory: Trajectory so far.
        step: The walk, with its time.
        ways: Approaches in order of preference.
        given_rad: Direction of the walk from +x towards +y; None for any.

    Returns:
        The approach, or None.
    """
    here_m = trajectory.position_m
    for way in ways:
        corners = np.stack([here_m, *way.corners_m])
        gaps = np.diff(corners, axis=0)
        lasts = max(step.end_s - step.start_s - 0.35 * len(gaps), 0.1)
        slowest, fastest = _SPEEDS_MPS.get(step.lower, _WALK_MPS)
        if not slowest <= float(np.hypot(*gaps.T).sum()) / lasts <= fastest:
            continue
        towards = float(np.arctan2(gaps[0, 1], gaps[0, 0]))
        if given_rad is not None and abs(signed_angle_rad(given_rad, towards)) >= _DIRECTION_RAD:
            continue
        if bool(_are_free(trajectory.floor, here_m[None], way.sitting, way.gate_m)[0]):
            return way
    return None


def start_of_walk(way: Approach, step: Step, direction_rad: float | None, rng: np.random.Generator) -> Array | None:
    """Samples a start for a walk to a seat.

    Args:
        way: Approach to the seat.
        step: The walk, with its time.
        direction_rad: Direction of the walk from +x towards +y; None for any.
        rng: Random stream.

    Returns:
        Position (x, y) in metres from which the walk fits time and direction; None if there is none.
    """
    gaps_m = way.corners_m[0] - way.starts_m
    further_m = 0.0 if way.gate_m is None else distance_m(way.sitting.feet_m, way.gate_m)
    apart_m = np.hypot(*gaps_m.T) + further_m
    lasts = step.end_s - step.start_s
    fits = (apart_m > 0.55 * lasts) & (apart_m < 1.35 * lasts)
    if direction_rad is not None:
        towards = np.arctan2(gaps_m[:, 1], gaps_m[:, 0])
        fits &= np.abs((towards - direction_rad + np.pi) % (2 * np.pi) - np.pi) < 0.9 * _DIRECTION_RAD
    some = way.starts_m[fits]
    return random_choice(some, rng) if len(some) else None


def walk_to_seat(trajectory: Trajectory, step: Step, way: Approach, *, first: bool) -> None:
    """Lays out a walk to a seat: straight, or through the gate and along the front of the seat.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The walk, with its time.
        way: Approach to the seat.
        first: Whether the motion begins with this step.

    Raises:
        NoTrajectory: If there is no time to walk.
    """
    corners = np.stack([trajectory.position_m, *way.corners_m])
    gaps = np.diff(corners, axis=0)
    lengths, directions = np.hypot(*gaps.T), np.arctan2(gaps[:, 1], gaps[:, 0])
    time = step.start_s
    for leg, (length, direction) in enumerate(zip(lengths, directions, strict=True)):
        begin = face_along(trajectory, step, float(direction), time, first=first and leg == 0)
        end = step.end_s
        if leg + 1 < len(lengths):
            turn_rad = abs(signed_angle_rad(float(direction), float(directions[leg + 1])))
            turning_s = 0.5 * (TURN_OVERHEAD_S + turn_rad / TURN_RATE_RADPS)
            end = begin + (step.end_s - turning_s - begin) * float(length / lengths.sum())
        ramps = (ramps_of(end - begin, first=first and leg == 0, last=False)[0], min(0.45, 0.42 * (end - begin)))
        trajectory.go(step, float(direction), float(length), (begin, end), ramps)
        time = end
    if time - step.start_s < 0.3:
        raise NoTrajectory("no time to walk to the seat")


def _ways_to(seat: Sitting, floor: FloorMap, body: SkeletonProportions) -> list[Approach]:
    """The least unusual ways to sit on a seat with room for the feet, a path to it, and a collision-free body."""
    cells = floor.walkable_m
    cells = cells[:: max(1, len(cells) // _MAX_STARTS)]
    found: list[Approach] = []
    for sitting in _clear_sittings(seat, floor, body) if len(cells) else []:
        if len(found) == _WAYS_A_SEAT:
            break
        for gate_m in (None, *_gates(sitting, floor)):
            starts_m = cells[_are_free(floor, cells, sitting, gate_m)]
            if len(starts_m):
                cost = sitting.cost + _NARROW_COST * (gate_m is not None)
                found.append(Approach(sitting=replace(sitting, cost=cost), gate_m=gate_m, starts_m=starts_m))
                break
    return found


def _clear_sittings(seat: Sitting, floor: FloorMap, body: SkeletonProportions) -> list[Sitting]:
    """Ways to sit, the best first, whose penetration while sitting down stays below the reported depth."""
    sittings = [one for one in _sittings(seat, floor) if _has_room_for_feet(one, floor)]
    if not sittings:
        return []
    obstacles = CollisionMap.of(floor.scene)
    lower = Step(lower="sit_down", start_s=0.0, end_s=_SITS_DOWN_S)
    placed = (PlacedStep(step=lower, seat_height_m=seat.height_m),)
    at = RootPath(start_m=(0.0, 0.0), heading_rad=0.0, moves=(), turns=())
    controls = assembled_controls(placed, at, body, seed=0, duration_s=_SITS_DOWN_S)
    pose = solved(controls, body, duration_s=_SITS_DOWN_S, floor_z_m=floor.scene.floor_z_m)
    sketch = BodySamples.of(pose).relative_to(at).deduplicated()
    bodies = [
        sketch.along(
            RootPath(
                start_m=(float(one.feet_m[0]), float(one.feet_m[1])), heading_rad=one.facing_rad, moves=(), turns=()
            )
        )
        for one in sittings
    ]
    seats = [((float(one.seat_m[0]), float(one.seat_m[1])),) for one in sittings]
    rough_m = obstacles.estimates_m(bodies, seats, margin_m=_MARGIN_M, chairs=[one.chair for one in sittings])
    order = np.argsort([one.cost + _DEEP_COST_PER_M * depth for one, depth in zip(sittings, rough_m, strict=True)])
    found: list[Sitting] = []
    for k in order[:_MAX_TESTED]:
        depth_m = obstacles.penetration_m(bodies[k], seats[k], margin_m=_MARGIN_M, chair=sittings[k].chair)
        if depth_m <= _DEEPEST_M + _MARGIN_M:
            found.append(replace(sittings[k], cost=sittings[k].cost + _DEEP_COST_PER_M * depth_m))
    kept: list[Sitting] = []
    for one in sorted(found, key=lambda one: one.cost):
        if not any(_is_alike(one, other) for other in kept):
            kept.append(one)
    return kept


def _has_room_for_feet(sitting: Sitting, floor: FloorMap) -> bool:
    """Whether the floor in front of a seat is free, or occupied only by the chair that is pulled out."""
    was_chair = sitting.chair is not None and bool(sitting.chair.covers(sitting.feet_m))
    return was_chair or bool(floor.clearance_at(sitting.feet_m) > CLOSEST_FEET_M)


def _is_alike(one: Sitting, other: Sitting) -> bool:
    """Whether two ways to sit differ by a small shift only."""
    apart_m = distance_m(one.seat_m, other.seat_m)
    return apart_m < _SHIFT_M / 2 and abs(one.facing_rad - other.facing_rad) < 0.01


def _sittings(seat: Sitting, floor: FloorMap) -> Iterator[Sitting]:
    """Sitting ahead or turned; on a wide seat at several places along it, or on a chair pulled out."""
    spare_m = max(0.0, (seat.width_m - _SEAT_WIDTH_M) / 2)
    along_m = np.linspace(-spare_m, spare_m, 1 + 2 * int(np.ceil(spare_m / _SHIFT_M)))
    places = [(float(shift_m), 0.0) for shift_m in along_m]
    places += [(-_LITTLE_M, 0.0), (_LITTLE_M, 0.0), (0.0, -_LITTLE_M), (0.0, _LITTLE_M)]
    for shift_m, ahead_m in places:
        moved = seat.moved(shift_m * seat.aside).moved_ahead(ahead_m).clear_knees()
        for turn_rad in {sign * turn for turn in _TURNS_RAD for sign in (-1.0, 1.0)}:
            cost = _SHIFT_COST * float(np.hypot(shift_m, ahead_m))
            cost += 0.3 + _TURN_COST * abs(turn_rad) if turn_rad else 0.0
            yield replace(turned(moved, turn_rad), cost=cost)
    pulled = [one for by_m in _PULLED_M if (one := pulled_out(seat, floor, by_m)) is not None]
    for one, turn_rad in product(pulled, _PULLED_TURNS_RAD):
        yield turned(one, turn_rad)


def _gates(sitting: Sitting, floor: FloorMap) -> list[Float[Array, "2"]]:
    """Walkable places from which a narrow but free path leads along the front of the seat, the nearest first."""
    lengths_m = np.arange(_GATE_STEP_M, _LONGEST_NARROW_M + 1e-9, _GATE_STEP_M)
    found = []
    for side in (-1.0, 1.0):
        for off in _OFF_FRONT_RAD:
            angle = sitting.facing_rad + side * (np.pi / 2 - off)
            line_m = sitting.feet_m + lengths_m[:, None] * unit_vector(angle)
            can_stand, narrow = floor.can_stand(line_m), floor.clearance_at(line_m) > _NARROW_M
            first = int(np.argmax(can_stand))
            if can_stand[first] and narrow[:first].all():
                found.append((float(lengths_m[first]), line_m[first]))
    return [gate_m for _, gate_m in sorted(found, key=lambda one: one[0])]


def _are_free(floor: FloorMap, places_m: Array, sitting: Sitting, gate_m: Array | None) -> Array:
    """Whether the straight path from each place (place, 2) to the gate, or to the seat itself, is free, (place,)."""
    if gate_m is None:
        return are_reachable(floor, places_m, sitting)
    lines_m = places_m[:, None] + np.linspace(0, 1, 60)[:, None] * (gate_m - places_m)[:, None]
    return np.asarray(floor.can_stand(lines_m).all(axis=1))
