"""On the floor: kneeling, lying down on the back or the belly, falling, and getting up again.

The same controls pose a body on the floor: the pelvis's height and pitch, and where the knees point. The root stays
where the feet stood; on the back the body lies behind it, on the belly ahead of it.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import repeats, shift_foot, shift_pelvis, spline_through
from mmweaver.motion.animation.library.standing import STAND_STRETCH, upright
from mmweaver.motion.animation.profiles import bump, plateau, rise
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]
KNEELING_M = 0.316  # of the height: of the pelvis above the floor, thighs vertical
LYING_M = 0.075  # of the height: of the pelvis above the floor
BACK_BEHIND_M = 0.36  # of the height: from the root back to the pelvis, lying on the back
SIDE_AWAY_M = 0.34  # of the height: from the root sideways to the pelvis, lying on the side
BELLY_AHEAD_M = 0.648  # of the height: from the root ahead to the pelvis, lying on the belly


def kneeling_down(context: StepContext) -> Controls:
    lasts = float(np.clip(0.9 * context.duration_s, 1.3, (2.8, 2.2, 1.5)[context.step.speed + 1]))
    return _kneeling(context, (context.time_s - context.start_s) / lasts)


def kneeling(context: StepContext) -> Controls:
    return _kneeling(context, np.ones_like(context.time_s))


def rising_from_knees(context: StepContext) -> Controls:
    lasts = float(np.clip(0.9 * context.duration_s, 1.3, (2.8, 2.2, 1.5)[context.step.speed + 1]))
    return _kneeling(context, 1 - (context.time_s - context.start_s) / lasts)


def _kneeling(context: StepContext, u: PerTime) -> Controls:
    """u (n,) = 0 standing, 1 on the knees: one foot moves back and its knee down, then the other's."""
    controls, body, h = upright(context), context.body, context.body.height_m
    first = LEFT if context.step.foot == "left" else RIGHT
    feet = ((first, 0.0),) if context.step.style == "knee" else ((first, 0.0), (1 - first, 0.45))
    for side, begin in feet:
        step = (u - begin) / 0.5
        shift_foot(controls, side, -0.318 * h * rise(step), 0.0, 0.035 * h * bump(step))
        controls.foot_rad[:, side, 1] += 1.42 * rise(step)
        lift = bump(step)
        controls.contact[:, side] -= lift
    if context.step.style == "knee":  # the other foot steps ahead, so that its shank stands upright
        ahead = (u - 0.1) / 0.5
        shift_foot(controls, 1 - first, 0.2 * h * rise(ahead), 0.0, 0.035 * h * bump(ahead))
        controls.contact[:, 1 - first] -= bump(ahead)
    down = rise(u / 0.97)
    shift_pelvis(controls, 0.01 * h * down, 0.0, -down * (body.pelvis_height_m(STAND_STRETCH) - KNEELING_M * h))
    controls.knee_room[:] = np.maximum(controls.knee_room, rise(np.clip(3 * u, 0, 1)) * 0.7)
    lean = bump(np.clip(u, 0, 1))
    controls.spine_rad[:, 1] += 0.3 * lean
    controls.arm_rad[:, :, 0] += (0.25 * lean)[:, None]
    return controls


def lying_down(context: StepContext) -> Controls:
    lasts = float(np.clip(0.95 * context.duration_s, 2.3, (5.0, 3.6, 2.5)[context.step.speed + 1]))
    return _down(context, (context.time_s - context.start_s) / lasts, falls=False)


def falling(context: StepContext) -> Controls:
    """Loss of balance, and down within about a second."""
    lasts = float(np.clip(0.9 * context.duration_s, 1.15, (1.7, 1.4, 1.2)[context.step.speed + 1]))
    return _down(context, (context.time_s - context.start_s) / lasts, falls=True)


def lying(context: StepContext) -> Controls:
    """Lying still, with breathing and slight movement of the arms."""
    return _down(context, np.ones_like(context.time_s), falls=False)


def rolling_over(context: StepContext) -> Controls:
    """Lying, onto a side and back again, as often as the sentence says."""
    return rolled(context, lying(context))


def rolled(context: StepContext, controls: Controls) -> Controls:
    """A lying body that rolls onto its left or right side and back; the knees point where the chest does."""
    h = context.body.height_m
    side = context.step.direction or ("left" if context.rng.random() < 0.5 else "right")
    left = 1.0 if side == "left" else -1.0
    count = max(context.step.count, 1)
    over = np.zeros_like(context.time_s)
    for begin, lasts in repeats(context, min(3.4, context.duration_s / count), 1.5, 6.0)[:count]:
        over += plateau(context.time_s, begin, begin + lasts, 0.4 * lasts, 0.4 * lasts)
    on_belly = context.step.style == "front"
    controls.roll_over_rad[:] += left * 1.3 * over
    shift_pelvis(controls, 0.0, (-left if on_belly else left) * 0.05 * h * over, 0.045 * h * over)
    for foot in (LEFT, RIGHT):
        is_upper = (foot == RIGHT) == (side == "left") and not on_belly
        shift_foot(controls, foot, 0.0, 0.0, (0.1 if is_upper else 0.02) * h * over)
        controls.arm_rad[:, foot, 0] += 0.9 * over
        controls.arm_rad[:, foot, 1] -= (0.8 if is_upper else 0.35) * over  # the upper arm lies ahead
        controls.arm_rad[:, foot, 3] += 0.7 * over
    if not on_belly:
        controls.knee_up_rad[:] -= 0.5 * np.pi * over
        controls.foot_rad[:, :, 0] += left * 0.5 * np.pi * over[:, None]
        controls.knee_out_rad[:] += left * 0.25 * np.pi * over[:, None] * np.array([1.0, -1.0])
    return controls


def getting_up(context: StepContext) -> Controls:
    lasts = float(np.clip(0.95 * context.duration_s, 2.5, (5.0, 3.8, 2.7)[context.step.speed + 1]))
    return _down(context, 1 - (context.time_s - context.start_s) / lasts, falls=False)


def _down(context: StepContext, u: PerTime, *, falls: bool) -> Controls:
    if context.step.style in ("left", "right"):
        return on_side(context, u)
    return _on_belly(context, u, falls=falls) if context.step.style == "front" else _on_back(context, u, falls=falls)


def on_side(context: StepContext, u: PerTime) -> Controls:
    """To one's own left or right: that knee gives way, the hip and then the trunk land, knees bent, an arm ahead."""
    controls, body, h = upright(context), context.body, context.body.height_m
    side = LEFT if context.step.style == "left" else RIGHT
    left = 1.0 if side == LEFT else -1.0
    stand = body.pelvis_height_m(STAND_STRETCH)
    at, u = [0.0, 0.3, 0.6, 0.8, 1.0], np.clip(u, 0.0, 1.0)
    heights = [stand, stand - 0.1 * h, 0.17 * h, 0.115 * h, LYING_M * h + 0.025 * h]
    controls.pelvis_m[:, 2] += spline_through(u, at, heights) - stand
    shift_pelvis(controls, 0.0, left * spline_through(u, at, [0.0, 0.08, 0.27, 0.32, SIDE_AWAY_M]) * h, 0.0)
    controls.pelvis_rad[:, 0] -= left * spline_through(u, at, [0.0, 0.3, 0.85, 1.25, 1.45])
    controls.spine_rad[:, 0] -= left * spline_through(u, at, [0.0, 0.25, 0.1, 0.1, 0.05])
    controls.spine_rad[:, 1] += spline_through(u, at, [0.0, 0.2, 0.35, 0.25, 0.2])
    controls.head_rad[:, 0] += spline_through(u, at, [0.0, 0.0, 0.25, 0.2, 0.1])
    controls.knee_room[:] = np.maximum(controls.knee_room, rise(3 * u))
    controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    controls.arm_rad[:, side, 0] += spline_through(u, at, [0.0, 0.3, 1.0, 1.4, 1.5])
    controls.arm_rad[:, side, 1] += spline_through(u, at, [0.0, 0.7, 0.45, 0.0, -0.17])
    controls.arm_rad[:, 1 - side, 0] += spline_through(u, at, [0.0, 0.5, 0.8, 0.7, 0.6])
    controls.arm_rad[:, :, 3] += spline_through(u, at, [0.0, 0.3, 0.5, 0.5, 0.5])[:, None]
    return controls


def _on_back(context: StepContext, u: PerTime, *, falls: bool) -> Controls:
    """Down over the heels to sit on the floor, then the trunk leans back; knees bent, soles on the floor."""
    controls, body, h = upright(context), context.body, context.body.height_m
    stand = body.pelvis_height_m(STAND_STRETCH)
    at = [0.0, 0.3, 0.55, 0.75, 1.0]
    u = np.clip(u, 0.0, 1.0)
    low = 0.086 * h
    heights = [stand, stand - 0.2 * h, low + 0.02 * h, low, LYING_M * h]
    back = [0.0, -0.13, -0.32, -0.35, -BACK_BEHIND_M]
    pitch = [0.0, 0.55, 0.1, -0.75, -1.5] if not falls else [0.0, 0.3, -0.25, -1.0, -1.5]
    curl = [0.0, 0.55, 0.75, 0.5, 0.05]
    controls.pelvis_m[:, 2] += spline_through(u, at, heights) - stand
    shift_pelvis(controls, spline_through(u, at, back) * h, 0.0, 0.0)
    controls.pelvis_rad[:, 1] += spline_through(u, at, pitch)
    controls.spine_rad[:, 1] += spline_through(u, at, curl)
    controls.head_rad[:, 0] += spline_through(u, at, [0.0, 0.0, 0.25, 0.45, 0.0])
    controls.knee_up_rad[:] += 0.5 * np.pi * rise(u / 0.6)
    controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    out = 0.6 if falls else 0.25
    controls.arm_rad[:, :, 0] += spline_through(
        u, at, [0.0, 0.7, 0.15 if not falls else 0.6, 0.0 if falls else -0.1, -0.03]
    )[:, None]
    controls.arm_rad[:, :, 1] += spline_through(u, at, [0.0, out, 0.55, 0.4, 0.22])[:, None]
    controls.arm_rad[:, :, 3] += spline_through(u, at, [0.0, 0.2, 0.1, 0.0, -0.05])[:, None]
    return controls


def _on_belly(context: StepContext, u: PerTime, *, falls: bool) -> Controls:
    """Forward: the knees give way, the trunk tips over the toes, the arms reach ahead, the body lies stretched out."""
    controls, body, h = upright(context), context.body, context.body.height_m
    stand = body.pelvis_height_m(STAND_STRETCH)
    at = [0.0, 0.3, 0.52, 0.78, 1.0]
    u = np.clip(u, 0.0, 1.0)
    controls.pelvis_m[:, 2] += spline_through(u, at, [stand, 0.43 * h, 0.305 * h, 0.168 * h, LYING_M * h]) - stand
    shift_pelvis(controls, spline_through(u, at, [0.0, 0.1, 0.35, 0.605, BELLY_AHEAD_M]) * h, 0.0, 0.0)
    controls.pelvis_rad[:, 1] += spline_through(u, at, [0.0, 0.3, 0.62, 1.25, 1.5])
    controls.spine_rad[:, 1] += spline_through(u, at, [0.0, 0.25, 0.2, 0.0, -0.05])
    controls.head_rad[:, 0] -= spline_through(u, at, [0.0, 0.2, 0.4, 0.5, 0.35])
    for side in (LEFT, RIGHT):
        controls.foot_rad[:, side, 1] += spline_through(u, at, [0.0, 0.8, 1.4, 2.0, 2.2])
        controls.foot_m[:, side, 2] += 0.012 * h * rise(u)
    controls.knee_up_rad[:] -= spline_through(u, at, [0.0, 0.0, 0.2, 0.9, 1.45])
    controls.knee_room[:] = np.maximum(controls.knee_room, rise(3 * u))
    arms = [0.0, 0.8, 1.5, 2.3, 2.95] if falls else [0.0, 0.7, 1.35, 2.2, 2.95]
    controls.arm_rad[:, :, 0] += spline_through(u, at, arms)[:, None]
    controls.arm_rad[:, :, 1] += spline_through(u, at, [0.0, 0.1, 0.2, 0.3, 0.3])[:, None]
    controls.arm_rad[:, :, 3] += spline_through(u, at, [0.0, 0.3, 0.3, 0.1, -0.1])[:, None]
    return controls
