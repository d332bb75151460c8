"""Work about the house: sweeping, vacuuming, taking a jacket off; coughing, breathing deeply and trembling."""

import numpy as np

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.gestures import mouth_in_chest_m
from mmweaver.motion.animation.library.movement_primitives import (
    cycles,
    hand_to,
    mix_arm,
    place,
    repeats,
    sides,
    spline_through,
    vary,
)
from mmweaver.motion.animation.profiles import bump, plateau, wander
from mmweaver.motion.animation.step_context import StepContext


def sweeping(context: StepContext, controls: Controls) -> Controls:
    """Both hands on a broom's stick, one above the other; strokes across the body, the trunk turning along."""
    time_s, n = context.time_s, len(context.time_s)
    rate, _ = cycles(context, context.tempo(0.45, 0.7, 1.0), 0.3, 1.3)
    stroke = np.sin(2 * np.pi * rate * (time_s - context.start_s)) * vary(context, 1.0, 0.15)
    low = sides(context)[0]
    sign = 1.0 if low == LEFT else -1.0
    controls.spine_rad[:, 1] += 0.28
    controls.spine_rad[:, 2] += 0.22 * stroke * sign
    controls.head_rad[:, 0] += 0.25
    on = np.ones(n)
    hand_to(controls, context.body, low, place(0.2 + 0.02 * stroke, 0.04 + 0.09 * stroke, -0.13, n), on)
    hand_to(controls, context.body, 1 - low, place(0.15, 0.02 - 0.03 * stroke, 0.02, n), on)
    return controls


def vacuuming(context: StepContext, controls: Controls) -> Controls:
    """One hand pushes the nozzle ahead and draws it back; the trunk and the weight go with it."""
    time_s, n = context.time_s, len(context.time_s)
    rate, _ = cycles(context, context.tempo(0.35, 0.5, 0.75), 0.25, 1.0)
    out = 0.5 - 0.5 * np.cos(2 * np.pi * rate * (time_s - context.start_s))
    side = sides(context)[0]
    turn = 0.15 * np.sin(2 * np.pi * 0.12 * (time_s - context.start_s))
    controls.spine_rad[:, 1] += 0.22 + 0.2 * out
    controls.spine_rad[:, 2] += turn
    controls.head_rad[:, 0] += 0.2
    reach_out = 0.12 + vary(context, 0.16, 0.1) * out
    hand_to(controls, context.body, side, place(reach_out, 0.05, -0.14 + 0.03 * out, n), np.ones(n))
    return controls


def taking_jacket_off(context: StepContext, controls: Controls) -> Controls:
    """Both hands open the jacket at the chest and pull it back over the shoulders; one sleeve comes off, the other."""
    time_s, n = context.time_s, len(context.time_s)
    ((begin, lasts),) = repeats(context, 0.92 * context.duration_s, 2.0, 6.0)[:1]
    at = [begin + share * lasts for share in (0.0, 0.22, 0.45, 0.62, 0.8, 1.0)]
    first = sides(context)[0]
    for side in (LEFT, RIGHT):
        late = 0.0 if side == first else 0.06 * lasts
        t = time_s - late
        target = place(
            spline_through(t, at, [0.03, 0.14, 0.02, -0.13, -0.12, 0.05]),
            spline_through(t, at, [0.12, 0.05, 0.17, 0.1, 0.05, 0.12]),
            spline_through(t, at, [-0.2, 0.08, 0.06, -0.12, -0.14, -0.2]),
            n,
        )
        on = plateau(time_s, begin, begin + lasts, 0.18 * lasts, 0.18 * lasts)
        hand_to(controls, context.body, side, target, on, elbow=(-0.4, 0.8, -0.6))
    back = plateau(time_s, begin + 0.3 * lasts, begin + 0.9 * lasts, 0.2 * lasts, 0.2 * lasts)
    controls.spine_rad[:, 1] += 0.12 * back
    controls.spine_rad[:, 2] += (1 if first == LEFT else -1) * 0.3 * back
    return controls


def coughing(context: StepContext, controls: Controls) -> Controls:
    """A hand before the mouth; two or three jerks of the trunk, a pause, and again."""
    time_s, rng, body = context.time_s, context.rng, context.body
    jerk, begin = np.zeros_like(time_s), context.start_s + 0.35
    fits = context.step.count or max(1, int(context.duration_s / 2.2))
    for k in range(fits):
        for cough in range(int(rng.integers(2, 4))):
            at = begin + k * (context.duration_s - 0.4) / fits + 0.38 * cough
            jerk += vary(context, 1.0, 0.2) * bump((time_s - at) / 0.3)
    controls.spine_rad[:, 1] += 0.08 + 0.17 * jerk
    controls.head_rad[:, 0] += 0.12 + 0.15 * jerk
    side = sides(context)[0]
    mouth = mouth_in_chest_m(body, controls)
    mouth[:, 1] *= 1.0 if side == LEFT else -1.0
    arm = reach(body, mouth + np.array([0.035, 0.02, -0.02]) * body.height_m, elbow=(-0.2, 0.8, -1.0))
    mix_arm(controls, side, arm, plateau(time_s, context.start_s - 0.1, context.end_s + 0.2, 0.5, 0.5))
    return controls


def breathing_deeply(context: StepContext, controls: Controls) -> Controls:
    """The chest rises and falls visibly, about twelve times a minute; the shoulders and the head go with it."""
    rate, _ = cycles(context, context.tempo(0.13, 0.2, 0.32), 0.1, 0.5)
    full = 0.5 - 0.5 * np.cos(2 * np.pi * rate * (context.time_s - context.start_s))
    controls.spine_rad[:, 1] -= vary(context, 0.09, 0.2) * full
    controls.head_rad[:, 0] -= 0.05 * full
    controls.arm_rad[:, :, 1] += (0.06 * full)[:, None]
    return controls


def trembling(context: StepContext, controls: Controls) -> Controls:
    """Arms drawn to the chest; they shake six to nine times a second in bouts, and the trunk and the head with them.

    Rates as of shivering and of enhanced physiological tremor (6 to 12 Hz; Deuschl et al., "Consensus statement of the
    Movement Disorder Society on tremor", 1998); some 1 cm at the hands.
    """
    time_s, n, rng = context.time_s, len(context.time_s), context.rng
    on = plateau(time_s, context.start_s - 0.1, context.end_s + 0.2, 0.5, 0.5)
    rate = 2 * np.pi * context.tempo(6.0, 7.5, 9.0) * (time_s - context.start_s)
    bout = on * np.clip(0.65 + 0.35 * wander(time_s, rng, slow_hz=0.2, fast_hz=0.7), 0.2, 1.2)
    for side in (LEFT, RIGHT):
        shake = vary(context, 0.005, 0.2) * bout * np.sin(rate + rng.uniform(0, 2 * np.pi))
        target = place(0.1, 0.03, 0.02 + shake, n)
        hand_to(controls, context.body, side, target, on, (-0.2, 0.5, -1.0))
        controls.arm_rad[:, side, 3] += 2.0 * shake
    whole = bout * np.sin(rate + rng.uniform(0, 2 * np.pi))
    controls.spine_rad[:, 1] += 0.14 * on + 0.006 * whole
    controls.spine_rad[:, 2] += 0.008 * bout * np.sin(rate + rng.uniform(0, 2 * np.pi))
    controls.head_rad[:, 0] += 0.1 * on + 0.008 * whole
    return controls
