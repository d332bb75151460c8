"""Sitting, sitting down and standing up, and riding an exercise bike. The root is at the feet."""

import numpy as np

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.profiles import PerTime, rise, wide_bump
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.standing import ANKLE_BEHIND, ARM_HANGING, STAND_STRETCH
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

PELVIS_OVER_SEAT = 0.068  # of the body height: from the seat's surface up to the pelvis joint
MOUNTING_S = 1.2  # time from standing to the saddle of a bike
_CRANK_M, _AXLE_M = 0.17, 0.28  # length of a crank, height of the bottom bracket
_SADDLE_BEHIND = 0.115  # of the height: from the bottom bracket back to the pelvis
_LONGEST_LEG = 0.955  # of a leg's length, with the pedal at its lowest
_HEEL_UP_RAD, _ANKLING_RAD = 0.22, 0.16


def pelvis_behind_feet_m(body: SkeletonProportions, seat_height_m: float) -> float:
    """Distance of the seated pelvis behind the root: shins about vertical, extended on a high seat.

    Args:
        body: Bone lengths.
        seat_height_m: Height of the seat above the floor, metres.

    Returns:
        Metres.
    """
    hip = seat_height_m + PELVIS_OVER_SEAT * body.height_m - body.hip_below_pelvis_m
    drop = hip - body.ankle_height_m - body.shank_m * 0.985  # hip over knee
    return float(np.sqrt(body.thigh_m**2 - min(drop, 0.7 * body.thigh_m) ** 2) + ANKLE_BEHIND * body.height_m - 0.03)


def knees_ahead_m(body: SkeletonProportions, seat_height_m: float) -> float:
    """Distance of the seated knees, which are above the ankles, ahead of the pelvis.

    Args:
        body: Bone lengths.
        seat_height_m: Height of the seat above the floor, metres.

    Returns:
        Metres.
    """
    return pelvis_behind_feet_m(body, seat_height_m) - ANKLE_BEHIND * body.height_m + 0.03


@posture("sit")
def sitting(act: StepContext) -> None:
    """Sitting still."""
    _sit(act, np.ones_like(act.time_s))


@posture("sit_down")
def sitting_down(act: StepContext) -> None:
    """Hips back over the seat while the trunk leans forward, then down, once the root has almost stopped turning."""
    late = act.start_s + np.linspace(0, max(act.duration_s, 0.1), 60)
    turning = np.flatnonzero(np.abs(act.path.facing_rad(late) - act.path.facing_rad(late[-1:])[0]) > 0.6)
    begin = float(late[turning[-1]]) if len(turning) else act.start_s
    lasts = float(np.clip(act.end_s - begin - 0.1, 0.75, act.by_speed(2.0, 1.3, 1.3)))
    _sit(act, (act.time_s - begin) / lasts)


@posture("stand_up")
def standing_up(act: StepContext) -> None:
    """The trunk leans forward until the weight is over the feet, then up."""
    lasts = float(np.clip(act.duration_s - 0.1, 0.75, act.by_speed(1.9, 1.2, 1.2)))
    _sit(act, 1 - (act.time_s - act.start_s) / lasts)


def _sit(act: StepContext, u: PerTime) -> None:
    """From standing (`u` = 0) to sitting (1), (n,); the pelvis moves in between."""
    down, lean, slouch = rise((u - 0.08) / 0.92), wide_bump(u), act.uniform(0.05, 0.18)
    seat = act.seat_height_m + PELVIS_OVER_SEAT * act.height_m
    back = rise(u / 0.85) * pelvis_behind_feet_m(act.body, act.seat_height_m)
    act.pelvis(-back, up=down * (seat - act.controls.pelvis_m[:, 2]))
    act.add(1, pelvis_pitch=0.5 * lean - slouch * down, spine_pitch=0.35 * lean + 1.3 * slouch * down)
    act.add(lean, head_pitch=-0.5)
    act.add(down, knee_out=0.12)
    target = np.array([0.145, 0.066, -0.13]) * act.height_m  # hands on the thighs, seen from spine3
    lap = reach(act.body, target[None], elbow=(-0.6, 0.45, -1.0))
    act.controls.arm_rad[:] += down[:, None, None] * (lap - np.array(ARM_HANGING))
    act.add(lean, flexion=0.35)


@posture("pedal")
def pedalling(act: StepContext) -> None:
    """One turn of the cranks per second, after getting on; the root is below the saddle."""
    body, h, on = act.body, act.height_m, act.edges(MOUNTING_S, MOUNTING_S, 0.2)
    rate, _ = act.cycles(0.7, 1.05, 1.5, 0.5, 1.8)
    phase = act.phase(rate)
    leg_m, behind_m = _LONGEST_LEG * body.leg_m, _SADDLE_BEHIND * h
    lowest_ankle_m = _AXLE_M - _CRANK_M + body.ankle_height_m + body.ball_m * np.sin(_HEEL_UP_RAD)
    hip_m = lowest_ankle_m + float(np.sqrt(leg_m**2 - behind_m**2))
    act.pelvis(up=on * (hip_m + body.hip_below_pelvis_m - body.pelvis_height_m(STAND_STRETCH)))
    act.add(np.sin(phase), pelvis_roll=act.vary(0.03) * on)
    act.add(on, pelvis_pitch=0.25, spine_pitch=act.vary(0.3, 0.15), head_pitch=-0.35)
    act.bend_knees(rise(3 * on))
    for side in BOTH:
        sin, cos = np.sin(phase + side * np.pi), np.cos(phase + side * np.pi)
        act.move_foot(side, on * (behind_m + ANKLE_BEHIND * h + _CRANK_M * sin), 0.0, on * (_AXLE_M + _CRANK_M * cos))
        act.add(on, side, foot_pitch=_HEEL_UP_RAD - _ANKLING_RAD * sin)
        act.add(rise(2 * on), side, contact=-1)
        act.controls.knee_out_rad[:, side] *= 1 - on
        act.hand_to(side, (0.25, 0.11, 0.04), on, (-0.4, 0.7, -0.9))
