"""Irregular gait: sidestepping, limping, staggering, walking lunges, and stumbling after a push."""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.gait import cruise_mps, stepping, walking_style
from mmweaver.motion.animation.library.movement_primitives import leg_side
from mmweaver.motion.animation.profiles import bump, wander
from mmweaver.motion.animation.step_context import StepContext
from mmweaver.motion.language.plan import FALLING_ON

_MOST_OUT_OF_BALANCE = 0.65  # share of a stumble after which the trunk leans most
LUNGES_HZ = (0.58, 0.7, 0.9)  # steps a second of walking lunges: slowly, usually, quickly


def sidestepping(context: StepContext) -> Controls:
    """One foot steps out, the other closes; the feet never cross."""
    speed, h = cruise_mps(context), context.body.height_m
    steps_hz = context.tempo(1.5, 1.8, 2.3)
    style = walking_style(context, max(speed, 0.4))
    style = replace(
        style, steps_hz=steps_hz, half_stance_m=0.05 * h + 0.5 * speed / steps_hz, ahead_m=0.0, heel_strike_rad=0.0,
        toe_off_rad=0.0, arm_swing_rad=0.03, elbow_swing_rad=0.0, pelvis_yaw_rad=0.0, lift_m=0.045, bob_m=0.008,
        sink=0.978, sway_m=0.03,
    )  # fmt: skip
    return stepping(context, style, jog=False)


def limping(context: StepContext) -> Controls:
    """Short on the bad leg, the trunk thrown over it, little swing of the arms."""
    style = walking_style(context, cruise_mps(context))
    bad = leg_side(context)
    lame = float(context.rng.uniform(0.1, 0.17)) * (1 if bad == RIGHT else -1)
    style = replace(
        style, steps_hz=0.86 * style.steps_hz, uneven=lame, arm_swing_rad=0.5 * style.arm_swing_rad,
        toe_off_rad=0.7 * style.toe_off_rad, lean_rad=style.lean_rad + 0.06, sink=0.978,
    )  # fmt: skip
    return stepping(context, style, jog=False)


def staggering(context: StepContext) -> Controls:
    """Feet set wide and unevenly, the body swaying over them, arms loose."""
    style = walking_style(context, cruise_mps(context))
    style = replace(
        style, steps_hz=0.9 * style.steps_hz, weave_m=float(context.rng.uniform(0.05, 0.09)), sink=0.972,
        half_stance_m=1.9 * style.half_stance_m, uneven=float(context.rng.uniform(-0.15, 0.15)), bob_m=0.02,
    )  # fmt: skip
    controls = stepping(context, style, jog=False)
    time_s, rng = context.time_s, context.rng
    controls.spine_rad[:, 0] += 0.12 * wander(time_s, rng, slow_hz=0.25, fast_hz=0.7)
    controls.spine_rad[:, 1] += 0.1 + 0.09 * wander(time_s, rng, slow_hz=0.25, fast_hz=0.7)
    controls.head_rad[:, 0] += 0.15 + 0.12 * wander(time_s, rng, slow_hz=0.25, fast_hz=0.7)
    for side in (LEFT, RIGHT):
        controls.arm_rad[:, side, 0] += 0.2 * wander(time_s, rng, slow_hz=0.4, fast_hz=1.0)
        controls.arm_rad[:, side, 1] += 0.15 + 0.12 * wander(time_s, rng, slow_hz=0.4, fast_hz=1.0)
    return controls


def walking_lunges(context: StepContext) -> Controls:
    """Long slow steps, each of them down until the thigh ahead is nearly level, the heel behind raised."""
    speed, h = max(cruise_mps(context), 0.3), context.body.height_m
    steps_hz = context.tempo(*LUNGES_HZ, spread=0.04)
    style = walking_style(context, 0.8)
    style = replace(
        style, steps_hz=steps_hz, double_support=0.34, ahead_m=0.0, heel_strike_rad=0.2, toe_off_rad=1.7,
        heel_rises=0.42, folded=0.2, half_stance_m=0.045 * h, arm_swing_rad=0.08, elbow_swing_rad=0.0, bob_m=0.075 * h,
        highest=0.72, sink=0.985, surge_mps=0.75 * speed, surge_sharp=0.0, fastest=0.62, lift_m=0.06, sway_m=0.022,
        lean_rad=0.06, pelvis_yaw_rad=0.03, twist_rad=0.05,
    )  # fmt: skip
    return stepping(context, style, jog=False)


def stumbling(context: StepContext) -> Controls:
    """After a push the trunk lags behind, quick steps catch up, and the arms fly out for balance."""
    style = walking_style(context, 1.2)
    style = replace(
        style, steps_hz=context.tempo(2.3, 2.7, 3.0), double_support=0.05, arm_swing_rad=0.1, toe_off_rad=0.35,
        heel_strike_rad=0.05, lift_m=0.05, bob_m=0.01, sink=0.965, half_stance_m=1.5 * style.half_stance_m,
    )  # fmt: skip
    on_spot = context.step.direction == "spot"  # the feet are lifted, though they come down where they were
    if on_spot:
        style = replace(style, spot_lift_m=style.lift_m)
    controls = stepping(context, style, jog=on_spot)
    time_s, jolt = context.time_s, float(context.rng.uniform(0.25, 0.45))
    lasts_s = max(min(context.duration_s, 1.5), 0.9)
    if context.step.style == FALLING_ON:  # it ends where the trunk is farthest ahead of the feet
        lasts_s = context.duration_s / _MOST_OUT_OF_BALANCE
    u = (time_s - context.start_s) / lasts_s
    early, late = bump(u / 0.6), bump((u - 0.3) / 0.7)
    direction = context.moves[0].direction_rad if context.moves else float(controls.heading_rad[0]) + np.pi
    away = direction - controls.heading_rad
    ahead, left = np.cos(away), np.sin(away)
    lean = jolt * (late - 0.8 * early)  # first behind the feet, then ahead of them
    controls.spine_rad[:, 1] += ahead * lean
    controls.spine_rad[:, 0] -= left * lean
    controls.head_rad[:, 0] -= 0.6 * ahead * lean
    for side in (LEFT, RIGHT):
        controls.arm_rad[:, side, 1] += float(context.rng.uniform(0.4, 0.8)) * late
        controls.arm_rad[:, side, 0] += float(context.rng.uniform(0.1, 0.6)) * early + 0.3 * late
        controls.arm_rad[:, side, 3] += 0.5 * (early + late)
    return controls
