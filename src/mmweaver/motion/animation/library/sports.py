"""Arm activities that involve the trunk: boxing, throwing, tennis, golf, pushing, pulling, carrying, reaching."""

from dataclasses import dataclass

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, Span, plateau, spline_through, sum_plateaus
from mmweaver.motion.animation.step_context import BOTH, StepContext, gesture

BEGINS, THERE, BACK = 0.18, 0.52, 0.98  # shares of a punch: leaves the guard, hits, returns to the guard
QUICK_STRIKE_S = 0.46  # of a fist, from the guard and back
_GUARD = (0.15, 0.06, 0.11)  # of a fist: ahead, outward and up of spine3, in body heights


@dataclass(frozen=True, kw_only=True)
class Punch:
    """Path of a fist and the response of the trunk; positions are ahead, outward and up in body heights.

    Attributes:
        on_the_way: Waypoint of the fist between guard and hit.
        hits: Position of the fist at the hit.
        turn_rad: Turn of the trunk with the fist.
        dip: Dip of the body before the hit, in body heights.
        elbow: Direction of the elbow.
        leads: Whether the leading hand punches by default.
        in_turn: Whether several punches alternate.
        lasts_s: Usual time from guard to guard.
    """

    on_the_way: list[float]
    hits: list[float]
    turn_rad: float
    dip: float
    elbow: list[float]
    leads: bool
    in_turn: bool
    lasts_s: float


PUNCHES = {name: Punch(**MOVEMENTS[name]) for name in ("jab", "cross", "hook", "uppercut")}


@gesture("jab")
@gesture("cross")
@gesture("hook")
@gesture("uppercut")
def boxing(act: StepContext) -> None:
    """From the guard: one fist after the other if both punch, else the same one; the other stays in the guard."""
    punch, n = PUNCHES[act.step.upper], len(act.time_s)
    size, restless = min(act.vary(0.98, 0.05), 1.02), act.uniform(0.003, 0.01)
    fists, out = [np.tile(_GUARD, (n, 1)) for _ in BOTH], [np.zeros(n), np.zeros(n)]
    for fist in fists:
        fist += restless * np.stack([act.wander(0.8, 2.0) for _ in range(3)], axis=1)
    hits, guard = size * np.array(punch.hits), np.array(_GUARD)
    ways = np.array([_GUARD, punch.on_the_way, hits, 0.5 * (guard + hits), _GUARD]) - guard
    for k, span in enumerate(act.repeats(punch.lasts_s, 0.9 * punch.lasts_s, 1.4)):
        side = _fist(act, punch, k)
        at = [span.at(share) for share in (BEGINS, 0.5 * (BEGINS + THERE), THERE, 0.76, BACK)]
        fists[side] += np.stack([spline_through(act.time_s, at, way) for way in ways.T.tolist()], axis=1)
        hit = act.plateau(at[0], at[-1], at[2] - at[0], at[-1] - at[2])
        out[side] += hit
        _turn_shoulder(act, punch, side, hit, at)
    act.add(1, spine_pitch=0.08, head_pitch=0.1)
    for side in BOTH:
        act.hand_to(side, fists[side], 1.0, (-0.15, 0.45, -1.0))
        act.hand_to(side, fists[side], out[side], punch.elbow)


def _fist(act: StepContext, punch: Punch, k: int) -> int:
    """The fist of punch k: as stated, else the leading or following one; several punches alternate."""
    if act.hand in ("left", "right"):
        return act.named_side
    in_front = RIGHT if act.step.usual_hand == "left" else LEFT
    side = in_front if punch.leads else 1 - in_front
    return side if k % 2 == 0 or not (act.hand == "both" or punch.in_turn) else 1 - side


def _turn_shoulder(act: StepContext, punch: Punch, side: int, hit: PerTime, at: list[float]) -> None:
    """The trunk turns the shoulder of the fist forward, after a slight backward turn."""
    wound = spline_through(act.time_s, [at[0] - 0.1, at[1], at[2], at[-1]], [0.0, -0.2, 1.0, 0.0])
    turn = -OUTWARD[side] * act.vary(punch.turn_rad, 0.15) * wound
    act.add(turn, spine_yaw=0.75, pelvis_yaw=0.25, head_yaw=-1)
    low = act.plateau(at[0] - 0.12, at[2], at[1] - at[0] + 0.12, at[2] - at[1])
    act.pelvis(0.02 * act.height_m * hit, 0.0, -punch.dip * act.height_m * low)
    act.bend_knees(0.4 * low * (punch.dip > 0))
    act.add(hit, spine_pitch=0.06)


@gesture("punch")
def punching(act: StepContext) -> None:
    """Fists in front of the face; one after the other shoots forward at shoulder height and comes back.

    The trunk moves with each punch and sways in between over planted feet.
    """
    rng, one_arm = act.rng, act.hand in ("left", "right")
    rate, _ = act.cycles(1.1, 1.7, 2.0 if one_arm else 2.3, 0.9, 2.6)
    period = 1 / rate
    count = act.count or int(np.ceil(act.duration_s / period - 0.2))
    arms = act.sides() if one_arm else BOTH
    first, out = int(rng.integers(2)), [np.zeros_like(act.time_s), np.zeros_like(act.time_s)]
    # Quick boxing raises the rate; a shorter strike would exceed realistic accelerations of a fist (100 m/s2).
    shortest_s = 0.34 if act.speed <= 0 else min(QUICK_STRIKE_S, 0.95 * period * len(arms))
    strike = float(np.clip(0.75 * period, shortest_s, 0.62))
    for k in range(max(count, 1)):
        span = Span(act.time_s, act.start_s + 0.06 + k * period, strike)
        out[arms[(k + first) % len(arms)]] += span.plateau(0, 1, 0.48, 0.52)
    twist = act.uniform(0.35, 0.7) * (out[RIGHT] - out[LEFT])
    act.add(twist, spine_yaw=1, head_yaw=-0.8)
    act.add(1, spine_pitch=0.06)
    lunge_m, calm = act.uniform(0.02, 0.06) * (out[RIGHT] + out[LEFT]), 0.3 if one_arm else 1.0
    ahead = lunge_m + calm * act.uniform(0.015, 0.075) * act.wander(0.35, 1.5)
    aside = calm * act.uniform(0.02, 0.07) * act.wander(0.35, 1.2)
    act.pelvis(ahead, aside)
    act.add(ahead, spine_pitch=2.0)
    act.add(aside, spine_roll=-1.5)
    guard = np.array([act.uniform(0.13, 0.175), act.uniform(0.04, 0.09), act.uniform(0.06, 0.15)])
    hook = float(rng.choice([0.0, 0.0, rng.uniform(0.04, 0.12)]))  # hooks curve around the side
    restless = act.uniform(0.004, 0.02) * (act.count == 0 and len(arms) == 2)
    for side in BOTH:
        aim = np.array([act.uniform(0.25, 0.29), 0.035, 0.08 + rng.normal(0, 0.03)])
        target = guard + out[side][:, None] * (aim - guard)
        target[:, 1] += hook * 4 * out[side] * (1 - out[side])
        for axis in range(3):  # fists keep moving in the guard
            target[:, axis] += restless * act.wander(0.8, 2.2) * (1 - out[side])
        act.hand_to(side, target, 1.0, (-0.15, 0.45 + 3 * hook, -1.0))


def _key_arm(act: StepContext, span: Span, side: int, movement: str, weight: PerTime) -> None:
    """Blends an arm to the keyframes of a movement."""
    act.arm(np.stack(span.rows(movement, "flexion", "abduction", "twist", "elbow"), axis=1), weight, side)


@gesture("throw")
def throwing(act: StepContext) -> None:
    """The hand moves back next to the ear with the trunk, then both move forward and follow through."""
    side = act.one_side()
    movement = "throw_under" if act.style == "under" or act.rng.random() < 0.2 else "throw_over"
    for span in act.repeats(1.6, 1.3, 2.3):
        _key_arm(act, span, side, movement, span.plateau(0, 1, 0.2, 0.2))
        turn, pitch = span.rows(movement, "turn", "pitch")
        act.add(OUTWARD[side] * (act.vary(0.5) * turn), spine_yaw=1, pelvis_yaw=0.25, head_yaw=-0.9)
        act.add(pitch, spine_pitch=1)


@gesture("push")
def pushing(act: StepContext) -> None:
    """Palms in front of the chest, then away with the trunk leaning in, and back."""
    hands = act.named_arms
    for span in act.repeats(1.6, 1.1, 2.6):
        on, out = span.plateau(0, 1, 0.28, 0.28), span.plateau(0.25, 0.85, 0.28, 0.3)
        act.hand_to(hands, (0.13 + 0.15 * out, 0.08, 0.02 + 0.03 * out), on)
        act.add(1, spine_pitch=0.22 * out - 0.06 * on)


@gesture("pull")
def pulling(act: StepContext) -> None:
    """Outstretched arms pull something towards the body repeatedly, the trunk leaning back."""
    draw = sum_plateaus(act.in_turn(act.tempo(1.8, 1.4, 1.1), 1.0, 2.4, lag=0.1), 0, 0.88, 0.42, 0.42)
    act.hand_to(act.named_arms, (0.27 - 0.15 * draw, 0.06, -0.02 - 0.05 * draw))
    act.add(1, spine_pitch=0.12 - 0.26 * draw)


@gesture("carry")
def carrying(act: StepContext) -> None:
    """Something held in both hands in front of the belly, moving with the trunk; or hanging from one hand."""
    if act.hand in ("left", "right"):
        side = act.named_side
        act.arm((0.0, 0.16, 0.0, 0.08), 1.0, side)
        act.add(1, spine_roll=0.06 * OUTWARD[side])
        return
    act.hand_to(BOTH, (act.vary(0.17, 0.05), act.vary(0.085), act.uniform(-0.13, -0.05)))
    act.add(1, spine_pitch=-0.05)


@gesture("cradle")
def cradling(act: StepContext) -> None:
    """A baby at the chest: its head in the crook of one elbow, the other hand below it; the trunk rocks it."""
    head = 1 - act.sides()[0]  # most people keep the preferred hand free
    rate, _ = act.cycles(0.25, 0.4, 0.6, 0.2, 0.9)
    act.hand_to(head, (0.15, -0.03, -0.03), 1.0, (-0.3, 0.5, -1.0))
    act.hand_to(1 - head, (0.165, 0.0, -0.1), 1.0, (-0.5, 0.4, -1.0))
    act.add(np.sin(act.phase(rate)), spine_roll=act.vary(0.07, 0.2), spine_yaw=act.vary(0.12, 0.2))
    act.add(1, head_yaw=0.25 * OUTWARD[head])


@gesture("reach")
def reaching(act: StepContext) -> None:
    """A hand reaches for something ahead at table height, or up, and brings it back."""
    hands = act.sides()
    if act.style == "high":
        _reach_up(act)
        return
    up = act.uniform(-0.08, 0.03)
    for span in act.repeats(1.7, 1.1, 2.6):
        out = span.plateau(0, 0.78, 0.36, 0.34)
        target = (0.15 + 0.13 * out, 0.07, up + 0.02 - 0.02 * out)
        act.hand_to(hands, target, span.plateau(0, 1, 0.3, 0.3))
        act.add(out, spine_pitch=0.24, head_pitch=0.12)


def _reach_up(act: StepContext) -> None:
    """A hand reaches up ahead of the head, the trunk stretches after it."""
    hands, up = act.sides(), act.uniform(2.5, 2.85)
    for span in act.repeats(1.9, 1.2, 2.8):
        out = span.plateau(0, 1, 0.36, 0.36)
        for side in hands:
            act.arm((up, 0.12, 0.0, 0.12), out, side)
            act.add(np.sin(np.pi * out), side, elbow=1.1)
        if len(hands) == 1:
            act.add(out, spine_roll=0.1 * OUTWARD[hands[0]])
        act.add(out, head_pitch=-0.3)


@gesture("golf")
def golf_swing(act: StepContext) -> None:
    """Both hands together in front of the trunk: up over one shoulder, down, and up over the other."""
    near = act.named_side  # backswing to the right of a right-handed player
    for span in act.repeats(2.1, 1.6, 3.0):
        on = _stroke_weight(span, 0.1, 0.2)
        for side in BOTH:
            _key_arm(act, span, side, "golf_near" if side == near else "golf_far", on)
        act.add(OUTWARD[near] * span.rows("golf_near", "turn")[0], spine_yaw=1, pelvis_yaw=0.3, head_yaw=-1)
        act.add(on, spine_pitch=0.35)


def _stroke_weight(span: Span, around_s: float, ramp: float) -> PerTime:
    """1 during a stroke and within `around_s` seconds of it, with ramps of a share of its duration."""
    ramp_s = ramp * span.lasts_s
    return plateau(span.time_s, span.begin_s - around_s, span.at(1) + around_s, ramp_s, ramp_s)


@gesture("forehand")
@gesture("backhand")
def swinging_racket(act: StepContext) -> None:
    """The hand swings back at its own side or across the body, forward past the hip, and to the other side.

    The other hand is on the same grip, or goes out from in front of the body as the ball is hit.
    """
    side, h, stroke = act.one_side(), act.height_m, act.step.upper
    record = MOVEMENTS[stroke]
    for span in act.repeats(1.7, 1.4, 2.4):
        on = _stroke_weight(span, 0.15, 0.22)
        hand = np.stack(span.rows(stroke, "hand_ahead", "hand_out", "hand_up"), axis=1)
        swing, turn, ahead = span.rows(stroke, "swing", "turn", "ahead")
        act.hand_to(side, hand, on, (-0.6, 0.15, -1.0))
        other = [start + way * swing for start, way in zip((0.17, 0.03, -0.03), record["balance"], strict=True)]
        grip = hand * [1, -1, 1] + np.array([0.0, 0.045, 0.03])
        act.hand_to(1 - side, grip if act.hand == "both" else other, on, (-0.5, 0.6, -1.0))
        turn = OUTWARD[side] * act.vary(record["turn_rad"], 0.1) * turn
        act.add(turn, spine_yaw=0.7, pelvis_yaw=0.3, head_yaw=-0.9)
        low = span.plateau(0, 1, 0.35, 0.35)
        act.pelvis(ahead * h, 0.0, -0.02 * h * low)
        act.bend_knees(0.5 * low)
        act.add(low, spine_pitch=0.12)


@gesture("tennis_serve")
def serving(act: StepContext) -> None:
    """One hand throws the ball up and stays up; the other swings back, over the head and down across the body."""
    side, h, movement = act.one_side(), act.height_m, "tennis_serve"
    for span in act.repeats(2.2, 1.8, 3.0):
        on, up = _stroke_weight(span, 0.1, 0.2), span.plateau(0.08, 0.72, 0.3, 0.24)
        turn, pitch, ahead, dip = span.rows(movement, "turn", "pitch", "ahead", "dip")
        _key_arm(act, span, side, movement, on)
        toss = np.zeros((len(up), 4))
        toss[:, 0], toss[:, 1], toss[:, 3] = 0.3 + 2.3 * up, 0.1, 0.5 - 0.35 * up
        act.arm(toss, on, 1 - side)
        act.add(-OUTWARD[side] * act.vary(0.6, 0.1) * turn, spine_yaw=1, pelvis_yaw=0.3, head_yaw=-1)
        act.add(pitch, spine_pitch=1)
        act.add(up, head_pitch=-0.35)
        act.pelvis(ahead * h, 0.0, dip * h)
        act.bend_knees(0.6 * plateau(act.time_s, span.begin_s, span.at(1), 0.3, 0.3))
