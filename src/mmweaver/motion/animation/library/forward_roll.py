"""A forward roll: hands on the floor, over the rounded back, and up onto the feet again a body's length ahead.

Arms are solved from the floor while hands lie on it. Whole turns are taken out of angles once a roll is over: joints do
not see it, and what follows begins at zero.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.kinematics import ankle_from_foot, chest_of
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    mix_arm,
    repeats,
    shift_pelvis,
    spline_through,
)
from mmweaver.motion.animation.library.standing import STAND_STRETCH, upright
from mmweaver.motion.animation.profiles import cap, plateau, rise
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.step_context import StepContext

PerTime = Float[np.ndarray, " n"]
AHEAD = 1.08  # of the height: how far on the body stands up again
UPRIGHT_AGAIN = 0.82  # share of a roll after which trunk and feet have turned once
_AT = (0.0, 0.27, 0.4, 0.47, 0.53, 0.6, 0.67, 0.73, 0.82, 1.0)  # shares of a roll
_PELVIS_AHEAD = (0.0, 0.03, 0.16, 0.32, 0.5, 0.67, 0.79, 0.88, 1.0, AHEAD)  # of the height
_PELVIS_UP = (0.0, 0.29, 0.38, 0.37, 0.24, 0.1, 0.085, 0.11, 0.25, 0.0)  # 0: as in standing
_FOOT_AT = (0.36, 0.45, 0.52, 0.58, 0.64, 0.7, 0.75)
_FOOT_AHEAD = (0.0, -0.02, 0.22, 0.68, 0.98, 1.07, AHEAD)
_FOOT_UP = (0.0, 0.15, 0.55, 0.52, 0.3, 0.06, 0.0)
_HANDS = (0.46, 0.12, 0.03)  # where they lie: ahead, outward, up


def rolling_forward(context: StepContext) -> Controls:
    """As often as the sentence says, one after the other."""
    ends = np.array([context.start_s - 0.001, context.end_s])
    start, end = context.path.position_m(ends)
    heading = float(context.path.facing_rad(ends)[0])
    here = replace(context, path=RootPath(start_m=(float(start[0]), float(start[1])), heading_rad=heading))
    controls, rolls = upright(here), repeats(context, 2.9, 2.5, 4.0)
    each_m = float(np.hypot(*(end - start))) / len(rolls)
    for k, (begin, lasts) in enumerate(rolls):
        _roll(here, controls, (context.time_s - begin) / lasts, each_m, k * each_m)
    return controls


def _roll(context: StepContext, controls: Controls, share: PerTime, length_m: float, gone_m: float) -> None:
    """One roll over `share` (n,) 0 to 1, after the body has gone `gone_m` ahead."""
    body, h = context.body, context.body.height_m
    stretch = length_m / (AHEAD * h)
    whole = 2 * np.pi * (share >= UPRIGHT_AGAIN)
    ahead = stretch * h * spline_through(share, _AT, _PELVIS_AHEAD)
    stand = body.pelvis_height_m(STAND_STRETCH)
    heights = [(z * h or stand) - stand for z in _PELVIS_UP]
    shift_pelvis(controls, ahead, 0.0, spline_through(share, _AT, heights))
    over = 1.0 * rise(share / 0.27) + (2 * np.pi - 1.0) * rise((share - 0.26) / (UPRIGHT_AGAIN - 0.26)) - whole
    round_back = plateau(share, 0.08, 0.95, 0.3, 0.3)
    controls.pelvis_rad[:, 1] += over
    controls.spine_rad[:, 1] += 1.0 * round_back
    controls.head_rad[:, 0] += 0.9 * plateau(share, 0.2, 0.85, 0.18, 0.2)
    controls.knee_up_rad[:] += -over + 0.25 * np.pi * plateau(share, 0.1, 0.9, 0.2, 0.2)
    controls.knee_room[:] = np.maximum(controls.knee_room, plateau(share, 0.0, 1.0, 0.15, 0.15))
    _feet(controls, context, share, whole, stretch)
    for side in (LEFT, RIGHT):
        controls.contact[:, side] -= plateau(share, 0.33, 0.77, 0.08, 0.06)
        arm = np.tile([0.9, 0.15, 0.0, 0.9], (len(share), 1))
        mix_arm(controls, side, arm, plateau(share, 0.1, 0.98, 0.2, 0.25))
        _hand_on_floor(controls, context, side, share, gone_m)


def _feet(controls: Controls, context: StepContext, share: PerTime, whole: PerTime, stretch: float) -> None:
    """Both feet push off, go over the head with the legs, and come down together."""
    h, heading = context.body.height_m, controls.heading_rad
    pitch = 2 * np.pi * rise((share - 0.33) / (UPRIGHT_AGAIN - 0.03 - 0.33))
    pivot = ankle_from_foot(context.body, np.zeros(len(share)), pitch) - [0.0, 0.0, context.body.ankle_height_m]
    ahead = stretch * h * spline_through(share, _FOOT_AT, _FOOT_AHEAD) - pivot[:, 0]
    up = h * spline_through(share, _FOOT_AT, _FOOT_UP) - pivot[:, 2]
    pushing = 1 - plateau(share, _FOOT_AT[0], _FOOT_AT[-1], 0.05, 0.05)  # on the ball until it leaves the floor
    ahead += pushing * pivot[:, 0]
    up += pushing * pivot[:, 2]
    controls.foot_m[:, :, 0] += (ahead * np.cos(heading))[:, None]
    controls.foot_m[:, :, 1] += (ahead * np.sin(heading))[:, None]
    controls.foot_m[:, :, 2] += up[:, None]
    controls.foot_rad[:, :, 1] += (pitch - whole)[:, None]


def _hand_on_floor(controls: Controls, context: StepContext, side: int, share: PerTime, gone_m: float) -> None:
    """One hand at its place on the floor while it carries weight."""
    h, heading = context.body.height_m, controls.heading_rad
    start = context.path.position_m(context.time_s)
    ahead, left = _HANDS[0] * h + gone_m, OUTWARD[side] * _HANDS[1] * h
    target = np.stack(
        [
            start[:, 0] + ahead * np.cos(heading) - left * np.sin(heading),
            start[:, 1] + ahead * np.sin(heading) + left * np.cos(heading),
            np.full(len(share), _HANDS[2] * h),
        ],
        axis=1,
    )
    place, frame = chest_of(context.body, controls)
    in_chest = np.einsum("nji,nj->ni", frame, target - place)
    in_chest[:, 1] *= OUTWARD[side]
    arm = reach(context.body, in_chest, elbow=(-0.2, 0.9, -0.3))
    arm[:, 0] = cap(arm[:, 0], 2.9, 0.4)  # the hands leave the floor when the shoulders have passed them
    mix_arm(controls, side, arm, plateau(share, 0.12, 0.58, 0.15, 0.17))
