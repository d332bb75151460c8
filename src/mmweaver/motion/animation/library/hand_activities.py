"""Hand activities in front of the body: eating, typing, reading, phoning, wiping, writing, instruments, doors."""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.gestures import mouth_in_chest_m
from mmweaver.motion.animation.library.movement_primitives import (
    cycles,
    hand_to,
    lift_weight,
    one_side,
    place,
    repeats,
    shift_foot,
    shift_pelvis,
    sides,
    vary,
)
from mmweaver.motion.animation.profiles import plateau, rise, wander
from mmweaver.motion.animation.step_context import StepContext


def _on(context: StepContext) -> np.ndarray:
    """(n,) ones: the arm is in place all the time."""
    return np.ones_like(context.time_s)


def eating(context: StepContext, controls: Controls) -> Controls:
    """From a plate in front of the belly to the mouth and back, again and again; the head meets the hand."""
    time_s, rng, n = context.time_s, context.rng, len(context.time_s)
    side = one_side(context)
    bite_s = context.tempo(2.6, 2.0, 1.5)
    count = context.step.count or max(1, int(context.duration_s / bite_s + 0.4))
    bite_s = float(np.clip(context.duration_s / count, 1.2, 3.6))
    lift = np.zeros(n)
    for k in range(count):
        begin = context.start_s + (k + 0.08) * bite_s
        lift += plateau(time_s, begin, begin + 0.86 * bite_s, 0.34 * bite_s, 0.36 * bite_s)
    controls.head_rad[:, 0] += 0.12 + 0.1 * lift
    controls.spine_rad[:, 1] += 0.06
    mouth = mouth_in_chest_m(context.body, controls) / context.body.height_m
    mouth[:, 1] *= 1.0 if side == LEFT else -1.0
    spoon = mouth + np.array([0.045, 0.03, -0.03])
    plate = np.array([rng.uniform(0.17, 0.2), rng.uniform(0.03, 0.06), rng.uniform(-0.12, -0.07)])
    hand_to(controls, context.body, side, plate + lift[:, None] * (spoon - plate), _on(context), (-0.25, 0.75, -1.0))
    rest = place(0.18, 0.05, plate[2] - 0.01, n)
    hand_to(controls, context.body, 1 - side, rest, _on(context))
    return controls


def typing(context: StepContext, controls: Controls) -> Controls:
    """Both hands over a keyboard: movements of centimetres, fast and irregular, with pauses."""
    time_s, rng, n = context.time_s, context.rng, len(context.time_s)
    controls.head_rad[:, 0] += 0.22
    controls.spine_rad[:, 1] += 0.05
    busy = 0.6 + 0.4 * np.tanh(2 * wander(time_s, rng, slow_hz=0.15, fast_hz=0.6))
    tap_hz = context.tempo(2.2, 3.2, 4.2)
    for side in (LEFT, RIGHT):
        tap = wander(time_s, rng, slow_hz=0.7 * tap_hz, fast_hz=1.3 * tap_hz) * busy
        drift = wander(time_s, rng, slow_hz=0.3, fast_hz=1.2)
        target = place(0.2 + 0.006 * drift, 0.045 + 0.008 * drift, -0.085 + 0.0035 * tap, n)
        hand_to(controls, context.body, side, target, _on(context), (-0.6, 0.4, -1.0))
    return controls


def reading(context: StepContext, controls: Controls) -> Controls:
    """A book in both hands in front of the chest, eyes down; a page is turned every few seconds."""
    time_s, rng, n = context.time_s, context.rng, len(context.time_s)
    controls.head_rad[:, 0] += 0.32
    controls.head_rad[:, 1] += 0.07 * np.sin(2 * np.pi * 0.35 * time_s)
    page_s = float(rng.uniform(2.5, 4.0))
    first = context.start_s + float(rng.uniform(0.4, 1.4))
    turn = np.zeros(n)
    for begin in np.arange(first, context.end_s, page_s):
        turn += plateau(time_s, float(begin), float(begin) + 0.9, 0.45, 0.45)
    up = float(rng.uniform(-0.05, 0.01))
    left, right = place(0.17, 0.05, up, n), place(0.17 - 0.02 * turn, 0.05 - 0.075 * turn, up + 0.03 * turn, n)
    hand_to(controls, context.body, LEFT, left, _on(context))
    hand_to(controls, context.body, RIGHT, right, _on(context))
    return controls


def phoning(context: StepContext, controls: Controls) -> Controls:
    """One hand at the ear; the head tilts slightly and nods while talking."""
    time_s, rng, n = context.time_s, context.rng, len(context.time_s)
    side = one_side(context)
    ear = place(0.035, 0.075, float(rng.uniform(0.12, 0.135)), n)
    hand_to(controls, context.body, side, ear, _on(context), (0.5, 0.8, -1.0))
    controls.head_rad[:, 0] += 0.05 * wander(time_s, rng, slow_hz=0.3, fast_hz=1.2)
    controls.head_rad[:, 1] += 0.12 * wander(time_s, rng, slow_hz=0.1, fast_hz=0.5)
    return controls


def texting(context: StepContext, controls: Controls) -> Controls:
    """A phone in one or both hands in front of the chest, head down; thumbs move the wrists by millimetres."""
    time_s, rng, n = context.time_s, context.rng, len(context.time_s)
    hands = sides(context) if context.step.hand else ((LEFT, RIGHT) if rng.random() < 0.5 else (RIGHT,))
    controls.head_rad[:, 0] += 0.4
    for side in hands:
        tap = wander(time_s, rng, slow_hz=1.5, fast_hz=4.0)
        target = place(0.15, 0.022, 0.0 + 0.0015 * tap, n)
        hand_to(controls, context.body, side, target, _on(context), (-0.5, 0.4, -1.0))
    return controls


def _to_and_fro(context: StepContext, rate: tuple[float, float, float], spread: float = 0.1) -> np.ndarray:
    """A sine (n,) at a sampled rate, (slow, usual, fast) in Hz, with a random phase."""
    rate_hz = context.tempo(*rate, spread)
    return np.sin(2 * np.pi * rate_hz * (context.time_s - context.start_s) + context.rng.uniform(0, 2 * np.pi))


def counting_on_fingers(context: StepContext, controls: Controls) -> Controls:
    """One hand is held open before the chest, the other taps at its fingers, one after the other."""
    time_s, n = context.time_s, len(context.time_s)
    tapping = one_side(context)
    rate_hz, end_s = cycles(context, context.tempo(1.1, 1.5, 2.0), 0.8, 2.4)
    phase = 2 * np.pi * rate_hz * (time_s - context.start_s)
    stops = rise((end_s - time_s) / 0.3 + 1.0)
    away = (0.5 - 0.5 * np.cos(phase)) * stops
    hand_to(controls, context.body, 1 - tapping, place(0.16, 0.03, -0.03, n), _on(context))
    target = place(0.165, 0.005 + 0.02 * away, 0.0 + 0.03 * away, n)
    hand_to(controls, context.body, tapping, target, _on(context))
    controls.head_rad[:, 0] += 0.22 + 0.04 * away
    return controls


def brushing_teeth(context: StepContext, controls: Controls) -> Controls:
    """A hand in front of the mouth moves to and fro by a few centimetres, three times a second."""
    n, side = len(context.time_s), one_side(context)
    stroke = _to_and_fro(context, (2.0, 2.8, 3.6)) * vary(context, 0.011)
    drift = wander(context.time_s, context.rng, slow_hz=0.1, fast_hz=0.4)
    target = place(0.115 + 0.2 * stroke, 0.035 + stroke + 0.008 * drift, 0.13 + 0.004 * drift, n)
    hand_to(controls, context.body, side, target, _on(context), (-0.1, 1.0, -0.7))
    controls.head_rad[:, 0] += 0.08
    return controls


def combing(context: StepContext, controls: Controls) -> Controls:
    """From the forehead over the head to its back, and forward again through the air."""
    time_s, n, side = context.time_s, len(context.time_s), one_side(context)
    phase = 2 * np.pi * context.tempo(0.45, 0.65, 0.85) * (time_s - context.start_s)
    back = 0.5 - 0.5 * np.cos(phase)
    off = np.maximum(np.sin(phase + np.pi), 0) ** 3
    target = place(0.09 - 0.1 * back, 0.05 + 0.02 * back, 0.235 - 0.04 * back + 0.025 * off, n)
    hand_to(controls, context.body, side, target, _on(context), (0.4, 1.0, -0.1))
    controls.head_rad[:, 0] += 0.06
    return controls


def wiping(context: StepContext, controls: Controls) -> Controls:
    """Over a table ahead: to and fro or in circles, with shoulder and trunk."""
    n, side, rng = len(context.time_s), one_side(context), context.rng
    rate = context.tempo(0.6, 0.95, 1.4)
    phase = 2 * np.pi * rate * (context.time_s - context.start_s)
    wide = vary(context, 0.075) * min(1.0, 1.0 / rate)
    deep = wide * float(rng.choice([0.15, 0.8]))
    across = np.sin(phase)
    controls.spine_rad[:, 1] += 0.3
    controls.head_rad[:, 0] += 0.12
    controls.spine_rad[:, 2] += (0.07 if side == LEFT else -0.07) * across
    target = place(0.21 + deep * np.cos(phase), 0.06 + wide * across, -0.1 - 0.2 * deep * np.cos(phase), n)
    hand_to(controls, context.body, side, target, _on(context), (-0.4, 0.6, -0.8))
    return controls


def writing(context: StepContext, controls: Controls) -> Controls:
    """On a board at head height (standing) or a table: small strokes along a line."""
    time_s, n, side = context.time_s, len(context.time_s), one_side(context)
    standing = context.step.lower == "stand"
    stroke = wander(time_s, context.rng, slow_hz=1.2, fast_hz=2.4)
    other = wander(time_s, context.rng, slow_hz=1.2, fast_hz=2.4)
    line = ((time_s - context.start_s) / 4.0) % 1.0
    line = rise(np.asarray(line / 0.85)) - rise(np.asarray((line - 0.85) / 0.15))
    outward = 0.09 - (0.14 * line if side == LEFT else 0.14 * (1 - line)) + 0.05
    if standing:
        target = place(0.24, outward + 0.006 * other, 0.12 + 0.009 * stroke, n)
    else:
        target = place(0.2 + 0.005 * stroke, 0.6 * outward + 0.005 * other, -0.08, n)
        controls.head_rad[:, 0] += 0.28
    hand_to(controls, context.body, side, target, _on(context), (-0.3, 0.6, -1.0))
    return controls


def stirring(context: StepContext, controls: Controls) -> Controls:
    """Circles over a pot in front of the belly; the other hand holds it."""
    n, side = len(context.time_s), one_side(context)
    phase = 2 * np.pi * context.tempo(0.7, 1.1, 1.6) * (context.time_s - context.start_s)
    wide = vary(context, 0.03)
    target = place(0.2 + wide * np.cos(phase), 0.03 + wide * np.sin(phase), -0.03 + 0.0 * phase, n)
    hand_to(controls, context.body, side, target, _on(context), (-0.2, 0.9, -0.8))
    hand_to(controls, context.body, 1 - side, place(0.19, 0.06, -0.1, n), _on(context))
    controls.head_rad[:, 0] += 0.25
    return controls


def knocking(context: StepContext, controls: Controls) -> Controls:
    """A raised fist taps a door ahead a few times."""
    time_s, n, side = context.time_s, len(context.time_s), one_side(context)
    rate, _ = cycles(context, context.tempo(2.2, 2.8, 3.4), 1.8, 3.6)
    up_s = min(0.45, 0.3 * context.duration_s)
    count = context.step.count or max(2, int((context.duration_s - 2 * up_s) * rate))
    begin = context.start_s + up_s
    end = begin + count / rate
    up = plateau(time_s, context.start_s, end + up_s, up_s, up_s)
    beat = plateau(time_s, begin, end, 0.15, 0.15) * (0.5 - 0.5 * np.cos(2 * np.pi * rate * (time_s - begin)))
    target = place(0.185 + 0.05 * beat, 0.06, 0.11 + 0.012 * beat, n)
    for hand in sides(context) if context.step.hand == "both" else (side,):
        hand_to(controls, context.body, hand, target, up)
    return controls


def opening_door(context: StepContext, controls: Controls) -> Controls:
    """The hand reaches for a handle, turns it, and pulls the door past the side of the body, one foot stepping back."""
    time_s, n, side = context.time_s, len(context.time_s), one_side(context)
    ((begin, lasts),) = repeats(context, 2.2, 1.6, 3.2)[:1]
    up = plateau(time_s, begin, begin + lasts, 0.28 * lasts, 0.26 * lasts)
    press = plateau(time_s, begin + 0.28 * lasts, begin + 0.62 * lasts, 0.1 * lasts, 0.1 * lasts)
    draw = rise((time_s - begin - 0.4 * lasts) / (0.4 * lasts))
    target = place(0.235 - 0.12 * draw, 0.05 + 0.13 * draw, -0.055 - 0.02 * press, n)
    hand_to(controls, context.body, side, target, up, (-0.5, 0.6, -0.8))
    turn = plateau(time_s, begin + 0.4 * lasts, begin + 1.05 * lasts, 0.35 * lasts, 0.3 * lasts)
    controls.spine_rad[:, 2] += (0.25 if side == LEFT else -0.25) * turn
    if context.step.lower == "stand":
        _step_out_of_the_way(context, controls, side, begin + 0.36 * lasts, begin + 1.02 * lasts)
    return controls


def _step_out_of_the_way(context: StepContext, controls: Controls, side: int, begin_s: float, end_s: float) -> None:
    """The foot on the door's side steps back, the weight goes with it, and both return."""
    time_s, h, span = context.time_s, context.body.height_m, end_s - begin_s
    gone = plateau(time_s, begin_s, end_s, 0.34 * span, 0.34 * span)
    air = plateau(time_s, begin_s, begin_s + 0.34 * span, 0.17 * span, 0.17 * span)
    air = air + plateau(time_s, end_s - 0.34 * span, end_s, 0.17 * span, 0.17 * span)
    shift_foot(controls, side, -0.16 * h * gone, 0.01 * h * gone, 0.03 * h * air)
    lift_weight(controls, side, air)
    shift_pelvis(controls, -0.075 * h * gone, 0.0, -0.008 * h * gone)


def playing_guitar(context: StepContext, controls: Controls) -> Controls:
    """One hand strums in front of the belly, the other holds the neck; left-handed only if the sentence says so."""
    time_s, n = context.time_s, len(context.time_s)
    side = LEFT if context.step.hand == "left" else RIGHT
    rate = context.tempo(1.4, 2.1, 2.9)
    strum = np.sin(2 * np.pi * rate * (time_s - context.start_s)) * (0.8 + 0.2 * np.sin(2 * np.pi * 0.4 * time_s))
    wide = vary(context, 0.028) * min(1.0, 2.0 / rate)
    target = place(0.155, 0.035 + 0.15 * wide * strum, -0.105 + wide * strum, n)
    hand_to(controls, context.body, side, target, _on(context), (-0.3, 0.9, -0.5))
    slide = wander(time_s, context.rng, slow_hz=0.15, fast_hz=0.6)
    neck = place(0.16, 0.165 + 0.012 * slide, -0.005 + 0.008 * slide, n)
    hand_to(controls, context.body, 1 - side, neck, _on(context), (-0.2, 0.3, -1.0))
    controls.head_rad[:, 0] += 0.18
    controls.spine_rad[:, 1] += 0.04 * np.sin(2 * np.pi * 0.5 * rate * time_s)
    return controls


def playing_violin(context: StepContext, controls: Controls) -> Controls:
    """The neck held out to one side at shoulder height, the bow moved across by the other arm."""
    time_s, n = context.time_s, len(context.time_s)
    side = LEFT if context.step.hand == "left" else RIGHT
    bow_hz = context.tempo(0.5, 0.8, 1.3)
    draw = 0.5 + 0.5 * np.sin(2 * np.pi * bow_hz * (time_s - context.start_s))
    target = place(0.185 - 0.02 * draw, -0.01 + 0.17 * draw, 0.125 - 0.05 * draw, n)
    hand_to(controls, context.body, side, target, _on(context), (0.2, 0.9, -0.3))
    tremble = wander(time_s, context.rng, slow_hz=3.0, fast_hz=5.0)
    hand_to(controls, context.body, 1 - side, place(0.22, 0.15 + 0.0012 * tremble, 0.125, n), _on(context))
    turn = 1.0 if side == RIGHT else -1.0
    controls.head_rad[:, 1] += 0.4 * turn
    controls.head_rad[:, 0] += 0.12
    return controls
