"""The room's door: a sentence and a Scene -> the motion of a body in it. Read this file first."""

import math
from dataclasses import dataclass

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.assemble import assemble
from mmweaver.motion.animation.skeleton_proportions import SHORTEST_M, TALLEST_M, SkeletonProportions
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import schedule
from mmweaver.motion.planning.collision import CollisionMap
from mmweaver.motion.planning.collision_ranking import most_clear
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.placement import Placement, place
from mmweaver.motion.planning.targets import without_things

LONGEST_S = 600.0


@dataclass(frozen=True, kw_only=True)
class Motion:
    """A body's motion in a scene: dense and smooth poses, the steps with their times, and what was assumed."""

    pose: PoseSequence  # 120 Hz, from two samples before 0 to two after the end, in the radar's frame
    plan: MotionPlan
    assumptions: tuple[str, ...]  # plain sentences


def compose(
    text: str,
    scene: Scene,
    *,
    duration_s: float,
    seed: int,
    range_window_m: tuple[float, float],
    start_m: tuple[float, float] | None = None,
    height_m: float | None = None,
    others: tuple[PoseSequence, ...] = (),
    has_photo: bool = True,
) -> Motion:
    """Reads the sentence, shares out the time, finds room on the scene's floor, and moves the body.

    `range_window_m`: the slant ranges that the radar keeps; the body stays inside. `start_m`: where the person starts,
    (x, y). `height_m`: the body's height, else drawn from the seed between 1.63 and 1.96 m. `others`: people who are
    there already; the way keeps clear of them (see `company`). Without a photo behind the scene (`has_photo`) a thing
    to go to cannot be looked for: the way then leads where there is room, and a note says so. Raises InputError where
    the sentence is not understood, its steps do not fit the time, or the room has no place for it.
    """
    if not (math.isfinite(duration_s) and 0 < duration_s <= LONGEST_S):
        raise InputError(f"a duration of {duration_s:g} s is not possible; choose above 0 and up to {LONGEST_S:g} s")
    plan = schedule(parse(text), duration_s)
    if not has_photo:
        plan = without_things(plan)
    if height_m is None:
        height_m = float(stream(seed, "motion", "height").uniform(SHORTEST_M, TALLEST_M))
    body = SkeletonProportions(height_m)
    floor = FloorMap(scene, range_window_m, height_m)
    plan, spot_notes = _jogging_without_a_way(plan)

    def draw(again: int) -> list[Placement]:
        return place(plan, floor, body, seed=seed, start_m=start_m, others=others, again=again)

    def moved(placement: Placement) -> PoseSequence:
        return assemble(
            plan.steps, placement.path, placement.moves, placement.seat_height_m, body,
            seed=seed, duration_s=duration_s, floor_z_m=scene.floor_z_m,
        )  # fmt: skip

    best = most_clear(draw, moved, CollisionMap.of(scene))
    notes = plan.notes + spot_notes + best.placement.assumptions + best.notes
    return Motion(pose=best.pose, plan=plan, assumptions=notes)


def _jogging_without_a_way(plan: MotionPlan) -> tuple[MotionPlan, tuple[str, ...]]:
    """Jogging needs metres a second that a room seldom has: without a direction it is on the spot, and said so."""
    from dataclasses import replace

    aimless = [step.lower == "jog" and step.direction == "" for step in plan.steps]
    steps = tuple(
        replace(step, direction="spot") if free else step for step, free in zip(plan.steps, aimless, strict=True)
    )
    note = ("no direction is said for jogging: the person jogs on the spot",) if any(aimless) else ()
    return replace(plan, steps=steps), note
