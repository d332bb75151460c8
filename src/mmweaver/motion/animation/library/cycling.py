"""Riding an exercise bike: the pelvis on the saddle, feet on the pedals, hands on the handlebar."""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    cycles,
    hand_to,
    place,
    shift_foot,
    shift_pelvis,
    vary,
)
from mmweaver.motion.animation.library.standing import ANKLE_BEHIND, STAND_STRETCH, upright
from mmweaver.motion.animation.profiles import rise
from mmweaver.motion.animation.step_context import StepContext

MOUNTING_S = 1.2  # from standing to the saddle
_CRANK_M, _AXLE_M = 0.17, 0.28  # length of a crank, height of the bottom bracket
_SADDLE_BEHIND = 0.115  # of the height: from the bottom bracket back to the pelvis
_LONGEST_LEG = 0.955  # of a leg's length, with the pedal at its lowest
_HEEL_UP_RAD, _ANKLING_RAD = 0.22, 0.16


def pedalling(context: StepContext) -> Controls:
    """One turn of the cranks a second, after getting on; the root is under the saddle."""
    controls, body, h = upright(context), context.body, context.body.height_m
    on = rise((context.time_s - context.start_s) / MOUNTING_S) if not context.first else np.ones_like(context.time_s)
    on = on if context.last else on * rise((context.end_s + 0.2 - context.time_s) / MOUNTING_S)
    rate, _ = cycles(context, context.tempo(0.7, 1.05, 1.5), 0.5, 1.8)
    phase = 2 * np.pi * rate * (context.time_s - context.start_s)
    leg_m, behind_m = _LONGEST_LEG * body.leg_m, _SADDLE_BEHIND * h
    lowest_ankle_m = _AXLE_M - _CRANK_M + body.ankle_height_m + body.ball_m * np.sin(_HEEL_UP_RAD)
    hip_m = lowest_ankle_m + float(np.sqrt(leg_m**2 - behind_m**2))
    shift_pelvis(controls, 0.0, 0.0, on * (hip_m + body.hip_below_pelvis_m - body.pelvis_height_m(STAND_STRETCH)))
    controls.pelvis_rad[:, 0] += vary(context, 0.03) * on * np.sin(phase)
    controls.pelvis_rad[:, 1] += 0.25 * on
    controls.spine_rad[:, 1] += vary(context, 0.3, 0.15) * on
    controls.head_rad[:, 0] -= 0.35 * on
    controls.knee_room[:] = np.maximum(controls.knee_room, rise(3 * on))
    bar = place(0.25, 0.11, 0.04, len(phase))
    for side, opposite in ((LEFT, 0.0), (RIGHT, np.pi)):
        ahead, up = _CRANK_M * np.sin(phase + opposite), _CRANK_M * np.cos(phase + opposite)
        shift_foot(controls, side, on * (behind_m + ANKLE_BEHIND * h + ahead), 0.0, on * (_AXLE_M + up))
        controls.foot_rad[:, side, 1] += on * (_HEEL_UP_RAD - _ANKLING_RAD * np.sin(phase + opposite))
        controls.contact[:, side] -= rise(2 * on)
        controls.knee_out_rad[:, side] *= 1 - on
        hand_to(controls, body, side, bar, on, (-0.4, 0.7, -0.9))
    return controls
