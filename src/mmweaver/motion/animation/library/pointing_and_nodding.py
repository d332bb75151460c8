"""Communication with head and arms: pointing, nodding, shaking the head, looking around, crossed or held-out arms."""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    cycles,
    hand_to,
    mix_arm,
    one_side,
    place,
    repeats,
    sides,
    spline_through,
)
from mmweaver.motion.animation.profiles import plateau, rise, travel, wander
from mmweaver.motion.animation.step_context import StepContext


def _held(context: StepContext, up_s: float = 0.6) -> np.ndarray:
    """(n,) rises to 1 at the step's start and falls at its end, unless the arms are held so before or after it."""
    move = min(up_s, 0.4 * context.duration_s)
    rising = not (context.first or context.arms_before)
    begin = rise((context.time_s - context.start_s) / move) if rising else np.ones_like(context.time_s)
    falling = not (context.last or context.arms_after)
    return begin * rise((context.end_s + 0.2 - context.time_s) / move) if falling else begin


def _heading_rad(context: StepContext, controls: Controls) -> float:
    """Where the body faces during the step, whatever came before."""
    meanwhile = (context.time_s >= context.start_s) & (context.time_s <= context.end_s)
    return float(np.median(controls.heading_rad[meanwhile] if meanwhile.any() else controls.heading_rad))


def pointing(context: StepContext, controls: Controls) -> Controls:
    """An arm stretched towards the given side (the viewer's left or right), ahead if none is given."""
    time_s, rng = context.time_s, context.rng
    side = one_side(context)
    goal = {"left": np.pi, "right": 0.0}.get(context.step.facing or context.step.direction)
    if goal is None:
        aside = 0.0 if context.step.facing else float(rng.uniform(-0.5, 0.1))
    else:  # the angle to the body's left
        left = (goal - _heading_rad(context, controls) + np.pi) % (2 * np.pi) - np.pi
        if not context.step.hand:
            side = LEFT if left > 0 else RIGHT
        aside = float(np.clip(left if side == LEFT else -left, -0.6, 1.5))
    count = max(context.step.count, 1)
    level = float(rng.uniform(1.35, 1.6))
    for begin, lasts in repeats(context, max(1.7, min(context.duration_s / count, 4.0)), 1.1, 4.5):
        move = float(np.clip(0.35 * lasts, 0.38, 0.7))
        up = plateau(time_s, begin, begin + lasts, move, move)
        ahead, out = np.cos(aside), np.sin(aside)
        arm = np.tile([level * max(ahead, 0.15), 0.1 + 1.35 * max(out, 0.0), 0.0, 0.12], (len(time_s), 1))
        arm[:, 1] += min(out, 0.0) * 0.8
        mix_arm(controls, side, arm, up)
        controls.arm_rad[:, side, 3] += 0.7 * np.sin(np.pi * up)
        controls.head_rad[:, 1] += (1 if side == LEFT else -1) * 0.5 * aside * up
    return controls


def nodding(context: StepContext, controls: Controls) -> Controls:
    rate, end = cycles(context, context.tempo(1.1, 1.6, 2.2), 1.0, 2.6)
    on = plateau(context.time_s, context.start_s, max(end, context.start_s + 0.5), 0.2, 0.2)
    deep = float(context.rng.uniform(0.16, 0.3))
    phase = 2 * np.pi * rate * (context.time_s - context.start_s)
    controls.head_rad[:, 0] += deep * on * (0.5 - 0.5 * np.cos(phase))
    return controls


def shaking_head(context: StepContext, controls: Controls) -> Controls:
    rate, end = cycles(context, context.tempo(0.9, 1.4, 2.0), 0.8, 2.2)
    on = plateau(context.time_s, context.start_s, max(end, context.start_s + 0.5), 0.25, 0.25)
    wide = float(context.rng.uniform(0.3, 0.55))
    controls.head_rad[:, 1] += wide * on * np.sin(2 * np.pi * rate * (context.time_s - context.start_s))
    return controls


def looking_around(context: StepContext, controls: Controls) -> Controls:
    """To one side and the other, the trunk following slightly; to one side only where one is given."""
    time_s, first = context.time_s, float(context.rng.choice([-1.0, 1.0]))
    wide = float(context.rng.uniform(0.7, 1.0))
    facing = context.step.facing or context.step.direction
    begin, lasts = context.start_s, max(context.duration_s, 1.0)
    if facing == "down":
        controls.head_rad[:, 0] += 0.6 * plateau(time_s, begin, begin + lasts, 0.3 * lasts, 0.3 * lasts)
        return controls
    if facing in ("left", "right"):
        sign = -1.0 if facing == "left" else 1.0  # the viewer's side of somebody who may face anywhere
        sign *= 1.0 if np.sin(_heading_rad(context, controls)) < 0 else -1.0
        yaw = sign * wide * plateau(time_s, begin, begin + lasts, 0.3 * lasts, 0.3 * lasts)
    else:
        at = [begin + share * lasts for share in (0.0, 0.25, 0.4, 0.7, 0.82, 1.0)]
        yaw = spline_through(time_s, at, [0.0, first * wide, first * wide, -first * wide, -first * wide, 0.0])
    controls.head_rad[:, 1] += yaw
    controls.spine_rad[:, 2] += 0.3 * yaw
    return controls


def crossing_arms(context: StepContext, controls: Controls) -> Controls:
    """Forearms crossed in front of the chest."""
    held, n = _held(context, 0.9), len(context.time_s)
    over = int(context.rng.integers(2))
    for side in (LEFT, RIGHT):
        ahead = 0.135 if side == over else 0.105
        target = place(ahead, -0.055, 0.0 if side == over else -0.02, n)
        hand_to(controls, context.body, side, target, held, (-0.1, 0.8, -1.0))
    return controls


def hands_on_hips(context: StepContext, controls: Controls) -> Controls:
    held, n = _held(context, 0.8), len(context.time_s)
    for side in sides(context) if context.step.hand else (LEFT, RIGHT):
        hand_to(controls, context.body, side, place(0.035, 0.1, -0.17, n), held, (-0.35, 1.0, -0.1))
    return controls


def shrugging(context: StepContext, controls: Controls) -> Controls:
    """Forearms turn out and up, the head tilts to one side, and all drops again."""
    tilt = float(context.rng.choice([-1.0, 1.0]) * context.rng.uniform(0.05, 0.15))
    for begin, lasts in repeats(context, 1.2, 0.9, 1.8):
        up = plateau(context.time_s, begin, begin + lasts, 0.35 * lasts, 0.4 * lasts)
        arm = np.tile([0.15, 0.45, 0.75, 1.35], (len(up), 1))
        for side in (LEFT, RIGHT):
            mix_arm(controls, side, arm, up)
        controls.spine_rad[:, 0] += 0.4 * tilt * up
        controls.head_rad[:, 1] += tilt * up
    return controls


def arms_out(context: StepContext, controls: Controls) -> Controls:
    """Straight arms held out: to the sides (as in a T), or ahead where the sentence says so."""
    held, n = _held(context, 0.9), len(context.time_s)
    ahead = context.step.arms_ahead
    tired = 0.03 * wander(context.time_s, context.rng, slow_hz=0.2, fast_hz=0.9)
    for side in sides(context) if context.step.hand else (LEFT, RIGHT):
        arm = np.zeros((n, 4))
        arm[:, 0 if ahead else 1] = float(context.rng.uniform(1.42, 1.58)) + tired
        arm[:, 1 if ahead else 0] = 0.08
        arm[:, 3] = 0.1
        mix_arm(controls, side, arm, held)
    return controls


def stretching(context: StepContext, controls: Controls) -> Controls:
    """Both arms go up, the back arches, then the trunk leans to one side and the other, and the arms come down."""
    time_s = context.time_s
    ((begin, lasts),) = repeats(context, 3.0, 1.7, 4.5)[:1]
    up = plateau(time_s, begin, begin + lasts, 0.33 * lasts, 0.33 * lasts)
    peak = plateau(time_s, begin + 0.2 * lasts, begin + 0.85 * lasts, 0.2 * lasts, 0.2 * lasts)
    arm = np.tile([float(context.rng.uniform(2.75, 3.0)), 0.15, 0.0, 0.2], (len(time_s), 1))
    for side in (LEFT, RIGHT):
        mix_arm(controls, side, arm, up)
        controls.arm_rad[:, side, 3] += 0.9 * np.sin(np.pi * up)
    aside = float(context.rng.choice([-1.0, 1.0]) * context.rng.uniform(0.1, 0.32))
    controls.spine_rad[:, 0] += aside * peak * np.sin(2 * np.pi * (time_s - begin) / lasts)
    controls.spine_rad[:, 1] -= 0.16 * peak
    controls.head_rad[:, 0] -= 0.2 * peak
    return controls


def circling_arms(context: StepContext, controls: Controls) -> Controls:
    """Stretched arms go round at the sides: forward, up, back, down."""
    rate, end = cycles(context, context.tempo(0.5, 0.8, 1.1), 0.5, 1.2)
    lasts = max(end - context.start_s, 0.8)
    turns = max(1, round(rate * lasts))
    ramp = min(0.5, 0.4 / lasts)
    phase = 2 * np.pi * turns * travel(np.clip((context.time_s - context.start_s) / lasts, 0, 1), ramp, ramp)
    for side in sides(context) if context.step.hand else (LEFT, RIGHT):
        controls.arm_rad[:, side, 0] = -0.02 + phase
        controls.arm_rad[:, side, 1] = 0.18 + 0.12 * np.sin(phase / 2) ** 2
        controls.arm_rad[:, side, 3] = 0.12
    return controls
