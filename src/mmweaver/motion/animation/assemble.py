"""From scheduled steps and a root path to one dense, smooth PoseSequence."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.carry_over import ControlsState, carried_over
from mmweaver.motion.animation.controls import NO_HABITS, Controls, Habits, blended
from mmweaver.motion.animation.kinematics import solve
from mmweaver.motion.animation.library.activity_registry import perform
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep, StepContext
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.plan import Step

RATE_HZ = 120.0
MARGIN_SAMPLES = 2  # before the start and after the end, for interpolation
LONGEST_BLEND_S = 0.45
# Gravity sets their tempo.
_IN_THE_AIR = ("jump", "leap", "hop", "hop_one_leg", "jumping_jacks", "jog", "turn", "forward_roll")


def dense_times(duration_s: float) -> Float[np.ndarray, " n"]:
    """Times at which motions are composed.

    Args:
        duration_s: Duration of the motion in seconds.

    Returns:
        Times (n,) in seconds at 120 Hz, from two samples before 0 to at least two samples after the end.
    """
    count = int(np.ceil(duration_s * RATE_HZ - 1e-9))
    return np.arange(-MARGIN_SAMPLES, count + MARGIN_SAMPLES + 1) / RATE_HZ


def assemble(
    steps: tuple[PlacedStep, ...],
    path: RootPath,
    body: SkeletonProportions,
    *,
    seed: int,
    duration_s: float,
    floor_z_m: float,
    habits: Habits = NO_HABITS,
) -> PoseSequence:
    """Animates every step along the path, blends neighbours and solves the joints.

    Args:
        steps: Scheduled steps of a plan in order, each with its moves.
        path: Position and heading of the root over time.
        body: Bone lengths.
        seed: Determines what the sentence leaves open.
        duration_s: Duration of the motion in seconds.
        floor_z_m: Height of the floor in the radar's frame, metres.
        habits: Habits of the person; none by default.

    Returns:
        The motion at `dense_times`, in the radar's frame.
    """
    controls = assembled_controls(steps, path, body, seed=seed, duration_s=duration_s, habits=habits)
    return solved(controls, body, duration_s=duration_s, floor_z_m=floor_z_m)


def solved(controls: Controls, body: SkeletonProportions, *, duration_s: float, floor_z_m: float) -> PoseSequence:
    """Solves the joints of controls.

    Args:
        controls: Controls at `dense_times`.
        body: Bone lengths.
        duration_s: Duration of the motion in seconds.
        floor_z_m: Height of the floor in the radar's frame, metres.

    Returns:
        The motion in the radar's frame.
    """
    joints_m = solve(body, controls)
    joints_m[..., 2] += floor_z_m
    return PoseSequence(time_s=dense_times(duration_s), joints_m=joints_m, height_m=body.height_m)


def assembled_controls(
    steps: tuple[PlacedStep, ...],
    path: RootPath,
    body: SkeletonProportions,
    *,
    seed: int,
    duration_s: float,
    habits: Habits = NO_HABITS,
    entry: ControlsState | None = None,
) -> Controls:
    """Animates every step along the path and blends neighbours.

    Args:
        steps: Scheduled steps of a plan in order, each with its moves.
        path: Position and heading of the root over time.
        body: Bone lengths.
        seed: Determines what the sentence leaves open; each step has a random stream of its own.
        duration_s: Duration of the motion in seconds.
        habits: Habits of the person; none by default.
        entry: State in which the motion begins; None for that of the first step.

    Returns:
        Controls at `dense_times`.
    """
    time_s = dense_times(duration_s)
    parts, starts, blends = [], [], []
    steps = _merge_gait(steps)
    for k, placed in enumerate(steps):
        step = placed.step
        own_time_s = habits.warped(time_s, step.start_s, step.end_s) if _may_be_uneven(placed) else time_s
        context = StepContext(
            time_s=own_time_s,
            step=step,
            body=body,
            path=path,
            rng=stream(seed, "motion", "step", k, step.name),
            moves=placed.moves,
            seat_height_m=placed.seat_height_m,
            habits=habits,
            first=k == 0,
            last=k == len(steps) - 1,
            arms_before=k > 0 and _same_arms(steps[k - 1], placed),
            arms_after=k + 1 < len(steps) and _same_arms(placed, steps[k + 1]),
        )
        parts.append(perform(context))
        before = steps[k - 1].step.end_s - steps[k - 1].step.start_s if k else step.end_s
        blends.append(float(min(LONGEST_BLEND_S, 0.6 * min(context.duration_s, before))))
        starts.append(step.start_s + 0.5 * blends[-1] if k else step.start_s)
    controls = blended(parts, starts, blends, time_s)
    return controls if entry is None else carried_over(controls, time_s, entry)


def _same_arms(one: PlacedStep, other: PlacedStep) -> bool:
    """Whether two steps in a row hold the arms in the same posture."""
    return bool(one.step.upper) and (one.step.upper, one.step.hand) == (other.step.upper, other.step.hand)


def _merge_gait(steps: tuple[PlacedStep, ...]) -> tuple[PlacedStep, ...]:
    """Merges consecutive walking and turning into one gait: blending two step rhythms would make the feet jump."""
    merged: list[PlacedStep] = []
    for placed in steps:
        if merged and _is_one_gait(merged[-1].step, placed.step):
            before = merged[-1]
            style = before.step.style or placed.step.style
            whole = replace(before.step, lower="walk", style=style, end_s=placed.step.end_s)
            merged[-1] = replace(before, step=whole, moves=(*before.moves, *placed.moves))
        else:
            merged.append(placed)
    return tuple(merged)


def _may_be_uneven(placed: PlacedStep) -> bool:
    """Whether the tempo of a step may drift: on the spot, feet on the floor, and a continuous activity."""
    activity = BY_KEY[placed.step.lower]
    return not (placed.moves or activity.once or activity.posture == "floor" or placed.step.lower in _IN_THE_AIR)


def _is_one_gait(one: Step, other: Step) -> bool:
    """Whether two steps are a walk of one style and its turns."""
    is_turn = "turn" in (one.lower, other.lower)
    return _is_plain_gait(one) and _is_plain_gait(other) and (is_turn or one.style == other.style)


def _is_plain_gait(step: Step) -> bool:
    return step.lower in ("walk", "turn") and not step.upper
