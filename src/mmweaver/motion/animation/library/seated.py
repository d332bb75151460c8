"""Exercises and movements of a sitting person: knee extension, marching, leaning, reaching down, crossing the legs."""

import numpy as np

from mmweaver.motion.animation.controls import OUTWARD
from mmweaver.motion.animation.library.legs import there_and_back
from mmweaver.motion.animation.library.sitting import sitting
from mmweaver.motion.animation.profiles import PerTime, rise
from mmweaver.motion.animation.step_context import StepContext, posture


def _swing_shank(act: StepContext, side: int, angle_rad: PerTime) -> None:
    """Extends a knee by an angle (n,) over a resting thigh: the foot goes ahead and up about the knee."""
    shank_m = act.body.shank_m
    act.move_foot(side, shank_m * np.sin(angle_rad), 0.0, shank_m * (1 - np.cos(angle_rad)))
    act.add(rise(4 * angle_rad), side, contact=-1)
    act.add(-0.6 * angle_rad, side, foot_pitch=1)


@posture("knee_extension")
def extending_a_knee(act: StepContext) -> None:
    """The shank swings up until the leg is nearly straight, and down again, the thigh resting on the seat."""
    sitting(act)
    side, up = act.leg_side(), there_and_back(act, 2.4, 1.1, 4.0)
    _swing_shank(act, side, min(act.vary(1.3, 0.05), 1.4) * up)
    act.add(up, spine_pitch=-0.06)


@posture("seated_march")
def marching_seated(act: StepContext) -> None:
    """One knee and then the other rises from the seat."""
    sitting(act)
    h, first, high = act.height_m, act.leg_side(), act.vary(0.085, 0.1)
    for k, span in enumerate(act.in_turn(0.75, 0.45, 1.3, fewest=2)):
        side, up = first if k % 2 == 0 else 1 - first, span.plateau(0, 1, 0.45, 0.45)
        act.move_foot(side, 0.01 * h * up, 0.0, high * h * up)
        act.add(rise(4 * up), side, contact=-1)
        act.add(up, side, foot_pitch=0.2)
        act.add(up, 1 - side, flexion=0.12)
        act.add(up, spine_roll=OUTWARD[side] * 0.02)


@posture("seated_lean")
def leaning_seated(act: StepContext) -> None:
    """The trunk of a sitter leans forward, back or to a side from the hips, stays a moment and comes up."""
    sitting(act)
    down, deep = there_and_back(act, 3.0, 1.4, 5.0), act.vary(0.55, 0.1)
    if act.direction in ("left", "right"):
        right = -1.0 if act.direction == "left" else 1.0
        act.add(deep * down, pelvis_roll=0.12 * right, spine_roll=0.8 * right)
    elif act.direction == "backwards":
        act.add(deep * down, pelvis_pitch=-0.55, spine_pitch=-0.1, head_pitch=0.3)
    else:
        act.add(deep * down, pelvis_pitch=1.0, spine_pitch=0.3, head_pitch=-0.4)
        act.add(deep * down, flexion=0.5)


@posture("seated_reach")
def reaching_down_seated(act: StepContext) -> None:
    """Over the knees until the hands are near the floor, and up again."""
    sitting(act)
    down = there_and_back(act, 3.2, 1.8, 5.0)
    act.add(down, pelvis_pitch=0.95, spine_pitch=0.65, head_pitch=-0.3)
    for side in act.sides():
        act.arm((1.5, 0.12, 0.0, 0.1), down, side)


@posture("cross_legs")
def crossing_legs(act: StepContext) -> None:
    """Sitting with one thigh over the other."""
    sitting(act)
    h, side = act.height_m, act.leg_side()
    over = act.edges(1.1, 1.1) if not act.first else rise((act.time_s - act.start_s - 0.3) / 1.2)
    act.move_foot(side, 0.06 * h * over, -0.14 * h * over, 0.13 * h * over)
    act.add(rise(3 * over), side, contact=-1)
    act.add(over, side, foot_pitch=0.35, knee_out=-0.35)
    act.add(over, pelvis_roll=OUTWARD[side] * -0.03, spine_pitch=-0.04)
