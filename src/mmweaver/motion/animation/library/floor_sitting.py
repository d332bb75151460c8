"""Sitting on the floor, knees drawn up, cross-legged or with the legs out; getting there and up again.

The root stays where the feet stood; the pelvis comes down behind it.
"""

import numpy as np

from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, bump, rise, spline_through
from mmweaver.motion.animation.standing import HALF_STANCE, STAND_STRETCH
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

SEATED_M = 0.086  # of the height: pelvis above the floor
_LASTS = (1.7, 3.8, 2.5, 1.8, 0.95)


@posture("floor_sit_down")
def sitting_down_on_floor(act: StepContext) -> None:
    """Down over the heels with a hand behind the body, then the legs into place."""
    _sit_on_floor(act, act.since_start(*_LASTS))


@posture("floor_sit")
def sitting_on_floor(act: StepContext) -> None:
    """Sitting still."""
    _sit_on_floor(act, np.ones_like(act.time_s))
    act.add(act.wander(0.1, 0.3), spine_pitch=0.02, head_yaw=0.1)


@posture("floor_rise")
def rising_from_floor(act: StepContext) -> None:
    """The legs are drawn in, the trunk leans over them, and the body rises."""
    _sit_on_floor(act, 1 - act.since_start(*_LASTS))


def _sit_on_floor(act: StepContext, u: PerTime) -> None:
    """From standing (`u` = 0) to sitting on the floor (1), (n,)."""
    u, h, record = np.clip(u, 0.0, 1.0), act.height_m, MOVEMENTS["sit_on_floor"]
    stand = act.body.pelvis_height_m(STAND_STRETCH)
    heights = [stand, stand - 0.2 * h, (SEATED_M + 0.02) * h, SEATED_M * h, SEATED_M * h]
    act.pelvis(
        spline_through(u, record["at"], record["ahead"]) * h, 0.0, spline_through(u, record["at"], heights) - stand
    )
    act.keyed(u, "sit_on_floor", "trunk")
    legs, lift = rise((u - 0.62) / 0.38), bump((u - 0.62) / 0.38)
    up = 0.5 * np.pi * rise(u / 0.6)
    act.controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    act.bend_knees(rise(3 * u))
    act.add(rise((u - 0.35) / 0.3), contact=-1)
    for side in BOTH:
        if act.style == "legs_out":
            act.move_foot(side, 0.248 * h * legs, 0.0, 0.01 * h * lift)
            act.add(legs, side, foot_pitch=-1.15)
        elif act.style == "crossed":
            act.move_foot(side, (-0.115 - 0.035 * side) * h * legs, -(HALF_STANCE + 0.055) * h * legs, 0.025 * h * lift)
            act.add(legs, side, knee_out=1.0, foot_pitch=0.35)
    act.add(up * (1 - 0.72 * legs * (act.style == "crossed")), knee_up=1)
    ahead = {"crossed": 0.15, "legs_out": 0.16}.get(act.style, 0.2)
    act.hand_to(BOTH, (ahead, 0.1, -0.16), legs, (-0.5, 0.6, -0.8))
