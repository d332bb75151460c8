"""Placement of a plan in the room: many start positions are sampled, and their trajectories sorted by cost."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import NoRoomError
from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.library.sitting import pelvis_behind_feet_m
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.planning.body_state import BodyState
from mmweaver.motion.planning.collision import PulledChair
from mmweaver.motion.planning.floor_map import FloorMap, distances_m, random_choice, unit_vector
from mmweaver.motion.planning.named_places import cells_of
from mmweaver.motion.planning.occluded_geometry import occluded_along
from mmweaver.motion.planning.seating import Sitting, usable_seats
from mmweaver.motion.planning.separation import is_clear_of
from mmweaver.motion.planning.trajectory import NoTrajectory, Trajectory
from mmweaver.motion.planning.trajectory_sampler import CandidateSampler, starts_seated

Array = np.ndarray
MAX_TRIES, TRIES, ENOUGH = 140, 28, 10  # maximum candidates until the first, for all, and found
LEAVES_SEATS = 2  # the attempt that abandons the room's seats, also made if none of them works
ENOUGH_SEATED = 14  # found, of more ways to sit, if the usual ones touch something
MAX_TRIES_IF_LOST = 60  # candidates tried for one that loses nothing of the sentence
_SMALL_M2, MAX_TRIES_IF_SMALL = 0.5, 40  # a small floor is searched quickly
_OCCLUDED_COST, _OCCLUDED_SITTING_COST = 4.0, 1.5  # cost of a trajectory, or seat, occluded from the camera
_NUM_OCCLUSION_TESTS = 12  # along a trajectory
_SEAT_RADIUS_M = 0.65  # radius within which a position counts as sitting


@dataclass(frozen=True, kw_only=True)
class Placement:
    """Placement of a plan in the room.

    Attributes:
        path: Path of the root.
        steps: Steps with their moves and seat heights.
        seats_m: Seats (x, y) in metres on which the person sits.
        assumptions: Sentences on what was assumed.
        invents_seat: Whether a stool was assumed although the room has a reachable seat.
        chair: A chair assumed to be pulled out, if any.
        lost: Share of what the sentence asks for that the path loses (`path_facts.lost_share`).
    """

    path: RootPath
    steps: tuple[PlacedStep, ...]
    seats_m: tuple[tuple[float, float], ...]
    assumptions: tuple[str, ...]
    invents_seat: bool = False
    chair: PulledChair | None = None
    lost: float = 0.0

    @property
    def is_still(self) -> bool:
        """Whether the body neither moves nor turns: its placements then differ by a rigid motion only."""
        return not self.path.moves and not self.path.turns

    def end_state(self, plan: MotionPlan, body: SkeletonProportions) -> BodyState:
        """State of the body after the last step.

        Args:
            plan: The plan that was placed.
            body: Bone lengths.
        """
        end_s, last = np.array([plan.duration_s]), plan.steps[-1]
        feet_m = self.path.position_m(end_s)[0]
        heading_rad = float(self.path.facing_rad(end_s)[0])
        sitting, height_m = None, self._last_seat_height_m()
        if height_m is not None:
            behind_m = pelvis_behind_feet_m(body, height_m) * unit_vector(heading_rad)
            sitting = Sitting(
                feet_m=feet_m, facing_rad=heading_rad, height_m=height_m, seat_m=feet_m - behind_m, chair=self.chair
            )
        return BodyState(
            position_m=(float(feet_m[0]), float(feet_m[1])),
            heading_rad=heading_rad,
            posture=last.posture,
            style=last.style,
            foot=last.foot,
            sitting=sitting,
        )

    def _last_seat_height_m(self) -> float | None:
        """Height of the seat on which the body sits at the end, or from which it has just got up; None without one."""
        for placed in reversed(self.steps):
            if placed.step.uses_seat:
                return placed.seat_height_m
            if placed.moves or placed.step.lower == "turn":
                return None
        return None

    def seat_heights(self, step_m: float) -> tuple[int, ...]:
        """Heights of the seats that the steps use, in multiples of `step_m`."""
        return tuple(round(placed.seat_height_m / step_m) for placed in self.steps)


@dataclass(frozen=True, kw_only=True)
class Conditions:
    """Constraints of a placement in addition to its plan."""

    seed: int  # determines what the sentence leaves open
    start_m: tuple[float, float] | None = None  # start (x, y); None: anywhere
    heading_rad: float | None = None  # initial heading, from +x towards +y
    is_varied: bool = True  # False: standing people face the radar, where it observes them best
    others: tuple[PoseSequence, ...] = ()  # people to keep clear of
    after: BodyState | None = None  # final state of the previous motion


def place(
    plan: MotionPlan, floor: FloorMap, body: SkeletonProportions, conditions: Conditions, *, attempt: int = 0
) -> list[Placement]:
    """Samples placements of the whole plan that are free and in view throughout.

    Args:
        plan: Scheduled plan.
        floor: Floor that a body of this height can use.
        body: Bone lengths.
        conditions: Start, heading, other people.
        attempt: 1 and 2 sample other placements, with more ways to sit: 1 drops some of the seats, 2 all of them
            unless the sentence names one that the room has.

    Returns:
        Placements, the best first.

    Raises:
        InputError: If the start is not free or out of view, there is no room, or the room lacks the destination of a
            step.
    """
    start_m, after, others = conditions.start_m, conditions.after, conditions.others
    for step in plan.steps:
        if step.place is not None:
            floor.place_cells[step.place] = cells_of(step.place, floor)
    if after is None and not floor.walkable.any() and not (usable_seats(floor, body) and starts_seated(plan)):
        raise NoRoomError(_no_floor(floor))
    if start_m is not None:
        floor.check_start(start_m)
    rng = stream(conditions.seed, "motion", f"placement {attempt}" if attempt else "placement")
    sampler = CandidateSampler(
        plan=plan,
        floor=floor,
        body=body,
        rng=rng,
        start_m=start_m,
        attempt=attempt,
        after=after,
        **_open_choices(floor, conditions),
    )
    trajectories: list[Trajectory] = []
    best_lost = np.inf
    enough = ENOUGH_SEATED if attempt and any(step.uses_seat for step in plan.steps) else ENOUGH
    enough = MAX_TRIES if floor.is_tight else enough  # all of them fit: search for the one that touches least
    is_small = not floor.is_tight and len(floor.walkable_m) * floor.cell_m**2 < _SMALL_M2
    for tried in range(MAX_TRIES_IF_SMALL if is_small else MAX_TRIES):
        is_lossless = best_lost < 1e-9
        if is_lossless and (len(trajectories) >= enough or (tried >= TRIES and not floor.is_tight)):
            break
        if trajectories and not is_lossless and tried >= MAX_TRIES_IF_LOST:
            break
        try:
            trajectory = sampler.sample()
        except NoTrajectory:
            continue
        if others and not _is_clear_of(trajectory, plan, others):
            continue
        trajectories.append(trajectory)
        best_lost = min(best_lost, trajectory.lost)
    if not trajectories and attempt < LEAVES_SEATS and after is None and starts_seated(plan):
        return place(plan, floor, body, conditions, attempt=LEAVES_SEATS)
    if not trajectories:
        raise NoRoomError(_no_room(plan, floor, start_m))
    order = np.argsort(
        [trajectory.cost for trajectory in trajectories] + _occlusion_costs(trajectories, plan, floor), kind="stable"
    )
    return [_placement(trajectories[k], plan) for k in order]


def _open_choices(floor: FloorMap, conditions: Conditions) -> dict[str, Any]:
    """Choices that the sentence leaves open, made by the seed once for all candidates: rough position and heading."""
    cells = floor.walkable_m
    rng = stream(conditions.seed, "motion", "open choices")
    facing_rad = float(rng.normal(0, 0.35)) if rng.random() < 0.5 else float(rng.uniform(-np.pi, np.pi))
    spot = random_choice(cells, rng) if len(cells) else None
    return {
        "heading_rad": conditions.heading_rad,
        "off_radar_rad": facing_rad if conditions.is_varied else None,
        "favourite_m": spot if conditions.is_varied else None,
    }


def _occlusion_costs(trajectories: list[Trajectory], plan: MotionPlan, floor: FloorMap) -> Float[Array, " trajectory"]:
    """Cost of trajectories, and of seats, occluded from the camera: the space there is unknown."""
    time_s = np.linspace(0.0, plan.steps[-1].end_s, _NUM_OCCLUSION_TESTS)
    tracks_m = np.array([trajectory.path().position_m(time_s) for trajectory in trajectories])
    cost = np.full(tracks_m.shape[:2], _OCCLUDED_COST)
    for trajectory, costs, track_m in zip(trajectories, cost, tracks_m, strict=True):
        for seat in trajectory.seats_m:
            costs[distances_m(track_m, seat) < _SEAT_RADIUS_M] = _OCCLUDED_SITTING_COST
    return (cost * occluded_along(floor.scene, tracks_m)).max(axis=1)


def _placement(trajectory: Trajectory, plan: MotionPlan) -> Placement:
    parts = zip(plan.steps, trajectory.moves, trajectory.seat_height_m, strict=True)
    return Placement(
        path=trajectory.path(),
        steps=tuple(PlacedStep(step=step, moves=tuple(moves), seat_height_m=seat_m) for step, moves, seat_m in parts),
        seats_m=tuple(trajectory.seats_m),
        assumptions=tuple(dict.fromkeys(trajectory.notes)),
        invents_seat=trajectory.invents_seat,
        chair=trajectory.chair,
        lost=trajectory.lost,
    )


def _is_clear_of(trajectory: Trajectory, plan: MotionPlan, others: tuple[PoseSequence, ...]) -> bool:
    time_s = np.arange(0.0, plan.steps[-1].end_s + 1e-9, 0.05)
    track_m = trajectory.path().position_m(time_s)
    return all(is_clear_of(track_m, time_s, other) for other in others)


def _no_floor(floor: FloorMap) -> str:
    low, high = floor.range_window_m
    return (
        f"there is no room for a person: no free floor is in the picture between {low:.2f} and {high:.2f} m from the"
        " radar; keep more range bins (--range), take another radar (--radar) or a photo with more floor"
    )


def _no_room(plan: MotionPlan, floor: FloorMap, start_m: tuple[float, float] | None) -> str:
    if any(step.route_m for step in plan.steps):  # its floor is free, or `walk_along` has reported where not
        return f"{plan.duration_s:.1f} s are too short for the path; give more --seconds or --frames, or a shorter path"
    from_there = f" from {start_m[0]:g},{start_m[1]:g}" if start_m else ""
    going = [step.clause for step in plan.steps if step.moves]
    what = f" for {going[0]!r}" if going else ""
    cells = floor.walkable_m
    longest = floor.longest_free_m(4.0)
    return (
        f"there is no room{what}{from_there}: in the picture and the radar's window {len(cells) * floor.cell_m**2:.1f}"
        f" m2 of floor are free, the longest straight path is about {longest:.1f} m; try another direction"
        " (--heading), or keep more range bins (--range)"
    )
