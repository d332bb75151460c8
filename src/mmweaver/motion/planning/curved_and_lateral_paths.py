"""Paths other than walking straight ahead: bends, sidesteps, stumbles, leaps, turns by an angle; room to lie down."""

import numpy as np

from mmweaver.motion.animation.library.on_furniture import OFF_SEAT_AHEAD_M
from mmweaver.motion.animation.library.on_the_floor import BACK_BEHIND_M, BELLY_AHEAD_M, SIDE_AWAY_M
from mmweaver.motion.animation.root_path import Move, Turn
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.plan import FALLS_OFF, Shape, Side, Step, Way
from mmweaver.motion.planning.floor_map import random_sign, unit_vector
from mmweaver.motion.planning.trajectory import (
    RAMP_S,
    SLOWER_TURNS,
    NoTrajectory,
    Trajectory,
    face_along,
    gait_limit_mps,
    preferred_speed_mps,
    ramps_of,
)

Array = np.ndarray
SPECIAL = ("sidestep", "stumble", "leap", "forward_roll")
ROLL_M = 1.85  # length of a forward roll, from standing to standing
LYING_ROOM_M = 0.22  # clearance on either side of a lying body
_TIGHT_COST = 40.0  # of a body entirely off the free floor: exceeds all other costs of a trajectory
SIDESTEP_M = 0.3  # length of one sidestep
_OUT_OF_VIEW = 0.5  # equivalent share of missing clearance
_TIGHT = "the free floor has no room"
_BEND_RADII_M = (1.3, 1.0, 0.8, 0.65, 0.5, 0.4)


def is_curved_or_lateral(step: Step) -> bool:
    """Whether `lay_curved_or_lateral` lays out this step."""
    return step.lower in SPECIAL or (bool(step.arc_deg) and step.direction != Shape.CIRCLE)


def lay_curved_or_lateral(
    trajectory: Trajectory, step: Step, direction_rad: float | None, *, first: bool, last: bool
) -> None:
    """Lays out a step for which `is_curved_or_lateral` holds.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The step.
        direction_rad: Direction in the sentence, from +x towards +y; None if open.
        first: Whether the motion begins with this step.
        last: Whether the motion ends with this step.

    Raises:
        NoTrajectory: If there is no room.
    """
    if step.arc_deg:
        _walk_bend(trajectory, step, direction_rad, first=first, last=last)
    elif step.lower == "sidestep":
        _walk_sideways(trajectory, step, direction_rad, first=first, last=last)
    else:
        _short_move(trajectory, step, direction_rad)


def _relative(trajectory: Trajectory, step: Step, direction_rad: float | None) -> float | None:
    """The direction, with forwards and backwards relative to the person's heading even at the very start."""
    if step.direction == Way.FORWARDS:
        return trajectory.heading_rad
    if step.direction in (Way.BACKWARDS, Way.BACK):
        return trajectory.heading_rad + np.pi
    return direction_rad


def _walk_bend(trajectory: Trajectory, step: Step, direction_rad: float | None, *, first: bool, last: bool) -> None:
    """A bend through the requested angle, as wide as time and room allow."""
    direction = direction_rad
    if direction is None or isinstance(step.direction, Side):
        chosen = first and not trajectory.heading_is_given
        direction = float(trajectory.rng.uniform(0, 2 * np.pi)) if chosen else trajectory.heading_rad
    backwards = step.direction == Way.BACKWARDS
    begin = face_along(trajectory, step, direction, step.start_s, first=first)
    ramps = ramps_of(step.end_s - begin, first=first, last=last)
    lasts = step.end_s - begin - sum(ramps) / 2
    either = random_sign(trajectory.rng) if step.either_side else 1.0
    bend = either * np.radians(step.arc_deg) * (-1.0 if backwards else 1.0)
    speed, slowest = preferred_speed_mps(step, trajectory.rng), gait_limit_mps(step)
    for radius in (speed * lasts / abs(bend), *_BEND_RADII_M):
        length = min(radius * abs(bend), speed * lasts)
        if length < slowest * min(lasts, 1.0):
            continue
        stops = length < slowest * lasts  # a short bend ends early
        span = length / (0.85 * speed) + 0.5 * (ramps[0] + RAMP_S) if stops else step.end_s - begin
        span = min(span, step.end_s - begin)
        move = Move(
            start_s=begin,
            end_s=begin + span,
            length_m=length,
            direction_rad=direction,
            ramp_in_s=ramps[0],
            ramp_out_s=min(RAMP_S, 0.4 * span) if stops else ramps[1],
            curvature_per_m=bend / length,
        )
        places = trajectory.position_m + move.shift_m(np.linspace(begin, begin + span, 60))
        if trajectory.floor.can_stand(places).all():
            trajectory.append(move, places, 0.5 * stops)
            trajectory.heading_rad += bend
            across, along = move.end_shift_m[::-1]  # walking back leads straight to the start of the bend
            trajectory.last_direction_rad = float(np.arctan2(across, along))
            return
    raise NoTrajectory("no room for the bend")


def _walk_sideways(trajectory: Trajectory, step: Step, direction_rad: float | None, *, first: bool, last: bool) -> None:
    """Sideways with the heading unchanged, to the given side or either."""
    direction = direction_rad
    if direction is None or step.direction in (Way.FORWARDS, Way.BACKWARDS, Way.BACK, Way.TOWARDS, Way.AWAY):
        direction = trajectory.heading_rad + float(trajectory.rng.choice([-0.5, 0.5])) * np.pi
    else:  # perpendicular to the heading, on the given side
        left = trajectory.heading_rad + 0.5 * np.pi
        direction = left if np.cos(direction - left) > 0 else left - np.pi
    begin, span = step.start_s, step.end_s - step.start_s
    speed = float(trajectory.rng.uniform(*((0.3, 0.4), (0.4, 0.6), (0.65, 0.85))[step.speed + 1]))
    steps = step.count if step.count and not step.upper else 0
    if steps:
        span = min(span, 0.75 * steps + 0.3)
    ramps = ramps_of(span, first=first and not steps, last=last and not steps)
    wanted = steps * SIDESTEP_M if steps else speed * (span - sum(ramps) / 2)
    length = trajectory.free_length_m(direction, wanted)
    if length < min(0.25, 0.6 * wanted):
        raise NoTrajectory(f"only {length:.1f} m")
    trajectory.cost += 2.0 * (1 - length / wanted)
    trajectory.go(step, direction, length, (begin, begin + span), ramps)


def _short_move(trajectory: Trajectory, step: Step, direction_rad: float | None) -> None:
    """A short move: caught after a push, or a leap."""
    direction = _relative(trajectory, step, direction_rad)
    if direction is None:
        directions_rad = (0.5 * np.pi, -0.5 * np.pi) if step.style == "side" else (0.0, np.pi, np.pi)
        direction = trajectory.heading_rad + float(trajectory.rng.choice(directions_rad))
    if step.lower == "stumble":
        length, span = float(trajectory.rng.uniform(0.3, 0.6)), min(step.end_s - step.start_s, 1.2)
        begin = step.start_s + 0.12
    elif step.lower == "forward_roll":
        length, begin, span = ROLL_M * max(step.count, 1), step.start_s, step.end_s - step.start_s
    else:
        each = (0.2, 0.35) if step.speed < 0 else (0.3, 0.6)
        length = float(trajectory.rng.uniform(*each)) * max(step.count, 1)
        begin, span = step.start_s, step.end_s - step.start_s
    free = trajectory.free_length_m(direction, length)
    if free < (0.93 if step.lower == "forward_roll" else 0.6) * length:
        raise NoTrajectory(f"only {free:.1f} m")
    ramp = min(0.3, 0.4 * span)
    trajectory.go(step, direction, free, (begin, begin + span), (ramp, ramp))


def turn_by(trajectory: Trajectory, step: Step) -> None:
    """Turns by `step.turn_deg`, to the left if positive; more than half a turn is possible.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The step.
    """
    either = random_sign(trajectory.rng) if step.either_side else 1.0
    angle_rad, start_s, span_s = either * np.radians(step.turn_deg), step.start_s, step.end_s - step.start_s
    lasts = min(SLOWER_TURNS[step.speed + 1] * (0.25 + abs(angle_rad) / 3.2), max(span_s, 0.6))
    trajectory.turns.append(Turn(start_s=start_s, end_s=start_s + lasts, angle_rad=angle_rad))
    trajectory.heading_rad += angle_rad


def _tight_note(step: Step) -> str:
    """Note on a body on a floor too small for it."""
    how = (
        "on hands and knees" if step.lower == "crawl" else "on the knees" if step.posture == "knees" else "full length"
    )
    return f"{_TIGHT} for {step.clause or step.name!r} {how}: the body reaches beyond it, where it touches least"


def check_floor_space(trajectory: Trajectory, step: Step, body: SkeletonProportions) -> None:
    """Checks that a kneeling, falling or lying body fits on the floor.

    On a tight floor it adds a cost that grows with the share of the body off the free floor, and a note.

    Args:
        trajectory: Trajectory so far.
        step: The step after which the body is tested.
        body: Bone lengths.

    Raises:
        NoTrajectory: If the body would penetrate furniture on a floor that is not tight.
    """
    if step.posture not in ("floor", "knees", "ground") and step.lower not in ("kneel_up", "get_up", "floor_rise"):
        return
    h = body.height_m
    if step.lower == "crawl":
        low, high = -0.4 * h, 0.55 * h
    elif step.posture == "ground" or step.lower == "floor_rise":
        low, high = -0.4 * h, 0.35 * h
    elif step.posture == "knees" or step.lower == "kneel_up":
        low, high = -0.4 * h, 0.15 * h
    elif step.style == "front" or step.lower == "push_ups":
        low, high = 0.0, (BELLY_AHEAD_M + 0.8) * h  # the arms are stretched out ahead
    else:
        low, high = -(BACK_BEHIND_M + 0.5) * h, 0.15 * h
    heading_rad = trajectory.heading_rad
    if step.style in ("left", "right") and (step.posture == "floor" or step.lower == "get_up"):
        heading_rad += 0.5 * np.pi * (1 if step.style == "left" else -1)
        low, high = -0.1 * h, (SIDE_AWAY_M + 0.55) * h
    along = np.linspace(low, high, 24)[:, None] * unit_vector(heading_rad)
    ahead_m = OFF_SEAT_AHEAD_M if step.lower in FALLS_OFF else 0.0
    ahead = unit_vector(trajectory.heading_rad)
    places = trajectory.position_m + ahead_m * ahead + along
    short_m = np.maximum(LYING_ROOM_M - trajectory.floor.clearance_at(places), 0.0)
    if short_m.any():
        if not trajectory.floor.is_tight:
            raise NoTrajectory("no floor to lie on")
        out_of_view = _OUT_OF_VIEW * ~trajectory.floor.sees(places)
        trajectory.cost += _TIGHT_COST * float(np.maximum(short_m / LYING_ROOM_M, out_of_view).mean())
        rises = step.lower in ("kneel_up", "get_up")  # from a position that has been reported already
        if not (rises and any(note.startswith(_TIGHT) for note in trajectory.notes)):
            trajectory.notes.append(_tight_note(step))
    trajectory.cost += float(trajectory.floor.cost_at(places).mean())
