"""Kicks in which the body turns over the standing foot: around the side (roundhouse) and out to the side."""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    lean_over,
    leg_side,
    lift_weight,
    mix_arm,
    repeats,
    shift_foot,
    shift_pelvis,
    spline_through,
)
from mmweaver.motion.animation.library.standing import upright
from mmweaver.motion.animation.profiles import plateau
from mmweaver.motion.animation.step_context import StepContext

# Shares of a kick's time: standing, drawn back, knee up, hit, through, knee up again, standing.
_AT = (0.0, 0.17, 0.35, 0.54, 0.66, 0.83, 1.0)
_GUARD = (0.55, 0.35, -0.5, 2.0)  # of both arms: flexion, abduction, twist, elbow


def roundhouse(context: StepContext) -> Controls:
    """The leg swings around the side to the front, the body turning with it on the ball of the other foot, and back."""
    high = float(context.rng.uniform(0.42, 0.56)) + (0.14 if context.step.style == "high" else 0.0)
    ahead = (0.0, -0.1, -0.06, 0.4, 0.33, 0.08, 0.0)
    out = (0.0, 0.04, 0.25, 0.04, -0.08, 0.04, 0.0)
    up = (0.0, 0.07, 0.32, high, 0.9 * high, 0.22, 0.0)
    return _kicked(context, (ahead, out, up), turn_rad=float(context.rng.uniform(1.2, 1.5)), roll_rad=0.5)


def side_kick(context: StepContext) -> Controls:
    """The knee comes up, then the foot shoots out to the own side, the trunk leaning away from it."""
    high = float(context.rng.uniform(0.3, 0.42))
    ahead = (0.0, 0.06, 0.1, 0.02, 0.02, 0.08, 0.0)
    out = (0.0, 0.0, 0.05, 0.36, 0.36, 0.08, 0.0)
    up = (0.0, 0.08, 0.25, high, 0.95 * high, 0.22, 0.0)
    return _kicked(context, (ahead, out, up), turn_rad=0.3, roll_rad=0.5)


def _kicked(context: StepContext, foot: tuple[tuple[float, ...], ...], *, turn_rad: float, roll_rad: float) -> Controls:
    """A kick whose foot goes through places (ahead, outward, up; body heights) at the times _AT."""
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    side = leg_side(context)
    away = -OUTWARD[side]  # the sign of a turn towards the standing leg
    for begin, lasts in repeats(context, 1.65, 1.3, 2.3):
        at = [begin + share * lasts for share in _AT]
        ahead, out, up = (spline_through(time_s, at, values) for values in foot)
        over = plateau(time_s, begin - 0.12 * lasts, begin + 1.1 * lasts, 0.3 * lasts, 0.32 * lasts)
        air = plateau(time_s, begin, begin + lasts, 0.16 * lasts, 0.16 * lasts)
        swing = plateau(time_s, begin + 0.14 * lasts, begin + 0.96 * lasts, 0.4 * lasts, 0.36 * lasts)
        shift_foot(controls, side, ahead * h, out * h, np.maximum(up, 0.0) * h)
        lean_over(controls, context.body, 1 - side, over)
        lift_weight(controls, side, air)
        shift_pelvis(controls, 0.0, 0.0, -0.014 * h * over)
        controls.heading_rad[:] += away * turn_rad * swing  # the way of the foot was given before the turn
        controls.foot_rad[:, :, 0] += (away * turn_rad * swing)[:, None]
        controls.pelvis_rad[:, 0] -= away * roll_rad * swing
        controls.spine_rad[:, 0] -= away * 0.3 * swing
        controls.head_rad[:, 1] -= away * min(turn_rad, 1.0) * swing
        controls.foot_rad[:, side, 1] += 0.75 * swing
        for arm in (LEFT, RIGHT):
            mix_arm(controls, arm, np.tile(np.array(_GUARD), (len(time_s), 1)), over)
            controls.arm_rad[:, arm, 0] += (0.3 if arm != side else -0.7) * swing
            controls.arm_rad[:, arm, 3] -= (0.0 if arm != side else 1.0) * swing
    return controls
