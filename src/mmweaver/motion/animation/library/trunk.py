"""Trunk over stationary feet: bowing, bending, leaning, twisting, picking up, putting down, dancing, hula hoop."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import PerTime, Span, bump, plateau, raised_cosine
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

_BEYOND_S = 10.0  # longer than coming up takes


@posture("bow")
def bowing(act: StepContext) -> None:
    """The straight trunk leans forward from the hips, which move back slightly; holds, and comes up."""
    deep = act.uniform(0.55, 0.95)
    arms = int(act.rng.integers(3))  # arms at the sides, hands on the thighs, one hand in front of the belly
    for span in act.repeats(2.1, 1.25, 3.2):
        down = span.plateau(0, 1, 0.38, 0.4)
        _hinge(act, down, deep)
        if arms == 2:
            act.arm((0.35, 0.25, -0.9, 1.5), down, RIGHT)
        else:
            act.add(down, flexion=(0.55 if arms else 0.2) * deep)


def _hinge(act: StepContext, down: PerTime, angle_rad: float) -> None:
    """Bends at the hips by an angle, scaled by `down` (n,); the pelvis moves back to keep the balance."""
    act.pelvis(-0.085 * act.height_m * np.sin(angle_rad) * down, 0.0, -0.01 * act.height_m * down)
    act.add(down, pelvis_pitch=0.62 * angle_rad, spine_pitch=0.38 * angle_rad, head_pitch=0.1)
    act.bend_knees(0.5 * down)


def _spells(act: StepContext, usual_s: float, min_s: float, max_s: float, share: float) -> list[PerTime]:
    """Depth (n,), 0 to 1, of each repetition: once, or throughout if it is held; ramps of a `share`.

    A posture held at the end of a sequence lasts to its last frame, unless the hands are active meanwhile.
    """
    if act.style in ("held", "released"):
        stays = act.last and act.style == "held" and not act.step.upper
        spans = [Span(act.time_s, act.start_s, act.duration_s + _BEYOND_S * stays)]
    else:
        spans = act.repeats(usual_s, min_s, max_s)
    ramps = [share * min(span.lasts_s, act.duration_s, max_s) for span in spans]
    return [act.plateau(span.begin_s, span.at(1), ramp, ramp) for span, ramp in zip(spans, ramps, strict=True)]


@posture("bend")
def bending(act: StepContext) -> None:
    """Far down with nearly straight legs, the hands towards the feet, and up again."""
    deep = act.uniform(1.35, 1.75)
    for down in _spells(act, 2.3, 1.5, 3.4, 0.42):
        _hinge(act, down, deep)
        act.pelvis(up=-0.025 * act.height_m * down)
        act.add(down, flexion=0.95 * deep)


@posture("lean")
def leaning(act: StepContext) -> None:
    """The trunk leans to one side or back and comes up; to both sides in turn if none is named."""
    h, deep = act.height_m, act.uniform(0.4, 0.6)
    for k, down in enumerate(_spells(act, 2.0, 1.2, 3.0, 0.4)):
        if act.direction == "backwards":
            act.pelvis(0.05 * h * down, 0.0, -0.01 * h * down)
            act.add(down, pelvis_pitch=-0.15 * deep, spine_pitch=-0.7 * deep, head_pitch=0.2)
            continue
        left_first = act.direction != "right"
        right = -1.0 if left_first == (k % 2 == 0 or bool(act.direction)) else 1.0  # roll: right side down
        act.pelvis(0.0, 0.035 * h * right * down, -0.006 * h * down)
        act.add(down, pelvis_roll=0.15 * deep * right, spine_roll=deep * right)


@posture("twist")
def twisting(act: StepContext) -> None:
    """The trunk turns to one side and the other over stationary feet, forearms level in front."""
    rate, end_s = act.cycles(0.3, 0.45, 0.7, 0.25, 0.9)
    on = act.plateau(act.start_s, end_s, 0.5, 0.5)
    wide = act.uniform(0.65, 0.9)
    act.add(on * np.sin(act.phase(rate)), pelvis_yaw=0.35 * wide, spine_yaw=wide)
    act.arm((0.35, 0.3, 0.5, 1.5), on)


@posture("pick_up")
def picking_up(act: StepContext) -> None:
    """Knees and hips bend, the hand reaches the floor in front of the feet and brings something up to the belly."""
    arms, spans = act.sides(), act.repeats(2.3, 1.6, 3.4)
    for span in spans:
        _reach_floor(act, span.plateau(0, 0.92, 0.44, 0.44), arms)
    _hold(act, act.plateau(spans[-1].at(0.5), act.end_s + 0.2, 0.7, 0.5), arms)


@posture("put_down")
def putting_down(act: StepContext) -> None:
    """Something held in front of the body is put on the floor, and the body comes up without it."""
    arms, spans = act.sides(), act.repeats(2.3, 1.6, 3.4)
    for span in spans:
        _reach_floor(act, span.plateau(0, 1, 0.44, 0.44), arms)
    _hold(act, act.plateau(act.start_s - 0.4, spans[-1].at(0.5), 0.5, 0.7), arms)


def _reach_floor(act: StepContext, down: PerTime, arms: tuple[int, ...]) -> None:
    """Down until the hands are near the floor, with a sampled proportion of knees and back."""
    depth = act.uniform(0.72, 0.95)
    act.crouch(depth * down, lean_rad=1.5 / depth)
    for side in BOTH:
        gains = {"flexion": 1.5, "abduction": -0.1} if side in arms else {"flexion": 0.5, "elbow": 0.6}
        act.add(down, side, **gains)
    if len(arms) == 1:
        act.add(down, spine_roll=-0.12 * OUTWARD[arms[0]])


def _hold(act: StepContext, share: PerTime, arms: tuple[int, ...]) -> None:
    """Forearms level in front of the belly, once the trunk is upright."""
    up = share * np.clip(1 - 0.8 * act.controls.pelvis_rad[:, 1], 0, 1)
    for side in arms:
        act.add(up, side, elbow=1.25, flexion=0.12)


@posture("dance")
def dancing(act: StepContext) -> None:
    """Step-touch: on every second beat a foot goes out and comes back while the weight is on the other one."""
    h, beat_hz, on = act.height_m, act.tempo(1.4, 1.8, 2.2), act.edges(0.5, 0.5)
    beat, lead = beat_hz * (act.time_s - act.start_s), act.sign()
    sway = lead * np.sin(np.pi * beat) * on  # +1: the weight is on the left
    act.pelvis(0.0, 0.042 * h * sway, -on * h * (0.014 + 0.011 * raised_cosine(2 * np.pi * beat)))
    act.bend_knees(on)
    _dance_steps(act, beat, lead, on)
    hip, chest = act.vary(0.14), act.vary(0.18)
    act.add(sway, pelvis_yaw=hip, spine_yaw=-1.6 * chest, spine_roll=-0.1)
    act.add(np.cos(2 * np.pi * beat), head_pitch=0.07 * on)
    act.add(sway, head_yaw=0.8 * chest)
    _dancing_arms(act, beat, sway, on)


def _dance_steps(act: StepContext, beat: PerTime, lead: float, on: PerTime) -> None:
    """The free foot steps out, touches and returns within its beat."""
    h, wide, ahead = act.height_m, act.vary(0.055), act.uniform(-0.04, 0.05)
    for side in BOTH:
        first = 0.0 if lead * OUTWARD[side] < 0 else 1.0  # free while the weight is on the other side
        within = (beat - first) % 2.0
        free = plateau(within, 0.08, 0.96, 0.38, 0.38) * on
        lift = (bump((within - 0.06) / 0.44) + bump((within - 0.5) / 0.5)) * on
        act.move_foot(side, ahead * h * free, wide * h * free, 0.035 * h * lift)
        act.add(np.clip(free, 0, 1), side, contact=-0.9)
        act.add(lift, side, foot_pitch=0.3)


def _dancing_arms(act: StepContext, beat: PerTime, sway: PerTime, on: PerTime) -> None:
    """One of three styles: pumping bent arms, swinging arms, hands in the air."""
    style, size = int(act.rng.integers(3)), act.uniform(0.7, 1.2)
    for side in BOTH:
        other = OUTWARD[side] * sway
        flexion, abduction, elbow = (
            (on * 0.15 + 0.45 * size * other, 0.2 * on, on * (1.3 + 0.25 * size * np.cos(2 * np.pi * beat))),
            (0.4 * size * other, on * 0.25 + 0.45 * size * np.maximum(other, 0) ** 2, 0.5 * on),
            (on * 2.1, on * 0.45 + 0.25 * size * other, on * 0.8),
        )[style]
        act.add(1, side, flexion=flexion, abduction=abduction, elbow=elbow)


@posture("hula_hoop")
def hula_hooping(act: StepContext) -> None:
    """The hips circle over slightly spread feet, the chest lagging behind; the arms are kept clear."""
    h, on = act.height_m, act.edges(0.6, 0.6)
    turn = 2 * np.pi * act.tempo(0.9, 1.4, 1.9) * act.sign() * (act.time_s - act.start_s)
    ahead, left = act.vary(0.032) * np.cos(turn) * on, act.vary(0.03) * np.sin(turn) * on
    act.pelvis(ahead * h, left * h, -0.012 * h * on)
    # The hips lead: the pelvis tilts against its motion, and the chest stays over the feet.
    act.add(ahead, pelvis_pitch=-2.2, spine_pitch=-2.6)
    act.add(left, pelvis_roll=2.2, spine_roll=2.6)
    act.bend_knees(0.5 * on)
    out = act.uniform(0.6, 1.1)
    for side in BOTH:
        act.move_foot(side, out=0.03 * h)
        arm: Float[np.ndarray, "n 4"] = np.tile([0.35, out, -0.3, 1.5], (len(turn), 1))
        arm[:, 0] += 0.1 * np.cos(turn + 0.5 * OUTWARD[side])
        act.arm(arm, on, side)
