"""Leg activities on the spot: kicks, stamps, raised legs, standing and hopping on one leg, lunges, marching."""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library import gait
from mmweaver.motion.animation.library.jumping import bounce
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    crouched,
    cycles,
    lean_over,
    leg_side,
    lift_weight,
    repeats,
    shift_foot,
    shift_pelvis,
    spline_through,
    vary,
)  # fmt: skip
from mmweaver.motion.animation.library.standing import upright
from mmweaver.motion.animation.profiles import bump, plateau, rise
from mmweaver.motion.animation.step_context import StepContext
from mmweaver.motion.language.plan import Shape


def kicking(context: StepContext) -> Controls:
    """Weight on one leg; the other swings back, shoots forward with the knee extending, and comes back.

    In a kick to the back it shoots out behind the body, which leans ahead.
    """
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    side = leg_side(context)
    high = (
        float(context.rng.uniform(0.1, 0.3)) if context.step.style != "high" else float(context.rng.uniform(0.38, 0.46))
    )
    backwards = context.step.style == "back"
    leans_back = -0.75 if backwards else 1.0
    reach = np.sqrt(0.44**2 - max(0.43 - high, 0.0) ** 2) if high < 0.43 else 0.42
    for begin, lasts in repeats(context, 1.35, 1.0, 1.9):
        at = [begin + share * lasts for share in (0.0, 0.2, 0.36, 0.6, 0.78, 1.0)]
        way = [0.0, 0.0, 0.03, -0.75 * reach, -0.1, 0.0] if backwards else [0.0, -0.08, -0.16, 0.95 * reach, 0.12, 0.0]
        ahead = spline_through(time_s, at, way)
        up = spline_through(time_s, at, [0.0, 0.045, 0.1, high, 0.14, 0.0])
        over = plateau(time_s, begin - 0.12 * lasts, begin + 1.1 * lasts, 0.32 * lasts, 0.34 * lasts)
        air = plateau(time_s, begin, begin + lasts, 0.16 * lasts, 0.16 * lasts)
        swing = plateau(time_s, begin + 0.32 * lasts, begin + 0.9 * lasts, 0.28 * lasts, 0.3 * lasts)
        shift_foot(controls, side, ahead * h, -0.02 * h * over, np.maximum(up, 0.0) * h)
        lean_over(controls, context.body, 1 - side, over)
        lift_weight(controls, side, air)
        shift_pelvis(controls, 0.0, 0.0, -0.012 * h * over)
        controls.foot_rad[:, side, 1] += spline_through(time_s, at, [0.0, 0.5, 0.8, -0.25, 0.1, 0.0])
        controls.pelvis_rad[:, 1] -= 0.22 * leans_back * swing
        controls.spine_rad[:, 1] += 0.12 * leans_back * swing
        controls.pelvis_rad[:, 2] += OUTWARD[1 - side] * 0.25 * swing
        for arm in (LEFT, RIGHT):
            controls.arm_rad[:, arm, 0] += (0.7 if arm != side else -0.45) * swing
            controls.arm_rad[:, arm, 1] += 0.35 * over
            controls.arm_rad[:, arm, 3] += 0.5 * over
    return controls


def stamping(context: StepContext) -> Controls:
    """One knee goes up and the foot comes down hard and flat."""
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    side = leg_side(context)
    for begin, lasts in repeats(context, 0.95, 0.75, 1.4):
        at = [begin, begin + 0.42 * lasts, begin + 0.86 * lasts]
        up = spline_through(time_s, at, [0.0, vary(context, 0.13, 0.08), 0.0])
        over = plateau(time_s, begin - 0.15 * lasts, begin + 1.05 * lasts, 0.4 * lasts, 0.3 * lasts)
        shift_foot(controls, side, 0.05 * h * np.maximum(up, 0) / 0.15, 0.0, np.maximum(up, 0.0) * h)
        lean_over(controls, context.body, 1 - side, over)
        lift_weight(controls, side, plateau(time_s, begin, begin + 0.8 * lasts, 0.2 * lasts, 0.2 * lasts))
        controls.foot_rad[:, side, 1] += 0.25 * np.maximum(up, 0.0) / 0.15
    return controls


def raising_leg(context: StepContext) -> Controls:
    """The knee comes up in front until the thigh is about level, and goes down again."""
    controls, time_s = upright(context), context.time_s
    side = leg_side(context)
    high = float(context.rng.uniform(0.16, 0.24))
    count = max(context.step.count, 1)
    for begin, lasts in repeats(context, max(1.9, min(context.duration_s / count, 4.0)), 1.2, 4.5):
        move = min(0.42 * lasts, 0.95)
        _lift_leg(controls, context, side, plateau(time_s, begin, begin + lasts, move, move), high)
    return controls


def _lift_leg(controls: Controls, context: StepContext, side: int, share: np.ndarray, high: float) -> None:
    """Raises a leg by `high` (of the body height) as `share` (n,) goes to 1, with the weight on the other."""
    h = context.body.height_m
    over = rise(np.clip(2.5 * share, 0, 1))
    shift_foot(controls, side, 0.13 * h * share * (high / 0.2), -0.01 * h * share, high * h * share)
    lean_over(controls, context.body, 1 - side, over)
    shift_pelvis(controls, 0.0, 0.0, -0.008 * h * over)
    lift_weight(controls, side, over)
    controls.foot_rad[:, side, 1] += 0.35 * share
    controls.spine_rad[:, 1] += 0.05 * share
    for arm in (LEFT, RIGHT):
        controls.arm_rad[:, arm, 1] += 0.35 * over


def on_one_leg(context: StepContext) -> Controls:
    """Balancing on one leg, the arms out and never quite still."""
    controls, time_s = upright(context), context.time_s
    side = 1 - leg_side(context) if context.step.foot else int(context.rng.integers(2))
    begin = context.start_s if not context.first else context.time_s[0] - 2.0
    end = context.end_s if not context.last else context.time_s[-1] + 2.0
    up = plateau(time_s, float(begin), float(end), 0.8, 0.8)
    _lift_leg(controls, context, side, up, float(context.rng.uniform(0.1, 0.2)))
    rate = 2 * np.pi * context.rng.uniform(0.5, 0.9)
    wobble = up * (np.sin(rate * time_s) + 0.6 * np.sin(1.7 * rate * time_s + 1.0))
    out = float(context.rng.uniform(0.2, 0.8))
    controls.spine_rad[:, 0] += 0.035 * wobble
    shift_pelvis(controls, 0.0, 0.006 * wobble, 0.0)
    for arm, sign in ((LEFT, 1.0), (RIGHT, -1.0)):
        controls.arm_rad[:, arm, 1] += up * out + 0.12 * sign * wobble
    return controls


def hopping_on_one_leg(context: StepContext) -> Controls:
    """The other leg stays lifted behind; the body leans over the leg that hops."""
    controls, time_s = upright(context), context.time_s
    side = 1 - leg_side(context) if context.step.foot else int(context.rng.integers(2))
    ready, h = 0.55, context.body.height_m
    start = context.start_s if not context.first else context.start_s - ready
    up = plateau(time_s, start, context.end_s + 0.6, ready, 0.6) if not context.last else rise((time_s - start) / ready)
    inner = replace(context, step=replace(context.step, start_s=start + ready))
    high = controls.pelvis_m[:, 2].copy()
    bounce(controls, inner, one_leg=True)
    bob = controls.pelvis_m[:, 2] - high
    back = float(context.rng.uniform(0.12, 0.2))
    shift_foot(
        controls, side, -back * h * up, -0.01 * h * up, up * (0.14 * h + 0.5 * bob) - controls.foot_m[:, side, 2] * up
    )
    lean_over(controls, context.body, 1 - side, up)
    lift_weight(controls, side, np.minimum(up, controls.contact[:, side]))
    controls.foot_rad[:, side, 1] += 0.7 * up
    for arm in (LEFT, RIGHT):
        controls.arm_rad[:, arm, 1] += 0.45 * up
        controls.arm_rad[:, arm, 3] += 0.5 * up
    return controls


def lunging(context: StepContext) -> Controls:
    """A long step ahead with one leg, down until the thigh is nearly level, and back.

    A front lunge leaves the leg behind straight and goes less deep, again and again; half of those who do it keep both
    feet where they are in between, and many turn to the side of the leg ahead, as the first subject of MARS does.
    """
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    side, is_front = leg_side(context), context.step.style == "frontlunge"
    long, deep = vary(context, 0.38, 0.06), 0.165
    ahead, heel_rad, stays = 0.5, 0.75, False
    if is_front:
        long, deep, ahead, heel_rad = vary(context, 0.36, 0.06), vary(context, 0.068, 0.1), 0.68, 0.1
        context, stays = _repeated(context, 3.0), context.rng.random() < 0.5
        if context.step.foot:
            _turn_aside(controls, context, side)
    every = repeats(context, 3.0 if is_front else 2.2, 1.6, 3.6)
    if stays:
        _from_planted_feet(controls, context, every, side if context.step.foot else RIGHT, 0.85 * long * h, deep * h)
        return controls
    for k, (begin, lasts) in enumerate(every):
        acting = side if k % 2 == 0 or context.step.foot else 1 - side
        gone = plateau(time_s, begin, begin + lasts, 0.3 * lasts, 0.3 * lasts)
        air = plateau(time_s, begin, begin + 0.3 * lasts, 0.14 * lasts, 0.14 * lasts)
        air = air + plateau(time_s, begin + 0.7 * lasts, begin + lasts, 0.14 * lasts, 0.14 * lasts)
        down = plateau(time_s, begin + 0.12 * lasts, begin + 0.88 * lasts, 0.36 * lasts, 0.36 * lasts)
        shift_foot(controls, acting, long * h * gone, 0.0, 0.05 * h * air)
        lift_weight(controls, acting, air)
        controls.knee_room[:] = np.maximum(controls.knee_room, 0.8 * gone)
        shift_pelvis(controls, ahead * long * h * gone, 0.0, -deep * h * down)
        controls.foot_rad[:, 1 - acting, 1] += heel_rad * down
        controls.spine_rad[:, 1] += 0.06 * down
    return controls


def _turn_aside(controls: Controls, context: StepContext, side: int) -> None:
    """Turns the body to the side of the leg that goes ahead, by up to 45 degrees, while the step lasts."""
    turned = context.rng.uniform(0.0, 0.8) * plateau(context.time_s, context.start_s, context.end_s, 0.5, 0.5)
    controls.heading_rad[:] += OUTWARD[side] * turned
    controls.foot_rad[:, :, 0] += OUTWARD[side] * turned[:, None]


def _from_planted_feet(
    controls: Controls, context: StepContext, every: list[tuple[float, float]], side: int, long_m: float, deep_m: float
) -> None:
    """One step ahead; then the weight goes from between the feet over the leg ahead, again and again, and back."""
    time_s, step_s = context.time_s, min(0.6, 0.15 * context.duration_s)
    start_s, end_s = context.start_s, context.end_s
    gone = plateau(time_s, start_s, end_s, step_s, step_s)
    air = sum(plateau(time_s, at, at + step_s, 0.5 * step_s, 0.5 * step_s) for at in (start_s, end_s - step_s))
    over = np.zeros_like(time_s)
    for begin, lasts in every:
        over += plateau(time_s, begin + 0.1 * lasts, begin + 0.95 * lasts, 0.4 * lasts, 0.4 * lasts)
    over *= gone
    shift_foot(controls, side, long_m * gone, 0.0, 0.03 * context.body.height_m * air)
    lift_weight(controls, side, np.asarray(air))
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.8 * gone)
    shift_pelvis(controls, long_m * (0.5 * gone + 0.35 * over), 0.0, -deep_m * (0.2 * gone + 0.9 * over))
    controls.foot_rad[:, 1 - side, 1] += 0.15 * over
    controls.spine_rad[:, 1] += 0.06 * over


def _repeated(context: StepContext, each_s: float) -> StepContext:
    """The step with as many repetitions as its time allows, where the sentence names no number."""
    count = context.step.count or max(1, round(context.duration_s / each_s))
    return replace(context, step=replace(context.step, count=count))


def crouching(context: StepContext) -> Controls:
    """Down into a deep crouch, and staying there."""
    controls, time_s = upright(context), context.time_s
    down = rise((time_s - context.start_s) / min(1.2, 0.8 * context.duration_s))
    if not context.last:
        down = down * rise((context.end_s + 0.3 - time_s) / 0.9)
    crouched(controls, context.body, down * float(context.rng.uniform(0.8, 0.95)), lean_rad=0.9)
    controls.arm_rad[:, :, 0] += (0.9 * down)[:, None]
    controls.arm_rad[:, :, 3] += (0.6 * down)[:, None]
    return controls


def marching(context: StepContext) -> Controls:
    """High knees on the spot, each arm swinging with the opposite leg."""
    style = gait.walking_style(context, 1.3)
    style = replace(
        style, steps_hz=context.tempo(1.5, 1.85, 2.2), double_support=0.12,
        spot_lift_m=float(context.rng.uniform(0.13, 0.2)),
        arm_swing_rad=float(context.rng.uniform(0.35, 0.6)), elbow_rad=0.7, bob_m=0.01, sink=0.988,
    )  # fmt: skip
    spot = replace(context, step=replace(context.step, direction=Shape.SPOT))
    return gait.stepping(spot, style, jog=True)


def stepping_up_and_down(context: StepContext) -> Controls:
    """On the spot, up a stair of 17 cm that is not there and backwards down again, one foot after the other."""
    controls, h = upright(context), context.body.height_m
    first = leg_side(context)
    rate, _ = cycles(context, context.tempo(0.33, 0.45, 0.62), 0.25, 0.8)
    share = 4.0 * rate * (context.time_s - context.start_s)  # a foot moves in each quarter of a cycle
    if context.step.count:
        share = np.clip(share, 0.0, 4.0 * context.step.count)
    share = share % 4.0
    height_m, tread_m = 0.17, 0.15 * h
    for side, begin in ((first, 0.0), (1 - first, 1.0)):
        on = rise(share - begin) - rise(share - begin - 2.0)
        air = bump(share - begin) + bump(share - begin - 2.0)
        shift_foot(controls, side, tread_m * on, 0.0, height_m * on + 0.06 * air)
        controls.contact[:, side] -= air
        controls.foot_rad[:, side, 1] += 0.25 * bump(share - begin) - 0.1 * bump(share - begin - 2.0)
        controls.arm_rad[:, side, 0] += 0.3 * (bump((share - 1.0 + begin) / 2.0) - 0.5)
    up = rise((share - 0.7) / 1.2) - rise((share - 2.2) / 1.2)
    shift_pelvis(controls, tread_m * (rise(share / 1.7) - rise((share - 2.0) / 1.7)), 0.0, height_m * up)
    controls.knee_room[:] = 0.8
    controls.spine_rad[:, 1] += 0.12 + 0.08 * bump(share / 2.0)
    return controls
