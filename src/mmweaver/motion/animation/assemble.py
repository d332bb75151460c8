"""From scheduled steps and a root path to one dense, smooth PoseSequence."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.controls import blended
from mmweaver.motion.animation.kinematics import solve
from mmweaver.motion.animation.library.activity_registry import perform
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import PlacedStep, StepContext
from mmweaver.motion.language.plan import Step

RATE_HZ = 120.0
MARGIN_SAMPLES = 2  # before the start and after the end, for interpolation
LONGEST_BLEND_S = 0.45


def dense_times(duration_s: float) -> Float[np.ndarray, " n"]:
    """Times (n,) in seconds at 120 Hz, from two samples before 0 to at least two samples after the end."""
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
) -> PoseSequence:
    """Animates every step along the path, blends neighbours and solves the joints, in the radar's frame."""
    time_s = dense_times(duration_s)
    parts, starts, blends = [], [], []
    steps = _merge_gait(steps)
    for k, placed in enumerate(steps):
        step = placed.step
        context = StepContext(
            time_s=time_s, step=step, body=body, path=path, rng=stream(seed, "motion", "step", k, step.name),
            moves=placed.moves, seat_height_m=placed.seat_height_m, first=k == 0, last=k == len(steps) - 1,
        )  # fmt: skip
        parts.append(perform(context))
        before = steps[k - 1].step.end_s - steps[k - 1].step.start_s if k else step.end_s
        blends.append(float(min(LONGEST_BLEND_S, 0.6 * min(context.duration_s, before))))
        starts.append(step.start_s + 0.5 * blends[-1] if k else step.start_s)
    controls = blended(parts, starts, blends, time_s)
    joints_m = solve(body, controls)
    joints_m[..., 2] += floor_z_m
    return PoseSequence(time_s=time_s, joints_m=joints_m, height_m=body.height_m)


def _merge_gait(steps: tuple[PlacedStep, ...]) -> tuple[PlacedStep, ...]:
    """Merges walking, turning and walking on into one gait: blending two rhythms would make the feet jump."""
    merged: list[PlacedStep] = []
    for placed in steps:
        if merged and _is_plain_gait(placed.step) and _is_plain_gait(merged[-1].step):
            before = merged[-1]
            whole = replace(before.step, lower="walk", end_s=placed.step.end_s)
            merged[-1] = replace(before, step=whole, moves=(*before.moves, *placed.moves))
        else:
            merged.append(placed)
    return tuple(merged)


def _is_plain_gait(step: Step) -> bool:
    return step.lower in ("walk", "turn") and not step.upper
