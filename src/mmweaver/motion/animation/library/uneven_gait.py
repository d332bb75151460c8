"""Irregular gait: sidestepping, limping, staggering, walking lunges, and stumbling after a push."""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import RIGHT
from mmweaver.motion.animation.library.gait import cruise_mps, steps_along_path, walking_style
from mmweaver.motion.animation.profiles import bump
from mmweaver.motion.animation.spans import MOVEMENTS
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture
from mmweaver.motion.language.plan import FALLING_ON

_MOST_OUT_OF_BALANCE = 0.65  # share of a stumble after which the trunk leans most
LUNGES_HZ = (0.58, 0.7, 0.9)  # steps per second of walking lunges: slowly, usually, quickly


@posture("sidestep", stands=False)
def sidestepping(act: StepContext) -> None:
    """One foot steps out, the other closes; the feet never cross."""
    speed, steps_hz = cruise_mps(act), act.tempo(1.5, 1.8, 2.3)
    style = replace(
        walking_style(act, max(speed, 0.4)),
        steps_hz=steps_hz,
        half_stance_m=0.05 * act.height_m + 0.5 * speed / steps_hz,
        **MOVEMENTS["sidestep"],
    )
    steps_along_path(act, style)


@posture("limp", stands=False)
def limping(act: StepContext) -> None:
    """Short stance on the bad leg, the trunk shifted over it, little arm swing."""
    style = walking_style(act, cruise_mps(act))
    bad = act.leg_side()
    style = replace(
        style,
        steps_hz=0.86 * style.steps_hz,
        uneven=act.uniform(0.1, 0.17) * (1 if bad == RIGHT else -1),
        arm_swing_rad=0.5 * style.arm_swing_rad,
        toe_off_rad=0.7 * style.toe_off_rad,
        lean_rad=style.lean_rad + 0.06,
        **MOVEMENTS["limp"],
    )
    steps_along_path(act, style)


@posture("stagger", stands=False)
def staggering(act: StepContext) -> None:
    """Feet set wide and unevenly, the body swaying over them, arms loose."""
    style = walking_style(act, cruise_mps(act))
    style = replace(
        style,
        steps_hz=0.9 * style.steps_hz,
        weave_m=act.uniform(0.05, 0.09),
        half_stance_m=1.9 * style.half_stance_m,
        uneven=act.uniform(-0.15, 0.15),
        **MOVEMENTS["stagger"],
    )
    steps_along_path(act, style)
    act.add(act.wander(0.25, 0.7), spine_roll=0.12)
    act.add(1, spine_pitch=0.1 + 0.09 * act.wander(0.25, 0.7))
    act.add(1, head_pitch=0.15 + 0.12 * act.wander(0.25, 0.7))
    for side in BOTH:
        act.add(act.wander(0.4, 1.0), side, flexion=0.2)
        act.add(1, side, abduction=0.15 + 0.12 * act.wander(0.4, 1.0))


@posture("walking_lunge", stands=False)
def walking_lunges(act: StepContext) -> None:
    """Long slow steps, each of them down until the thigh ahead is nearly level, the heel behind raised."""
    speed, h = max(cruise_mps(act), 0.3), act.height_m
    steps_hz = act.tempo(*LUNGES_HZ, spread=0.04)
    style = replace(
        walking_style(act, 0.8),
        steps_hz=steps_hz,
        half_stance_m=0.045 * h,
        bob_m=0.075 * h,
        surge_mps=0.75 * speed,
        **MOVEMENTS["walking_lunge"],
    )
    steps_along_path(act, style)


@posture("stumble", stands=False)
def stumbling(act: StepContext) -> None:
    """After a push the trunk lags behind, quick steps catch up, and the arms fly out for balance."""
    style = walking_style(act, 1.2)
    on_spot = act.direction == "spot"  # the feet are lifted but land in place
    style = replace(
        style,
        steps_hz=act.tempo(2.3, 2.7, 3.0),
        half_stance_m=1.5 * style.half_stance_m,
        spot_lift_m=0.05 if on_spot else style.spot_lift_m,
        **MOVEMENTS["stumble"],
    )
    steps_along_path(act, style, jog=on_spot, on_spot=on_spot)
    jolt, lasts_s = act.uniform(0.25, 0.45), max(min(act.duration_s, 1.5), 0.9)
    if act.style == FALLING_ON:  # ends with the trunk farthest ahead of the feet
        lasts_s = act.duration_s / _MOST_OUT_OF_BALANCE
    u = (act.time_s - act.start_s) / lasts_s
    early, late = bump(u / 0.6), bump((u - 0.3) / 0.7)
    heading = act.controls.heading_rad
    away = (act.moves[0].direction_rad if act.moves else float(heading[0]) + np.pi) - heading
    lean = jolt * (late - 0.8 * early)  # first behind the feet, then ahead of them
    act.add(lean, spine_pitch=np.cos(away), spine_roll=-np.sin(away), head_pitch=-0.6 * np.cos(away))
    for side in BOTH:
        act.add(late, side, abduction=act.uniform(0.4, 0.8))
        act.add(1, side, flexion=act.uniform(0.1, 0.6) * early + 0.3 * late, elbow=0.5 * (early + late))
