"""Gestures of arms, head and trunk over any posture, among them the ten arm gestures of mHomeGes (Liu et al., 2020).

Each changes the controls of the underlying posture; the legs are kept.
"""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import (
    PerTime,
    Span,
    larger,
    raised_cosine,
    reached,
    rise,
    spline_through,
    sum_plateaus,
    travel,
)
from mmweaver.motion.animation.step_context import BOTH, StepContext, gesture


@gesture("wave")
def waving(act: StepContext) -> None:
    """Upper arm out and ahead, forearm up and swinging sideways; the twisting upper arm makes the hand nod."""
    rng = act.rng
    rate, end = act.cycles(1.0, 1.6, 2.2, 0.8, 2.5)
    swing = act.uniform(0.35, 0.5) * min(1.0, 1.5 / rate)
    on = _until(act, end + 0.25)
    for side in act.sides():
        phase = act.phase(rate) + (rng.uniform(0, 0.6) if side else 0.0)
        abduction, flexion = rng.uniform(0.95, 1.4), rng.uniform(0.2, 0.8)
        nod, late = act.uniform(0.06, 0.3) * min(1.0, 1.5 / rate), rng.uniform(-0.6, 0.6)
        angles = (
            flexion + 0.05 * np.sin(phase + 0.5),
            abduction + 0.08 * np.sin(phase + 0.3),
            rng.uniform(1.15, 1.5) + nod * np.sin(phase + late),
            rng.uniform(1.55, 1.75) - swing * np.sin(phase),
        )
        act.arm(np.stack(angles, axis=1), on, side)
        act.add(on, spine_roll=0.03 * OUTWARD[side])


def _until(act: StepContext, end_s: float) -> PerTime:
    """1 until a counted movement has ended, then 0."""
    return rise((end_s - act.time_s) / 0.5) if act.count else np.ones_like(act.time_s)


@gesture("clap")
def clapping(act: StepContext) -> None:
    """Palms meet in front of the chest; each wrist stays on its own side of the midline."""
    h = act.height_m
    rate, end = act.cycles(1.2, 2.0, 2.8, 0.9, 3.5)
    opening = 0.5 + 0.5 * np.cos(act.phase(rate))  # 0 when the palms meet
    open_m = act.uniform(0.08, 0.13) * min(1.0, 2.0 / rate) * h
    ahead, up = act.uniform(0.16, 0.19), act.uniform(0.02, 0.07)
    x, y = (ahead - act.uniform(0.0, 0.04) * opening) * h, 0.024 * h + open_m * opening
    act.hand_to_m(BOTH, (x, y, (up + 0.01 * opening) * h), _until(act, end + 0.2))


@gesture("raise")
def raising(act: StepContext) -> None:
    """The straight arm rises in front or at the side, holds, and comes down at the end of the step."""
    rng, count = act.rng, max(act.count, 1)
    each = float(min(act.duration_s / count, 6.0 if count == 1 else 3.5))
    move = float(np.clip(act.tempo(1.2, 0.85, 0.6) * min(1.0, each / 2.0), 0.42, 1.6))
    up = np.zeros_like(act.time_s)
    for k in range(count):
        begin = act.start_s + k * each
        up += act.plateau(begin, max(begin + each - 0.02, begin + 2 * move), move, move)
    sideways, top = rng.random() < 0.3, act.uniform(2.75, 2.98)
    for side in act.sides():
        elbow = rng.uniform(0.12, 0.25)
        act.arm((0.12, top, 0.0, elbow) if sideways else (top, 0.08, 0.0, elbow), up, side)
        act.add(np.sin(np.pi * up), side, elbow=0.8 * (not sideways))
        act.add(up, spine_roll=-0.05 * OUTWARD[side] * (len(act.sides()) == 1))


@gesture("drink")
def drinking(act: StepContext) -> None:
    """A cup in front of the belly rises to the mouth, the head tilts back for the sip, and the cup comes down."""
    side, h = act.sides()[0], act.height_m
    sip_s = act.tempo(3.4, 2.6, 1.9)
    count = act.count or max(1, int(act.duration_s / sip_s + 0.3))
    sip_s = float(np.clip(act.duration_s / count, 1.3, 4.5))
    lift, tilt = np.zeros_like(act.time_s), np.zeros_like(act.time_s)
    for k in range(count):
        begin, end = act.start_s + (k + 0.04) * sip_s, act.start_s + (k + 0.96) * sip_s
        lift += act.plateau(begin, end, 0.36 * sip_s, 0.36 * sip_s)
        tilt += act.plateau(begin + 0.28 * sip_s, end - 0.28 * sip_s, 0.2 * sip_s, 0.2 * sip_s)
    act.add(tilt, head_pitch=-act.rng.uniform(0.2, 0.32))
    cup = act.mouth_m(side) + np.array([0.032, 0.022, -0.036]) * h
    rest = np.array([act.uniform(0.15, 0.18), act.uniform(0.05, 0.08), act.uniform(-0.08, -0.04)]) * h
    bow = np.array([0.03, 0.0, 0.0]) * h  # the path bows slightly outward
    target = rest + lift[:, None] * (cup - rest) + (4 * lift * (1 - lift))[:, None] * bow
    act.hand_to_m(side, target)


def _hold_arms(act: StepContext, up_s: float) -> PerTime:
    """Weight (n,): rises at the step's start and falls at its end, unless neighbouring steps hold the same posture."""
    move, ones = min(up_s, 0.4 * act.duration_s), np.ones_like(act.time_s)
    begin = ones if act.first or act.arms_before else rise((act.time_s - act.start_s) / move)
    return begin if act.last or act.arms_after else begin * rise((act.end_s + 0.2 - act.time_s) / move)


def _heading_rad(act: StepContext) -> float:
    """Median heading of the body during the step, radians."""
    meanwhile, heading = (act.time_s >= act.start_s) & (act.time_s <= act.end_s), act.controls.heading_rad
    return float(np.median(heading[meanwhile] if meanwhile.any() else heading))


@gesture("point")
def pointing(act: StepContext) -> None:
    """An arm stretched towards the given side (the viewer's left or right), ahead if none is given."""
    side = act.one_side()
    goal = {"left": np.pi, "right": 0.0}.get(act.facing or act.direction)
    if goal is None:
        aside = 0.0 if act.facing else act.uniform(-0.5, 0.1)
    else:  # the angle to the body's left
        left = (goal - _heading_rad(act) + np.pi) % (2 * np.pi) - np.pi
        if not act.hand:
            side = LEFT if left > 0 else RIGHT
        aside = float(np.clip(left * OUTWARD[side], -0.6, 1.5))
    level, ahead, out = act.uniform(1.35, 1.6), np.cos(aside), np.sin(aside)
    for span in act.repeats(max(1.7, min(act.duration_s / max(act.count, 1), 4.0)), 1.1, 4.5):
        move = float(np.clip(0.35 * span.lasts_s, 0.38, 0.7))
        up = act.plateau(span.begin_s, span.at(1), move, move)
        abduction = 0.1 + 1.35 * max(out, 0.0) + min(out, 0.0) * 0.8
        act.arm((level * max(ahead, 0.15), abduction, 0.0, 0.12), up, side)
        act.add(np.sin(np.pi * up), side, elbow=0.7)
        act.add(up, head_yaw=OUTWARD[side] * 0.5 * aside)


@gesture("nod")
def nodding(act: StepContext) -> None:
    """The head pitches down and up repeatedly."""
    rate, end = act.cycles(1.1, 1.6, 2.2, 1.0, 2.6)
    on = act.plateau(act.start_s, max(end, act.start_s + 0.5), 0.2, 0.2)
    act.add(raised_cosine(act.phase(rate)), head_pitch=act.uniform(0.16, 0.3) * on)


@gesture("shake_head")
def shaking_head(act: StepContext) -> None:
    """The head yaws to one side and the other repeatedly."""
    rate, end = act.cycles(0.9, 1.4, 2.0, 0.8, 2.2)
    on = act.plateau(act.start_s, max(end, act.start_s + 0.5), 0.25, 0.25)
    act.add(np.sin(act.phase(rate)), head_yaw=act.uniform(0.3, 0.55) * on)


@gesture("look_around")
def looking_around(act: StepContext) -> None:
    """Looks to one side and the other, or only to a given side, the trunk following slightly."""
    first, wide, facing = act.sign(), act.uniform(0.7, 1.0), act.facing or act.direction
    lasts = max(act.duration_s, 1.0)
    there = act.plateau(act.start_s, act.start_s + lasts, 0.3 * lasts, 0.3 * lasts)
    if facing == "down":
        act.add(there, head_pitch=0.6)
        return
    if facing in ("left", "right"):
        sign = -1.0 if facing == "left" else 1.0  # the viewer's side, whatever the body's heading
        yaw = sign * (1.0 if np.sin(_heading_rad(act)) < 0 else -1.0) * wide * there
    else:
        at = [act.start_s + share * lasts for share in (0.0, 0.25, 0.4, 0.7, 0.82, 1.0)]
        yaw = spline_through(act.time_s, at, [0.0, first * wide, first * wide, -first * wide, -first * wide, 0.0])
    act.add(yaw, head_yaw=1, spine_yaw=0.3)


@gesture("cross_arms")
def crossing_arms(act: StepContext) -> None:
    """Forearms crossed in front of the chest."""
    held, over = _hold_arms(act, 0.9), int(act.rng.integers(2))
    for side in BOTH:
        place = (0.135, -0.055, 0.0) if side == over else (0.105, -0.055, -0.02)
        act.hand_to(side, place, held)


@gesture("hips")
def hands_on_hips(act: StepContext) -> None:
    """Hands on the hips, elbows out."""
    act.hand_to(act.named_arms, (0.035, 0.1, -0.17), _hold_arms(act, 0.8))


@gesture("shrug")
def shrugging(act: StepContext) -> None:
    """Forearms turn out and up, the head tilts to one side, and all return."""
    tilt = float(act.sign() * act.rng.uniform(0.05, 0.15))
    for span in act.repeats(1.2, 0.9, 1.8):
        up = span.plateau(0, 1, 0.35, 0.4)
        act.arm((0.15, 0.45, 0.75, 1.35), up)
        act.add(up, spine_roll=0.4 * tilt, head_yaw=tilt)


@gesture("arms_out")
def arms_out(act: StepContext) -> None:
    """Straight arms held out: to the sides (as in a T), or ahead if stated."""
    tired = 0.03 * act.wander(0.2, 0.9)
    for side in act.named_arms:
        arm = np.zeros((len(tired), 4))
        ahead = act.step.arms_ahead
        arm[:, 0 if ahead else 1] = act.uniform(1.42, 1.58) + tired
        arm[:, 1 if ahead else 0] = 0.08
        arm[:, 3] = 0.1
        act.arm(arm, _hold_arms(act, 0.9), side)


@gesture("stretch")
def stretching(act: StepContext) -> None:
    """Both arms rise, the back arches, then the trunk leans to one side and the other, and the arms come down."""
    span = act.repeats(3.0, 1.7, 4.5)[0]
    up, peak = span.plateau(0, 1, 0.33, 0.33), span.plateau(0.2, 0.85, 0.2, 0.2)
    act.arm((act.uniform(2.75, 3.0), 0.15, 0.0, 0.2), up)
    act.add(np.sin(np.pi * up), elbow=0.9)
    aside = act.sign() * act.rng.uniform(0.1, 0.32)
    act.add(np.sin(2 * np.pi * (act.time_s - span.begin_s) / span.lasts_s), spine_roll=aside * peak)
    act.add(peak, spine_pitch=-0.16, head_pitch=-0.2)


@gesture("arm_circles")
def circling_arms(act: StepContext) -> None:
    """Straight arms circle at the sides: forward, up, back, down."""
    rate, end = act.cycles(0.5, 0.8, 1.1, 0.5, 1.2)
    lasts = max(end - act.start_s, 0.8)
    ramp = min(0.5, 0.4 / lasts)
    gone = travel(np.clip((act.time_s - act.start_s) / lasts, 0, 1), ramp, ramp)
    phase = 2 * np.pi * max(1, round(rate * lasts)) * gone
    for side in act.named_arms:
        arm = act.controls.arm_rad[:, side]
        arm[:, 0], arm[:, 1], arm[:, 3] = -0.02 + phase, 0.18 + 0.12 * np.sin(phase / 2) ** 2, 0.12


def _once(act: StepContext, slow: float, usual: float, fast: float) -> PerTime:
    """0 to 1 (n,) within a sampled time shortly after the start, then 1: a gesture that holds its final position."""
    lasts = float(np.clip(1 / act.tempo(1 / slow, 1 / usual, 1 / fast), 0.45, 0.9 * act.duration_s))
    wait = float(np.clip(act.rng.uniform(0.05, 0.3), 0.0, 0.2 * act.duration_s))
    return np.asarray(rise((act.time_s - act.start_s - wait) / lasts))


@gesture("raise_hold")
def raising_and_holding(act: StepContext) -> None:
    """The straight arm is lifted ahead to above the head and stays there; at once if it was there before."""
    _lift_arm(act, np.ones_like(act.time_s) if act.arms_before else _once(act, 1.6, 1.0, 0.65))


@gesture("lower_arm")
def lowering(act: StepContext) -> None:
    """The straight arm starts above the head, falls straight down and stays down."""
    _lift_arm(act, 1 - _once(act, 1.4, 0.85, 0.55))


def _lift_arm(act: StepContext, up: PerTime) -> None:
    """Arm between hanging (0) and overhead (1), by `up` (n,)."""
    top, bent = act.uniform(2.75, 3.0), act.uniform(0.05, 0.2)
    for side in act.sides():
        arm = act.controls.arm_rad[:, side].copy()
        arm[:, 0] += up * (top - arm[:, 0])
        arm[:, 1] += up * (0.1 - arm[:, 1])
        arm[:, 2] *= 1 - up
        arm[:, 3] += (bent - arm[:, 3]) * reached(4 * up)
        act.arm(arm, 1.0, side)


@gesture("push_hand")
def pushing_hand(act: StepContext) -> None:
    """The hand before the chest, palm forward, is pushed ahead, and the arm stays straight."""
    _stretch_arm(act, _once(act, 1.1, 0.6, 0.45))


@gesture("pull_hand")
def pulling_hand(act: StepContext) -> None:
    """The arm is straight ahead, and the hand returns to the chest."""
    _stretch_arm(act, 1 - _once(act, 1.1, 0.6, 0.45))


def _stretch_arm(act: StepContext, out: PerTime) -> None:
    """A hand between the chest (0) and full reach ahead (1); the shoulder follows."""
    near, far = np.array([0.09, 0.06, 0.03]), np.array([0.297, 0.08, 0.07])
    for side in act.sides():
        act.hand_to(side, near + out[:, None] * (far - near))
        act.add(out, spine_yaw=-OUTWARD[side] * 0.3)


@gesture("draw_circle")
def drawing_circle(act: StepContext) -> None:
    """The straight arm draws large circles, clockwise for the person, from hanging across the body, up and around."""
    count = act.count or max(1, round(act.duration_s / 2.5))
    spans = act.repeats(act.duration_s / count * 0.9, 0.9, 4.0)[:count]
    angle = 2 * np.pi * np.sum([rise(span.progress()) for span in spans], axis=0)
    _draw(act, -np.sin(angle), -np.cos(angle), 0.25)


@gesture("draw_z")
def drawing_z(act: StepContext) -> None:
    """The straight arm draws a large Z in front of the body: across, down to the other side, and across again."""
    span, at = act.repeats(0.85 * act.duration_s, 1.1, 3.5)[0], (0.0, 0.3, 0.65, 1.0)
    aside = span.keys(at, [-1.0, 1.0, -1.0, 1.0]) * -OUTWARD[act.sides()[0]]
    _draw(act, aside, span.keys(at, [1.0, 1.0, -1.0, -1.0]), 0.17)


def _draw(act: StepContext, aside: PerTime, up: PerTime, half: float) -> None:
    """Moves the hand of the straight arm in a plane: to the person's right and up, from -1 to 1 times `half`.

    Across the body the arm passes in front of it.
    """
    size = act.vary(half, 0.12)
    on = rise((act.time_s - act.start_s + 0.4) / 0.5) if not act.first else np.ones_like(aside)
    side = act.sides()[0]
    out = -OUTWARD[side] * aside
    ahead = np.sqrt(larger(0.28**2 - size**2 * (out**2 + up**2), 0.06**2, 0.01))
    ahead += 0.08 * (np.hypot(out, 0.3) - out) / 2
    # an elbow pointing down would be singular where the arm itself points down
    act.hand_to(side, (ahead, 0.09 + size * out, 0.07 + size * up), on)


@gesture("swipe")
def swiping(act: StepContext) -> None:
    """The hand is raised before the chest, sweeps to one side, up or down, and returns."""
    swipes = act.repeats(1.1, 0.5, 1.6)
    stroke = np.sum([rise((u - 0.3) / 0.3) - rise((u - 0.65) / 0.35) for u in map(Span.progress, swipes)], axis=0)
    first, last = swipes[0], swipes[-1]
    on = act.plateau(first.begin_s, last.at(1), 0.3 * first.lasts_s, 0.3 * last.lasts_s)
    along, side = act.vary(0.13, 0.12) * (2 * stroke - 1), act.sides()[0]
    outward = 1.0 if act.direction == ("right" if side == RIGHT else "left") else -1.0  # inward if no side is named
    vertical = {"up": 1.0, "down": -1.0}.get(act.style, 0.0)
    out = 0.05 + (0.0 if vertical else outward) * along
    act.hand_to(side, (0.27 - 0.5 * np.square(along), out, -0.02 + vertical * along), on)


@gesture("yawn")
def yawning(act: StepContext) -> None:
    """The hand covers the mouth and stays, the head tilts back and the body leans."""
    up = _once(act, 1.5, 1.0, 0.7)
    act.add(up, head_pitch=-act.vary(0.22), spine_pitch=-act.vary(0.08, 0.3))
    side = act.sides()[0]
    target = act.mouth_m(side) + np.array([0.03, 0.03, -0.015]) * act.height_m
    act.hand_to_m(side, target, up)


@gesture("knock_elbow")
def knocking_from_elbow(act: StepContext) -> None:
    """The hand at the side is raised from the elbow and lowered, without a pause."""
    count = act.count or max(1, round(act.duration_s / 1.2))
    spans = act.repeats(min(1.0, 0.95 * act.duration_s / count), 0.45, 1.6)[:count]
    up = sum_plateaus(spans, 0, 1, 0.5, 0.5)
    for side in act.sides():
        act.add(up, side, elbow=act.vary(1.9, 0.08), flexion=0.15)
