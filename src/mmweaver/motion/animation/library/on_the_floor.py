"""On the floor: kneeling, lying down on the back or the belly, falling, and getting up again.

The same controls pose a body on the floor: the pelvis's height and pitch, and where the knees point. The root stays
where the feet stood; on the back the body lies behind it, on the belly ahead of it.
"""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import bump, rise
from mmweaver.motion.animation.spans import PerTime, spline_through
from mmweaver.motion.animation.standing import STAND_STRETCH
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

KNEELING_M = 0.316  # of the height: of the pelvis above the floor, thighs vertical
LYING_M = 0.075  # of the height: of the pelvis above the floor
BACK_BEHIND_M = 0.36  # of the height: from the root back to the pelvis, lying on the back
SIDE_AWAY_M = 0.34  # of the height: from the root sideways to the pelvis, lying on the side
BELLY_AHEAD_M = 0.648  # of the height: from the root ahead to the pelvis, lying on the belly
_KNEELING_S = (1.3, 2.8, 2.2, 1.5, 0.9)


@posture("kneel_down")
def kneeling_down(act: StepContext) -> None:
    """From standing onto the knees."""
    _kneel(act, act.since_start(*_KNEELING_S))


@posture("kneel")
def kneeling(act: StepContext) -> None:
    """On the knees, still."""
    _kneel(act, np.ones_like(act.time_s))


@posture("kneel_up")
def rising_from_knees(act: StepContext) -> None:
    """From the knees to standing."""
    _kneel(act, 1 - act.since_start(*_KNEELING_S))


def _kneel(act: StepContext, u: PerTime) -> None:
    """u (n,) = 0 standing, 1 on the knees: one foot moves back and its knee down, then the other's."""
    body, h, one_knee = act.body, act.height_m, act.style == "knee"
    first = LEFT if act.foot == "left" else RIGHT
    for side, begin in ((first, 0.0), (1 - first, 0.45))[: 1 if one_knee else 2]:
        back, lift = rise((u - begin) / 0.5), bump((u - begin) / 0.5)
        act.move_foot(side, -0.318 * h * back, 0.0, 0.035 * h * lift)
        act.add(back, side, foot_pitch=1.42)
        act.add(lift, side, contact=-1)
    if one_knee:  # the other foot steps ahead, so that its shank stands upright
        ahead, lift = rise((u - 0.1) / 0.5), bump((u - 0.1) / 0.5)
        act.move_foot(1 - first, 0.2 * h * ahead, 0.0, 0.035 * h * lift)
        act.add(lift, 1 - first, contact=-1)
    down, lean = rise(u / 0.97), bump(np.clip(u, 0, 1))
    act.pelvis(0.01 * h * down, 0.0, -down * (body.pelvis_height_m(STAND_STRETCH) - KNEELING_M * h))
    act.bend_knees(rise(np.clip(3 * u, 0, 1)) * 0.7)
    act.add(lean, spine_pitch=0.3, flexion=0.25)


@posture("lie_down")
def lying_down(act: StepContext) -> None:
    """From standing to lying, slowly."""
    _lie_down(act, act.since_start(2.3, 5.0, 3.6, 2.5, 0.95))


@posture("fall")
def falling(act: StepContext) -> None:
    """Loss of balance, and down within about a second."""
    _lie_down(act, act.since_start(1.15, 1.7, 1.4, 1.2, 0.9), falls=True)


@posture("lie")
def lying(act: StepContext) -> None:
    """Lying still, with breathing and slight movement of the arms."""
    _lie_down(act, np.ones_like(act.time_s))


@posture("get_up")
def getting_up(act: StepContext) -> None:
    """From lying to standing."""
    _lie_down(act, 1 - act.since_start(2.5, 5.0, 3.8, 2.7, 0.95))


@posture("roll_over")
def rolling_over(act: StepContext) -> None:
    """Lying, onto a side and back again, as often as the sentence says."""
    lying(act)
    roll(act)


def roll(act: StepContext) -> None:
    """Rolls a lying body onto its left or right side and back; the knees point where the chest does."""
    h, count = act.height_m, max(act.count, 1)
    left = 1.0 if (act.direction or ("left" if act.rng.random() < 0.5 else "right")) == "left" else -1.0
    over = np.zeros_like(act.time_s)
    for span in act.repeats(min(3.4, act.duration_s / count), 1.5, 6.0)[:count]:
        over += span.plateau(0, 1, 0.4, 0.4)
    on_belly = act.style == "front"
    act.add(over, roll_over=left * 1.3)
    act.pelvis(0.0, (-left if on_belly else left) * 0.05 * h * over, 0.045 * h * over)
    for foot in BOTH:
        is_upper = OUTWARD[foot] != left and not on_belly
        act.move_foot(foot, up=(0.1 if is_upper else 0.02) * h * over)
        act.add(over, foot, flexion=0.9, abduction=-0.8 if is_upper else -0.35, elbow=0.7)  # the upper arm lies ahead
    if not on_belly:
        act.add(over, knee_up=-0.5 * np.pi, foot_yaw=left * 0.5 * np.pi)
        for foot in BOTH:
            act.add(over, foot, knee_out=OUTWARD[foot] * left * 0.25 * np.pi)


def _lie_down(act: StepContext, u: PerTime, *, falls: bool = False) -> None:
    """u (n,) = 0 standing, 1 lying, on a side, the belly or the back, as the sentence says."""
    if act.style in ("left", "right"):
        lie_down_on_side(act, u)
    else:
        (_lie_down_on_belly if act.style == "front" else _lie_down_on_back)(act, np.clip(u, 0.0, 1.0), falls)


def _lower_pelvis(act: StepContext, u: PerTime, at: list[float], heights: list[float], ahead: list[float]) -> None:
    """Moves the pelvis through heights in metres, the first that of standing, and ahead, in body heights."""
    act.controls.pelvis_m[:, 2] += spline_through(u, at, heights) - heights[0]
    act.pelvis(spline_through(u, at, ahead) * act.height_m)


def lie_down_on_side(act: StepContext, u: PerTime) -> None:
    """To one's own left or right: that knee gives way, the hip and then the trunk land, knees bent, an arm ahead."""
    h, side = act.height_m, LEFT if act.style == "left" else RIGHT
    left, stand = OUTWARD[side], act.body.pelvis_height_m(STAND_STRETCH)
    at, u = [0.0, 0.3, 0.6, 0.8, 1.0], np.clip(u, 0.0, 1.0)
    _lower_pelvis(act, u, at, [stand, stand - 0.1 * h, 0.17 * h, 0.115 * h, LYING_M * h + 0.025 * h], [0.0] * 5)
    act.pelvis(left=left * spline_through(u, at, [0.0, 0.08, 0.27, 0.32, SIDE_AWAY_M]) * h)
    act.keyed(u, at, -left, pelvis_roll=[0.0, 0.3, 0.85, 1.25, 1.45], spine_roll=[0.0, 0.25, 0.1, 0.1, 0.05])
    act.keyed(u, at, spine_pitch=[0.0, 0.2, 0.35, 0.25, 0.2], head_pitch=[0.0, 0.0, 0.25, 0.2, 0.1])
    act.bend_knees(rise(3 * u))
    act.controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    act.keyed(u, at, 1, side, flexion=[0.0, 0.3, 1.0, 1.4, 1.5], abduction=[0.0, 0.7, 0.45, 0.0, -0.17])
    act.keyed(u, at, 1, 1 - side, flexion=[0.0, 0.5, 0.8, 0.7, 0.6])
    act.keyed(u, at, elbow=[0.0, 0.3, 0.5, 0.5, 0.5])


def _lie_down_on_back(act: StepContext, u: PerTime, falls: bool) -> None:
    """Down over the heels to sit on the floor, then the trunk leans back; knees bent, soles on the floor."""
    h, stand, low = act.height_m, act.body.pelvis_height_m(STAND_STRETCH), 0.086 * act.height_m
    at = [0.0, 0.3, 0.55, 0.75, 1.0]
    heights = [stand, stand - 0.2 * h, low + 0.02 * h, low, LYING_M * h]
    _lower_pelvis(act, u, at, heights, [0.0, -0.13, -0.32, -0.35, -BACK_BEHIND_M])
    act.keyed(u, at, pelvis_pitch=[0.0, 0.3, -0.25, -1.0, -1.5] if falls else [0.0, 0.55, 0.1, -0.75, -1.5])
    act.keyed(u, at, spine_pitch=[0.0, 0.55, 0.75, 0.5, 0.05], head_pitch=[0.0, 0.0, 0.25, 0.45, 0.0])
    act.add(rise(u / 0.6), knee_up=0.5 * np.pi)
    act.controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    act.keyed(
        u,
        at,
        flexion=[0.0, 0.7, 0.6, 0.0, -0.03] if falls else [0.0, 0.7, 0.15, -0.1, -0.03],
        abduction=[0.0, 0.6 if falls else 0.25, 0.55, 0.4, 0.22],
        elbow=[0.0, 0.2, 0.1, 0.0, -0.05],
    )


def _lie_down_on_belly(act: StepContext, u: PerTime, falls: bool) -> None:
    """Forward: the knees give way, the trunk tips over the toes, the arms reach ahead, the body lies stretched out."""
    h, stand = act.height_m, act.body.pelvis_height_m(STAND_STRETCH)
    at = [0.0, 0.3, 0.52, 0.78, 1.0]
    heights = [stand, 0.43 * h, 0.305 * h, 0.168 * h, LYING_M * h]
    _lower_pelvis(act, u, at, heights, [0.0, 0.1, 0.35, 0.605, BELLY_AHEAD_M])
    act.keyed(u, at, pelvis_pitch=[0.0, 0.3, 0.62, 1.25, 1.5], spine_pitch=[0.0, 0.25, 0.2, 0.0, -0.05])
    act.keyed(u, at, -1, head_pitch=[0.0, 0.2, 0.4, 0.5, 0.35], knee_up=[0.0, 0.0, 0.2, 0.9, 1.45])
    act.keyed(u, at, foot_pitch=[0.0, 0.8, 1.4, 2.0, 2.2])
    act.controls.foot_m[:, :, 2] += (0.012 * h * rise(u))[:, None]
    act.bend_knees(rise(3 * u))
    act.keyed(
        u,
        at,
        flexion=[0.0, 0.8, 1.5, 2.3, 2.95] if falls else [0.0, 0.7, 1.35, 2.2, 2.95],
        abduction=[0.0, 0.1, 0.2, 0.3, 0.3],
        elbow=[0.0, 0.3, 0.3, 0.1, -0.1],
    )
