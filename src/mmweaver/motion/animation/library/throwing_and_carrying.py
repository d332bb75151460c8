"""Arm activities that involve the trunk: throwing, pushing, pulling, carrying, rocking a baby, reaching, golf."""

import numpy as np
from jaxtyping import Float

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
    vary,
)
from mmweaver.motion.animation.profiles import plateau
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]


# Keyframes of a throw, overarm and underarm: share of its time, then flexion, abduction, twist, elbow.
_OVER = ((0.0, -0.02, 0.13, 0.0, 0.22), (0.4, -0.1, 1.35, 1.35, 1.6), (0.66, 1.45, 0.45, 0.4, 0.5),
         (0.8, 0.85, 0.1, 0.1, 0.5), (1.0, -0.02, 0.13, 0.0, 0.22))  # fmt: skip
_UNDER = ((0.0, -0.02, 0.13, 0.0, 0.22), (0.4, -0.75, 0.25, 0.0, 0.2), (0.66, 1.05, 0.15, 0.0, 0.3),
          (0.8, 1.5, 0.15, 0.0, 0.5), (1.0, -0.02, 0.13, 0.0, 0.22))  # fmt: skip


def keyed_arm(time_s: PerTime, begin_s: float, lasts_s: float, keys: tuple[tuple[float, ...], ...]) -> Array:
    """Arm angles (n, 4) interpolated through keyframes of (share of the time, flexion, abduction, twist, elbow)."""
    at = [begin_s + key[0] * lasts_s for key in keys]
    return np.stack([spline_through(time_s, at, [key[angle] for key in keys]) for angle in range(1, 5)], axis=1)


def throwing(context: StepContext, controls: Controls) -> Controls:
    """The hand goes back next to the ear and the trunk turns with it, then both move forward and follow through."""
    time_s, side = context.time_s, one_side(context)
    sign = 1.0 if side == LEFT else -1.0
    under = context.step.style == "under" or context.rng.random() < 0.2
    for begin, lasts in repeats(context, 1.6, 1.3, 2.3):
        at = [begin + share * lasts for share in (0.0, 0.4, 0.66, 0.8, 1.0)]
        on = plateau(time_s, begin, begin + lasts, 0.2 * lasts, 0.2 * lasts)
        mix_arm(controls, side, keyed_arm(time_s, begin, lasts, _UNDER if under else _OVER), on)
        turn = vary(context, 0.5) * spline_through(time_s, at, [0.0, 1.0, -0.7, -0.8, 0.0])
        controls.spine_rad[:, 2] += sign * turn
        controls.pelvis_rad[:, 2] += 0.25 * sign * turn
        controls.head_rad[:, 1] -= sign * 0.9 * turn
        controls.spine_rad[:, 1] += spline_through(time_s, at, [0.0, -0.08, 0.14, 0.2, 0.0])
    return controls


def pushing(context: StepContext, controls: Controls) -> Controls:
    """Palms in front of the chest, then away with the trunk leaning in, and back."""
    time_s, n = context.time_s, len(context.time_s)
    hands = sides(context) if context.step.hand else (LEFT, RIGHT)
    for begin, lasts in repeats(context, 1.6, 1.1, 2.6):
        on = plateau(time_s, begin, begin + lasts, 0.28 * lasts, 0.28 * lasts)
        out = plateau(time_s, begin + 0.25 * lasts, begin + 0.85 * lasts, 0.28 * lasts, 0.3 * lasts)
        target = place(0.13 + 0.15 * out, 0.08, 0.02 + 0.03 * out, n)
        for side in hands:
            hand_to(controls, context.body, side, target, on, (-0.5, 0.8, -0.8))
        controls.spine_rad[:, 1] += 0.22 * out - 0.06 * on
    return controls


def pulling(context: StepContext, controls: Controls) -> Controls:
    """Stretched arms pull something towards the body, the trunk leaning back, again and again."""
    time_s, n = context.time_s, len(context.time_s)
    hands = sides(context) if context.step.hand else (LEFT, RIGHT)
    each = context.tempo(1.8, 1.4, 1.1)
    count = context.step.count or max(1, round(context.duration_s / each))
    each = float(np.clip(context.duration_s / count, 1.0, 2.4))
    draw = np.zeros(n)
    for k in range(count):
        begin = context.start_s + (k + 0.1) * each
        draw += plateau(time_s, begin, begin + 0.88 * each, 0.42 * each, 0.42 * each)
    target = place(0.27 - 0.15 * draw, 0.06, -0.02 - 0.05 * draw, n)
    for side in hands:
        hand_to(controls, context.body, side, target, np.ones(n), (-0.7, 0.6, -0.7))
    controls.spine_rad[:, 1] += 0.12 - 0.26 * draw
    return controls


def carrying(context: StepContext, controls: Controls) -> Controls:
    """Something held in both hands in front of the belly, moving with the trunk; or hanging from one hand."""
    n = len(context.time_s)
    if context.step.hand in ("left", "right"):
        side = LEFT if context.step.hand == "left" else RIGHT
        mix_arm(controls, side, np.tile([0.0, 0.16, 0.0, 0.08], (n, 1)), np.ones(n))
        controls.spine_rad[:, 0] += 0.06 * (1 if side == LEFT else -1)
        return controls
    target = place(vary(context, 0.17, 0.05), vary(context, 0.085), float(context.rng.uniform(-0.13, -0.05)), n)
    for side in (LEFT, RIGHT):
        hand_to(controls, context.body, side, target, np.ones(n), (-0.7, 0.35, -1.0))
    controls.spine_rad[:, 1] -= 0.05
    return controls


def cradling(context: StepContext, controls: Controls) -> Controls:
    """A baby before the chest: its head in the crook of one elbow, the other hand under it; the trunk rocks it."""
    n = len(context.time_s)
    head = LEFT if sides(context)[0] == RIGHT else RIGHT  # most people keep the hand they use free
    rate, _ = cycles(context, context.tempo(0.25, 0.4, 0.6), 0.2, 0.9)
    rock = np.sin(2 * np.pi * rate * (context.time_s - context.start_s))
    hand_to(controls, context.body, head, place(0.15, -0.03, -0.03, n), np.ones(n), (-0.3, 0.5, -1.0))
    hand_to(controls, context.body, 1 - head, place(0.165, 0.0, -0.1, n), np.ones(n), (-0.5, 0.4, -1.0))
    sign = 1.0 if head == LEFT else -1.0
    controls.spine_rad[:, 0] += vary(context, 0.07, 0.2) * rock
    controls.spine_rad[:, 2] += vary(context, 0.12, 0.2) * rock
    controls.spine_rad[:, 1] -= 0.04
    controls.head_rad[:, 0] += 0.3
    controls.head_rad[:, 1] += 0.25 * sign
    return controls


def reaching(context: StepContext, controls: Controls) -> Controls:
    """A hand reaches for something ahead at table height, or up, and comes back with it."""
    time_s, n, hands = context.time_s, len(context.time_s), sides(context)
    if context.step.style == "high":
        return _reaching_up(context, controls)
    up = float(context.rng.uniform(-0.08, 0.03))
    for begin, lasts in repeats(context, 1.7, 1.1, 2.6):
        on = plateau(time_s, begin, begin + lasts, 0.3 * lasts, 0.3 * lasts)
        out = plateau(time_s, begin, begin + 0.78 * lasts, 0.36 * lasts, 0.34 * lasts)
        target = place(0.15 + 0.13 * out, 0.07, up + 0.02 - 0.02 * out, n)
        for side in hands:
            hand_to(controls, context.body, side, target, on, (-0.5, 0.6, -1.0))
        controls.spine_rad[:, 1] += 0.24 * out
        controls.head_rad[:, 0] += 0.12 * out
    return controls


def _reaching_up(context: StepContext, controls: Controls) -> Controls:
    """A hand reaches up ahead of the head, the trunk stretches after it."""
    time_s, hands = context.time_s, sides(context)
    up = float(context.rng.uniform(2.5, 2.85))
    for begin, lasts in repeats(context, 1.9, 1.2, 2.8):
        out = plateau(time_s, begin, begin + lasts, 0.36 * lasts, 0.36 * lasts)
        for side in hands:
            mix_arm(controls, side, np.tile([up, 0.12, 0.0, 0.12], (len(time_s), 1)), out)
            controls.arm_rad[:, side, 3] += 1.1 * np.sin(np.pi * out)
        if len(hands) == 1:
            controls.spine_rad[:, 0] += (-0.1 if hands[0] == RIGHT else 0.1) * out
        controls.head_rad[:, 0] -= 0.3 * out
    return controls


# Keyframes of the arm far from the backswing, and of the near one; the follow-through mirrors them.
_FAR = ((0.0, 0.45, -0.1, 0.0, 0.15), (0.18, 0.45, -0.1, 0.0, 0.1), (0.48, 1.35, -0.55, 0.0, 0.2),
        (0.66, 0.45, -0.12, 0.0, 0.1), (0.84, 1.1, 0.2, 0.0, 1.2), (1.0, 0.45, -0.1, 0.0, 0.15))  # fmt: skip
_NEAR = ((0.0, 0.45, -0.1, 0.0, 0.15), (0.18, 0.45, -0.1, 0.0, 0.1), (0.48, 1.1, 0.2, 0.0, 1.2),
         (0.66, 0.45, -0.12, 0.0, 0.1), (0.84, 1.35, -0.55, 0.0, 0.2), (1.0, 0.45, -0.1, 0.0, 0.15))  # fmt: skip


def golf_swing(context: StepContext, controls: Controls) -> Controls:
    """Both hands together in front of the trunk: up over one shoulder, down, and up over the other."""
    time_s = context.time_s
    near, back = (
        (LEFT, 1.0) if context.step.hand == "left" else (RIGHT, -1.0)
    )  # backswing to the right of a right-handed player
    for begin, lasts in repeats(context, 2.1, 1.6, 3.0):
        at = [begin + share * lasts for share in (0.0, 0.18, 0.48, 0.66, 0.84, 1.0)]
        on = plateau(time_s, begin - 0.1, begin + lasts + 0.1, 0.2 * lasts, 0.2 * lasts)
        for side in (LEFT, RIGHT):
            mix_arm(controls, side, keyed_arm(time_s, begin, lasts, _NEAR if side == near else _FAR), on)
        turn = back * spline_through(time_s, at, [0.0, 0.0, 0.85, 0.0, -0.85, 0.0])
        controls.spine_rad[:, 2] += turn
        controls.pelvis_rad[:, 2] += 0.3 * turn
        controls.head_rad[:, 1] -= turn
        controls.spine_rad[:, 1] += 0.35 * on
    return controls
