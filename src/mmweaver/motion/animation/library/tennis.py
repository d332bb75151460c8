"""Strokes of a racket, which is not shown: forehand, backhand with one or both hands, serve."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import Controls
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    hand_to,
    mix_arm,
    one_side,
    repeats,
    shift_pelvis,
    spline_through,
    vary,
)
from mmweaver.motion.animation.profiles import plateau
from mmweaver.motion.animation.step_context import StepContext

PerTime = Float[np.ndarray, " n"]
# Keyframes of a stroke: shares of its time; ready, swung back, ball, followed through, ready.
_AT = (0.0, 0.36, 0.6, 0.76, 1.0)
# Places of the hand: ahead, outward and up of spine3, in body heights.
_READY = (0.17, 0.02, -0.03)
_FOREHAND = (_READY, (-0.02, 0.29, 0.0), (0.22, 0.2, -0.02), (0.17, -0.09, 0.13), _READY)
_BOTH = np.array([0.0, 0.045, 0.03])  # of the second hand on the same grip, from the first
_BACKHAND = (_READY, (0.12, -0.15, -0.02), (0.26, 0.06, -0.02), (0.13, 0.27, 0.13), _READY)


def forehand(context: StepContext, controls: Controls) -> Controls:
    """The hand swings back at its own side, forward past the hip, and ends over the other shoulder."""
    return _stroke(context, controls, _FOREHAND, turn_rad=-0.9)


def backhand(context: StepContext, controls: Controls) -> Controls:
    """The hand swings back across the body, forward, and out to its own side."""
    return _stroke(context, controls, _BACKHAND, turn_rad=0.85)


def _stroke(
    context: StepContext, controls: Controls, places: tuple[tuple[float, float, float], ...], turn_rad: float
) -> Controls:
    """One hand through `places` at the times _AT; the trunk turns by `turn_rad` (outward positive: away) before it."""
    time_s, side, h = context.time_s, one_side(context), context.body.height_m
    for begin, lasts in repeats(context, 1.7, 1.4, 2.4):
        at = [begin + share * lasts for share in _AT]
        on = plateau(time_s, begin - 0.15, begin + lasts + 0.15, 0.22 * lasts, 0.22 * lasts)
        hand = np.stack([spline_through(time_s, at, [one[axis] for one in places]) for axis in range(3)], axis=1)
        hand_to(controls, context.body, side, hand, on, (-0.6, 0.15, -1.0))
        if context.step.hand == "both":
            hand_to(controls, context.body, 1 - side, hand * np.array([1, -1, 1]) + _BOTH, on, (-0.5, 0.6, -1.0))
        else:
            _other_hand(context, controls, 1 - side, places, at, on)
        turn = OUTWARD[side] * vary(context, -turn_rad, 0.1) * spline_through(time_s, at, [0.0, 1.0, -0.1, -0.7, 0.0])
        controls.spine_rad[:, 2] += 0.7 * turn
        controls.pelvis_rad[:, 2] += 0.3 * turn
        controls.head_rad[:, 1] -= 0.9 * turn
        low = plateau(time_s, begin, begin + lasts, 0.35 * lasts, 0.35 * lasts)
        over = spline_through(time_s, at, [0.0, -0.03, 0.02, 0.03, 0.0])
        shift_pelvis(controls, over * h, 0.0, -0.02 * h * low)
        controls.knee_room[:] = np.maximum(controls.knee_room, 0.5 * low)
        controls.spine_rad[:, 1] += 0.12 * low
    return controls


def _other_hand(
    context: StepContext, controls: Controls, side: int, places: tuple[tuple[float, float, float], ...],
    at: list[float], on: PerTime,
) -> None:  # fmt: skip
    """In front of the body for balance: out to its own side as the ball is hit."""
    swing = spline_through(context.time_s, at, [0.0, 0.5, 1.0, 0.8, 0.0])
    hand = np.stack([0.17 + 0.02 * swing, 0.03 + 0.17 * swing, -0.03 + 0.03 * swing], axis=1)
    if places is _BACKHAND:
        hand = np.stack([0.17 - 0.16 * swing, 0.03 + 0.2 * swing, -0.03 - 0.05 * swing], axis=1)
    hand_to(controls, context.body, side, hand, on, (-0.5, 0.6, -1.0))


# Keyframes of a serve: shares of its time, then flexion, abduction, twist and elbow of the arm with the racket.
_SERVE = ((0.0, 0.3, 0.15, 0.0, 0.6), (0.3, -0.35, 0.55, 0.2, 0.5), (0.5, 0.0, 1.5, 1.3, 1.7),
          (0.66, 2.75, 0.25, 0.3, 0.25), (0.8, 0.95, -0.15, 0.1, 0.35), (1.0, 0.3, 0.15, 0.0, 0.6))  # fmt: skip


def serving(context: StepContext, controls: Controls) -> Controls:
    """One hand throws the ball up and stays up; the other swings back, over the head and down across the body."""
    from mmweaver.motion.animation.library.throwing_and_carrying import keyed_arm

    time_s, side, h = context.time_s, one_side(context), context.body.height_m
    for begin, lasts in repeats(context, 2.2, 1.8, 3.0):
        on = plateau(time_s, begin - 0.1, begin + lasts + 0.1, 0.2 * lasts, 0.2 * lasts)
        at = [begin + share * lasts for share in (0.0, 0.3, 0.5, 0.66, 0.8, 1.0)]
        mix_arm(controls, side, keyed_arm(time_s, begin, lasts, _SERVE), on)
        up = plateau(time_s, begin + 0.08 * lasts, begin + 0.72 * lasts, 0.3 * lasts, 0.24 * lasts)
        toss = np.zeros((len(time_s), 4))
        toss[:, 0], toss[:, 1], toss[:, 3] = 0.3 + 2.3 * up, 0.1, 0.5 - 0.35 * up
        mix_arm(controls, 1 - side, toss, on)
        turn = -OUTWARD[side] * vary(context, 0.6, 0.1) * spline_through(time_s, at, [0.0, -0.6, -1.0, 0.5, 0.8, 0.0])
        controls.spine_rad[:, 2] += turn
        controls.pelvis_rad[:, 2] += 0.3 * turn
        controls.head_rad[:, 1] -= turn
        controls.spine_rad[:, 1] += spline_through(time_s, at, [0.0, -0.05, -0.22, 0.08, 0.3, 0.0])
        controls.head_rad[:, 0] -= 0.35 * up
        dip = spline_through(time_s, at, [0.0, -0.01, -0.045, 0.0, -0.01, 0.0])
        shift_pelvis(controls, spline_through(time_s, at, [0.0, -0.01, 0.02, 0.035, 0.03, 0.0]) * h, 0.0, dip * h)
        controls.knee_room[:] = np.maximum(controls.knee_room, 0.6 * plateau(time_s, begin, begin + lasts, 0.3, 0.3))
    return controls
