"""From a scheduled plan and a Scene to the motion of a body in it. Read this file first."""

from dataclasses import dataclass, replace

from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.assemble import assemble
from mmweaver.motion.animation.skeleton_proportions import SHORTEST_M, TALLEST_M, SkeletonProportions
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.planning.collision import CollisionMap
from mmweaver.motion.planning.collision_ranking import least_collision
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.placement import Placement, place
from mmweaver.motion.planning.targets import without_targets


@dataclass(frozen=True, kw_only=True)
class Motion:
    """A body's motion in a scene, the plan that it carries out, and what was assumed."""

    pose: PoseSequence  # 120 Hz, from two samples before 0 to two after the end, in the radar's frame
    plan: MotionPlan
    assumptions: tuple[str, ...]  # plain sentences


def compose(
    plan: MotionPlan,
    scene: Scene,
    *,
    seed: int,
    range_window_m: tuple[float, float],
    start_m: tuple[float, float] | None = None,
    height_m: float | None = None,
    others: tuple[PoseSequence, ...] = (),
    has_photo: bool = True,
) -> Motion:
    """Finds a free trajectory on the scene's floor for a plan, and animates the body along it.

    Args:
        plan: a scheduled plan, as `motion.language.timing.plan_motion` makes it of a sentence.
        scene: the room, in the radar's frame.
        seed: decides everything that the sentence leaves open.
        range_window_m: nearest and farthest slant range that the radar keeps; the body stays inside.
        start_m: where the person starts, (x, y); chosen if None.
        height_m: the body's height; if None sampled between 1.63 and 1.96 m.
        others: people who are already in the scene; the trajectory keeps clear of them (see `multi_person`).
        has_photo: False where no photo stands behind the scene. Nobody can then walk to a door or a table of it; the
            walk leads where there is room, and an assumption says so.

    Raises InputError where the room has no place for the motion.
    """
    if plan.duration_s <= 0:
        raise ValueError("the plan is not scheduled; make it with plan_motion, or call schedule")
    if not has_photo:
        plan = without_targets(plan)
    if height_m is None:
        height_m = float(stream(seed, "motion", "height").uniform(SHORTEST_M, TALLEST_M))
    body = SkeletonProportions(height_m)
    floor = FloorMap(scene, range_window_m, height_m)
    plan, jogging_notes = _jog_on_the_spot(plan)

    def candidates(attempt: int) -> list[Placement]:
        return place(plan, floor, body, seed=seed, start_m=start_m, others=others, attempt=attempt)

    def animate(placement: Placement) -> PoseSequence:
        return assemble(
            placement.steps, placement.path, body, seed=seed, duration_s=plan.duration_s, floor_z_m=scene.floor_z_m
        )

    best = least_collision(candidates, animate, CollisionMap.of(scene))
    notes = plan.notes + jogging_notes + best.placement.assumptions + best.notes
    return Motion(pose=best.pose, plan=plan, assumptions=notes)


def _jog_on_the_spot(plan: MotionPlan) -> tuple[MotionPlan, tuple[str, ...]]:
    """Jogging takes more room than most rooms have: without a direction it is on the spot, and a note says so."""
    is_aimless = [step.lower == "jog" and step.direction == "" for step in plan.steps]
    if not any(is_aimless):
        return plan, ()
    steps = tuple(
        replace(step, direction="spot") if aimless else step
        for step, aimless in zip(plan.steps, is_aimless, strict=True)
    )
    return replace(plan, steps=steps), ("no direction is given for jogging: the person jogs on the spot",)
