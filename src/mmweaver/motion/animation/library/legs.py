"""Legs on the spot: kicks, raised legs, balancing, lunges, stairs, crouching, yoga, rehabilitation exercises.

The latter are those of MARS (An and Ogras, 2021). The ranges of the joints were chosen by hand; those of side lunges,
squats and front lunges after inspection of its first subject.
"""

import numpy as np

from mmweaver.motion.animation.controls import OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, Span, bump, reached, rise, sum_plateaus
from mmweaver.motion.animation.step_context import BOTH, StepContext, gesture, posture


@posture("kick")
def kicking(act: StepContext) -> None:
    """Weight on one leg; the other swings back, shoots forward with the knee extending, and comes back.

    In a kick to the back it shoots out behind the body, which leans ahead.
    """
    h, side = act.height_m, act.leg_side()
    high = act.uniform(0.38, 0.46) if act.style == "high" else act.uniform(0.1, 0.3)
    reach = np.sqrt(0.44**2 - max(0.43 - high, 0.0) ** 2) if high < 0.43 else 0.42
    lean, way = 1.0, [0.0, -0.08, -0.16, 0.95 * reach, 0.12, 0.0]
    if act.style == "back":
        lean, way = -0.75, [0.0, 0.0, 0.03, -0.75 * reach, -0.1, 0.0]
    at = MOVEMENTS["kick"]["at"]
    for span in act.repeats(1.35, 1.0, 1.9):
        ahead, up = span.keys(at, way), span.keys(at, [0.0, 0.045, 0.1, high, 0.14, 0.0])
        over, swing = span.plateau(-0.12, 1.1, 0.32, 0.34), span.plateau(0.32, 0.9, 0.28, 0.3)
        act.move_foot(side, ahead * h, -0.02 * h * over, np.maximum(up, 0.0) * h)
        act.lean_over(1 - side, over)
        act.lift_weight(side, span.plateau(0, 1, 0.16, 0.16))
        act.pelvis(up=-0.012 * h * over)
        act.add(span.rows("kick", "pitch")[0], side, foot_pitch=1)
        act.add(swing, pelvis_pitch=-0.22 * lean, spine_pitch=0.12 * lean, pelvis_yaw=-OUTWARD[side] * 0.25)
        act.add(swing, 1 - side, flexion=0.7)
        act.add(swing, side, flexion=-0.45)
        act.add(over, abduction=0.35, elbow=0.5)


@posture("roundhouse", stands=False)
def roundhouse(act: StepContext) -> None:
    """The leg swings around the side to the front, the body turning with it on the ball of the other foot, and back."""
    high = act.uniform(0.42, 0.56) + (0.14 if act.style == "high" else 0.0)
    _kick_turned(act, "roundhouse", (0.0, 0.07, 0.32, high, 0.9 * high, 0.22, 0.0), act.uniform(1.2, 1.5))


@posture("side_kick", stands=False)
def side_kick(act: StepContext) -> None:
    """The knee comes up, then the foot shoots out to its own side, the trunk leaning away from it."""
    high = act.uniform(0.3, 0.42)
    _kick_turned(act, "side_kick", (0.0, 0.08, 0.25, high, 0.95 * high, 0.22, 0.0), 0.3)


def _kick_turned(act: StepContext, movement: str, ups: tuple[float, ...], turn_rad: float) -> None:
    """A kick over the standing foot, which turns; the kicking foot passes through heights `ups`."""
    act.stand()
    h, side = act.height_m, act.leg_side()
    away = -OUTWARD[side]  # the sign of a turn towards the standing leg
    for span in act.repeats(1.65, 1.3, 2.3):
        ahead, out = span.rows(movement, "ahead", "out")
        up = span.keys(MOVEMENTS[movement]["at"], ups)
        over, swing = span.plateau(-0.12, 1.1, 0.3, 0.32), span.plateau(0.14, 0.96, 0.4, 0.36)
        act.move_foot(side, ahead * h, out * h, np.maximum(up, 0.0) * h)
        act.lean_over(1 - side, over)
        act.lift_weight(side, span.plateau(0, 1, 0.16, 0.16))
        act.pelvis(up=-0.014 * h * over)
        turn = away * turn_rad  # the path of the foot is specified before the turn
        act.add(swing, heading=turn, foot_yaw=turn, pelvis_roll=-away * 0.5, spine_roll=-away * 0.3)
        act.add(swing, head_yaw=-away * min(turn_rad, 1.0))
        act.add(swing, side, foot_pitch=0.75)
        act.arm((0.55, 0.35, -0.5, 2.0), over)
        act.add(swing, 1 - side, flexion=0.3)
        act.add(swing, side, flexion=-0.7, elbow=-1.0)


@posture("stomp")
def stamping(act: StepContext) -> None:
    """One knee goes up and the foot comes down hard and flat."""
    h, side = act.height_m, act.leg_side()
    for span in act.repeats(0.95, 0.75, 1.4):
        up = np.maximum(span.keys((0.0, 0.42, 0.86), [0.0, act.vary(0.13, 0.08), 0.0]), 0)
        act.move_foot(side, 0.05 * h * up / 0.15, 0.0, up * h)
        act.lean_over(1 - side, span.plateau(-0.15, 1.05, 0.4, 0.3))
        act.lift_weight(side, span.plateau(0, 0.8, 0.2, 0.2))
        act.add(1, side, foot_pitch=0.25 * up / 0.15)


@posture("raise_leg")
def raising_leg(act: StepContext) -> None:
    """The knee rises in front until the thigh is about level, and comes down again."""
    side, high = act.leg_side(), act.uniform(0.16, 0.24)
    for span in act.repeats(max(1.9, min(act.duration_s / max(act.count, 1), 4.0)), 1.2, 4.5):
        move = min(0.42 * span.lasts_s, 0.95)
        _lift_leg(act, side, act.plateau(span.begin_s, span.at(1), move, move), high)


def _lift_leg(act: StepContext, side: int, share: PerTime, high: float) -> None:
    """Raises a leg by `high` (of the body height) as `share` (n,) goes to 1, with the weight on the other."""
    h, over = act.height_m, rise(np.clip(2.5 * share, 0, 1))
    act.move_foot(side, 0.13 * h * share * (high / 0.2), -0.01 * h * share, high * h * share)
    act.lean_over(1 - side, over)
    act.pelvis(up=-0.008 * h * over)
    act.lift_weight(side, over)
    act.add(share, side, foot_pitch=0.35)
    act.add(share, spine_pitch=0.05)
    act.add(over, abduction=0.35)


@posture("one_leg")
def balancing(act: StepContext) -> None:
    """Balancing on one leg, the arms out and never entirely still."""
    time_s, rng = act.time_s, act.rng
    side = 1 - act.leg_side() if act.foot else int(rng.integers(2))
    begin = float(time_s[0] - 2.0) if act.first else act.start_s
    up = act.plateau(begin, float(time_s[-1] + 2.0) if act.last else act.end_s, 0.8, 0.8)
    _lift_leg(act, side, up, act.uniform(0.1, 0.2))
    rate = 2 * np.pi * rng.uniform(0.5, 0.9)
    wobble = up * (np.sin(rate * time_s) + 0.6 * np.sin(1.7 * rate * time_s + 1.0))
    out = act.uniform(0.2, 0.8)
    act.add(wobble, spine_roll=0.035)
    act.pelvis(left=0.006 * wobble)
    for arm, sign in enumerate(OUTWARD):
        act.add(1, arm, abduction=up * out + 0.12 * sign * wobble)


@posture("lunge")
def lunging(act: StepContext) -> None:
    """A long step ahead with one leg, down until the thigh is nearly level, and back.

    A front lunge leaves the leg behind straight and goes less deep, again and again; half of the subjects keep both
    feet where they are in between, and many turn to the side of the leg ahead, as the first subject of MARS does.
    """
    h, side, is_front = act.height_m, act.leg_side(), act.style == "frontlunge"
    long, deep, ahead, heel_rad, stays = act.vary(0.38, 0.06), 0.165, 0.5, 0.75, False
    if is_front:
        long, deep, ahead, heel_rad = act.vary(0.36, 0.06), act.vary(0.068, 0.1), 0.68, 0.1
        stays = act.rng.random() < 0.5
        if act.foot:  # the body turns to the side of the leg that goes ahead while the step lasts
            turn_rad = OUTWARD[side] * (act.rng.uniform(0.0, 0.8) * act.plateau(act.start_s, act.end_s, 0.5, 0.5))
            act.add(1, heading=turn_rad, foot_yaw=turn_rad)
    spans = act.repeats(3.0, 1.6, 3.6, max(1, round(act.duration_s / 3.0))) if is_front else act.repeats(2.2, 1.6, 3.6)
    if stays:
        _lunge_between_planted_feet(act, spans, side if act.foot else RIGHT, 0.85 * long * h, deep * h)
        return
    for k, span in enumerate(spans):
        acting = side if k % 2 == 0 or act.foot else 1 - side
        gone, down = span.plateau(0, 1, 0.3, 0.3), span.plateau(0.12, 0.88, 0.36, 0.36)
        air = span.plateau(0, 0.3, 0.14, 0.14) + span.plateau(0.7, 1, 0.14, 0.14)
        act.move_foot(acting, long * h * gone, 0.0, 0.05 * h * air)
        act.lift_weight(acting, air)
        act.bend_knees(0.8 * gone)
        act.pelvis(ahead * long * h * gone, 0.0, -deep * h * down)
        act.add(down, 1 - acting, foot_pitch=heel_rad)
        act.add(down, spine_pitch=0.06)


def _lunge_between_planted_feet(act: StepContext, spans: list[Span], side: int, long_m: float, deep_m: float) -> None:
    """One step ahead; then the weight shifts from between the feet over the front leg repeatedly, and back."""
    step_s = min(0.6, 0.15 * act.duration_s)
    gone = act.plateau(act.start_s, act.end_s, step_s, step_s)
    air = sum(act.plateau(at, at + step_s, 0.5 * step_s, 0.5 * step_s) for at in (act.start_s, act.end_s - step_s))
    over = sum_plateaus(spans, 0.1, 0.95, 0.4, 0.4) * gone
    act.move_foot(side, long_m * gone, 0.0, 0.03 * act.height_m * air)
    act.lift_weight(side, np.asarray(air))
    act.bend_knees(0.8 * gone)
    act.pelvis(long_m * (0.5 * gone + 0.35 * over), 0.0, -deep_m * (0.2 * gone + 0.9 * over))
    act.add(over, 1 - side, foot_pitch=0.15)
    act.add(over, spine_pitch=0.06)


@posture("crouch")
def crouching(act: StepContext) -> None:
    """Down into a deep crouch, which is held."""
    down = rise((act.time_s - act.start_s) / min(1.2, 0.8 * act.duration_s))
    if not act.last:
        down = down * rise((act.end_s + 0.3 - act.time_s) / 0.9)
    act.crouch(down * act.uniform(0.8, 0.95), lean_rad=0.9)
    act.add(down, flexion=0.9, elbow=0.6)


@posture("stairs")
def stepping_up_and_down(act: StepContext) -> None:
    """On the spot, up an imaginary stair of 17 cm and backwards down again, one foot after the other."""
    h, first = act.height_m, act.leg_side()
    rate, _ = act.cycles(0.33, 0.45, 0.62, 0.25, 0.8)
    share = 4.0 * rate * (act.time_s - act.start_s)  # a foot moves in each quarter of a cycle
    share = (np.clip(share, 0.0, 4.0 * act.count) if act.count else share) % 4.0
    height_m, tread_m = 0.17, 0.15 * h
    for side, begin in ((first, 0.0), (1 - first, 1.0)):
        on = rise(share - begin) - rise(share - begin - 2.0)
        up, down = bump(share - begin), bump(share - begin - 2.0)
        act.move_foot(side, tread_m * on, 0.0, height_m * on + 0.06 * (up + down))
        act.add(up + down, side, contact=-1)
        act.add(1, side, foot_pitch=0.25 * up - 0.1 * down)
        act.add(bump((share - 1.0 + begin) / 2.0) - 0.5, side, flexion=0.3)
    up = rise((share - 0.7) / 1.2) - rise((share - 2.2) / 1.2)
    act.pelvis(tread_m * (rise(share / 1.7) - rise((share - 2.0) / 1.7)), 0.0, height_m * up)
    act.controls.knee_room[:] = 0.8
    act.add(1, spine_pitch=0.12 + 0.08 * bump(share / 2.0))


def _hold_pose(act: StepContext, into_s: float) -> PerTime:
    """0 standing, 1 in the pose: entered and left within the step."""
    into_s = min(into_s, 0.35 * act.duration_s)
    return act.plateau(act.start_s, act.end_s, into_s, into_s)


@posture("tree_pose")
def tree_pose(act: StepContext) -> None:
    """One foot against the other leg's knee, that knee out to the side, palms together above the head."""
    h, side, held = act.height_m, act.leg_side(), _hold_pose(act, 1.6)
    act.lean_over(1 - side, reached(2.0 * held))
    act.lift_weight(side, reached(3.0 * held))
    act.move_foot(side, 0.02 * h * held, -act.vary(0.052, 0.05) * h * held, act.vary(0.24, 0.08) * h * held)
    act.add(held, side, knee_out=1.25, foot_pitch=0.9)
    act.arm((2.75, 0.35, 0.2, 0.75), held)


@posture("warrior_pose")
def warrior_pose(act: StepContext) -> None:
    """A wide stance, one knee bent over its foot, the arms out to front and back, the face over the front hand."""
    h, front, held = act.height_m, act.leg_side(), _hold_pose(act, 1.4)
    wide = act.vary(0.26, 0.06) * h
    act.move_foot(front, 0.0, 1.0 * wide * held, 0.03 * h * bump(held))
    act.move_foot(1 - front, 0.0, 0.75 * wide * held)
    act.add(held, front, foot_yaw=OUTWARD[front] * 1.3)
    act.pelvis(0.0, OUTWARD[front] * 0.1 * h * held, -act.vary(0.12, 0.08) * h * held)
    act.bend_knees(0.8 * held)
    act.add(held, head_yaw=OUTWARD[front] * 1.2)
    act.arm((0.0, 1.53, 0.0, 0.08), held)


@posture("downward_dog")
def downward_dog(act: StepContext) -> None:
    """Hands and feet on the floor, hips high: the body forms an inverted V."""
    h, held = act.height_m, _hold_pose(act, 1.5)
    act.pelvis(0.27 * h * held, 0.0, -0.07 * h * held)
    act.add(held, pelvis_pitch=2.05, spine_pitch=0.1, head_pitch=0.1, foot_pitch=0.35)
    act.bend_knees(0.5 * bump(held))
    act.arm((2.75, 0.12, 0.0, 0.08), held)


def there_and_back(act: StepContext, usual_s: float, min_s: float, max_s: float) -> PerTime:
    """0 to 1 and back (n,), as often as stated or as time permits, each slightly different and with a hold.

    Args:
        act: Context of the step; its random stream is consumed.
        usual_s: Usual duration of one repetition in seconds.
        min_s: Minimum duration.
        max_s: Maximum duration.
    """
    ramp = 0.5 * (1 - act.uniform(0.05, 0.3))
    spans = act.in_turn(usual_s, min_s, max_s)
    return np.sum([act.vary(1.0, 0.06) * span.plateau(0, 0.98, ramp, ramp) for span in spans], axis=0)


@posture("side_lunge")
def side_lunging(act: StepContext) -> None:
    """From a wide stance the weight shifts over one bent knee; the arms are held out to the sides."""
    h, side, down = act.height_m, act.leg_side(), there_and_back(act, 3.0, 1.4, 5.0)
    half = act.vary(0.1, 0.12) * h  # widening of the stance per foot
    for foot in BOTH:
        act.move_foot(foot, out=half)
        act.add(1, foot, foot_yaw=OUTWARD[foot] * 0.25)
    aside = OUTWARD[side] * act.vary(0.125, 0.1) * h * down
    act.pelvis(-0.02 * h * down, aside, -(0.01 + act.vary(0.056, 0.1) * down) * h)
    act.add(down, spine_roll=-OUTWARD[side] * 0.06, spine_pitch=act.vary(0.12, 0.3))
    act.add(1, knee_out=0.25)
    act.bend_knees(0.2)
    abduction, ahead = float(act.rng.normal(1.5, 0.1)), float(act.rng.normal(0.1, 0.1))
    act.arm((ahead, abduction, 0.0, 0.12))


@posture("limb_extension")
def limb_extension(act: StepContext) -> None:
    """One straight leg moves out to the side and the arm of the same side up; then both return."""
    side, up, leg_m = act.leg_side(), there_and_back(act, 2.8, 1.3, 4.5), act.body.leg_m
    angle, over = act.vary(0.62, 0.2) * up, reached(2.5 * up)
    act.lean_over(1 - side, over)
    act.lift_weight(side, reached(3 * up))
    act.move_foot(side, 0.0, leg_m * np.sin(angle), leg_m * (1 - np.cos(angle)))
    act.add(up, spine_roll=OUTWARD[side] * 0.1)
    _raise_arm_aside(act, side, up, act.vary(1.95, 0.1))
    act.add(up, 1 - side, abduction=0.15)
    act.controls.knee_out_rad[:, side] *= 1 - 0.5 * over


@gesture("arm_extension")
def arm_extension(act: StepContext) -> None:
    """The straight arm rises at the side until the hand is at head height, and comes down, repeatedly."""
    up, top, arms = there_and_back(act, 4.0, 1.1, 6.0), act.vary(2.0, 0.07), act.sides()
    for side in arms:
        _raise_arm_aside(act, side, up, top)
        act.add(up, spine_roll=OUTWARD[side] * 0.04 * (len(act.sides()) == 1))


def _raise_arm_aside(act: StepContext, side: int, up: PerTime, top: float) -> None:
    act.arm((act.rng.normal(0.1, 0.12), top, 0.1, 0.1), reached(up, 1.1), side)


@gesture("hands_up")
def hands_up(act: StepContext) -> None:
    """Both hands next to or in front of the face, elbows bent and out, as often held in squats and lunges."""
    act.arm((act.uniform(0.6, 1.2), act.uniform(0.5, 1.0), -0.3, act.uniform(1.9, 2.4)))
