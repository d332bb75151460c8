"""Lying on a couch or bed, along the edge on which one sits, getting there and back, and falling off a seat."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls, blend
from mmweaver.motion.animation.library.movement_primitives import shift_foot, shift_pelvis, spline_through
from mmweaver.motion.animation.library.on_the_floor import BACK_BEHIND_M, on_side, rolled
from mmweaver.motion.animation.library.sitting import sitting
from mmweaver.motion.animation.library.standing import ANKLE_BEHIND, HALF_STANCE, SIDE_SIGN
from mmweaver.motion.animation.profiles import bump, rise
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]
PELVIS_OVER_SEAT = 0.075  # of the height: of the pelvis of somebody who lies
OFF_SEAT_AHEAD_M = 0.25  # in front of the feet of the sitter: where somebody who falls off lands
_TOWARDS_FEET = 0.06  # of the height: how far the pelvis moves along the couch, so that head and feet fit


def lying_on_seat(context: StepContext) -> Controls:
    return _along_seat(context, np.ones_like(context.time_s))


def reclining(context: StepContext) -> Controls:
    """From sitting: the trunk goes down to the own left while the legs come up, one after the other."""
    return _along_seat(context, (context.time_s - context.start_s) / _lasts_s(context))


def sitting_up(context: StepContext) -> Controls:
    return _along_seat(context, 1 - (context.time_s - context.start_s) / _lasts_s(context))


def rolling_in_bed(context: StepContext) -> Controls:
    """Lying on it, onto a side and back again."""
    return rolled(context, lying_on_seat(context))


def _lasts_s(context: StepContext) -> float:
    return float(np.clip(0.95 * context.duration_s, 1.4, (3.6, 2.6, 1.8)[context.step.speed + 1]))


def _along_seat(context: StepContext, u: PerTime) -> Controls:
    """u (n,) = 0 sitting, 1 lying on the back with the head to the own left, knees bent, soles on the seat."""
    controls, h = sitting(context), context.body.height_m
    u = np.clip(u, 0.0, 1.0)
    at = [0.0, 0.3, 0.55, 0.8, 1.0]
    turned = 0.5 * np.pi * rise(u / 0.85)
    feet_rad = controls.heading_rad - 0.5 * np.pi  # the direction in which the feet end up
    controls.heading_rad[:] -= turned
    along = np.stack([np.cos(feet_rad), np.sin(feet_rad)], axis=1)
    left = np.stack([-np.sin(feet_rad), np.cos(feet_rad)], axis=1)
    down = rise(u)
    controls.pelvis_m[:, :2] += _TOWARDS_FEET * h * down[:, None] * along
    lying_m = context.seat_height_m + PELVIS_OVER_SEAT * h
    controls.pelvis_m[:, 2] += down * (lying_m - controls.pelvis_m[:, 2]) + 0.02 * h * bump(u)
    controls.pelvis_rad[:, 1] += (
        spline_through(u, at, [0.0, -0.25, -0.75, -1.2, -1.5]) - down * controls.pelvis_rad[:, 1]
    )
    controls.spine_rad[:, 1] += spline_through(u, at, [0.0, 0.1, 0.35, 0.25, 0.05]) - down * controls.spine_rad[:, 1]
    controls.spine_rad[:, 0] -= spline_through(u, at, [0.0, 0.35, 0.25, 0.1, 0.0])
    controls.head_rad[:, 0] += spline_through(u, at, [0.0, 0.15, 0.4, 0.3, 0.1])
    controls.knee_up_rad[:] += 0.5 * np.pi * rise(u / 0.7)
    controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    controls.knee_room[:] = np.maximum(controls.knee_room, rise(4 * u))
    for side, begin in ((RIGHT, 0.1), (LEFT, 0.22)):
        over = rise((u - begin) / 0.6)
        goal = controls.pelvis_m[:, :2] + (BACK_BEHIND_M - ANKLE_BEHIND) * h * along
        goal = goal + SIDE_SIGN[side] * HALF_STANCE * h * left
        controls.foot_m[:, side, :2] += over[:, None] * (goal - controls.foot_m[:, side, :2])
        controls.foot_m[:, side, 2] += rise((u - begin) / 0.4) * context.seat_height_m + 0.05 * h * bump(
            (u - begin) / 0.6
        )
        controls.foot_rad[:, side, 0] -= 0.5 * np.pi * over
        controls.contact[:, side] -= bump((u - begin) / 0.6)
    controls.arm_rad[:, :, 0] += 0.2 * bump(u)[:, None]
    for side in (LEFT, RIGHT):
        rest = np.array([-0.03, 0.2, 0.0, 0.25])
        controls.arm_rad[:, side] += rise((u - 0.2) / 0.8)[:, None] * (rest - controls.arm_rad[:, side])
    return controls


def falling_off(context: StepContext) -> Controls:
    """From sitting down to the floor next to the feet, to the own side; within about a second."""
    lasts = float(np.clip(0.9 * context.duration_s, 0.9, (1.5, 1.25, 1.05)[context.step.speed + 1]))
    u = np.clip((context.time_s - context.start_s) / lasts, 0.0, 1.0)
    seated, fallen = sitting(context), on_side(context, 0.4 + 0.6 * u)
    shift_pelvis(fallen, OFF_SEAT_AHEAD_M, 0.0, 0.0)
    for side in (LEFT, RIGHT):
        shift_foot(fallen, side, OFF_SEAT_AHEAD_M, 0.0, 0.0)
    weight = rise(u / 0.75)
    of_feet = np.repeat(rise((u - 0.1) / 0.7)[:, None], 2, axis=1)
    return blend([seated, fallen], [1 - weight, weight], [1 - of_feet, of_feet])
