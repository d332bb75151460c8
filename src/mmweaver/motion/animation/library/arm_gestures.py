"""Gestures of one arm or both as given to a device: raised and kept there, lowered, pushed, pulled, circle, Z, yawn.

They are the ten arm gestures of mHomeGes (Liu et al., IMWUT 4(4), 2020), as its instructions word them.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.gestures import mouth_in_chest_m
from mmweaver.motion.animation.library.movement_primitives import (
    hand_to,
    mix_arm,
    place,
    repeats,
    sides,
    spline_through,
    vary,
)
from mmweaver.motion.animation.profiles import larger, plateau, reached, rise
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]
# Places of the wrist from spine3 (ahead, outward, up) and lengths, in body heights.
_CHEST = (0.09, 0.06, 0.03)  # close before the chest
_AHEAD = (0.297, 0.08, 0.07)  # stretched forward
_CIRCLE, _LETTER = 0.25, 0.17  # half the size of what a straight arm draws large in the air
_SWIPE = 0.13  # half the way of a hand that swipes
_ACROSS = 0.08  # farther ahead where the arm is across the body
_MIDDLE, _ARM = (0.09, 0.07), 0.28  # of drawings: outward and up; a straight arm from the shoulder


def _once(context: StepContext, slow: float, usual: float, fast: float) -> PerTime:
    """0 to 1 (n,) within a sampled time from just after the start, and then 1: a gesture that stays where it ends."""
    lasts = float(np.clip(1 / context.tempo(1 / slow, 1 / usual, 1 / fast), 0.45, 0.9 * context.duration_s))
    wait = float(np.clip(context.rng.uniform(0.05, 0.3), 0.0, 0.2 * context.duration_s))
    return np.asarray(rise((context.time_s - context.start_s - wait) / lasts))


def raising_and_holding(context: StepContext, controls: Controls) -> Controls:
    """The straight arm is lifted ahead, straight up, and stays above the head; at once where it was there before."""
    up = np.ones_like(context.time_s) if context.arms_before else _once(context, 1.6, 1.0, 0.65)
    return _lifted(context, controls, up)


def lowering(context: StepContext, controls: Controls) -> Controls:
    """The straight arm is above the head, falls straight down and stays down."""
    return _lifted(context, controls, 1 - _once(context, 1.4, 0.85, 0.55))


def _lifted(context: StepContext, controls: Controls, up: PerTime) -> Controls:
    top, bent = float(context.rng.uniform(2.75, 3.0)), float(context.rng.uniform(0.05, 0.2))
    for side in sides(context):
        arm = controls.arm_rad[:, side].copy()
        arm[:, 0] += up * (top - arm[:, 0])
        arm[:, 1] += up * (0.1 - arm[:, 1])
        arm[:, 2] *= 1 - up
        arm[:, 3] += (bent - arm[:, 3]) * reached(4 * up)
        mix_arm(controls, side, arm, np.ones_like(up))
    return controls


def pushing_hand(context: StepContext, controls: Controls) -> Controls:
    """The hand before the chest, palm forward, is stretched ahead, and the arm stays straight."""
    return _between(context, controls, _once(context, 1.1, 0.6, 0.45))


def pulling_hand(context: StepContext, controls: Controls) -> Controls:
    """The arm is straight ahead, and the hand returns to the chest."""
    return _between(context, controls, 1 - _once(context, 1.1, 0.6, 0.45))


def _between(context: StepContext, controls: Controls, out: PerTime) -> Controls:
    """A hand between the chest (0) and as far ahead as it reaches (1)."""
    near, far = np.array(_CHEST), np.array(_AHEAD)
    target = near + out[:, None] * (far - near)
    for side in sides(context):
        hand_to(controls, context.body, side, target, np.ones_like(out), elbow=(-0.2, 0.6, -1.0))
        controls.spine_rad[:, 2] += (-1 if side == LEFT else 1) * 0.3 * out  # the shoulder goes along
    return controls


def drawing_circle(context: StepContext, controls: Controls) -> Controls:
    """The straight arm draws large circles, clockwise for the person: from hanging across the body, up and round."""
    count = context.step.count or max(1, round(context.duration_s / 2.5))
    turned = np.zeros_like(context.time_s)
    for begin, lasts in repeats(context, context.duration_s / count * 0.9, 0.9, 4.0)[:count]:
        turned += rise((context.time_s - begin) / lasts)
    angle = 2 * np.pi * turned
    return _drawn(context, controls, -np.sin(angle), -np.cos(angle), _CIRCLE)


def drawing_z(context: StepContext, controls: Controls) -> Controls:
    """The straight arm draws a large Z before the body: across, down to the other side, and across again."""
    ((begin, lasts),) = repeats(context, 0.85 * context.duration_s, 1.1, 3.5)[:1]
    at = [begin + share * lasts for share in (0.0, 0.3, 0.65, 1.0)]
    side = -1.0 if sides(context)[0] == LEFT else 1.0
    aside = spline_through(context.time_s, at, [-1.0, 1.0, -1.0, 1.0]) * side
    up = spline_through(context.time_s, at, [1.0, 1.0, -1.0, -1.0])
    return _drawn(context, controls, aside, up, _LETTER)


def _drawn(context: StepContext, controls: Controls, aside: PerTime, up: PerTime, half: float) -> Controls:
    """The hand of the straight arm at a place of a drawing: to the person's right and up, from -1 to 1 times `half`.

    Across the body the arm passes before it.
    """
    size = vary(context, half, 0.12)
    on = rise((context.time_s - context.start_s + 0.4) / 0.5) if not context.first else np.ones_like(aside)
    for side in sides(context)[:1]:
        out = -aside if side == LEFT else aside
        ahead = np.sqrt(larger(_ARM**2 - size**2 * (out**2 + up**2), 0.06**2, 0.01))
        ahead += _ACROSS * (np.hypot(out, 0.3) - out) / 2
        target = place(ahead, _MIDDLE[0] + size * out, _MIDDLE[1] + size * up, len(up))
        # an elbow that pointed down would jump where the arm of a circle points down, too
        hand_to(controls, context.body, side, target, on, elbow=(-1.0, 0.0, -0.3))
    return controls


def swiping(context: StepContext, controls: Controls) -> Controls:
    """The hand is raised before the chest, sweeps through the air to one side, up or down, and comes back."""
    time_s, step = context.time_s, context.step
    stroke = np.zeros_like(time_s)
    swipes = repeats(context, 1.1, 0.5, 1.6)
    for begin, lasts in swipes:
        u = (time_s - begin) / lasts
        stroke += rise((u - 0.3) / 0.3) - rise((u - 0.65) / 0.35)
    first, last = swipes[0], swipes[-1]
    on = plateau(time_s, first[0], last[0] + last[1], 0.3 * first[1], 0.3 * last[1])
    along = vary(context, _SWIPE, 0.12) * (2 * stroke - 1)
    side = sides(context)[0]
    is_outward = step.direction == ("right" if side == RIGHT else "left")  # inward where the sentence names no side
    outward = 1.0 if is_outward else -1.0
    vertical = {"up": 1.0, "down": -1.0}.get(step.style, 0.0)
    out = 0.05 + (0.0 if vertical else outward) * along
    target = place(0.27 - 0.5 * np.square(along), out, -0.02 + vertical * along, len(time_s))
    hand_to(controls, context.body, side, target, on, elbow=(-0.2, 0.5, -1.0))
    return controls


def yawning(context: StepContext, controls: Controls) -> Controls:
    """The hand goes to the mouth and stays, the head tilts back and the body leans."""
    up, body = _once(context, 1.5, 1.0, 0.7), context.body
    controls.head_rad[:, 0] -= vary(context, 0.22) * up
    controls.spine_rad[:, 1] -= vary(context, 0.08, 0.3) * up
    side = sides(context)[0]
    mouth = mouth_in_chest_m(body, controls)
    mouth[:, 1] *= 1.0 if side == LEFT else -1.0
    target = mouth + np.array([0.03, 0.03, -0.015]) * body.height_m
    mix_arm(controls, side, reach(body, target, elbow=(-0.2, 0.8, -1.0)), up)
    return controls


def knocking_from_elbow(context: StepContext, controls: Controls) -> Controls:
    """The hand at the side is raised from the elbow and lowered, without a pause between."""
    count = context.step.count or max(1, round(context.duration_s / 1.2))
    up = np.zeros_like(context.time_s)
    for begin, lasts in repeats(context, min(1.0, 0.95 * context.duration_s / count), 0.45, 1.6)[:count]:
        up += plateau(context.time_s, begin, begin + lasts, 0.5 * lasts, 0.5 * lasts)
    for side in sides(context):
        controls.arm_rad[:, side, 3] += vary(context, 1.9, 0.08) * up
        controls.arm_rad[:, side, 0] += 0.15 * up
    return controls
