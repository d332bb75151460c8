"""Hand activities overlaid on any posture: waving, clapping, raising a hand, drinking, punching.

Each takes the Controls of the posture and returns them with arms, trunk and head changed; the legs are kept.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import cycles, mix_arm, sides
from mmweaver.motion.animation.profiles import plateau, rise, wander
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]
QUICK_STRIKE_S = 0.46  # of a fist, from the guard and back


def waving(context: StepContext, controls: Controls) -> Controls:
    """Upper arm out and ahead, forearm up and swinging sideways; the upper arm twists, so that the hand nods."""
    time_s, rng = context.time_s, context.rng
    rate, end = cycles(context, context.tempo(1.0, 1.6, 2.2), 0.8, 2.5)
    swing = float(rng.uniform(0.35, 0.5)) * min(1.0, 1.5 / rate)
    on = rise((end + 0.25 - time_s) / 0.5) if context.step.count else np.ones_like(time_s)
    begin = context.start_s
    for side in sides(context):
        phase = 2 * np.pi * rate * (time_s - begin) + (rng.uniform(0, 0.6) if side else 0.0)
        abduction, flexion = rng.uniform(0.95, 1.4), rng.uniform(0.2, 0.8)
        nod, late = float(rng.uniform(0.06, 0.3)) * min(1.0, 1.5 / rate), rng.uniform(-0.6, 0.6)
        arm = np.stack(
            [
                flexion + 0.05 * np.sin(phase + 0.5),
                abduction + 0.08 * np.sin(phase + 0.3),
                rng.uniform(1.15, 1.5) + nod * np.sin(phase + late),
                rng.uniform(1.55, 1.75) - swing * np.sin(phase),
            ],
            axis=1,
        )
        mix_arm(controls, side, arm, on)
        controls.spine_rad[:, 0] += 0.03 * (1 if side == LEFT else -1) * on
    return controls


def clapping(context: StepContext, controls: Controls) -> Controls:
    """Palms meet in front of the chest; each wrist stays on its own side of the midline."""
    time_s, rng, body = context.time_s, context.rng, context.body
    rate, end = cycles(context, context.tempo(1.2, 2.0, 2.8), 0.9, 3.5)
    on = rise((end + 0.2 - time_s) / 0.5) if context.step.count else np.ones_like(time_s)
    phase = 2 * np.pi * rate * (time_s - context.start_s)
    opening = (0.5 + 0.5 * np.cos(phase)) ** 1.0  # 0 when the palms meet
    open_m = float(rng.uniform(0.08, 0.13)) * min(1.0, 2.0 / rate) * body.height_m
    ahead, up = rng.uniform(0.16, 0.19), rng.uniform(0.02, 0.07)
    target = np.zeros((len(time_s), 3))
    target[:, 0] = (ahead - rng.uniform(0.0, 0.04) * opening) * body.height_m
    target[:, 1] = 0.024 * body.height_m + open_m * opening
    target[:, 2] = (up + 0.01 * opening) * body.height_m
    arm = reach(body, target, elbow=(-0.1, 0.8, -1.0))
    for side in (LEFT, RIGHT):
        mix_arm(controls, side, arm, on)
    return controls


def raising(context: StepContext, controls: Controls) -> Controls:
    """The straight arm goes up in front or at the side, holds, and comes down at the end of the step."""
    time_s, rng = context.time_s, context.rng
    count = max(context.step.count, 1)
    each = float(min(context.duration_s / count, 6.0 if count == 1 else 3.5))
    move = float(np.clip(context.tempo(1.2, 0.85, 0.6) * min(1.0, each / 2.0), 0.42, 1.6))
    up = np.zeros_like(time_s)
    for k in range(count):
        begin = context.start_s + k * each
        up += plateau(time_s, begin, max(begin + each - 0.02, begin + 2 * move), move, move)
    sideways = rng.random() < 0.3
    top = float(rng.uniform(2.75, 2.98))
    for side in sides(context):
        arm = controls.arm_rad[:, side].copy()
        arm[:, 1 if sideways else 0] = top
        arm[:, 0 if sideways else 1] = 0.12 if sideways else 0.08
        arm[:, 3] = rng.uniform(0.12, 0.25)
        arm[:, 2] = 0.0
        mix_arm(controls, side, arm, up)
        controls.arm_rad[:, side, 3] += 0.8 * np.sin(np.pi * up) * (not sideways)
        controls.spine_rad[:, 0] += 0.05 * up * (-1 if side == LEFT else 1) * (len(sides(context)) == 1)
    return controls


def mouth_in_chest_m(body: SkeletonProportions, controls: Controls) -> Float[Array, "n 3"]:
    """Position of the mouth relative to spine3 in the chest's frame, (n, 3) in metres."""
    from mmweaver.motion.animation.kinematics import about_y, about_z, rotated

    half = about_z(controls.head_rad[:, 1] / 2) @ about_y(controls.head_rad[:, 0] / 2)
    head = body.offset_m[joint("neck")] + rotated(half, body.offset_m[joint("head")])
    return head + rotated(half @ half, body.mouth_m)


def drinking(context: StepContext, controls: Controls) -> Controls:
    """A cup in front of the belly goes to the mouth, the head tilts back for the sip, and the cup comes down."""
    time_s, rng, body = context.time_s, context.rng, context.body
    side = sides(context)[0]
    sip_s = context.tempo(3.4, 2.6, 1.9)
    count = context.step.count or max(1, int(context.duration_s / sip_s + 0.3))
    sip_s = float(np.clip(context.duration_s / count, 1.3, 4.5))
    lift = np.zeros_like(time_s)
    tilt = np.zeros_like(time_s)
    for k in range(count):
        begin = context.start_s + (k + 0.04) * sip_s
        end = context.start_s + (k + 0.96) * sip_s
        lift += plateau(time_s, begin, end, 0.36 * sip_s, 0.36 * sip_s)
        tilt += plateau(time_s, begin + 0.28 * sip_s, end - 0.28 * sip_s, 0.2 * sip_s, 0.2 * sip_s)
    sign = 1.0 if side == LEFT else -1.0
    controls.head_rad[:, 0] -= rng.uniform(0.2, 0.32) * tilt
    mouth = mouth_in_chest_m(body, controls)
    mouth[:, 1] *= sign  # in the frame of the acting arm
    cup = mouth + np.array([0.032, 0.022, -0.036]) * body.height_m
    rest = np.array([rng.uniform(0.15, 0.18), rng.uniform(0.05, 0.08), rng.uniform(-0.08, -0.04)]) * body.height_m
    bow = np.array([0.03, 0.0, 0.0]) * body.height_m  # the path bows slightly outward
    target = rest + lift[:, None] * (cup - rest) + (4 * lift * (1 - lift))[:, None] * bow
    arm = reach(body, target, elbow=(-0.25, 0.75, -1.0))
    mix_arm(controls, side, arm, np.ones_like(time_s))
    return controls


def _sway(controls: Controls, context: StepContext, lunge_m: PerTime) -> None:
    """A boxer's trunk moves with each punch, `lunge_m` (n,) ahead, and sways in between over planted feet."""
    rng, time_s = context.rng, context.time_s
    calm = 0.3 if context.step.hand in ("left", "right") else 1.0  # a single hand is a demonstration rather than boxing
    ahead = lunge_m + calm * float(rng.uniform(0.015, 0.075)) * wander(time_s, rng, slow_hz=0.35, fast_hz=1.5)
    aside = calm * float(rng.uniform(0.02, 0.07)) * wander(time_s, rng, slow_hz=0.35, fast_hz=1.2)
    cos, sin = np.cos(controls.heading_rad), np.sin(controls.heading_rad)
    controls.pelvis_m[:, 0] += ahead * cos - aside * sin
    controls.pelvis_m[:, 1] += ahead * sin + aside * cos
    controls.spine_rad[:, 1] += 2.0 * ahead
    controls.spine_rad[:, 0] -= 1.5 * aside


def punching(context: StepContext, controls: Controls) -> Controls:
    """Fists in front of the face; one after the other shoots forward at shoulder height and comes back."""
    time_s, rng, body = context.time_s, context.rng, context.body
    one_arm = context.step.hand in ("left", "right")
    rate, _ = cycles(context, context.tempo(1.1, 1.7, 2.0 if one_arm else 2.3), 0.9, 2.6)
    period = 1 / rate
    count = context.step.count or int(np.ceil(context.duration_s / period - 0.2))
    arms = sides(context) if one_arm else (LEFT, RIGHT)
    first = int(rng.integers(2))
    out = [np.zeros_like(time_s), np.zeros_like(time_s)]
    # Who hurries strikes more often, but a fist that is there and back sooner would pass what fists reach (100 m/s2).
    shortest_s = 0.34 if context.step.speed <= 0 else min(QUICK_STRIKE_S, 0.95 * period * len(arms))
    strike = float(np.clip(0.75 * period, shortest_s, 0.62))
    for k in range(max(count, 1)):
        begin = context.start_s + 0.06 + k * period
        side = arms[(k + first) % len(arms)]
        out[side] += plateau(time_s, begin, begin + strike, 0.48 * strike, 0.52 * strike)
    twist = float(rng.uniform(0.35, 0.7)) * (out[RIGHT] - out[LEFT])
    controls.spine_rad[:, 2] += twist
    controls.head_rad[:, 1] -= 0.8 * twist
    controls.spine_rad[:, 1] += 0.06
    _sway(controls, context, float(rng.uniform(0.02, 0.06)) * (out[RIGHT] + out[LEFT]))
    guard = np.array([rng.uniform(0.13, 0.175), rng.uniform(0.04, 0.09), rng.uniform(0.06, 0.15)])
    hook = float(rng.choice([0.0, 0.0, rng.uniform(0.04, 0.12)]))  # hooks curve around the side
    restless = float(rng.uniform(0.004, 0.02)) * (context.step.count == 0 and len(arms) == 2)
    for side in (LEFT, RIGHT):
        aim = np.array([rng.uniform(0.25, 0.29), 0.035, 0.08 + rng.normal(0, 0.03)])
        target = guard + out[side][:, None] * (aim - guard)
        target[:, 1] += hook * 4 * out[side] * (1 - out[side])
        for axis in range(3):  # fists keep moving in the guard
            target[:, axis] += restless * wander(time_s, rng, slow_hz=0.8, fast_hz=2.2) * (1 - out[side])
        arm = reach(body, target * body.height_m, elbow=(-0.15, 0.45 + 3 * hook, -1.0))
        mix_arm(controls, side, arm, np.ones_like(time_s))
    return controls
