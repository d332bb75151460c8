"""Exercises of a workout: high knees, mountain climbers, burpees, pull-ups, leg raises lying."""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, blend
from mmweaver.motion.animation.library.floor_exercises import support_on_hands
from mmweaver.motion.animation.library.gait import steps_along_path, walking_style
from mmweaver.motion.animation.library.legs import there_and_back
from mmweaver.motion.animation.library.on_the_floor import lying
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, bump, rise
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

_HANG, _PULL = 0.08, 0.2  # of the height: hanging above standing, and from hanging to the chin over the bar
_BAR_OVER_CHEST = 0.37  # bar above spine3 of a hanging body


@posture("high_knees", stands=False)
def running_with_high_knees(act: StepContext) -> None:
    """On the spot, fast, every knee up to hip height, the arms pumping."""
    style = replace(
        walking_style(act, 1.3),
        steps_hz=act.tempo(2.0, 2.5, 3.0),
        spot_lift_m=act.uniform(0.2, 0.23) * act.height_m,
        arm_swing_rad=act.uniform(0.5, 0.7),
        **{**MOVEMENTS["march"], "elbow_rad": 1.5},
    )
    steps_along_path(act, style, jog=True, on_spot=True)
    for side in BOTH:
        act.move_foot(side, 0.75 * act.controls.foot_m[:, side, 2])  # below a thigh that is level


@posture("mountain_climbers", stands=False)
def climbing_mountains(act: StepContext) -> None:
    """Support on hands and toes, one knee and then the other drawn to the chest."""
    act.stand()
    support_on_hands(act, np.zeros_like(act.time_s))
    h, first = act.height_m, act.leg_side()
    for k, span in enumerate(act.in_turn(0.6, 0.4, 1.1, fewest=2)):
        side, drawn = first if k % 2 == 0 else 1 - first, span.plateau(0, 1, 0.45, 0.45)
        act.move_foot(side, 0.26 * h * drawn, 0.0, 0.035 * h * drawn)
        act.add(rise(4 * drawn), side, contact=-1)
        act.pelvis(up=0.015 * h * drawn)


@posture("burpee")
def burpees(act: StepContext) -> None:
    """Down into a squat, the feet back into a plank, forward into the squat again, and a jump."""
    planked, flat = replace(act), np.zeros_like(act.time_s)
    planked.stand()
    support_on_hands(planked, flat)
    h, spans = act.height_m, act.repeats(3.2, 2.4, 4.2)
    down, plank, flight, reach = flat, flat, flat, flat
    for span in spans:
        down = down + span.plateau(0.0, 0.8, 0.24, 0.16)
        plank = plank + span.plateau(0.2, 0.66, 0.16, 0.16)
        reach = reach + span.plateau(0.72, 1.0, 0.14, 0.14)
        flight = flight + bump((span.progress() - 0.79) / 0.2)
    act.crouch(0.92 * down, lean_rad=1.35)
    act.arm((1.35, 0.15, 0.0, 0.1), down)
    feet = np.repeat(plank[:, None], 2, axis=1)
    act.controls = blend([act.controls, planked.controls], [1 - plank, plank], [1 - feet, feet])
    act.pelvis(up=0.115 * h * flight)
    act.arm((1.4, 0.3, 0.0, 0.4), 0.8 * reach)
    for side in BOTH:
        act.move_foot(side, up=0.105 * h * flight)
        act.add(flight, side, foot_pitch=0.6, contact=-1)


@posture("pull_ups")
def pull_ups(act: StepContext) -> None:
    """Hanging from a bar out of the picture, up until the chin is over it, and down to straight arms."""
    h, on = act.height_m, act.plateau(act.start_s, act.end_s, 0.7, 0.7)
    count, lasts_s = act.count, act.duration_s - 1.6
    part = replace(act, step=replace(act.step, start_s=act.start_s + 0.8, end_s=act.start_s + 0.8 + lasts_s))
    pull: PerTime = there_and_back(part, 2.4, 1.2, 4.0) if count or lasts_s > 1.2 else np.zeros_like(on)
    up = _HANG * on + _PULL * pull
    act.pelvis(up=h * up)
    act.hand_to(BOTH, (0.06, 0.14, _BAR_OVER_CHEST - _PULL * pull), on, (0.2, 0.8, -0.4))
    for side in BOTH:
        act.move_foot(side, -0.06 * h * on, 0.0, h * up)
        act.add(on, side, contact=-1, foot_pitch=0.7)
    act.add(pull, head_pitch=-0.15)
    act.bend_knees(on)


@posture("lying_leg_raise")
def raising_a_leg_lying(act: StepContext) -> None:
    """On a side the upper leg, straight, goes up; on the back either leg."""
    lying(act)
    h, up, on = act.height_m, there_and_back(act, 2.4, 1.3, 4.0), act.edges(0.5, 0.5)
    if act.style in ("left", "right"):
        side = RIGHT if act.style == "left" else LEFT
        act.move_foot(side, 0.0, (0.14 * on - 0.06 * up) * h, (0.05 * on + 0.28 * up) * h)
    else:
        side = act.leg_side()
        act.move_foot(side, 0.1 * h * on - 0.02 * h * up, 0.0, 0.36 * h * up)
        act.add(up, side, foot_pitch=-0.9)
    act.add(rise(2 * up + on), side, contact=-1)
