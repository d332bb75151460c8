"""Falls as people record them: fainting, slipping, out of a bed, and lying there after an attempt to get up.

A collapse takes about two seconds, longer than a fall; a slip is as fast as one, the feet sliding ahead of the body.
"""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import blend
from mmweaver.motion.animation.library.on_furniture import OFF_SEAT_AHEAD_M, lying_on_seat
from mmweaver.motion.animation.library.on_the_floor import LYING_M, lie_down, lie_down_on_side
from mmweaver.motion.animation.profiles import bump, plateau, rise
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture


@posture("collapse")
def collapsing(act: StepContext) -> None:
    """The knees give way, the body sinks over its feet, the head hanging, and tips onto a side."""
    u = act.since_start(1.7, 3.4, 2.4, 1.8, 0.9)
    if act.style not in ("left", "right"):
        lie_down(act, u)
        return
    h = act.height_m
    lie_down_on_side(act, u, "collapse", (0.3 * h, 0.18 * h, 0.115 * h, (LYING_M + 0.025) * h))


@posture("slip")
def slipping(act: StepContext) -> None:
    """The feet slide away ahead, one of them off the floor, the arms fly up, and the body lands on the back."""
    h, u = act.height_m, act.since_start(1.1, 1.6, 1.3, 1.1, 0.85)
    lie_down(act, u, falls=True)
    slides, side = plateau(u, 0.0, 1.05, 0.3, 0.4), act.leg_side()
    for foot in BOTH:
        act.move_foot(foot, (0.3 if foot == side else 0.2) * h * slides)
    flies = bump((u - 0.05) / 0.7)
    act.move_foot(side, up=0.13 * h * flies)
    act.add(rise(3 * flies), side, contact=-1)
    act.add(flies, flexion=0.5, abduction=0.5)
    act.add(flies, foot_pitch=-0.3)
    act.pelvis(0.16 * h * slides)


@posture("fall_out_of_bed")
def falling_out_of_bed(act: StepContext) -> None:
    """From lying along the edge: the body rolls over it and lands next to the bed on its side."""
    u = np.clip(act.since_start(1.1, 1.9, 1.4, 1.1, 0.9), 0.0, 1.0)
    lying_on_seat(act)
    fallen = replace(act)
    fallen.stand()
    lie_down_on_side(fallen, np.ones_like(u))
    fallen.pelvis(OFF_SEAT_AHEAD_M)
    for side in BOTH:
        fallen.move_foot(side, OFF_SEAT_AHEAD_M)
    weight = rise(u)
    feet = np.repeat(weight[:, None], 2, axis=1)
    act.controls = blend([act.controls, fallen.controls], [1 - weight, weight], [1 - feet, feet])
    act.pelvis(ahead=0.12 * act.height_m * bump(u))


@posture("try_to_get_up")
def trying_to_get_up(act: StepContext) -> None:
    """From lying the trunk comes up, stays a moment, and sinks back, as often as stated."""
    least = {"front": 0.72, "left": 0.62, "right": 0.62}.get(act.style, 0.6)
    up = np.sum([span.plateau(0.05, 0.95, 0.4, 0.3) for span in act.in_turn(3.4, 2.2, 4.5)], axis=0)
    lie_down(act, 1 - (1 - act.uniform(least, least + 0.06)) * up)
