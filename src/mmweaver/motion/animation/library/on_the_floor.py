"""On the floor: kneeling, lying down on the back or the belly, falling, and getting up again.

The same controls pose a body on the floor: height and pitch of the pelvis, and the direction of the knees. The root
stays where the feet stood; on the back the body lies behind it, on the belly ahead of it.
"""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, bump, rise, spline_through, sum_plateaus
from mmweaver.motion.animation.standing import STAND_STRETCH
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

# In body heights: pelvis above the floor, kneeling with the thighs vertical, and lying
KNEELING_M, LYING_M = 0.316, 0.075
# and root to pelvis of a lying body: behind on the back, sideways on a side, ahead on the belly.
BACK_BEHIND_M = -MOVEMENTS["lie_on_back"]["ahead"][
    -1
]  # of the height: from the root back to the pelvis, lying on the back
SIDE_AWAY_M = MOVEMENTS["lie_on_side"]["aside"][
    -1
]  # of the height: from the root sideways to the pelvis, lying on the side
BELLY_AHEAD_M = MOVEMENTS["lie_on_belly"]["ahead"][
    -1
]  # of the height: from the root ahead to the pelvis, lying on the belly
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
    """From standing (`u` = 0) to kneeling (1), (n,): one foot moves back and its knee down, then the other's."""
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
    lie_down(act, act.since_start(2.3, 5.0, 3.6, 2.5, 0.95))


@posture("fall")
def falling(act: StepContext) -> None:
    """Loss of balance, and down to the floor within about a second."""
    lie_down(act, act.since_start(1.15, 1.7, 1.4, 1.2, 0.9), falls=True)


@posture("lie")
def lying(act: StepContext) -> None:
    """Lying still."""
    lie_down(act, np.ones_like(act.time_s))


@posture("get_up")
def getting_up(act: StepContext) -> None:
    """From lying to standing."""
    lie_down(act, 1 - act.since_start(2.5, 5.0, 3.8, 2.7, 0.95))


@posture("roll_over")
def rolling_over(act: StepContext) -> None:
    """Lying, onto a side and back again, as often as stated."""
    lying(act)
    roll(act)


def roll(act: StepContext) -> None:
    """Rolls a lying body onto its left or right side and back; the knees follow the chest."""
    h, count = act.height_m, max(act.count, 1)
    left = 1.0 if (act.direction or ("left" if act.rng.random() < 0.5 else "right")) == "left" else -1.0
    over = sum_plateaus(act.repeats(min(3.4, act.duration_s / count), 1.5, 6.0)[:count], 0, 1, 0.4, 0.4)
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


def lie_down(act: StepContext, u: PerTime, *, falls: bool = False) -> None:
    """From standing to lying on a side, the belly or the back, as stated.

    Args:
        act: Context whose controls are written.
        u: Progress (n,): 0 standing, 1 lying.
        falls: Whether the body falls instead of being lowered.
    """
    if act.style in ("left", "right"):
        lie_down_on_side(act, u)
    else:
        (_lie_down_on_belly if act.style == "front" else _lie_down_on_back)(act, np.clip(u, 0.0, 1.0), falls)


def _lower_pelvis(act: StepContext, u: PerTime, movement: str, heights: list[float]) -> PerTime:
    """Moves the pelvis through heights in metres, from standing to lying; returns its relative descent (n,)."""
    record, stand = MOVEMENTS[movement], act.body.pelvis_height_m(STAND_STRETCH)
    act.controls.pelvis_m[:, 2] += spline_through(u, record["at"], [stand, *heights]) - stand
    if "ahead" in record:
        act.pelvis(spline_through(u, record["at"], record["ahead"]) * act.height_m)
    return rise(u / 0.6)


def lie_down_on_side(
    act: StepContext, u: PerTime, movement: str = "lie_on_side", heights_m: tuple[float, ...] = ()
) -> None:
    """Onto one's own left or right side: that knee gives way, hip and then trunk land, knees bent, an arm ahead.

    Args:
        act: Context whose controls are written.
        u: Progress (n,): 0 standing, 1 lying.
        movement: Keyframes in `movements.toml`.
        heights_m: Heights of the pelvis at the keyframes after the first; empty for those of lying down.
    """
    h, side = act.height_m, LEFT if act.style == "left" else RIGHT
    left, u = OUTWARD[side], np.clip(u, 0.0, 1.0)
    stand = act.body.pelvis_height_m(STAND_STRETCH)
    heights_m = heights_m or (stand - 0.1 * h, 0.17 * h, 0.115 * h, LYING_M * h + 0.025 * h)
    down = _lower_pelvis(act, u, movement, [*heights_m])
    act.pelvis(left=left * spline_through(u, MOVEMENTS[movement]["at"], MOVEMENTS[movement]["aside"]) * h)
    act.bend_knees(rise(3 * u))
    act.controls.knee_out_rad[:] *= 1 - down[:, None]
    act.keyed(u, movement, "roll", left)
    act.keyed(u, movement, "lower_arm", 1, side)
    act.keyed(u, movement, "upper_arm", 1, 1 - side)
    for part in ("trunk", "arms"):
        act.keyed(u, movement, part)


def _lie_down_on_back(act: StepContext, u: PerTime, falls: bool) -> None:
    """Down over the heels to sit on the floor, then the trunk leans back; knees bent, soles on the floor."""
    h, low, stand = act.height_m, 0.086 * act.height_m, act.body.pelvis_height_m(STAND_STRETCH)
    down = _lower_pelvis(act, u, "lie_on_back", [stand - 0.2 * h, low + 0.02 * h, low, LYING_M * h])
    for part in ("trunk", "falls" if falls else "lies"):
        act.keyed(u, "lie_on_back", part)
    act.add(down, knee_up=0.5 * np.pi)
    act.controls.knee_out_rad[:] *= 1 - down[:, None]


def _lie_down_on_belly(act: StepContext, u: PerTime, falls: bool) -> None:
    """Forward: the knees give way, the trunk tips over the toes, the arms reach ahead, the body lies outstretched."""
    h = act.height_m
    _lower_pelvis(act, u, "lie_on_belly", [0.43 * h, 0.305 * h, 0.168 * h, LYING_M * h])
    for part in ("trunk", "falls" if falls else "lies"):
        act.keyed(u, "lie_on_belly", part)
    act.controls.foot_m[:, :, 2] += (0.012 * h * rise(u))[:, None]
    act.bend_knees(rise(3 * u))
