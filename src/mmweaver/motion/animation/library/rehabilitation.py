"""Exercises of rehabilitation as people do them: side lunges, limb extensions, and how arms are held meanwhile.

The exercises are those of MARS (An and Ogras, 2021). How far the joints go was chosen by hand, that of side lunges,
squats and front lunges after a look at its first subject (studies/motion/mars_exercises.py).
"""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    lean_over,
    leg_side,
    lift_weight,
    mix_arm,
    shift_foot,
    shift_pelvis,
    sides,
    vary,
)
from mmweaver.motion.animation.library.standing import upright
from mmweaver.motion.animation.profiles import plateau, reached
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]


def _there_and_back(context: StepContext, usual_s: float, least_s: float, most_s: float) -> PerTime:
    """0 to 1 and back (n,), as often as asked for or as the time allows, each a little different and with a hold."""
    count = context.step.count or max(1, round(context.duration_s / usual_s))
    each = float(np.clip(context.duration_s / count, least_s, most_s))
    share = np.zeros_like(context.time_s)
    hold = float(context.rng.uniform(0.05, 0.3))
    for k in range(count):
        begin, high = context.start_s + k * each, vary(context, 1.0, 0.06)
        ramp = 0.5 * (1 - hold) * each
        share += high * plateau(context.time_s, begin, begin + 0.98 * each, ramp, ramp)
    return share


def side_lunging(context: StepContext) -> Controls:
    """From a wide stance the weight goes over one bent knee; the arms are held out to the sides."""
    controls, h = upright(context), context.body.height_m
    side, down = leg_side(context), _there_and_back(context, 3.0, 1.4, 5.0)
    half = vary(context, 0.1, 0.12) * h  # how much wider each foot stands
    for foot in (LEFT, RIGHT):
        shift_foot(controls, foot, 0.0, half, 0.0)
        controls.foot_rad[:, foot, 0] += OUTWARD[foot] * 0.25
    aside = OUTWARD[side] * vary(context, 0.125, 0.1) * h * down
    shift_pelvis(controls, -0.02 * h * down, aside, -(0.01 + vary(context, 0.056, 0.1) * down) * h)
    controls.spine_rad[:, 0] -= OUTWARD[side] * 0.06 * down
    controls.spine_rad[:, 1] += vary(context, 0.12, 0.3) * down
    controls.knee_out_rad[:] += 0.25
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.2)
    _arms_out(context, controls)
    return controls


def _arms_out(context: StepContext, controls: Controls) -> None:
    abduction, ahead = float(context.rng.normal(1.5, 0.1)), float(context.rng.normal(0.1, 0.1))
    for arm in (LEFT, RIGHT):
        angles = np.tile([ahead, abduction, 0.0, 0.12], (len(context.time_s), 1))
        mix_arm(controls, arm, angles, np.ones_like(context.time_s))


def limb_extension(context: StepContext) -> Controls:
    """One leg goes out to the side, straight, and the arm of the same side up; then both come back."""
    controls, body = upright(context), context.body
    side, up = leg_side(context), _there_and_back(context, 2.8, 1.3, 4.5)
    angle = vary(context, 0.62, 0.2) * up
    over = reached(2.5 * up)
    lean_over(controls, body, 1 - side, over)
    lift_weight(controls, side, reached(3 * up))
    shift_foot(controls, side, 0.0, body.leg_m * np.sin(angle), body.leg_m * (1 - np.cos(angle)))
    controls.spine_rad[:, 0] += OUTWARD[side] * 0.1 * up
    _arm_aside(context, controls, side, up, vary(context, 1.95, 0.1))
    controls.arm_rad[:, 1 - side, 1] += 0.15 * up
    controls.knee_out_rad[:, side] *= 1 - 0.5 * over
    return controls


def arm_extension(context: StepContext, controls: Controls) -> Controls:
    """The straight arm goes up at the side until the hand is as high as the head, and comes down, again and again."""
    up, top = _there_and_back(context, 4.0, 1.1, 6.0), vary(context, 2.0, 0.07)
    for side in sides(context):
        _arm_aside(context, controls, side, up, top)
        controls.spine_rad[:, 0] += OUTWARD[side] * 0.04 * up * (len(sides(context)) == 1)
    return controls


def _arm_aside(context: StepContext, controls: Controls, side: int, up: PerTime, top: float) -> None:
    arm = controls.arm_rad[:, side].copy()
    arm[:, 1] = top
    arm[:, 0] = context.rng.normal(0.1, 0.12)
    arm[:, 2:] = 0.1
    mix_arm(controls, side, arm, reached(up, 1.1))


def hands_up(context: StepContext, controls: Controls) -> Controls:
    """Both hands next to or in front of the face, elbows bent and out, as many hold them in squats and lunges."""
    flexion, abduction = float(context.rng.uniform(0.6, 1.2)), float(context.rng.uniform(0.5, 1.0))
    bend = float(context.rng.uniform(1.9, 2.4))
    for arm in (LEFT, RIGHT):
        angles = np.tile([flexion, abduction, -0.3, bend], (len(context.time_s), 1))
        mix_arm(controls, arm, angles, np.ones_like(context.time_s))
    return controls
