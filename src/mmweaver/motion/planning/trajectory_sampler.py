"""Samples candidate trajectories of a plan: a start, and every step laid out from there."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Scene
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.activities import CLEARANCE_M
from mmweaver.motion.language.plan import FALLS, FALLS_OFF, MotionPlan, Shape, Side, Step, Way
from mmweaver.motion.planning.approaches import (
    CLOSEST_FEET_M,
    Approach,
    approach_from,
    approaches,
    fitting_approaches,
    start_of_walk,
    walk_to_seat,
)
from mmweaver.motion.planning.asked import Quantity, quantities, turns_the_body
from mmweaver.motion.planning.body_state import BodyState
from mmweaver.motion.planning.curved_and_lateral_paths import (
    check_floor_space,
    is_curved_or_lateral,
    lay_curved_or_lateral,
    turn_by,
)
from mmweaver.motion.planning.floor_map import (
    FloorMap,
    bearing_rad,
    distance_m,
    distances_m,
    random_choice,
)
from mmweaver.motion.planning.path_facts import lost_share, path_facts
from mmweaver.motion.planning.seating import (
    STOOL_HEIGHT_M,
    Sitting,
    any_variation,
    centred_to_lie,
    fitting,
    long_enough_to_lie_on,
    preferred,
    pulled_note,
    pulled_out,
    random_subset,
    stool_at,
    stool_fits,
    stool_note,
    turned,
    usable_seats,
    usual_variation,
)
from mmweaver.motion.planning.targets import (
    faced_landmarks,
    goes_to_target,
    kinds_of,
    start_for_target,
    walk_along,
    walk_to_target,
)
from mmweaver.motion.planning.trajectory import (
    SLOWER_TURNS,
    NoTrajectory,
    Trajectory,
    signed_angle_rad,
    walk_anywhere,
    walk_circle,
    walk_straight,
)

Array = np.ndarray
FAVOURITE_COST_PER_M, LOST_COST = 0.7, 12.0
FALLING_ON_FLOOR = (*FALLS, "lie_down", "lie", "crawl")
_SAME_PLACE_M = 0.1
_SAME_SEAT_M = 0.6  # places to sit within this distance belong to one seat
_KNOWN_WAYS = 0.5  # share of the tries that use known ways to sit, if the usual ones collide
_PULLED, _PULLED_M, _PULLED_TURN_RAD = 0.4, (0.08, 0.45), 0.5  # of pulled-out chairs: probability, distance, turn
_STRAIGHT = (*Side, Way.TOWARDS, Way.AWAY, Way.FORWARDS, Way.BACKWARDS, None)
_DEFAULT_MPS = {"walk": 1.15, "jog": 2.8, "limp": 0.75, "stagger": 0.75, "crawl": 0.35, "walking_lunge": 0.5}
_OF_USUAL = 0.7  # share of its usual length for which a walk needs room
_RUN_OF_USUAL = 1.0  # the same for a run, which is slowed down less
_LONGEST_SHARE = 0.2  # share of the starts with most room, used if none has enough
_NEAR_MIDDLE_M = 0.3  # from the place on a couch to sit down on, to lie in its middle
_SEAT_WAYS = 4  # approaches for which a start of the walk is searched
_FALLS_OFF_STOOL = (
    0.5  # share of the falls tried from a stool: before a seat of the room there may be no floor for them
)
_NEAR_START_M = 1.0  # a seat within this distance of the requested start is meant
_AT_START_M = 0.3  # the same if a heading is also requested
_FACES_AS_ASKED_RAD = 0.35
_BEFORE_THING_M = 0.4  # from the cells of a place to where one stands to use a thing there
_AT_TABLE = 0.6  # share of the sitters at a table that get a stool before it where no seat is
_STOOL_TRIES = 8  # places at a table
_SEAT_AT_PLACE_M = 0.7  # from the free floor of a place


def starts_seated(plan: MotionPlan) -> bool:
    """Whether the person sits at the start."""
    return plan.steps[0].uses_seat


def lies_on_seat(plan: MotionPlan) -> bool:
    """Whether the person lies on furniture."""
    return any(step.posture == "couch" for step in plan.steps)


@dataclass(frozen=True, kw_only=True)
class CandidateSampler:
    """Samples candidates for a plan on a floor.

    Attributes:
        plan: Scheduled plan.
        floor: Floor of the room.
        body: Bone lengths.
        rng: Random stream of the candidates.
        start_m: Prescribed start (x, y) in metres, or None.
        attempt: Number of the attempt, see `placement.place`.
        heading_rad: Prescribed initial heading, from +x towards +y, or None.
        off_radar_rad: Sampled angle of a standing body off the radar; None faces it.
        favourite_m: Sampled position (x, y) near which a start costs least; None for none.
        after: Final state of the previous motion, if any.
    """

    plan: MotionPlan
    floor: FloorMap
    body: SkeletonProportions
    rng: np.random.Generator
    start_m: tuple[float, float] | None
    attempt: int
    heading_rad: float | None = None
    off_radar_rad: float | None = None
    favourite_m: Float[Array, "2"] | None = None
    after: BodyState | None = None

    def sample(self) -> Trajectory:
        """Samples one candidate: a start, and every step laid out from there.

        Raises:
            NoTrajectory: If the candidate fails.
        """
        seats = self._seats()
        trajectory, sitting = self._start(seats)
        trajectory.reserve_m = float(self.rng.uniform(0, 1.5 * self._reserve_m)) if self._reserve_m else 0.0
        for k, step in enumerate(self.plan.steps):
            trajectory.moves.append([])
            following = self.plan.steps[k + 1] if k + 1 < len(self.plan.steps) else None
            if step.moves:
                target = self._seat_ahead(trajectory, step, following) if seats else None
                _lay_move(trajectory, step, target, first=k == 0, last=following is None)
                sitting = target.sitting if target and following and following.lower == "sit_down" else None
            elif step.lower == "turn" and step.turn_deg:
                turn_by(trajectory, step)
            elif step.lower == "turn" or (step.facing and turns_the_body(step)):
                _lay_turn(trajectory, step, first=k == 0)
            if not self._is_down_there(k):
                check_floor_space(trajectory, step, self.body)
            trajectory.from_seat = trajectory.from_seat or step.lower == "stand_up"
            if step.lower == "sit_down" and k:
                sitting = sitting or self._seat_behind(trajectory, seats)
                if sitting is None:
                    sitting = _stool_at_end(
                        trajectory, self.body, previous=self.plan.steps[k - 1], is_bed=lies_on_seat(self.plan)
                    )
                    trajectory.invents_seat = bool(self._approaches)
                trajectory.turn_to(sitting.facing_rad, step.start_s - 0.3)
            trajectory.seat_height_m.append(sitting.height_m if sitting else STOOL_HEIGHT_M)
            if sitting is not None and sitting.chair is not None:
                trajectory.chair = sitting.chair
                trajectory.notes.append(pulled_note(sitting.chair))
            if sitting is not None:
                trajectory.seats_m.append((float(sitting.seat_m[0]), float(sitting.seat_m[1])))
                trajectory.cost += sitting.cost
            if not step.moves and not step.uses_seat:
                wanted = max(CLEARANCE_M[step.lower], CLEARANCE_M.get(step.upper, 0.0))
                trajectory.cost += 2.0 * max(0.0, wanted - float(self.floor.clearance_at(trajectory.position_m)))
                trajectory.cost += float(self.floor.cost_at(trajectory.position_m))
        self._rate(trajectory)
        return trajectory

    def _rate(self, trajectory: Trajectory) -> None:
        """Adds the cost of what the path loses of the sentence, of a start far from the favourite, and of chance."""
        trajectory.lost = lost_share(self._asked, path_facts(trajectory, self.plan.steps))
        trajectory.cost += LOST_COST * trajectory.lost + float(self.rng.uniform(0, 0.5))
        if self.favourite_m is not None and self.start_m is None:
            gap_m = distance_m(trajectory.start_m, self.favourite_m)
            trajectory.cost += FAVOURITE_COST_PER_M * min(gap_m, 2.0)

    def _is_down_there(self, number: int) -> bool:
        """Whether the body still lies or kneels as the previous motion left it, or rises from there in this step."""
        down = (
            "" if self.after is None or self.after.posture not in ("floor", "knees", "ground") else self.after.posture
        )
        before, step = self.plan.steps[:number], self.plan.steps[number]
        stayed = bool(down) and all(one.posture == down for one in before)
        return stayed and (step.posture == down or step.lower in ("get_up", "kneel_up", "floor_rise"))

    @cached_property
    def _asked(self) -> list[list[Quantity]]:
        return [quantities(step, self.floor.scene) for step in self.plan.steps]

    @cached_property
    def _reserve_m(self) -> float:
        """Floor to keep free for a fall forwards after a walk."""
        walks = [k for k, step in enumerate(self.plan.steps) if step.moves]
        falls = [step for step in self.plan.steps[walks[0] :] if step.lower in FALLING_ON_FLOOR] if walks else []
        return 1.2 if falls else 0.0

    @cached_property
    def _usable_seats(self) -> list[Sitting]:
        return usable_seats(self.floor, self.body)

    def _seats(self) -> list[Sitting]:
        """The scene's seats with sampled ways to sit on them, as `attempt` allows."""
        seats = self._usable_seats
        if lies_on_seat(self.plan):
            long = long_enough_to_lie_on(seats, self.floor.scene)
            return centred_to_lie(long, self.body.height_m)
        if not self.attempt:
            return [usual_variation(seat, self.rng) for seat in seats]
        named = next((step.seat for step in self.plan.steps if step.seat), "")
        if self.attempt > 1 and not (named and fitting(seats, named, self.floor.scene)):
            return []
        subset = random_subset(preferred(seats, named, self.floor.scene), self.rng)
        return [self._pulled(seat) or any_variation(seat, self.rng) for seat in subset]

    def _pulled(self, seat: Sitting) -> Sitting | None:
        """The same chair pulled out, with some probability and if there is room."""
        if self.rng.random() > _PULLED:
            return None
        pulled = pulled_out(seat, self.floor, float(self.rng.uniform(*_PULLED_M)))
        return None if pulled is None else turned(pulled, float(self.rng.uniform(-1, 1) * _PULLED_TURN_RAD))

    @cached_property
    def _approaches(self) -> list[Approach]:
        """Approaches to the room's seats; only to those fit to lie on if the person lies."""
        ways = approaches(self.floor, self.body)
        if not lies_on_seat(self.plan):
            return ways
        middles_m = [one.seat_m for one in self._seats()]
        return [way for way in ways if any(distance_m(way.sitting.seat_m, at) < _NEAR_MIDDLE_M for at in middles_m)]

    def _ways_of(self, seat: str) -> list[Approach]:
        """Approaches to the seats that match a word, in random order."""
        ways = fitting_approaches(self._approaches, seat, self.floor.scene)
        return [ways[k] for k in self.rng.permutation(len(ways))]

    def _seat_ahead(self, trajectory: Trajectory, step: Step, following: Step | None) -> Approach | None:
        """The approach by which a walk ends at a seat; None if it does not, or no approach fits."""
        sits_down = following is not None and following.lower == "sit_down"
        if not sits_down and step.direction != Way.SEAT:
            return None
        named = step.seat if step.direction == Way.SEAT else ""
        ways = self._ways_of((following.seat if following and sits_down else "") or named)
        return approach_from(trajectory, step, ways, _direction_rad(trajectory, step))

    def _start(self, seats: list[Sitting]) -> tuple[Trajectory, Sitting | None]:
        """The start of the trajectory, and how the person sits there, if at all."""
        first = self.plan.steps[0]
        if self.after is not None:
            spot = np.array(self.after.position_m)
            is_before_seat = self.after.sitting is not None or not bool(self.floor.can_stand(spot))
            going_on = self._trajectory(spot, self.after.heading_rad, from_seat=is_before_seat)
            return going_on, self.after.sitting if starts_seated(self.plan) else None
        if starts_seated(self.plan):
            usable = preferred(seats, first.seat, self.floor.scene)
            if first.place is not None:
                cells = self.floor.place_cells[first.place]
                usable = [seat for seat in usable if distances_m(cells, seat.seat_m).min() < _SEAT_AT_PLACE_M]
            if any(step.lower not in ("sit", "sit_down", "lie_on_seat") for step in self.plan.steps):
                # Getting up needs room in front of the seat, where a table may stand.
                free = [seat for seat in usable if self.floor.clearance_at(seat.feet_m) > CLOSEST_FEET_M]
                usable = free or ([way.sitting for way in self._ways_of(first.seat)] if usable else [])
            if self.attempt and usable and self.rng.random() < _KNOWN_WAYS:
                usable = self._sittings_known_to_fit(usable)
            return self._start_seated(usable)
        before_seat = self._seat_to_start_at(seats)
        if before_seat is not None:
            return self._trajectory(before_seat.feet_m, before_seat.facing_rad, from_seat=True), None
        spot = np.array(self.start_m, dtype=float) if self.start_m is not None else self._random_start(seats)
        facing = float(np.arctan2(-spot[1], -spot[0]) + np.clip(self.rng.normal(0, 0.2), -0.4, 0.4))
        if self.off_radar_rad is not None and not first.moves:
            facing = bearing_rad(-spot) + self.off_radar_rad
        if any(step.posture in ("floor", "knees", "ground") for step in self.plan.steps):
            facing = float(self.rng.uniform(-np.pi, np.pi))  # wherever the floor is free
        if first.lower == "turn" and any(step.moves for step in self.plan.steps) and self.rng.random() < 0.5:
            facing = float(self.rng.uniform(-np.pi, np.pi))  # what follows needs floor in some direction
        if first.facing and turns_the_body(first):
            facing = _facing_rad(first, spot, self.floor.scene, facing) + float(self.rng.normal(0, 0.04))
        if self.heading_rad is not None:
            facing = self.heading_rad
        return self._trajectory(spot, facing, heading_is_given=self.heading_rad is not None), None

    def _trajectory(self, position_m: Float[Array, "2"], heading_rad: float, **more: Any) -> Trajectory:
        return Trajectory(floor=self.floor, rng=self.rng, position_m=position_m, heading_rad=heading_rad, **more)

    def _sittings_known_to_fit(self, seats: list[Sitting]) -> list[Sitting]:
        """Known collision-free ways to sit on these seats; the seats themselves if there are none."""
        ways = [way.sitting for way in self._approaches]
        near = [one for one in ways if any(distance_m(one.seat_m, seat.seat_m) < _SAME_SEAT_M for seat in seats)]
        return near or seats

    def _seat_behind(self, trajectory: Trajectory, seats: list[Sitting]) -> Sitting | None:
        """The seat in front of which the body stands: of the previous motion, or of the room."""
        before = [] if self.after is None or self.after.sitting is None else [self.after.sitting]
        known = before + seats + ([way.sitting for way in self._approaches] if seats else [])
        near = (seat for seat in known if distance_m(seat.feet_m, trajectory.position_m) < _SAME_PLACE_M)
        return next(near, None)

    def _seat_to_start_at(self, seats: list[Sitting]) -> Sitting | None:
        """The seat to stand in front of at the start, for a person who sits down without walking first."""
        steps = self.plan.steps
        down = next((k for k, step in enumerate(steps) if step.lower == "sit_down"), 0)
        if not down or self.start_m is not None or any(_changes_place(step) for step in steps[:down]):
            return None
        free = [seat for seat in seats if self.floor.clearance_at(seat.feet_m) > CLOSEST_FEET_M]
        free = free or ([way.sitting for way in self._approaches] if seats else [])
        free = preferred(free, steps[down].seat, self.floor.scene)
        return random_choice(free, self.rng) if free else None

    def _random_start(self, seats: list[Sitting]) -> Float[Array, "2"]:
        """Samples a position (x, y) in metres; for a walk to a seat often one from which it ends there."""
        first = self.plan.steps[0]
        route_m = next((step.route_m for step in self.plan.steps if step.route_m), ())
        if route_m:
            return np.array(route_m[0], float)
        if first.place is not None and not (first.moves and first.place.is_goal):
            cells = self.floor.place_cells[first.place]
            before = self._before_thing(first, cells)
            return random_choice(cells, self.rng) if before is None else before
        if first.moves and goes_to_target(first) and self.rng.random() < 0.8:
            spot = start_for_target(first, self.floor, self.rng)
            if spot is not None:
                return spot
        to_seat = first.direction == Way.SEAT or (len(self.plan.steps) > 1 and self.plan.steps[1].lower == "sit_down")
        if first.moves and seats and to_seat and self.rng.random() < 0.7:
            spot = self._start_of_walk_to_seat(first)
            if spot is not None:
                return spot
        cells = self._open_starts(first)
        spot = random_choice(cells, self.rng)
        return spot + self.rng.uniform(-0.3, 0.3, 2) * self.floor.cell_m

    def _before_thing(self, step: Step, cells: Float[Array, "cell 2"]) -> Float[Array, "2"] | None:
        """The place before a thing that the step acts on, among the cells of its place; None if it acts on none."""
        if step.place is None or step.facing != step.place.landmark:
            return None
        marks = [mark for mark in self.floor.scene.landmarks if mark.kind in kinds_of(step.facing)]
        spots = [np.asarray(mark.approach_m, float) for mark in marks]
        spots = [spot for spot in spots if len(cells) and distances_m(cells, spot).min() < _BEFORE_THING_M]
        if not spots:
            return None
        spot = random_choice(spots, self.rng)
        return spot if bool(self.floor.can_stand(spot)) else cells[int(np.argmin(distances_m(cells, spot)))]

    def _open_starts(self, step: Step) -> Float[Array, "cell 2"]:
        """Places to start at: for a straight walk those with enough room, else those with the most."""
        if not step.moves or step.lower not in _DEFAULT_MPS or step.arc_deg or step.direction not in _STRAIGHT:
            return self.floor.walkable_m
        if id(step) not in self._roomy_starts:
            relative = step.direction in (Way.FORWARDS, Way.BACKWARDS)
            cells, free_m = self.floor.straight_starts(None if relative else step.direction)
            of_usual = _RUN_OF_USUAL if step.lower == "jog" else _OF_USUAL
            enough_m = of_usual * _DEFAULT_MPS[step.lower] * step.pace * (step.end_s - step.start_s)
            share = _LONGEST_SHARE
            if step.distance_m or self._reserve_m:  # as long as asked, with floor for what follows
                enough_m, share = (step.distance_m or enough_m) + self._reserve_m + 0.05, _LONGEST_SHARE / 4
            self._roomy_starts[id(step)] = cells[free_m >= min(enough_m, np.quantile(free_m, 1 - share))]
        return self._roomy_starts[id(step)]

    @cached_property
    def _roomy_starts(self) -> dict[int, Float[Array, "cell 2"]]:
        """`_open_starts` of the plan's steps, cached."""
        return {}

    def _start_of_walk_to_seat(self, step: Step) -> Float[Array, "2"] | None:
        """A position (x, y) from which a walk in the step's time ends at a seat; None where none was found."""
        following = self.plan.steps[1] if len(self.plan.steps) > 1 else None
        for way in self._ways_of(step.seat or (following.seat if following else ""))[:_SEAT_WAYS]:
            fixed = {"left": np.pi, "right": 0.0}.get(step.direction)
            spot = start_of_walk(way, step, fixed, self.rng)
            if spot is not None:
                return spot
        return None

    def _start_seated(self, seats: list[Sitting]) -> tuple[Trajectory, Sitting]:
        """Starts on a seat of the scene, near the requested start; else on a stool, roughly facing the radar."""
        cost, notes = 0.0, []
        near = [seat for seat in seats if self._is_meant(seat, named=bool(self.plan.steps[0].seat))]
        falls_off = any(step.lower in FALLS_OFF for step in self.plan.steps)
        at_table = self._stool_at_thing()
        if at_table is not None and (not near or self.rng.random() < _AT_TABLE):
            notes.append(stool_note(at_table, none_at_all=not self.floor.scene.seats))
            return self._trajectory(at_table.feet_m, at_table.facing_rad, cost=3.0 * bool(near), notes=notes), at_table
        if near and not (falls_off and self.rng.random() < _FALLS_OFF_STOOL):
            sitting = random_choice(near, self.rng)
            is_blocked = sitting.chair is None and not self.floor.clearance_at(sitting.feet_m) > 0
            cost += float(self.floor.cost_at(sitting.seat_m)) + 2.0 * is_blocked
        else:
            first = self.plan.steps[0]
            cells = self.floor.walkable_m if first.place is None else self.floor.place_cells[first.place]
            if not len(cells):
                raise NoTrajectory("no free floor")
            spot = np.array(self.start_m, dtype=float) if self.start_m else random_choice(cells, self.rng)
            facing = float(np.arctan2(-spot[1], -spot[0]) + np.clip(self.rng.normal(0, 0.3), -0.6, 0.6))
            facing = facing if self.heading_rad is None else self.heading_rad
            sitting = stool_at(spot, facing, self.body)
            if self.heading_rad is not None and first.lower != "sit_down":  # a sitter's hips are there already
                sitting = stool_at(2 * spot - sitting.seat_m, facing, self.body)
            if not stool_fits(sitting, self.floor, is_bed=lies_on_seat(self.plan)):
                raise NoTrajectory("no room for a stool")
            notes.append(stool_note(sitting, none_at_all=not self.floor.scene.seats, is_bed=lies_on_seat(self.plan)))
            cost += 3.0 * bool(near)
            cost += float(self.floor.cost_at(spot)) + 2.0 * max(0.0, 0.5 - float(self.floor.clearance_at(spot)))
        return self._trajectory(sitting.feet_m, sitting.facing_rad, cost=cost, notes=notes), sitting

    def _stool_at_thing(self) -> Sitting | None:
        """A stool before the thing that a sitter faces, if there is room for it."""
        first = self.plan.steps[0]
        if not first.facing or self.start_m is not None:
            return None
        marks = [mark for mark in self.floor.scene.landmarks if mark.kind in kinds_of(first.facing)]
        if not marks:
            return None
        for attempt in range(_STOOL_TRIES):
            mark = random_choice(marks, self.rng)
            spot = np.asarray(mark.approach_m, float)
            if attempt and first.place is not None:
                spot = random_choice(self.floor.place_cells[first.place], self.rng)
            facing = bearing_rad(np.asarray(mark.position_m[:2], float) - spot)
            stool = stool_at(spot, facing + float(np.clip(self.rng.normal(0, 0.1), -0.25, 0.25)), self.body)
            if stool_fits(stool, self.floor):
                return stool
        return None

    def _is_meant(self, seat: Sitting, *, named: bool) -> bool:
        """Whether a person seated at the start may take the seat: near the requested start, with the requested heading.

        A seat that the sentence names may have any heading.
        """
        strict = self.heading_rad is not None and not named
        within_m = _AT_START_M if strict else _NEAR_START_M
        if self.start_m is not None and distance_m(seat.seat_m, self.start_m) >= within_m:
            return False
        return not strict or abs(signed_angle_rad(seat.facing_rad, self.heading_rad)) < _FACES_AS_ASKED_RAD


def _changes_place(step: Step) -> bool:
    """Whether a step leaves the position, turns the body, or needs floor or a posture of its own."""
    return step.moves or step.posture != "feet" or step.lower == "turn" or bool(step.facing) or step.place is not None


def _lay_move(trajectory: Trajectory, step: Step, target: Approach | None, *, first: bool, last: bool) -> None:
    """Lays out a step that moves: to a seat (`target`), to a landmark, on a curve, straight, or anywhere."""
    if step.route_m:
        walk_along(trajectory, step, first=first)
        return
    # With a prescribed heading the body turns first, so that it is not under way at the start.
    has_target = target is not None or goes_to_target(step)
    direction = None if has_target else _direction_rad(trajectory, step)
    is_aimed = has_target or direction is not None
    first = first and not (is_aimed and trajectory.heading_is_given)
    if target is None and goes_to_target(step):
        walk_to_target(trajectory, step, first=first)
        return
    if target is None and is_curved_or_lateral(step):
        lay_curved_or_lateral(trajectory, step, direction, first=first, last=last)
        return
    if target is not None:
        walk_to_seat(trajectory, step, target, first=first)
        return
    trajectory.cost += 3.0 * (step.direction == Way.SEAT)
    if step.direction == Shape.CIRCLE:
        walk_circle(trajectory, step, first=first, last=last)
    elif direction is None:
        if step.direction == Way.SEAT and not any("stool" in note or "no seat" in note for note in trajectory.notes):
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
    if isinstance(step.direction, Side):
        return jitter + (np.pi if step.direction == Side.LEFT else 0.0)
    if step.direction == Way.TOWARDS:
        return float(np.arctan2(-y, -x)) + 0.3 * jitter
    if step.direction == Way.AWAY:
        return float(np.arctan2(y, x)) + 0.3 * jitter
    if step.direction in (Way.FORWARDS, Way.BACKWARDS) or (step.distance_m and step.direction is None):
        return _relative_rad(trajectory, step)
    if step.direction == Way.BACK:
        back_to = trajectory.last_direction_rad
        return back_to + np.pi if back_to is not None else trajectory.heading_rad + np.pi
    return None


def _relative_rad(trajectory: Trajectory, step: Step) -> float | None:
    """Direction of a walk relative to the body: ahead or back; at the start, where the room leaves space for it."""
    is_back = step.direction == Way.BACKWARDS
    ahead = trajectory.heading_rad + np.pi * is_back
    is_open = not trajectory.moves[:-1] and not trajectory.heading_is_given and not trajectory.turns
    is_plain = step.lower in ("walk", "jog", "limp", "stagger", "crawl", "walking_lunge") and not step.arc_deg
    if not is_plain or (is_open and step.direction == Way.FORWARDS and not step.distance_m):
        return None if step.direction == Way.FORWARDS and is_open else ahead
    wanted = step.distance_m or min(_DEFAULT_MPS.get(step.lower, 1.0) * (step.end_s - step.start_s), 3.0)
    free = trajectory.free_length_m(ahead, wanted)
    if free >= wanted - 1e-9 or not (is_open or step.direction is None):
        return ahead
    directions = trajectory.rng.uniform(0, 2 * np.pi) + np.arange(16) * np.pi / 8
    lengths = trajectory.free_lengths_m(directions, wanted)
    best = np.flatnonzero(lengths >= lengths.max() - 1e-6)
    return float(directions[int(best[trajectory.rng.integers(len(best))])])


def _facing_rad(step: Step, spot: Float[Array, "2"], scene: Scene, near_rad: float) -> float:
    """Heading of a body at `spot` (x, y) that faces left, right, the radar, away from it, or a landmark.

    Of the two headings sideways to the radar it is the one nearer to `near_rad`.
    """
    if step.facing in ("left", "right"):
        return np.pi if step.facing == "left" else 0.0
    aims = [np.asarray(mark.position_m[:2]) - spot for mark in faced_landmarks(step, scene)]
    if aims:
        x, y = min(aims, key=lambda aim: float(np.hypot(*aim)))
        return float(np.arctan2(y, x))
    away = bearing_rad(spot)
    if step.facing == "sideways":
        return min(away + np.pi / 2, away - np.pi / 2, key=lambda one: abs(signed_angle_rad(one, near_rad)))
    return away if step.facing == "away" else away + np.pi


def _lay_turn(trajectory: Trajectory, step: Step, *, first: bool) -> None:
    """Turns to the left or right of the person, around, or to face something (`step.facing`)."""
    if step.facing:
        if first and step.lower != "turn" and not trajectory.heading_is_given:
            return  # the start faces that direction already
        if first and not trajectory.heading_is_given:
            trajectory.start_heading_rad = trajectory.heading_rad = trajectory.heading_rad + float(
                trajectory.rng.choice([-1.0, 1.0]) * trajectory.rng.uniform(1.2, 2.2)
            )
        heading = _facing_rad(step, trajectory.position_m, trajectory.floor.scene, trajectory.heading_rad)
    else:
        quarter = float(np.pi / 2 + np.clip(trajectory.rng.normal(0, 0.06), -0.12, 0.12))
        about = np.pi - min(abs(trajectory.rng.normal(0, 0.06)), 0.12) - 0.01
        about = float(trajectory.rng.choice([-1.0, 1.0]) * about)
        heading = trajectory.heading_rad + {"left": quarter, "right": -quarter}.get(step.direction, about)
    span_s = step.end_s - step.start_s
    trajectory.turn_to(heading, step.start_s, slower=SLOWER_TURNS[step.speed + 1], most_s=span_s)


def _stool_at_end(trajectory: Trajectory, body: SkeletonProportions, *, previous: Step, is_bed: bool) -> Sitting:
    """A stool (or bed) at the end of a walk, at most a quarter turn away, or behind a standing person."""
    to_radar = float(np.arctan2(-trajectory.position_m[1], -trajectory.position_m[0]))
    options = (
        [trajectory.heading_rad]
        if not previous.moves
        else [trajectory.heading_rad + np.pi / 2, trajectory.heading_rad - np.pi / 2]
    )
    options.sort(key=lambda angle: abs(signed_angle_rad(angle, to_radar)))
    for facing in options:
        stool = stool_at(trajectory.position_m, facing + float(trajectory.rng.normal(0, 0.08)), body)
        if stool_fits(stool, trajectory.floor, is_bed=is_bed):
            trajectory.cost += 3.0
            trajectory.notes.append(stool_note(stool, none_at_all=not trajectory.floor.scene.seats, is_bed=is_bed))
            return stool
    raise NoTrajectory("no room for a stool")
