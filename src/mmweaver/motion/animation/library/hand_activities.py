"""Activities of the hands in front of the body and in a home: eating, typing, phoning, instruments, doors, brooms."""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import PerTime, Span, bump, plateau, raised_cosine, rise, sum_plateaus
from mmweaver.motion.animation.step_context import BOTH, StepContext, gesture


@gesture("eat")
def eating(act: StepContext) -> None:
    """From a plate in front of the belly to the mouth and back repeatedly; the head meets the hand."""
    side, spans = act.one_side(), act.in_turn(act.tempo(2.6, 2.0, 1.5), 1.2, 3.6, lag=0.08, more=0.4)
    lift = sum_plateaus(spans, 0, 0.86, 0.34, 0.36)
    act.add(1, head_pitch=0.12 + 0.1 * lift, spine_pitch=0.06)
    spoon = act.mouth_m(side) / act.height_m + np.array([0.045, 0.03, -0.03])
    plate = np.array([act.uniform(0.17, 0.2), act.uniform(0.03, 0.06), act.uniform(-0.12, -0.07)])
    act.hand_to(side, plate + lift[:, None] * (spoon - plate), 1.0, (-0.25, 0.75, -1.0))
    act.hand_to(1 - side, (0.18, 0.05, plate[2] - 0.01))


@gesture("type")
def typing(act: StepContext) -> None:
    """Both hands over a keyboard: fast, irregular movements of centimetres, with pauses."""
    busy = 0.6 + 0.4 * np.tanh(2 * act.wander(0.15, 0.6))
    tap_hz = act.tempo(2.2, 3.2, 4.2)
    for side in BOTH:
        tap, drift = act.wander(0.7 * tap_hz, 1.3 * tap_hz) * busy, act.wander(0.3, 1.2)
        target = (0.2 + 0.006 * drift, 0.045 + 0.008 * drift, -0.085 + 0.0035 * tap)
        act.hand_to(side, target)


@gesture("read")
def reading(act: StepContext) -> None:
    """A book in both hands in front of the chest, eyes down; a page is turned every few seconds."""
    act.add(1, head_yaw=0.07 * np.sin(2 * np.pi * 0.35 * act.time_s))
    page_s, first, turn = act.uniform(2.5, 4.0), act.start_s + act.uniform(0.4, 1.4), np.zeros_like(act.time_s)
    for begin in np.arange(first, act.end_s, page_s):
        turn += act.plateau(float(begin), float(begin) + 0.9, 0.45, 0.45)
    up = act.uniform(-0.05, 0.01)
    act.hand_to(LEFT, (0.17, 0.05, up))
    act.hand_to(RIGHT, (0.17 - 0.02 * turn, 0.05 - 0.075 * turn, up + 0.03 * turn))


@gesture("phone")
def phoning(act: StepContext) -> None:
    """One hand at the ear; the head tilts slightly and nods while talking."""
    act.hand_to(act.one_side(), (0.035, 0.075, act.uniform(0.12, 0.135)))
    act.add(act.wander(0.3, 1.2), head_pitch=0.05)
    act.add(act.wander(0.1, 0.5), head_yaw=0.12)


@gesture("text")
def texting(act: StepContext) -> None:
    """A phone in one or both hands in front of the chest, head down; the thumbs move the wrists by millimetres."""
    hands = act.sides() if act.hand else (BOTH if act.rng.random() < 0.5 else (RIGHT,))
    for side in hands:
        act.hand_to(side, (0.15, 0.022, 0.0 + 0.0015 * act.wander(1.5, 4.0)))


@gesture("count_fingers")
def counting_on_fingers(act: StepContext) -> None:
    """One hand is held open before the chest, the other taps its fingers one after the other."""
    tapping = act.one_side()
    rate_hz, end_s = act.cycles(1.1, 1.5, 2.0, 0.8, 2.4)
    away = raised_cosine(act.phase(rate_hz)) * rise((end_s - act.time_s) / 0.3 + 1.0)
    act.hand_to(1 - tapping, (0.16, 0.03, -0.03))
    act.hand_to(tapping, (0.165, 0.005 + 0.02 * away, 0.0 + 0.03 * away))
    act.add(1, head_pitch=0.22 + 0.04 * away)


@gesture("brush_teeth")
def brushing_teeth(act: StepContext) -> None:
    """A hand in front of the mouth oscillates by a few centimetres, about three times per second."""
    side, phase = act.one_side(), act.phase(act.tempo(2.0, 2.8, 3.6))
    stroke = np.sin(phase + act.rng.uniform(0, 2 * np.pi)) * act.vary(0.011)
    drift = act.wander(0.1, 0.4)
    target = (0.115 + 0.2 * stroke, 0.035 + stroke + 0.008 * drift, 0.13 + 0.004 * drift)
    act.hand_to(side, target)


@gesture("comb")
def combing(act: StepContext) -> None:
    """From the forehead over the head to its back, and forward again through the air."""
    side, phase = act.one_side(), act.phase(act.tempo(0.45, 0.65, 0.85))
    back, off = raised_cosine(phase), np.maximum(np.sin(phase + np.pi), 0) ** 3
    target = (0.09 - 0.1 * back, 0.05 + 0.02 * back, 0.235 - 0.04 * back + 0.025 * off)
    act.hand_to(side, target)


@gesture("wipe")
def wiping(act: StepContext) -> None:
    """Wipes a table ahead, to and fro or in circles, with shoulder and trunk."""
    side, rate = act.one_side(), act.tempo(0.6, 0.95, 1.4)
    across, ahead = np.sin(act.phase(rate)), np.cos(act.phase(rate))
    wide = act.vary(0.075) * min(1.0, 1.0 / rate)
    deep = wide * float(act.rng.choice([0.15, 0.8]))
    act.add(1, spine_yaw=OUTWARD[side] * 0.07 * across)
    target = (0.21 + deep * ahead, 0.06 + wide * across, -0.1 - 0.2 * deep * ahead)
    act.hand_to(side, target)


@gesture("write")
def writing(act: StepContext) -> None:
    """Writes on a board at head height (standing) or on a table: small strokes along a line."""
    side = act.one_side()
    stroke, other = act.wander(1.2, 2.4), act.wander(1.2, 2.4)
    line = ((act.time_s - act.start_s) / 4.0) % 1.0
    line = rise(np.asarray(line / 0.85)) - rise(np.asarray((line - 0.85) / 0.15))
    outward = 0.09 - (0.14 * line if side == LEFT else 0.14 * (1 - line)) + 0.05
    target = (0.24, outward + 0.006 * other, 0.12 + 0.009 * stroke)
    if act.step.lower != "stand":
        target = (0.2 + 0.005 * stroke, 0.6 * outward + 0.005 * other, -0.08)
        act.add(1, head_pitch=0.28)
    act.hand_to(side, target)


@gesture("stir")
def stirring(act: StepContext) -> None:
    """Circles over a pot in front of the belly; the other hand holds it."""
    side, phase, wide = act.one_side(), act.phase(act.tempo(0.7, 1.1, 1.6)), act.vary(0.03)
    act.hand_to(side, (0.2 + wide * np.cos(phase), 0.03 + wide * np.sin(phase), -0.03), 1.0, (-0.2, 0.9, -0.8))
    act.hand_to(1 - side, (0.19, 0.06, -0.1))


@gesture("knock")
def knocking(act: StepContext) -> None:
    """A raised fist taps a door ahead a few times."""
    side, up_s = act.one_side(), min(0.45, 0.3 * act.duration_s)
    rate, _ = act.cycles(2.2, 2.8, 3.4, 1.8, 3.6)
    count, begin = act.count or max(2, int((act.duration_s - 2 * up_s) * rate)), act.start_s + up_s
    end = begin + count / rate
    beat = act.plateau(begin, end, 0.15, 0.15) * raised_cosine(2 * np.pi * rate * (act.time_s - begin))
    hands, up = act.sides() if act.hand == "both" else (side,), act.plateau(act.start_s, end + up_s, up_s, up_s)
    act.hand_to(hands, (0.185 + 0.05 * beat, 0.06, 0.11 + 0.012 * beat), up)


@gesture("open_door")
def opening_door(act: StepContext) -> None:
    """The hand reaches for a handle, turns it, and pulls the door past the body, one foot stepping back."""
    h, side, span = act.height_m, act.one_side(), act.repeats(2.2, 1.6, 3.2)[0]
    press = span.plateau(0.28, 0.62, 0.1, 0.1)
    draw = rise((act.time_s - span.begin_s - 0.4 * span.lasts_s) / (0.4 * span.lasts_s))
    target = (0.235 - 0.12 * draw, 0.05 + 0.13 * draw, -0.055 - 0.02 * press)
    act.hand_to(side, target, span.plateau(0, 1, 0.28, 0.26))
    act.add(span.plateau(0.4, 1.05, 0.35, 0.3), spine_yaw=OUTWARD[side] * 0.25)
    if act.step.lower != "stand":
        return
    # The foot on the door's side steps back, the weight follows, and both return.
    begin, end = span.at(0.36), span.at(1.02)
    step = end - begin
    gone = act.plateau(begin, end, 0.34 * step, 0.34 * step)
    air = act.plateau(begin, begin + 0.34 * step, 0.17 * step, 0.17 * step)
    air = air + act.plateau(end - 0.34 * step, end, 0.17 * step, 0.17 * step)
    act.move_foot(side, -0.16 * h * gone, 0.01 * h * gone, 0.03 * h * air)
    act.lift_weight(side, air)
    act.pelvis(-0.075 * h * gone, 0.0, -0.008 * h * gone)


@gesture("guitar")
def playing_guitar(act: StepContext) -> None:
    """One hand strums in front of the belly, the other holds the neck; left-handed only if stated."""
    time_s, side, rate = act.time_s, act.named_side, act.tempo(1.4, 2.1, 2.9)
    strum = np.sin(act.phase(rate)) * (0.8 + 0.2 * np.sin(2 * np.pi * 0.4 * time_s))
    wide = act.vary(0.028) * min(1.0, 2.0 / rate)
    act.hand_to(side, (0.155, 0.035 + 0.15 * wide * strum, -0.105 + wide * strum), 1.0, (-0.3, 0.9, -0.5))
    slide = act.wander(0.15, 0.6)
    act.hand_to(1 - side, (0.16, 0.165 + 0.012 * slide, -0.005 + 0.008 * slide), 1.0, (-0.2, 0.3, -1.0))
    act.add(1, spine_pitch=0.04 * np.sin(2 * np.pi * 0.5 * rate * time_s))


@gesture("violin")
def playing_violin(act: StepContext) -> None:
    """The neck held out to one side at shoulder height, the bow moved across by the other arm."""
    side, bow_hz = act.named_side, act.tempo(0.5, 0.8, 1.3)
    draw = 0.5 + 0.5 * np.sin(act.phase(bow_hz))
    act.hand_to(side, (0.185 - 0.02 * draw, -0.01 + 0.17 * draw, 0.125 - 0.05 * draw), 1.0, (0.2, 0.9, -0.3))
    act.hand_to(1 - side, (0.22, 0.15 + 0.0012 * act.wander(3.0, 5.0), 0.125))
    act.add(1, head_yaw=-0.4 * OUTWARD[side])


@gesture("sweep")
def sweeping(act: StepContext) -> None:
    """Both hands on a broom's stick, one above the other; strokes across the body, the trunk turning along."""
    rate, _ = act.cycles(0.45, 0.7, 1.0, 0.3, 1.3)
    stroke = np.sin(act.phase(rate)) * act.vary(1.0, 0.15)
    low = act.sides()[0]
    act.add(1, spine_yaw=0.22 * stroke * OUTWARD[low])
    act.hand_to(low, (0.2 + 0.02 * stroke, 0.04 + 0.09 * stroke, -0.13))
    act.hand_to(1 - low, (0.15, 0.02 - 0.03 * stroke, 0.02))


@gesture("vacuum")
def vacuuming(act: StepContext) -> None:
    """One hand pushes the nozzle ahead and pulls it back; trunk and weight follow."""
    rate, _ = act.cycles(0.35, 0.5, 0.75, 0.25, 1.0)
    out, side = raised_cosine(act.phase(rate)), act.sides()[0]
    act.add(1, spine_pitch=0.22 + 0.2 * out, spine_yaw=0.15 * np.sin(act.phase(0.12)), head_pitch=0.2)
    act.hand_to(side, (0.12 + act.vary(0.16, 0.1) * out, 0.05, -0.14 + 0.03 * out))


@gesture("jacket_off")
def taking_jacket_off(act: StepContext) -> None:
    """Both hands open the jacket at the chest and pull it back over the shoulders; the sleeves come off one by one."""
    span = act.repeats(0.92 * act.duration_s, 2.0, 6.0)[0]
    first = act.sides()[0]
    for side in BOTH:
        late = Span(act.time_s - (0.0 if side == first else 0.06 * span.lasts_s), span.begin_s, span.lasts_s)
        target = late.rows("jacket_off", "ahead", "out", "up")
        act.hand_to(side, target, span.plateau(0, 1, 0.18, 0.18))
    act.add(span.plateau(0.3, 0.9, 0.2, 0.2), spine_pitch=0.12, spine_yaw=OUTWARD[first] * 0.3)


@gesture("cough")
def coughing(act: StepContext) -> None:
    """A hand before the mouth; two or three jerks of the trunk, a pause, repeated."""
    jerk, begin = np.zeros_like(act.time_s), act.start_s + 0.35
    fits = act.count or max(1, int(act.duration_s / 2.2))
    for k in range(fits):
        for cough in range(int(act.rng.integers(2, 4))):
            at = begin + k * (act.duration_s - 0.4) / fits + 0.38 * cough
            jerk += act.vary(1.0, 0.2) * bump((act.time_s - at) / 0.3)
    act.add(1, spine_pitch=0.08 + 0.17 * jerk, head_pitch=0.12 + 0.15 * jerk)
    side = act.sides()[0]
    target = act.mouth_m(side) + np.array([0.035, 0.02, -0.02]) * act.height_m
    act.hand_to_m(side, target, _raised(act))


def _raised(act: StepContext) -> PerTime:
    """1 during the step, rising and falling within half a second around its ends."""
    return plateau(act.time_s, act.start_s - 0.1, act.end_s + 0.2, 0.5, 0.5)


@gesture("breathe")
def breathing_deeply(act: StepContext) -> None:
    """The chest rises and falls visibly, about twelve times per minute; shoulders and head follow."""
    rate, _ = act.cycles(0.13, 0.2, 0.32, 0.1, 0.5)
    act.add(raised_cosine(act.phase(rate)), spine_pitch=-act.vary(0.09, 0.2), head_pitch=-0.05, abduction=0.06)


@gesture("tremble")
def trembling(act: StepContext) -> None:
    """Arms drawn to the chest shake six to nine times per second in bouts, and trunk and head with them.

    Rates as of shivering and of enhanced physiological tremor (6 to 12 Hz; Deuschl et al., "Consensus statement of the
    Movement Disorder Society on tremor", 1998); about 1 cm at the hands.
    """
    on, phase = _raised(act), act.phase(act.tempo(6.0, 7.5, 9.0))
    bout = on * np.clip(0.65 + 0.35 * act.wander(0.2, 0.7), 0.2, 1.2)
    for side in BOTH:
        shake = act.vary(0.005, 0.2) * bout * np.sin(phase + act.rng.uniform(0, 2 * np.pi))
        act.hand_to(side, (0.1, 0.03, 0.02 + shake), on)
        act.add(shake, side, elbow=2.0)
    whole = bout * np.sin(phase + act.rng.uniform(0, 2 * np.pi))
    act.add(1, spine_pitch=0.14 * on + 0.006 * whole, head_pitch=0.1 * on + 0.008 * whole)
    act.add(np.sin(phase + act.rng.uniform(0, 2 * np.pi)), spine_yaw=0.008 * bout)
