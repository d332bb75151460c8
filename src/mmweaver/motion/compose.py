"""Composes the motion of a body in a Scene from a scheduled plan. Start with this file."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from mmweaver.core.records import PoseSequence, Scene
from mmweaver.motion.animation.assemble import assembled_controls, solved
from mmweaver.motion.animation.controls import NO_HABITS, Controls, habits_of
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.plan import APPROXIMATED, ClauseRecord, MotionPlan, Shape, Step
from mmweaver.motion.language.postures import add_shown_text, in_turn
from mmweaver.motion.people import Person, apply_habits, person_of, subject_of
from mmweaver.motion.planning.body_state import BodyState
from mmweaver.motion.planning.collision import CollisionMap, PulledChair
from mmweaver.motion.planning.collision_ranking import RankedPlacement, least_collision
from mmweaver.motion.planning.constraint_relaxation import relax_constraints
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.missing import STAND_IN, with_stand_ins
from mmweaver.motion.planning.named_places import settled
from mmweaver.motion.planning.placement import Conditions, Placement, place
from mmweaver.motion.verification.verify import VerifiedStep, verified_clauses, verified_steps

RUN_ROOM_M = 3.5  # straight free floor required to run to and fro at 3 m/s


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Motion of a body in a scene, the plan that it realizes, and the assumptions made.

    Attributes:
        pose: Joints at 120 Hz in the radar's frame, from two samples before 0 to two after the end.
        plan: The scheduled plan.
        assumptions: Plain sentences.
        person: The person; None for a recorded motion.
        end: Final state of the body; None for a recorded motion.
        controls: Pose parameters at the times of `pose`; None for a recorded motion.
        chair: A chair assumed to be pulled out, if any.
        asked: Steps as the sentence asks for them, before the room has changed them; () for a recorded motion.
        scene: The room, with what stands in for things that it lacks; None for a recorded motion.
    """

    pose: PoseSequence
    plan: MotionPlan
    assumptions: tuple[str, ...]
    person: Person | None = None
    end: BodyState | None = None
    controls: Controls | None = None
    chair: PulledChair | None = None
    asked: tuple[Step, ...] = ()
    scene: Scene | None = None

    @property
    def shown(self) -> str:
        """Description of all steps in order; "" for a recorded motion."""
        return "" if self.person is None else in_turn(self.plan.steps)

    @cached_property
    def verified(self) -> list[VerifiedStep]:
        """Every step as measured on the joints; none of a recorded motion."""
        if self.scene is None:
            return []
        return verified_steps(self.asked, self.plan.steps, self.pose, self.scene)

    @cached_property
    def clauses(self) -> tuple[ClauseRecord, ...]:
        """Outcome of every clause: the plan's records, the notes that the room has added, and what the joints show."""
        records = add_shown_text(self.plan.clauses, self.plan.steps)
        room = [note for note in self.assumptions if note not in self.plan.notes]
        for step in self.plan.steps:
            for note in room:
                if step.clause and repr(step.clause) in note:
                    records = tuple(
                        record.lowered_to(APPROXIMATED, note) if number in step.clauses else record
                        for number, record in enumerate(records)
                    )
        return verified_clauses(records, self.verified)


def compose(
    plan: MotionPlan,
    scene: Scene,
    *,
    range_window_m: tuple[float, float],
    height_m: float | None = None,
    subject: int | None = None,
    person: Person | None = None,
    may_touch: bool = True,
    farthest_m: float = math.inf,
    missing: str = STAND_IN,
    **conditions: Any,
) -> Motion:
    """Finds a free trajectory on the scene's floor for a plan, and animates the body along it.

    Args:
        plan: a scheduled plan, as `motion.language.timing.plan_motion` makes it of a sentence.
        scene: the room, in the radar's frame.
        range_window_m: nearest and farthest slant range that the radar keeps; the body stays inside.
        height_m: the body's height; if None as the sentence describes the person, else of the population.
        subject: who it is: surface, build, habits and usual height; sampled by the seed if None.
        person: instead of the two, a person made otherwise.
        may_touch: where nothing else has room, travelling movements are done on the spot, falls go another way, and a
            lying body touches furniture; each deviation is reported. False raises instead.
        farthest_m: what the radar sees at most, with all its range bins; a longer window is not advised.
        missing: what is done about a thing that the sentence names and the room lacks: a place of the room stands in
            for it ("stand-in"), or an InputError ("refuse").
        **conditions: the fields of `planning.placement.Conditions`: `seed`, and perhaps `start_m`, `heading_rad`,
            `is_varied` (False: no habits, too), `others` and `after`.

    Returns:
        The motion at 120 Hz in the radar's frame, with plan, person and assumptions.

    Raises:
        InputError: If the room has no place for the motion.
        ValueError: If the plan is not scheduled.
    """
    if plan.duration_s <= 0:
        raise ValueError("the plan is not scheduled; make it with plan_motion, or call schedule")
    given = Conditions(**conditions)
    plan = settled(plan)
    person = person or person_of(subject_of(given.seed) if subject is None else subject, plan.person, height_m)
    plan = apply_habits(plan, person)
    body = SkeletonProportions(person.height_m)
    floor = FloorMap.of(scene, range_window_m, person.height_m)
    scene, missing_notes = with_stand_ins(plan, floor, missing, given.seed)
    floor = floor if scene is floor.scene else FloorMap.of(scene, range_window_m, person.height_m)
    asked = plan.steps
    plan, running_notes = _running(plan, floor)

    controls: dict[int, Controls] = {}

    def compose_on(plan: MotionPlan, floor: FloorMap) -> RankedPlacement:
        def candidates(attempt: int) -> list[Placement]:
            return place(plan, floor, body, given, attempt=attempt)

        def animate(placement: Placement) -> PoseSequence:
            made = assembled_controls(
                placement.steps,
                placement.path,
                body,
                seed=given.seed,
                duration_s=plan.duration_s,
                habits=habits_of(person.subject) if given.is_varied else NO_HABITS,
                entry=None if given.after is None else given.after.controls,
            )
            controls[id(placement)] = made
            pose = solved(made, body, duration_s=plan.duration_s, floor_z_m=scene.floor_z_m)
            return replace(pose, subject=person.subject, girth=person.girth)

        return least_collision(candidates, animate, CollisionMap.of(scene))

    plan, best, room_notes = relax_constraints(
        plan, floor, compose_on, may_touch=may_touch, depth_m=_depth_m, farthest_m=farthest_m
    )
    placed, described = best.placement, (person.note,) if person.described else ()
    notes = plan.notes + described + missing_notes + running_notes + room_notes + placed.assumptions + best.notes
    return Motion(
        pose=best.pose,
        plan=plan,
        assumptions=notes,
        person=person,
        end=placed.end_state(plan, body),
        controls=controls[id(placed)],
        chair=placed.chair,
        asked=asked,
        scene=scene,
    )


def _depth_m(result: RankedPlacement) -> float:
    return result.penetration_m


def _running(plan: MotionPlan, floor: FloorMap) -> tuple[MotionPlan, tuple[str, ...]]:
    """Replaces undirected running by running on the spot if the room is too short for running to and fro."""
    if not any(_runs_anywhere(step) for step in plan.steps):
        return plan, ()
    longest_m = floor.longest_free_m(RUN_ROOM_M)
    if longest_m >= RUN_ROOM_M:
        return plan, ()
    steps, notes = [], []
    for step in plan.steps:
        aimless = _runs_anywhere(step)
        steps.append(replace(step, direction=Shape.SPOT) if aimless else step)
        if aimless:
            notes.append(
                f"for {step.clause!r} there are {longest_m:.1f} m of straight free floor, {RUN_ROOM_M:g} m are needed:"
                " the person runs on the spot"
            )
    return replace(plan, steps=tuple(steps)), tuple(notes)


def _runs_anywhere(step: Step) -> bool:
    """Whether a step is running without direction, circle, landmark, place or path."""
    leads = step.direction or step.target or step.arc_deg or step.place or step.route_m
    return step.lower == "jog" and not leads
