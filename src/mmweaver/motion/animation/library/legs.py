"""On the spot with the legs: kicks, stamps, lifted legs, standing and hopping on one, hopping, lunges, marching."""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library import gait
from mmweaver.motion.animation.library.jumping import bounce
from mmweaver.motion.animation.library.limbs import (
    OUTWARD,
    crouched,
    flowing,
    lean_over,
    leg_side,
    lift_weight,
    repeats,
    shift_foot,
    shift_pelvis,
    vary,
)  # fmt: skip
from mmweaver.motion.animation.library.standing import upright
from mmweaver.motion.animation.profiles import plateau, rise
from mmweaver.motion.animation.step_context import StepContext


def kicking(stage: StepContext) -> Controls:
    """Weight onto one leg, the other swings back, shoots forward with the knee stretching, and comes back."""
    controls, time_s, h = upright(stage), stage.time_s, stage.body.height_m
    side = leg_side(stage)
    high = float(stage.rng.uniform(0.1, 0.3)) if stage.step.style != "high" else float(stage.rng.uniform(0.38, 0.46))
    reach = np.sqrt(0.44**2 - max(0.43 - high, 0.0) ** 2) if high < 0.43 else 0.42
    for begin, lasts in repeats(stage, 1.35, 1.0, 1.9):
        at = [begin + share * lasts for share in (0.0, 0.2, 0.36, 0.6, 0.78, 1.0)]
        ahead = flowing(time_s, at, [0.0, -0.08, -0.16, 0.95 * reach, 0.12, 0.0])
        up = flowing(time_s, at, [0.0, 0.045, 0.1, high, 0.14, 0.0])
        over = plateau(time_s, begin - 0.12 * lasts, begin + 1.1 * lasts, 0.32 * lasts, 0.34 * lasts)
        air = plateau(time_s, begin, begin + lasts, 0.16 * lasts, 0.16 * lasts)
        swing = plateau(time_s, begin + 0.32 * lasts, begin + 0.9 * lasts, 0.28 * lasts, 0.3 * lasts)
        shift_foot(controls, side, ahead * h, -0.02 * h * over, np.maximum(up, 0.0) * h)
        lean_over(controls, stage.body, 1 - side, over)
        lift_weight(controls, side, air)
        shift_pelvis(controls, 0.0, 0.0, -0.012 * h * over)
        controls.foot_rad[:, side, 1] += flowing(time_s, at, [0.0, 0.5, 0.8, -0.25, 0.1, 0.0])
        controls.pelvis_rad[:, 1] -= 0.22 * swing
        controls.spine_rad[:, 1] += 0.12 * swing
        controls.pelvis_rad[:, 2] += OUTWARD[1 - side] * 0.25 * swing
        for arm in (LEFT, RIGHT):
            controls.arm_rad[:, arm, 0] += (0.7 if arm != side else -0.45) * swing
            controls.arm_rad[:, arm, 1] += 0.35 * over
            controls.arm_rad[:, arm, 3] += 0.5 * over
    return controls


def stamping(stage: StepContext) -> Controls:
    """One knee goes up and the foot comes down hard, flat."""
    controls, time_s, h = upright(stage), stage.time_s, stage.body.height_m
    side = leg_side(stage)
    for begin, lasts in repeats(stage, 0.95, 0.75, 1.4):
        at = [begin, begin + 0.42 * lasts, begin + 0.86 * lasts]
        up = flowing(time_s, at, [0.0, vary(stage, 0.13, 0.08), 0.0])
        over = plateau(time_s, begin - 0.15 * lasts, begin + 1.05 * lasts, 0.4 * lasts, 0.3 * lasts)
        shift_foot(controls, side, 0.05 * h * np.maximum(up, 0) / 0.15, 0.0, np.maximum(up, 0.0) * h)
        lean_over(controls, stage.body, 1 - side, over)
        lift_weight(controls, side, plateau(time_s, begin, begin + 0.8 * lasts, 0.2 * lasts, 0.2 * lasts))
        controls.foot_rad[:, side, 1] += 0.25 * np.maximum(up, 0.0) / 0.15
    return controls


def raising_leg(stage: StepContext) -> Controls:
    """The knee comes up in front, thigh about level, and goes down again."""
    controls, time_s = upright(stage), stage.time_s
    side = leg_side(stage)
    high = float(stage.rng.uniform(0.16, 0.24))
    count = max(stage.step.count, 1)
    for begin, lasts in repeats(stage, max(1.9, min(stage.duration_s / count, 4.0)), 1.2, 4.5):
        move = min(0.42 * lasts, 0.95)
        _lift_leg(controls, stage, side, plateau(time_s, begin, begin + lasts, move, move), high)
    return controls


def _lift_leg(controls: Controls, stage: StepContext, side: int, share: np.ndarray, high: float) -> None:
    h = stage.body.height_m
    over = rise(np.clip(2.5 * share, 0, 1))
    shift_foot(controls, side, 0.13 * h * share * (high / 0.2), -0.01 * h * share, high * h * share)
    lean_over(controls, stage.body, 1 - side, over)
    shift_pelvis(controls, 0.0, 0.0, -0.008 * h * over)
    lift_weight(controls, side, over)
    controls.foot_rad[:, side, 1] += 0.35 * share
    controls.spine_rad[:, 1] += 0.05 * share
    for arm in (LEFT, RIGHT):
        controls.arm_rad[:, arm, 1] += 0.35 * over


def on_one_leg(stage: StepContext) -> Controls:
    """Balancing on one leg, the arms out and never quite still."""
    controls, time_s = upright(stage), stage.time_s
    side = 1 - leg_side(stage) if stage.step.foot else int(stage.rng.integers(2))
    begin = stage.start_s if not stage.first else stage.time_s[0] - 2.0
    end = stage.end_s if not stage.last else stage.time_s[-1] + 2.0
    up = plateau(time_s, float(begin), float(end), 0.8, 0.8)
    _lift_leg(controls, stage, side, up, float(stage.rng.uniform(0.1, 0.2)))
    rate = 2 * np.pi * stage.rng.uniform(0.5, 0.9)
    wobble = up * (np.sin(rate * time_s) + 0.6 * np.sin(1.7 * rate * time_s + 1.0))
    out = float(stage.rng.uniform(0.2, 0.8))
    controls.spine_rad[:, 0] += 0.035 * wobble
    shift_pelvis(controls, 0.0, 0.006 * wobble, 0.0)
    for arm, sign in ((LEFT, 1.0), (RIGHT, -1.0)):
        controls.arm_rad[:, arm, 1] += up * out + 0.12 * sign * wobble
    return controls


def hopping_on_one_leg(stage: StepContext) -> Controls:
    """The other leg stays lifted behind; the body leans over the leg that hops."""
    controls, time_s = upright(stage), stage.time_s
    side = 1 - leg_side(stage) if stage.step.foot else int(stage.rng.integers(2))
    ready, h = 0.55, stage.body.height_m
    start = stage.start_s if not stage.first else stage.start_s - ready
    up = plateau(time_s, start, stage.end_s + 0.6, ready, 0.6) if not stage.last else rise((time_s - start) / ready)
    inner = replace(stage, step=replace(stage.step, start_s=start + ready))
    high = controls.pelvis_m[:, 2].copy()
    bounce(controls, inner, one_leg=True)
    bob = controls.pelvis_m[:, 2] - high
    back = float(stage.rng.uniform(0.12, 0.2))
    shift_foot(
        controls, side, -back * h * up, -0.01 * h * up, up * (0.14 * h + 0.5 * bob) - controls.foot_m[:, side, 2] * up
    )
    lean_over(controls, stage.body, 1 - side, up)
    lift_weight(controls, side, np.minimum(up, controls.contact[:, side]))
    controls.foot_rad[:, side, 1] += 0.7 * up
    for arm in (LEFT, RIGHT):
        controls.arm_rad[:, arm, 1] += 0.45 * up
        controls.arm_rad[:, arm, 3] += 0.5 * up
    return controls


def lunging(stage: StepContext) -> Controls:
    """A long step ahead with one leg, down until its thigh is nearly level, and back."""
    controls, time_s, h = upright(stage), stage.time_s, stage.body.height_m
    side = leg_side(stage)
    long = vary(stage, 0.38, 0.06)
    for k, (begin, lasts) in enumerate(repeats(stage, 2.2, 1.6, 3.2)):
        acting = side if k % 2 == 0 or stage.step.foot else 1 - side
        gone = plateau(time_s, begin, begin + lasts, 0.3 * lasts, 0.3 * lasts)
        air = plateau(time_s, begin, begin + 0.3 * lasts, 0.14 * lasts, 0.14 * lasts)
        air = air + plateau(time_s, begin + 0.7 * lasts, begin + lasts, 0.14 * lasts, 0.14 * lasts)
        down = plateau(time_s, begin + 0.12 * lasts, begin + 0.88 * lasts, 0.36 * lasts, 0.36 * lasts)
        shift_foot(controls, acting, long * h * gone, 0.0, 0.05 * h * air)
        lift_weight(controls, acting, air)
        shift_pelvis(controls, 0.5 * long * h * gone, 0.0, -0.165 * h * down)
        controls.foot_rad[:, 1 - acting, 1] += 0.75 * down
        controls.spine_rad[:, 1] += 0.06 * down
    return controls


def crouching(stage: StepContext) -> Controls:
    """Down into a deep crouch, and staying there."""
    controls, time_s = upright(stage), stage.time_s
    down = rise((time_s - stage.start_s) / min(1.2, 0.8 * stage.duration_s))
    if not stage.last:
        down = down * rise((stage.end_s + 0.3 - time_s) / 0.9)
    crouched(controls, stage.body, down * float(stage.rng.uniform(0.8, 0.95)), lean_rad=0.9)
    controls.arm_rad[:, :, 0] += (0.9 * down)[:, None]
    controls.arm_rad[:, :, 3] += (0.6 * down)[:, None]
    return controls


def marching(stage: StepContext) -> Controls:
    """High knees on the spot, arms swinging with the other leg."""
    style = gait.walking_style(stage, 1.3)
    style = replace(
        style, steps_hz=stage.tempo(1.5, 1.85, 2.2), double_support=0.12,
        spot_lift_m=float(stage.rng.uniform(0.13, 0.2)),
        arm_swing_rad=float(stage.rng.uniform(0.35, 0.6)), elbow_rad=0.7, bob_m=0.01, sink=0.988,
    )  # fmt: skip
    spot = replace(stage, step=replace(stage.step, direction="spot"))
    return gait.stepping(spot, style, jog=True)
