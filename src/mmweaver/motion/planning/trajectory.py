"""A candidate trajectory through a room: moves and turns laid out step by step, as far as the floor allows."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.library.gait import LUNGES_HZ
from mmweaver.motion.animation.root_path import Move, RootPath, Turn
from mmweaver.motion.language.plan import HOPPING, Shape, Step, Way
from mmweaver.motion.planning.collision import PulledChair
from mmweaver.motion.planning.floor_map import FloorMap, random_sign, unit_vector

Array = np.ndarray
SLOWEST_MPS = {
    "walk": 0.5,
    "jog": 1.6,
    "limp": 0.4,
    "stagger": 0.4,
    "crawl": 0.15,
    "hop": 0.25,
    "hop_one_leg": 0.25,
    "walking_lunge": 0.3,
}
SLOWED_TO, RUN_SLOWED_TO = 0.6, 0.8  # of the preferred speed on a short path; a slower run is no run
RAMP_S = 0.45  # acceleration from standing to walking, and deceleration
RUN_RAMP_S = 0.8  # the same for running
TURN_RATE_RADPS = 3.6
TURN_OVERHEAD_S = 0.25  # fixed part of the duration of a turn on the spot
_TO_AND_FRO_WITHIN_S = (3.0, 6.5)  # "walks to and fro" of this duration is there and back; the floor limits longer ones
_TO_AND_FRO_ON_KNEES_WITHIN_S = (6.5, 11.0)  # the same on hands and knees
SLOWER_TURNS = (1.5, 1.0, 0.8)  # factor of the duration: slowly, as usual, quickly
SHORTEST_LEG_M = 0.5
SHORTEST_WALK_M = 0.6  # one step
PACING_LEG_M = {"walk": 0.8, "jog": 2.0, "crawl": 0.5}  # shortest leg of pacing
PACED_M = {"walk": 2.5, "jog": 4.0, "crawl": 1.5}  # longest leg of "walks to and fro"
CRAWLING_TURN_RADPS, TURNS_ON_KNEES_M = 1.5, 0.9  # on hands and knees: turn rate, and clearance for a turn
CIRCLE_RADII_M = (0.9, 0.75, 0.6, 0.5, 0.4)
FASTER = 1.3  # maximum speed-up to complete a circle


class NoTrajectory(Exception):  # noqa: N818 - control flow, not an error
    """A candidate that fails; the message states the reason."""


def signed_angle_rad(one: float, other: float) -> float:
    """Angle from one direction to another in radians, in [-pi, pi)."""
    return float((other - one + np.pi) % (2 * np.pi) - np.pi)


def preferred_speed_mps(step: Step, rng: np.random.Generator) -> float:
    """Samples a speed for a step's gait and for 'slowly' or 'quickly'.

    Args:
        step: The step.
        rng: Random stream.

    Returns:
        Speed in m/s.
    """
    if step.speed_mps:
        return step.speed_mps
    if step.steps_hz and step.lower == "walk":
        return walking_mps(step.steps_hz)
    if step.lower == "jog" and step.style == "jog":  # "jogs", "trots"; else "runs", "sprints"
        low, high = ((1.8, 2.1), (2.1, 2.7), (2.7, 3.2))[step.speed + 1]
    elif step.lower == "jog":
        low, high = ((2.1, 2.6), (2.7, 3.3), (3.5, 4.2))[step.speed + 1]
    elif step.lower == "crawl":
        low, high = ((0.2, 0.25), (0.28, 0.45), (0.5, 0.7))[step.speed + 1]
    elif step.lower == "walking_lunge":
        low, high = ((0.36, 0.44), (0.46, 0.58), (0.6, 0.72))[step.speed + 1]
    elif step.lower in ("limp", "stagger"):
        low, high = ((0.45, 0.6), (0.6, 0.9), (0.9, 1.1))[step.speed + 1]
    elif step.lower in HOPPING:
        low, high = ((0.25, 0.35), (0.4, 0.6), (0.6, 0.75))[step.speed + 1]
    else:
        low, high = ((0.6, 0.8), (1.0, 1.3), (1.4, 1.6))[step.speed + 1]
    return float(rng.uniform(low, high)) * (0.7 if step.direction == Way.BACKWARDS else 1.0) * step.pace


def walking_mps(steps_hz: float) -> float:
    """Usual walking speed at a step rate, in m/s (the inverse of the step rate of `gait.walking_style`)."""
    return float(np.clip(1.3 * (steps_hz / 1.87) ** (1 / 0.55), 0.3, 2.0))


def slowest_mps(step: Step, speed_mps: float) -> float:
    """Lowest speed to which a short path slows a gait; on a shorter one, the body walks faster and then stands.

    Args:
        step: The step.
        speed_mps: Preferred speed in m/s.

    Returns:
        Speed in m/s.
    """
    if step.speed_mps or step.steps_hz:
        return 0.95 * speed_mps
    return max(SLOWEST_MPS[step.lower], (RUN_SLOWED_TO if step.lower == "jog" else SLOWED_TO) * speed_mps)


@dataclass
class Trajectory:
    """A trajectory under construction, in the radar's frame.

    Attributes:
        floor: Floor of the room.
        rng: Random stream.
        position_m: Current position (x, y) in metres.
        heading_rad: Current heading, from +x towards +y.
        start_m: Start (x, y) in metres.
        start_heading_rad: Initial heading.
        moves: Moves of each step.
        turns: Turns on the spot.
        notes: Assumptions to report.
        seat_height_m: Height of the seat of each step in metres.
        seats_m: Seats (x, y) on which the person sits.
        chair: Chair on which the person sits, if pulled out.
        cost: Sum of the penalties.
        last_direction_rad: Direction of the last move.
        invents_seat: Whether a stool was assumed although the room has a reachable seat.
        from_seat: Whether the body has just stood up: the seat's own edge does not block the first metre.
        turn_rate_radps: Angular rate of turns on the spot.
        heading_is_given: Whether the initial heading is prescribed; an undirected walk begins that way.
        reserve_m: Floor ahead that straight walks leave free for what follows, such as a fall.
        lost: Share of what the sentence asks for that the path loses (`path_facts.lost_share`).
    """

    floor: FloorMap
    rng: np.random.Generator
    position_m: Float[Array, "2"]
    heading_rad: float
    start_m: tuple[float, float] = (0.0, 0.0)
    start_heading_rad: float = 0.0
    moves: list[list[Move]] = field(default_factory=list)
    turns: list[Turn] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    seat_height_m: list[float] = field(default_factory=list)
    seats_m: list[tuple[float, float]] = field(default_factory=list)
    chair: PulledChair | None = None
    cost: float = 0.0
    last_direction_rad: float | None = None
    invents_seat: bool = False
    from_seat: bool = False
    turn_rate_radps: float = TURN_RATE_RADPS
    heading_is_given: bool = False
    reserve_m: float = 0.0
    lost: float = 0.0

    def __post_init__(self) -> None:
        self.start_m = (float(self.position_m[0]), float(self.position_m[1]))
        self.start_heading_rad = self.heading_rad

    def path(self) -> RootPath:
        """The path of the body's root as laid out so far."""
        return RootPath(
            start_m=self.start_m,
            heading_rad=self.start_heading_rad,
            moves=tuple(move for moves in self.moves for move in moves),
            turns=tuple(self.turns),
        )

    def free_length_m(self, direction_rad: float, wanted_m: float) -> float:
        """Length of the free straight path from the current position, metres.

        Args:
            direction_rad: Direction from +x towards +y.
            wanted_m: Maximum length in metres.
        """
        return float(self.free_lengths_m(np.array([direction_rad]), wanted_m)[0])

    def free_lengths_m(self, directions_rad: Float[Array, " way"], wanted_m: float) -> Float[Array, " way"]:
        """`free_length_m` in several directions."""
        return self.floor.free_lengths_m(
            self.position_m, directions_rad, wanted_m, excused_m=1.2 if self.from_seat else 0.0
        )

    def turn_to(self, heading_rad: float, start_s: float, *, slower: float = 1.0, most_s: float = np.inf) -> float:
        """Turns on the spot through the smaller angle.

        Args:
            heading_rad: New heading, from +x towards +y.
            start_s: Start of the turn, seconds.
            slower: Factor of the duration.
            most_s: Maximum duration in seconds to which `slower` may extend it.

        Returns:
            Duration in seconds.
        """
        angle = signed_angle_rad(self.heading_rad, heading_rad)
        if abs(angle) < 0.02:
            self.heading_rad = self.heading_rad + angle
            if angle:
                self.turns.append(Turn(start_s=start_s, end_s=start_s + 0.3, angle_rad=angle))
            return 0.0
        usual_s = TURN_OVERHEAD_S + abs(angle) / self.turn_rate_radps
        lasts = min(slower * usual_s, max(usual_s, most_s))
        self.turns.append(Turn(start_s=start_s, end_s=start_s + lasts, angle_rad=angle))
        self.heading_rad += angle
        self.cost += 0.25 * abs(angle)
        return lasts

    def go(
        self, step: Step, direction_rad: float, length_m: float, span: tuple[float, float], ramps: tuple[float, float]
    ):
        """Appends a straight move; the caller ensures that it is free.

        Args:
            step: The step.
            direction_rad: Direction from +x towards +y.
            length_m: Length in metres.
            span: Start and end in seconds.
            ramps: Acceleration and deceleration time in seconds.
        """
        move = Move(
            start_s=span[0],
            end_s=span[1],
            length_m=length_m,
            direction_rad=direction_rad,
            ramp_in_s=ramps[0],
            ramp_out_s=ramps[1],
        )
        self.append(move, self.position_m + np.linspace(0, length_m, 8)[:, None] * unit_vector(direction_rad))
        self.last_direction_rad = direction_rad

    def append(self, move: Move, places_m: Float[Array, "place 2"], extra_cost: float = 0.0) -> None:
        """Appends a move and its cost.

        Args:
            move: The move.
            places_m: Positions (x, y) on it in metres, whose floor cost is averaged.
            extra_cost: Additional cost.
        """
        self.moves[-1].append(move)
        self.position_m = self.position_m + move.end_shift_m
        self.cost += float(self.floor.cost_at(places_m).mean()) + extra_cost
        self.from_seat = False


def face_along(trajectory: Trajectory, step: Step, direction_rad: float, start_s: float, *, first: bool) -> float:
    """Turns the body along a direction (against it when going backwards).

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The step.
        direction_rad: Direction of motion, from +x towards +y.
        start_s: Start of the turn, seconds.
        first: Whether the motion begins here, so that no turn is needed.

    Returns:
        Time in seconds at which the first stride can begin.
    """
    heading = direction_rad + np.pi if step.direction == Way.BACKWARDS else direction_rad
    if first:
        trajectory.start_heading_rad = trajectory.heading_rad = heading
        return start_s
    return start_s + 0.5 * trajectory.turn_to(heading, start_s - 0.1)


def walk_straight(trajectory: Trajectory, step: Step, direction_rad: float, *, first: bool, last: bool) -> None:
    """Walks in a given direction for the step's time; slower or less far if the room is too short.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The step.
        direction_rad: Direction from +x towards +y.
        first: Whether the motion begins with this step.
        last: Whether the motion ends with this step.

    Raises:
        NoTrajectory: If there is less than about one step of free floor.
    """
    begin = face_along(trajectory, step, direction_rad, step.start_s, first=first)
    end = _stop_s(step, begin)
    goes_on = step.lower not in HOPPING and not step.count  # these begin and end on the spot
    last = last and end >= step.end_s - 1e-9 and goes_on
    ramps = ramps_of(end - begin, first=first and goes_on, last=last, ramp_s=_ramp_s(step))
    effective = end - begin - sum(ramps) / 2
    speed = preferred_speed_mps(step, trajectory.rng)
    wanted = speed * effective
    if step.distance_m:
        _walk_distance(trajectory, step, direction_rad, speed, (begin, end), first=first and goes_on, last=last)
        return
    free = trajectory.free_length_m(direction_rad, wanted + trajectory.reserve_m)
    free = min(max(free - trajectory.reserve_m, min(free, SHORTEST_WALK_M)), wanted)
    if free >= slowest_mps(step, speed) * effective:
        trajectory.cost += 2.0 * (1 - free / wanted)
        trajectory.go(step, direction_rad, free, (begin, end), ramps)
        return
    if free < SHORTEST_WALK_M * SLOWEST_MPS[step.lower] / SLOWEST_MPS["walk"]:
        raise NoTrajectory(f"only {free:.1f} m")
    stop_ramps = (ramps[0], _ramp_s(step))
    speed = speed if step.speed_mps or step.steps_hz else max(0.85 * speed, SLOWEST_MPS[step.lower])
    lasts = free / speed + sum(stop_ramps) / 2
    trajectory.cost += 1.5 + 2.0 * (1 - free / wanted)
    trajectory.go(step, direction_rad, free, (begin, begin + lasts), stop_ramps)
    _say_stopped(trajectory, step, free)


def _walk_distance(
    trajectory: Trajectory,
    step: Step,
    direction_rad: float,
    speed_mps: float,
    span_s: tuple[float, float],
    *,
    first: bool,
    last: bool,
) -> None:
    """Walks the stated distance at about the preferred speed, then stands; as far as there is floor and time.

    Raises NoTrajectory if there is less than about one step of free floor.
    """
    available_s, ramp_s = span_s[1] - span_s[0], _ramp_s(step)
    fastest = speed_mps * (1.1 if step.speed_mps else 1.6)
    wanted = min(step.distance_m, fastest * max(available_s - ramp_s / 2, 0.2))
    free = trajectory.free_length_m(direction_rad, wanted)
    if free < min(0.4, 0.9 * wanted):
        raise NoTrajectory(f"only {free:.1f} m")
    ramps = ramps_of(available_s, first=first, last=False, ramp_s=ramp_s)
    lasts = free / speed_mps + sum(ramps) / 2
    if lasts > available_s - 0.05:
        ramps = ramps_of(available_s, first=first, last=last, ramp_s=ramp_s)
        lasts = available_s
    ramps = (min(ramps[0], 0.42 * lasts), min(ramps[1], 0.42 * lasts))
    trajectory.go(step, direction_rad, free, (span_s[0], span_s[0] + lasts), ramps)


def _say_stopped(trajectory: Trajectory, step: Step, gone_m: float) -> None:
    if step.speed_mps and not step.seconds:
        return  # neither a length nor a time is asked for
    trajectory.notes.append(
        f"there is room to go {gone_m:.1f} m for {step.clause!r}; after that the person"
        f" {'stays on hands and knees' if step.lower == 'crawl' else 'stands still'} until {step.end_s:.1f} s"
    )


def _stop_s(step: Step, begin: float) -> float:
    """Time at which a counted number of paces is done, else the end of the step, in seconds."""
    if not step.count or step.upper:
        return step.end_s
    each = 0.38 if step.lower == "jog" else (0.72, 0.58, 0.5)[step.speed + 1]
    each = 1 / LUNGES_HZ[step.speed + 1] if step.lower == "walking_lunge" else each
    return min(step.end_s, begin + each * step.count + 0.3)


def _ramp_s(step: Step) -> float:
    return RUN_RAMP_S if step.lower == "jog" else RAMP_S


def ramps_of(span_s: float, *, first: bool, last: bool, ramp_s: float = RAMP_S) -> tuple[float, float]:
    """Acceleration and deceleration times in seconds; 0 if the motion is already under way, or continues.

    Args:
        span_s: Duration of the move in seconds.
        first: Whether the motion begins with this move, under way.
        last: Whether the motion ends with this move, under way.
        ramp_s: Usual ramp in seconds.

    Raises:
        NoTrajectory: If the move is shorter than 0.45 s.
    """
    if span_s < 0.45:
        raise NoTrajectory("no time left to walk after turning")
    ramp = min(ramp_s, 0.42 * span_s)
    return (0.0 if first else ramp), (0.0 if last else ramp)


def walk_anywhere(trajectory: Trajectory, step: Step, *, first: bool, last: bool) -> None:
    """Walks without a given direction: straight as long as there is room, then turns and continues, to and fro.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The step.
        first: Whether the motion begins with this step.
        last: Whether the motion ends with this step.

    Raises:
        NoTrajectory: If there is too little room or time.
    """
    speed = preferred_speed_mps(step, trajectory.rng)
    runs, slowest = step.lower == "jog", SLOWEST_MPS[step.lower]
    time, begun, ramp_s = step.start_s, first, _ramp_s(step)
    trajectory.turn_rate_radps = CRAWLING_TURN_RADPS if step.lower == "crawl" else TURN_RATE_RADPS
    pacing_m = _pacing_m(step, speed)
    for _ in range(40):
        left = step.end_s - time
        faces_already = time == step.start_s and (not first or trajectory.heading_is_given)
        if pacing_m and time > step.start_s and trajectory.last_direction_rad is not None:
            direction = trajectory.last_direction_rad + np.pi
            free = trajectory.free_length_m(direction, pacing_m)
        else:
            direction, free = _open_direction(trajectory, speed * left, keep_heading=faces_already)
            pacing_m = _there_and_back_m(trajectory, step, direction, free, pacing_m)
            free = min(free, pacing_m or free)
        if begun and trajectory.heading_is_given:
            begin = time + trajectory.turn_to(direction, time)
            begun = begin == time
        else:
            begin = face_along(trajectory, step, direction, time, first=begun)
        left = step.end_s - begin
        final = free >= (slowest_mps(step, speed) * left if runs else 0.75 * speed * (left - ramp_s / 2))
        if final:
            ramps = ramps_of(left, first=begun, last=last, ramp_s=ramp_s)
            length = min(free, speed * (left - sum(ramps) / 2))
            if length < slowest * (left - sum(ramps) / 2):
                raise NoTrajectory(f"only {free:.1f} m")
            trajectory.go(step, direction, length, (begin, step.end_s), ramps)
            return
        free = _knee_turn_reach_m(trajectory, direction, free) if step.lower == "crawl" else free
        if free < PACING_LEG_M.get(step.lower, PACING_LEG_M["walk"]):
            raise NoTrajectory(f"only {free:.1f} m")
        ramps = (0.0 if begun else ramp_s, ramp_s)
        lasts = free / speed + sum(ramps) / 2
        stops = left - lasts < 1.3
        if stops and runs:  # a run is not slowed down; the body stands still for the rest
            lasts = min(lasts, left)
        elif stops:  # leave enough time to turn and go back, or use all of it for this leg
            lasts = left if free >= slowest * (left - sum(ramps) / 2) else left - 1.3
        length = min(free, speed * (lasts - sum(ramps) / 2))
        if lasts < 0.8 or length < SHORTEST_LEG_M:
            raise NoTrajectory(f"only {free:.1f} m")
        trajectory.go(step, direction, length, (begin, begin + lasts), ramps)
        trajectory.cost += 0.15
        time, begun = begin + lasts - 0.15, False
        if step.end_s - time < 0.3:
            return
        if stops and runs:
            trajectory.cost += 2.0 * (1 - length / (speed * left))
            _say_stopped(trajectory, step, length)
            return
    raise NoTrajectory("too many turns")


def _pacing_m(step: Step, speed_mps: float) -> float:
    """Length in metres of a leg of pacing; 0 if time or sentence do not ask for it."""
    lasts_s, crawls = step.end_s - step.start_s, step.lower == "crawl"
    least_s, most_s = _TO_AND_FRO_ON_KNEES_WITHIN_S if crawls else _TO_AND_FRO_WITHIN_S
    if step.direction != Shape.PACING or not least_s < lasts_s < most_s:
        return 0.0
    turning_s = np.pi / CRAWLING_TURN_RADPS if crawls else 0.0
    return min(PACED_M.get(step.lower, PACED_M["walk"]), speed_mps * (lasts_s - turning_s - 1.2) / 2)


def _there_and_back_m(trajectory: Trajectory, step: Step, direction_rad: float, free_m: float, paced_m: float) -> float:
    """Maximum length of a leg of pacing; a crawling body that cannot turn there goes one way: 0."""
    if step.lower != "crawl" or not paced_m:
        return paced_m
    roomy_m = _knee_turn_reach_m(trajectory, direction_rad, min(free_m, paced_m))
    if not roomy_m:
        trajectory.cost += 2.0
        trajectory.notes.append(f"there is no room to turn on hands and knees for {step.clause!r}; one way is shown")
    return roomy_m


def _knee_turn_reach_m(trajectory: Trajectory, direction_rad: float, free_m: float) -> float:
    """Distance to the last position at which a crawling body has room to turn; 0 without one."""
    gone_m = np.arange(PACING_LEG_M["crawl"], free_m, 0.05)
    places = trajectory.position_m + gone_m[:, None] * unit_vector(direction_rad)
    roomy = gone_m[trajectory.floor.clearance_at(places) > TURNS_ON_KNEES_M] if len(gone_m) else gone_m
    return float(roomy[-1]) if len(roomy) else 0.0


def _open_direction(trajectory: Trajectory, wanted_m: float, *, keep_heading: bool) -> tuple[float, float]:
    """A direction with room and its free length, sampled among the better ones; straight on if possible."""
    wanted_m = min(wanted_m, 5.0)
    if keep_heading:
        free = trajectory.free_length_m(trajectory.heading_rad, wanted_m)
        if free >= 0.8 * wanted_m:
            return trajectory.heading_rad, free
    directions = trajectory.rng.uniform(0, 2 * np.pi) + np.arange(12) * np.pi / 6
    free = trajectory.free_lengths_m(directions, wanted_m)
    pick = int(np.argmax(free * trajectory.rng.uniform(0.6, 1.0, len(free))))
    return float(directions[pick]), float(free[pick])


def walk_circle(trajectory: Trajectory, step: Step, *, first: bool, last: bool) -> None:
    """Walks in a circle as wide as time and room allow: whole rounds, and at least one if time permits.

    Args:
        trajectory: Trajectory so far, which is extended.
        step: The step.
        first: Whether the motion begins with this step.
        last: Whether the motion ends with this step.

    Raises:
        NoTrajectory: If there is no room for the narrowest circle of 0.4 m.
    """
    rng = trajectory.rng
    side = float(np.sign(step.arc_deg)) if step.arc_deg and not step.either_side else random_sign(rng)
    chosen = first and not trajectory.heading_is_given
    direction = float(rng.uniform(0, 2 * np.pi)) if chosen else trajectory.heading_rad
    begin = face_along(trajectory, step, direction, step.start_s, first=first)
    goes_on = step.lower not in HOPPING  # hopping begins and ends on the spot
    ramps = ramps_of(step.end_s - begin, first=first and goes_on, last=last and goes_on)
    speed = min(preferred_speed_mps(step, rng), 1.6 if step.lower == "jog" else 1.1)
    within_m = speed * (step.end_s - begin - sum(ramps) / 2)
    widest_m, narrowest_m = CIRCLE_RADII_M[0], CIRCLE_RADII_M[-1]
    for radius in CIRCLE_RADII_M:
        length = _rounds(step, within_m / (2 * np.pi * radius)) * 2 * np.pi * radius
        if length > FASTER * within_m:
            if radius > narrowest_m:
                continue
            length = within_m  # time suffices for a part of it only
        move = Move(
            start_s=begin,
            end_s=step.end_s,
            length_m=length,
            direction_rad=direction,
            ramp_in_s=ramps[0],
            ramp_out_s=ramps[1],
            curvature_per_m=side / radius,
        )
        circle_m = trajectory.position_m + move.shift_m(np.linspace(begin, step.end_s, 60))
        if trajectory.floor.can_stand(circle_m).all():
            trajectory.moves[-1].append(move)
            trajectory.position_m = trajectory.position_m + move.end_shift_m
            trajectory.heading_rad = direction + move.curvature_per_m * move.length_m
            trajectory.last_direction_rad = trajectory.heading_rad
            trajectory.cost += float(trajectory.floor.cost_at(circle_m).mean()) + 0.3 * (widest_m - radius)
            _say_slower(trajectory, step, radius, length / max(move.end_s - begin - sum(ramps) / 2, 0.2))
            return
    raise NoTrajectory(f"no room for a circle of {narrowest_m:g} m")


def _say_slower(trajectory: Trajectory, step: Step, radius_m: float, speed_mps: float) -> None:
    """Notes a circle that is run more slowly than running elsewhere."""
    least_mps = 1.8 if step.style == "jog" else 2.1  # of `preferred_speed_mps`
    if step.lower == "jog" and speed_mps < least_mps * step.pace - 0.05:
        trajectory.notes.append(
            f"{step.clause!r} goes round in a circle of {radius_m:g} m, at {speed_mps:.1f} m/s: slower than running"
        )


def _rounds(step: Step, usual: float) -> float:
    """Number of rounds: as stated, else whole rounds at about the usual speed."""
    if step.count:
        return usual  # the paces are counted
    asked = abs(step.arc_deg) / 360
    return asked if asked > 1 else max(1.0, float(round(usual)))
