"""From scheduled steps and a root path to one dense, smooth PoseSequence."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PoseSequence
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.controls import blended
from mmweaver.motion.animation.kinematics import solve
from mmweaver.motion.animation.library.activity_registry import perform
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import StepContext
from mmweaver.motion.language.plan import Step

RATE_HZ = 120.0
MARGIN_SAMPLES = 2  # before the start and after the end, for interpolation
LONGEST_BLEND_S = 0.45


def dense_times(duration_s: float) -> Float[np.ndarray, " n"]:
    """Times (n,) in seconds at 120 Hz, from two samples before 0 to at least two samples after the end."""
    count = int(np.ceil(duration_s * RATE_HZ - 1e-9))
    return np.arange(-MARGIN_SAMPLES, count + MARGIN_SAMPLES + 1) / RATE_HZ


def assemble(
    steps: tuple[Step, ...],
    path: RootPath,
    moves: tuple[tuple[Move, ...], ...],
    seat_height_m: tuple[float, ...],
    body: SkeletonProportions,
    *,
    seed: int,
    duration_s: float,
    floor_z_m: float,
) -> PoseSequence:
    """Animates every step along the path, blends neighbours and solves the joints, in the radar's frame.

    `moves` and `seat_height_m` hold one entry for each step.
    """
    time_s = dense_times(duration_s)
    parts, starts, blends = [], [], []
    steps, moves, seat_height_m = _merge_gait(steps, moves, seat_height_m)
    for k, step in enumerate(steps):
        context = StepContext(
            time_s=time_s, step=step, body=body, path=path, rng=stream(seed, "motion", "step", k, step.name),
            moves=moves[k], seat_height_m=seat_height_m[k], first=k == 0, last=k == len(steps) - 1,
        )  # fmt: skip
        parts.append(perform(context))
        before = steps[k - 1].end_s - steps[k - 1].start_s if k else step.end_s
        blends.append(float(min(LONGEST_BLEND_S, 0.6 * min(context.duration_s, before))))
        starts.append(step.start_s + 0.5 * blends[-1] if k else step.start_s)
    controls = blended(parts, starts, blends, time_s)
    joints_m = solve(body, controls)
    joints_m[..., 2] += floor_z_m
    return PoseSequence(time_s=time_s, joints_m=joints_m, height_m=body.height_m)


def _merge_gait(
    steps: tuple[Step, ...], moves: tuple[tuple[Move, ...], ...], seat_height_m: tuple[float, ...]
) -> tuple[tuple[Step, ...], tuple[tuple[Move, ...], ...], tuple[float, ...]]:
    """Merges walking, turning and walking on into one gait: blending two rhythms would make the feet jump."""
    whole: list[Step] = []
    merged_moves: list[tuple[Move, ...]] = []
    seats: list[float] = []
    for step, own_moves, seat in zip(steps, moves, seat_height_m, strict=True):
        alike = step.lower in ("walk", "turn") and not step.upper
        if alike and whole and whole[-1].lower in ("walk", "turn") and not whole[-1].upper:
            whole[-1] = replace(whole[-1], lower="walk", end_s=step.end_s)
            merged_moves[-1] = (*merged_moves[-1], *own_moves)
        else:
            whole.append(step)
            merged_moves.append(own_moves)
            seats.append(seat)
    return tuple(whole), tuple(merged_moves), tuple(seats)
