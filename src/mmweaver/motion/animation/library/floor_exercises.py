"""On the floor: push-ups, sit-ups, crawling and forward rolls.

Arms of a roll are solved from the floor while the hands rest on it. Whole turns are removed from angles once a roll is
over: the joints are the same, and the following step begins at zero.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.kinematics import ankle_from_foot, chest_of
from mmweaver.motion.animation.library.on_the_floor import KNEELING_M, lying
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, cap, plateau, raised_cosine, rise, spline_through
from mmweaver.motion.animation.standing import ANKLE_BEHIND, STAND_STRETCH
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

_UP_RAD, _DOWN_RAD = 0.32, 0.06  # of the straight body over the floor, arms stretched and bent
_ON_TOES_RAD = 1.35  # pitch of the feet
_TURNING_M = 0.3  # of a limb from the body's axis of rotation
_LIFTING_S = 0.15  # over which limbs lift off and touch down
_FASTEST_TURNING_MPS = 0.35  # of limbs in a turn, which may be faster than crawling
_STRIDE_M, _SHIN = 0.35, 0.318  # of crawling; knee to ankle as a share of the height


@posture("plank")
def plank(act: StepContext) -> None:
    """The upper position of a push-up, held."""
    support_on_hands(act, np.zeros_like(act.time_s))


@posture("push_ups", stands=False)
def push_ups(act: StepContext) -> None:
    """The body stays straight from heels to head while the arms bend and extend; the root is at the feet."""
    support_on_hands(act, _counted_cycles(act, 0.35, 0.55, 0.8, 0.3, 1.1))


def _counted_cycles(act: StepContext, *rates_hz: float) -> PerTime:
    """0 to 1 and back (n,) repeatedly; a count ends at 0. The controls are sampled after the rate."""
    rate, end_s = act.cycles(*rates_hz)
    act.stand()
    return raised_cosine(2 * np.pi * rate * (np.minimum(act.time_s, end_s if act.count else np.inf) - act.start_s))


def support_on_hands(act: StepContext, down: PerTime) -> None:
    """Support on hands and toes.

    Args:
        act: Context whose controls are written.
        down: 0 with straight arms, 1 with bent ones, (n,).
    """
    body, h, n = act.body, act.height_m, len(down)
    slope = _UP_RAD + np.minimum(act.vary(0.92, 0.05), 1.0) * down * (_DOWN_RAD - _UP_RAD)
    leg = 0.995 * (body.leg_m + body.hip_below_pelvis_m)
    ankle = ankle_from_foot(body, np.zeros(1), np.array([_ON_TOES_RAD]))[0]
    up = ankle[2] + leg * np.sin(slope) - body.pelvis_height_m(STAND_STRETCH)
    act.pelvis(ankle[0] - ANKLE_BEHIND * h + leg * np.cos(slope), up=up)
    act.add(1, pelvis_pitch=0.5 * np.pi - slope, head_pitch=-0.35, foot_pitch=_ON_TOES_RAD, knee_up=-1.45)
    act.controls.spine_rad[:] = 0.0
    act.controls.knee_room[:] = 1.0
    straight, bent = np.tile([1.57 - 0.3, 0.15, 0.0, 0.1], (n, 1)), np.array([-0.25, 0.45, 0.0, 1.95])
    act.arm(straight + down[:, None] * (bent - straight))


@posture("sit_ups", stands=False)
def sit_ups(act: StepContext) -> None:
    """On the back, knees bent, arms crossed on the chest: the trunk curls up until it is upright, and down again."""
    up = _counted_cycles(act, 0.28, 0.42, 0.6, 0.25, 0.8)
    lying(act)
    act.add(up, pelvis_pitch=min(act.vary(1.2, 0.05), 1.3))
    act.add(np.sin(0.5 * np.pi * up), spine_pitch=0.7)
    act.add(1, head_pitch=0.25)
    act.pelvis(up=0.012 * act.height_m * up)
    for side, ahead in ((LEFT, 0.13), (RIGHT, 0.105)):
        act.hand_to(side, (ahead, -0.05, 0.03), 1.0, (-0.1, 0.8, -1.0))


@posture("crawl")
def crawling(act: StepContext) -> None:
    """On hands and knees; a knee and the opposite hand move ahead together."""
    h, (gone_m, going) = act.height_m, _crawled(act)
    phase = 2 * np.pi / act.vary(_STRIDE_M, 0.08) * gone_m
    act.pelvis(up=0.95 * KNEELING_M * h - act.body.pelvis_height_m(STAND_STRETCH) + 0.008 * h * np.cos(2 * phase))
    act.add(1, pelvis_pitch=1.25, pelvis_yaw=0.08 * np.sin(phase), head_pitch=-0.7, foot_pitch=1.42)
    act.controls.knee_room[:] = 1.0
    for side, sign in enumerate(OUTWARD):
        air = rise(sign * np.cos(phase) + 0.3) * going
        act.move_foot(side, 0.5 * _STRIDE_M * np.sin(phase) * sign - _SHIN * h, -0.01 * h, 0.02 * h * air)
        arm: Float[np.ndarray, "n 4"] = np.tile([1.3, 0.08, 0.0, 0.15], (len(phase), 1))
        arm[:, 0] += 0.28 * (-sign * np.sin(phase))  # the opposite hand
        arm[:, 3] += 0.35 * rise(-sign * np.cos(phase) + 0.3) * going
        act.arm(arm, 1.0, side)


def _crawled(act: StepContext) -> tuple[PerTime, PerTime]:
    """Distance (n,) in metres by which the limbs carry the body, and 1 while it moves or turns; even on the spot."""
    time_s, path = act.time_s, act.path
    if not act.moves:
        return 0.15 * (time_s - act.start_s), np.ones_like(time_s)
    turning_mps = _TURNING_M * np.abs(path.facing_rad(time_s + 1e-3) - path.facing_rad(time_s - 1e-3)) / 2e-3
    speed_mps = path.speed_mps(time_s) + np.minimum(turning_mps, _FASTEST_TURNING_MPS)
    steps_m = 0.5 * (speed_mps[1:] + speed_mps[:-1]) * np.diff(time_s)
    gone_m = np.concatenate([[0.0], np.cumsum(steps_m)])
    before_m, after_m = (np.interp(time_s + lag, time_s, gone_m) for lag in (-_LIFTING_S, _LIFTING_S))
    return gone_m, rise((after_m - before_m) / (2 * _LIFTING_S) / 0.12)


_ROLL, _FEET = MOVEMENTS["forward_roll"], MOVEMENTS["forward_roll_feet"]
AHEAD = _ROLL["ahead"][-1]  # distance covered by a roll, as a share of the height
UPRIGHT_AGAIN = 0.82  # share of a roll after which trunk and feet have turned once
_HANDS = (0.46, 0.12, 0.03)  # their position: ahead, outward, up


@posture("forward_roll", stands=False)
def rolling_forward(act: StepContext) -> None:
    """Hands on the floor, over the rounded back, and up onto the feet, one roll after the other."""
    start, end = act.path.position_m(np.array([act.start_s - 0.001, act.end_s]))
    act.path = act.standing_path()
    act.stand()
    rolls = act.repeats(2.9, 2.5, 4.0)
    each_m = float(np.hypot(*(end - start))) / len(rolls)
    for k, span in enumerate(rolls):
        _roll_once(act, (act.time_s - span.begin_s) / span.lasts_s, each_m, k * each_m)


def _roll_once(act: StepContext, share: PerTime, length_m: float, gone_m: float) -> None:
    """One roll over `share` (n,) from 0 to 1, after `gone_m` of earlier rolls."""
    h, stand = act.height_m, act.body.pelvis_height_m(STAND_STRETCH)
    stretch, whole = length_m / (AHEAD * h), 2 * np.pi * (share >= UPRIGHT_AGAIN)
    heights = [(z * h or stand) - stand for z in _ROLL["up"]]
    ahead = stretch * h * spline_through(share, _ROLL["at"], _ROLL["ahead"])
    act.pelvis(ahead, 0.0, spline_through(share, _ROLL["at"], heights))
    over = 1.0 * rise(share / 0.27) + (2 * np.pi - 1.0) * rise((share - 0.26) / (UPRIGHT_AGAIN - 0.26)) - whole
    act.add(1, pelvis_pitch=over, knee_up=-over + 0.25 * np.pi * plateau(share, 0.1, 0.9, 0.2, 0.2))
    act.add(plateau(share, 0.08, 0.95, 0.3, 0.3), spine_pitch=1.0)
    act.add(plateau(share, 0.2, 0.85, 0.18, 0.2), head_pitch=0.9)
    act.bend_knees(plateau(share, 0.0, 1.0, 0.15, 0.15))
    # Both feet push off, pass over the head with the legs, and land together.
    pitch = 2 * np.pi * rise((share - 0.33) / (UPRIGHT_AGAIN - 0.03 - 0.33))
    pivot = ankle_from_foot(act.body, np.zeros(len(share)), pitch) - [0.0, 0.0, act.body.ankle_height_m]
    pushing = 1 - plateau(share, _FEET["at"][0], _FEET["at"][-1], 0.05, 0.05)  # on the ball until it leaves the floor
    ahead = stretch * h * spline_through(share, _FEET["at"], _FEET["ahead"]) - pivot[:, 0] + pushing * pivot[:, 0]
    up = h * spline_through(share, _FEET["at"], _FEET["up"]) - pivot[:, 2] + pushing * pivot[:, 2]
    act.add(1, foot_pitch=pitch - whole)
    for side in BOTH:
        act.move_foot(side, ahead, 0.0, up)
    for side in BOTH:
        act.add(plateau(share, 0.33, 0.77, 0.08, 0.06), side, contact=-1)
        act.arm((0.9, 0.15, 0.0, 0.9), plateau(share, 0.1, 0.98, 0.2, 0.25), side)
        _put_hand_on_floor(act, side, share, gone_m)


def _put_hand_on_floor(act: StepContext, side: int, share: PerTime, gone_m: float) -> None:
    """Fixes one hand on the floor while it carries weight."""
    h, heading, start = act.height_m, act.controls.heading_rad, act.path.position_m(act.time_s)
    ahead, left = _HANDS[0] * h + gone_m, OUTWARD[side] * _HANDS[1] * h
    x = start[:, 0] + ahead * np.cos(heading) - left * np.sin(heading)
    y = start[:, 1] + ahead * np.sin(heading) + left * np.cos(heading)
    place, frame = chest_of(act.body, act.controls)
    in_chest = np.einsum("nji,nj->ni", frame, np.stack([x, y, np.full(len(share), _HANDS[2] * h)], axis=1) - place)
    in_chest[:, 1] *= OUTWARD[side]
    arm = reach(act.body, in_chest, elbow=(-0.2, 0.9, -0.3))
    arm[:, 0] = cap(arm[:, 0], 2.9, 0.4)  # the hands leave the floor when the shoulders have passed them
    act.arm(arm, plateau(share, 0.12, 0.58, 0.15, 0.17), side)
