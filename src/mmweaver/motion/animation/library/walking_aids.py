"""Walks of a style: heel to toe, with a cane, with a rollator, on crutches, pushing furniture.

Speeds are those of `trajectory.STYLED_MPS`. A cane goes with the other leg, both crutches with the weak leg.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.library.gait import STYLED_WALKS, Style, cruise_mps, steps_along_path, walking_style
from mmweaver.motion.animation.library.rehabilitation import FOOT_LENGTH
from mmweaver.motion.animation.profiles import rise
from mmweaver.motion.animation.step_context import BOTH, StepContext

Walk = Callable[[StepContext], None]


def _styled(name: str) -> Callable[[Walk], Walk]:
    """Registers a walk under a `Step.style`."""

    def register(walk: Walk) -> Walk:
        STYLED_WALKS[name] = walk
        return walk

    return register


def _elderly(act: StepContext, **changes: float) -> Style:
    """A slow, careful gait: short steps, flat feet, little swing of the arms, the trunk ahead."""
    style = walking_style(act, max(cruise_mps(act), 0.45))
    careful = {
        "arm_swing_rad": 0.3 * style.arm_swing_rad,
        "toe_off_rad": 0.7 * style.toe_off_rad,
        "heel_strike_rad": 0.6 * style.heel_strike_rad,
        "lean_rad": style.lean_rad + 0.08,
        "stepping_mps": 0.35,
    }
    return replace(style, **{**careful, **changes})


@_styled("tandem")
def walking_in_tandem(act: StepContext) -> None:
    """Every foot right before the other one, its heel at those toes, the arms out for balance."""
    speed = max(cruise_mps(act), 0.15)
    style = _elderly(
        act,
        steps_hz=speed / (FOOT_LENGTH * act.height_m),
        half_stance_m=0.0,
        toes_out_rad=0.0,
        ahead_m=0.0,
        lean_rad=0.03,
        sway_m=0.006,
        surge_mps=0.05,
        uneven=0.0,
        stepping_mps=0.5 * speed,
    )
    steps_along_path(act, style)
    act.add(act.wander(0.3, 0.9), spine_roll=0.025)
    act.add(1, abduction=act.uniform(0.2, 0.45))


@_styled("cane")
def walking_with_a_cane(act: StepContext) -> None:
    """The hand at hip height on the cane, the weight shifted towards it over the weak leg on the other side."""
    cane = LEFT if act.hand == "left" or act.foot == "right" else RIGHT
    weak = act.uniform(0.05, 0.1) * (1 if cane == LEFT else -1)  # the leg opposite to the cane strikes late
    steps_along_path(act, _elderly(act, uneven=weak))
    swing = act.controls.arm_rad[:, 1 - cane, 0] - np.mean(act.controls.arm_rad[:, 1 - cane, 0])
    act.arm((0.12, 0.26, 0.0, 0.5), 1.0, cane)
    act.add(-1.1 * swing, cane, flexion=1.0)
    act.add(1, spine_roll=-OUTWARD[cane] * 0.04)


@_styled("rollator")
def walking_with_a_rollator(act: StepContext) -> None:
    """Both hands on grips at hip height ahead of the body, the trunk bent over them."""
    steps_along_path(act, _elderly(act, lean_rad=act.uniform(0.2, 0.32), arm_swing_rad=0.0, twist_rad=0.03))
    act.add(1, head_pitch=0.1)
    act.hand_to(BOTH, (0.2, 0.13, -0.19), 1.0, (-0.8, 0.35, -0.4))


@_styled("pushing")
def walking_behind_a_thing(act: StepContext) -> None:
    """Both hands on the back of a chair that is pushed along, the arms nearly straight, leaning into it."""
    steps_along_path(act, _elderly(act, lean_rad=act.uniform(0.2, 0.3), arm_swing_rad=0.0, twist_rad=0.03))
    act.add(1, head_pitch=-0.1)
    act.hand_to(BOTH, (0.26, 0.11, -0.13), 1.0, (-0.6, 0.4, -0.8))


@_styled("crutches")
def walking_on_crutches(act: StepContext) -> None:
    """Both crutches and the weak leg go ahead together, then the good leg passes between them."""
    weak = act.leg_side()
    style = _elderly(act, uneven=act.uniform(0.12, 0.18) * (1 if weak == RIGHT else -1), lean_rad=0.14)
    steps_along_path(act, replace(style, arm_swing_rad=0.0, twist_rad=0.02))
    ahead = (act.controls.foot_m[:, weak, :2] - act.controls.pelvis_m[:, :2]) * np.stack(
        [np.cos(act.controls.heading_rad), np.sin(act.controls.heading_rad)], axis=1
    )
    with_leg = ahead.sum(axis=1) / (0.2 * act.height_m)
    act.arm((0.1, 0.3, -0.1, 0.45), 1.0)
    act.add(with_leg, flexion=0.32)
    act.add(rise(with_leg), elbow=-0.15)
    act.add(1, head_pitch=0.12)
