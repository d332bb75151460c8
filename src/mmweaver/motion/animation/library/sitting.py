"""Sitting, sitting down and standing up. The root is where the feet stand, in front of the seat."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import Controls
from mmweaver.motion.animation.library.standing import ANKLE_BEHIND, ARM_HANGING, upright
from mmweaver.motion.animation.profiles import rise, wide_bump
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PELVIS_OVER_SEAT = 0.068  # of the body height: from the seat's surface up to the pelvis joint


def pelvis_behind_feet_m(body: SkeletonProportions, seat_height_m: float) -> float:
    """How far in metres the seated pelvis is behind the root: shins about vertical, on a high seat extended."""
    hip = seat_height_m + PELVIS_OVER_SEAT * body.height_m - body.hip_below_pelvis_m
    drop = hip - body.ankle_height_m - body.shank_m * 0.985  # hip over knee
    return float(np.sqrt(body.thigh_m**2 - min(drop, 0.7 * body.thigh_m) ** 2) + ANKLE_BEHIND * body.height_m - 0.03)


def knees_ahead_m(body: SkeletonProportions, seat_height_m: float) -> float:
    """How far in metres the seated knees are ahead of the pelvis, which lie over the ankles."""
    return pelvis_behind_feet_m(body, seat_height_m) - ANKLE_BEHIND * body.height_m + 0.03


def sitting(context: StepContext) -> Controls:
    return _seated(context, np.ones_like(context.time_s))


def sitting_down(context: StepContext) -> Controls:
    """Hips back over the seat while the trunk leans forward, then down."""
    begin = _settled_s(context)
    lasts = float(np.clip(context.end_s - begin - 0.1, 0.75, 1.3 if context.step.speed >= 0 else 2.0))
    return _seated(context, (context.time_s - begin) / lasts)


def standing_up(context: StepContext) -> Controls:
    lasts = float(np.clip(context.duration_s - 0.1, 0.75, 1.2 if context.step.speed >= 0 else 1.9))
    return _seated(context, 1 - (context.time_s - context.start_s) / lasts)


def _seated(context: StepContext, u: Float[Array, " n"]) -> Controls:
    """u (n,) = 0 standing, 1 seated; in between the pelvis moves from one to the other."""
    controls, body = upright(context), context.body
    heading = controls.heading_rad
    back = rise(u / 0.85) * pelvis_behind_feet_m(body, context.seat_height_m)
    seat = context.seat_height_m + PELVIS_OVER_SEAT * body.height_m
    down = rise((u - 0.08) / 0.92)
    controls.pelvis_m[:, 2] += down * (seat - controls.pelvis_m[:, 2])
    controls.pelvis_m[:, 0] -= back * np.cos(heading)
    controls.pelvis_m[:, 1] -= back * np.sin(heading)
    lean = wide_bump(u)
    slouch = float(context.rng.uniform(0.05, 0.18))
    controls.pelvis_rad[:, 1] += 0.5 * lean - slouch * down
    controls.spine_rad[:, 1] += 0.35 * lean + 1.3 * slouch * down
    controls.head_rad[:, 0] -= 0.5 * lean
    controls.knee_out_rad[:] += (0.12 * down)[:, None]
    target = np.array([0.145, 0.066, -0.13]) * body.height_m  # hands on the thighs, seen from spine3
    lap = reach(body, target[None], elbow=(-0.6, 0.45, -1.0))
    controls.arm_rad[:] += down[:, None, None] * (lap - np.array(ARM_HANGING))
    controls.arm_rad[:, :, 0] += (0.35 * lean)[:, None]
    return controls


def _settled_s(context: StepContext) -> float:
    """Time in seconds when the root has almost stopped turning: sitting down begins only then."""
    late = context.start_s + np.linspace(0, max(context.duration_s, 0.1), 60)
    left = np.abs(context.path.facing_rad(late) - context.path.facing_rad(late[-1:])[0])
    turning = np.flatnonzero(left > 0.6)
    return float(late[turning[-1]]) if len(turning) else context.start_s
