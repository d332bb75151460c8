"""Lying on a couch or bed, along the edge on which one sits, getting there and back, and falling off a seat."""

from dataclasses import replace

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT, blend
from mmweaver.motion.animation.library.on_the_floor import BACK_BEHIND_M, lie_down_on_side, roll
from mmweaver.motion.animation.library.sitting import sitting
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, bump, rise, spline_through
from mmweaver.motion.animation.standing import ANKLE_BEHIND, HALF_STANCE
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

PELVIS_OVER_SEAT = 0.075  # of the height: pelvis of a lying body above the seat
OFF_SEAT_AHEAD_M = 0.25  # in front of the sitter's feet: landing point of a fall off the seat
_TOWARDS_FEET = 0.06  # of the height: shift of the pelvis along the couch, so that head and feet fit
_LASTS = (1.4, 3.6, 2.6, 1.8, 0.95)


@posture("lie_on_seat")
def lying_on_seat(act: StepContext) -> None:
    """Lying still, with the head to one's own left."""
    _lie_along_seat(act, np.ones_like(act.time_s))


@posture("recline")
def reclining(act: StepContext) -> None:
    """From sitting: the trunk goes down to one's own left while the legs come up, one after the other."""
    _lie_along_seat(act, act.since_start(*_LASTS))


@posture("sit_up")
def sitting_up(act: StepContext) -> None:
    """`reclining` in reverse."""
    _lie_along_seat(act, 1 - act.since_start(*_LASTS))


@posture("roll_in_bed")
def rolling_in_bed(act: StepContext) -> None:
    """Lying on furniture, onto a side and back again."""
    lying_on_seat(act)
    roll(act)


def _lie_along_seat(act: StepContext, u: PerTime) -> None:
    """From sitting (`u` = 0) to lying on the back (1), (n,), head to one's own left, knees bent, soles on the seat."""
    sitting(act)
    controls, h, u = act.controls, act.height_m, np.clip(u, 0.0, 1.0)
    record, down = MOVEMENTS["lie_on_seat"], rise(u)
    feet_rad = controls.heading_rad - 0.5 * np.pi  # the direction in which the feet end up
    along = np.stack([np.cos(feet_rad), np.sin(feet_rad)], axis=1)
    left = np.stack([-np.sin(feet_rad), np.cos(feet_rad)], axis=1)
    act.add(rise(u / 0.85), heading=-0.5 * np.pi)
    controls.pelvis_m[:, :2] += _TOWARDS_FEET * h * down[:, None] * along
    lying_m = act.seat_height_m + PELVIS_OVER_SEAT * h
    act.pelvis(up=down * (lying_m - controls.pelvis_m[:, 2]) + 0.02 * h * bump(u))
    for channel, now in (("pelvis_pitch", controls.pelvis_rad[:, 1]), ("spine_pitch", controls.spine_rad[:, 1])):
        act.add(1, **{channel: spline_through(u, record["at"], record[channel]) - down * now})
    act.keyed(u, "lie_on_seat", "trunk")
    act.add(rise(u / 0.7), knee_up=0.5 * np.pi)
    controls.knee_out_rad[:] *= 1 - rise(u / 0.6)[:, None]
    act.bend_knees(rise(4 * u))
    for side, begin in ((RIGHT, 0.1), (LEFT, 0.22)):
        over, lift = rise((u - begin) / 0.6), bump((u - begin) / 0.6)
        goal = controls.pelvis_m[:, :2] + (BACK_BEHIND_M - ANKLE_BEHIND) * h * along
        goal = goal + OUTWARD[side] * HALF_STANCE * h * left
        controls.foot_m[:, side, :2] += over[:, None] * (goal - controls.foot_m[:, side, :2])
        controls.foot_m[:, side, 2] += rise((u - begin) / 0.4) * act.seat_height_m + 0.05 * h * lift
        act.add(over, side, foot_yaw=-0.5 * np.pi)
        act.add(lift, side, contact=-1)
    act.add(bump(u), flexion=0.2)
    act.arm((-0.03, 0.2, 0.0, 0.25), rise((u - 0.2) / 0.8))


@posture("fall_off")
def falling_off(act: StepContext) -> None:
    """From sitting down to the floor next to the feet, to one's own side, within about a second."""
    u = np.clip(act.since_start(0.9, 1.5, 1.25, 1.05, 0.9), 0.0, 1.0)
    sitting(act)
    fallen = replace(act)
    fallen.stand()
    lie_down_on_side(fallen, 0.4 + 0.6 * u)
    fallen.pelvis(OFF_SEAT_AHEAD_M)
    for side in BOTH:
        fallen.move_foot(side, OFF_SEAT_AHEAD_M)
    weight, feet = rise(u / 0.75), np.repeat(rise((u - 0.1) / 0.7)[:, None], 2, axis=1)
    act.controls = blend([act.controls, fallen.controls], [1 - weight, weight], [1 - feet, feet])
