"""Walking, jogging and turning: feet planted along the root's path, trunk and arms driven by the phase of the steps.

Irregular gait: sidestepping, limping, staggering, walking lunges, and stumbling after a push.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mmweaver.core.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.motion.animation.controls import OUTWARD, RIGHT
from mmweaver.motion.animation.profiles import MOVEMENTS, PerTime, bump, plateau, rise, travel
from mmweaver.motion.animation.standing import ANKLE_BEHIND, HALF_STANCE, TOES_OUT_RAD
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture
from mmweaver.motion.language.plan import FALLING_ON

GRAVITY_MPS2 = 9.81
SHORT_REST_S, REST_SMOOTH_S = 0.6, 0.06  # maximum rest between two movements of the root that is bridged
SOLE_DOWN_S = 0.07  # minimum from heel strike until the sole is flat
ELBOW_LAG = 0.15  # of a step, behind the shoulder
NOD = 0.4  # share of the pelvis's surge that the neck does not follow


@dataclass(frozen=True)
class Style:
    """Gait parameters of one person: lengths in metres, angles in radians, times in steps (half a gait cycle)."""

    steps_hz: float
    # Share of a step between a foot's strike and the other's lift-off. The swing begins and ends slowly, which prolongs
    # double support (shortens flight) by another tenth of a step.
    double_support: float
    half_stance_m: float
    toes_out_rad: float
    ahead_m: float  # how much farther back than the middle of its stance a foot is planted
    heel_strike_rad: float
    toe_off_rad: float
    heel_rises: float  # share of the stance after which the heel leaves the floor
    folded: float  # share of the swing after which the foot points down most
    swing_ramps: list[float]  # shares of the swing in which the foot accelerates and decelerates
    toe_lift_m: float  # of the ball of the foot, early in the swing of a full step
    lift_m: float  # of the swinging sole in a full step
    spot_lift_m: float  # of the sole in a step on the spot
    arm_swing_rad: float
    arm_back_rad: float  # centre of the swing
    elbow_rad: float
    elbow_swing_rad: float
    lean_rad: float
    bob_m: float
    sink: float  # extension of the legs, as a share of their length
    pelvis_yaw_rad: float
    twist_rad: float  # of the shoulders relative to the pelvis
    sway_m: float
    surge_mps: float  # amplitude of the pelvis's speed variation, once a step
    surge_sharp: float  # share of its second harmonic: short fast, long slow phases
    fastest: float  # share of a step, from the strike, at which the pelvis is fastest
    highest: float  # and highest
    uneven: float = 0.0  # share of a step by which the right foot strikes late (negative: early): a limp
    lopsided: float = 0.0  # relative height of the left foot's swing above the right one's
    weave_m: float = 0.0  # lateral sway of the whole body
    stepping_mps: float = 0.6  # speed above which the feet are placed as in walking, not as in standing


def walking_style(act: StepContext, speed_mps: float) -> Style:
    """Gait parameters of a walk: step rate from speed (walk ratio about 0.42 m s; longer legs step slower).

    Args:
        act: Context of the step; its random stream is consumed.
        speed_mps: Walking speed in m/s.
    """
    rng, height_m = act.rng, act.height_m
    share = min(speed_mps / 1.3, 1.4)
    steps_hz = 1.87 * max(share, 0.25) ** 0.55 * (REFERENCE_HEIGHT_M / height_m) ** 0.5 * np.exp(rng.normal(0, 0.03))
    counted_s = sum(move.end_s - move.start_s for move in act.moves) - 0.3  # of `trajectory.walk_straight`
    if act.count and act.moves and counted_s > 0:
        steps_hz = act.count / counted_s
    steps_hz = act.step.steps_hz or steps_hz
    vigour = share**1.5 * np.exp(rng.normal(0, 0.3))
    leg_m, reach_m = act.body.leg_m, 0.46 * speed_mps / float(steps_hz)  # of the leading leg when its heel strikes
    drop_m = leg_m - (leg_m**2 - min(reach_m, 0.5 * leg_m) ** 2) ** 0.5
    return Style(
        **MOVEMENTS["walk"],
        steps_hz=float(steps_hz),
        half_stance_m=0.034 * height_m,
        toes_out_rad=0.09 + rng.normal(0, 0.02),
        ahead_m=-0.005 * share,
        heel_strike_rad=0.32 * share**0.5,
        toe_off_rad=0.85 * share**0.6,
        arm_swing_rad=0.19 * vigour,
        elbow_rad=0.42 + rng.normal(0, 0.1),
        elbow_swing_rad=0.18 * vigour,
        lean_rad=0.035 + rng.normal(0, 0.015),
        bob_m=0.27 * drop_m,
        surge_mps=0.19 * share**0.5,
        pelvis_yaw_rad=0.09 * share,
        twist_rad=0.16 * share,
        lopsided=float(np.clip(rng.normal(0, 0.06), -0.12, 0.12)),
    )


def jogging_style(act: StepContext, speed_mps: float) -> Style:
    """Gait parameters of a jog: short contacts with flight in between, in which the pelvis falls freely.

    Args:
        act: Context of the step; its random stream is consumed.
        speed_mps: Speed in m/s.
    """
    steps_hz, share = act.tempo(2.35, 2.6, 2.9, 0.08), min(speed_mps / 2.0, 1.7)  # of an easy indoor jog
    steps_hz = act.step.steps_hz or steps_hz
    vigour = np.exp(act.rng.normal(0, 0.12))
    return Style(
        **MOVEMENTS["jog"],
        steps_hz=steps_hz,
        double_support=-0.57 - 0.2 * max(share - 0.8, 0.0),
        half_stance_m=0.036 * act.height_m,
        ahead_m=0.055 * share,
        heel_strike_rad=0.12 * share,
        toe_off_rad=0.85 + 0.27 * share,
        toe_lift_m=0.08 * share,
        lift_m=0.03 + 0.03 * share,
        spot_lift_m=0.13 * vigour,
        arm_swing_rad=(0.19 + 0.05 * share) * vigour,
        elbow_rad=1.8 + act.rng.normal(0, 0.15),
        lean_rad=0.07 + 0.07 * share,
        bob_m=(1.0 + 0.28 * min(share, 1.4)) * GRAVITY_MPS2 / (2 * np.pi * steps_hz) ** 2,
        surge_mps=0.22 * share,
        lopsided=float(np.clip(act.rng.normal(0, 0.06), -0.12, 0.12)),
    )


@posture("stand")
def standing(act: StepContext) -> None:
    """Standing still."""
    act.add(act.wander(0.05, 0.25), head_yaw=0.1)


STYLED_WALKS: dict[str, Callable[[StepContext], None]] = {}  # by `Step.style`, see `walking_aids`


@posture("walk", stands=False)
def walking(act: StepContext) -> None:
    """Walks at the speed of the path, as the style of the step asks."""
    if act.style in STYLED_WALKS:
        STYLED_WALKS[act.style](act)
    else:
        steps_along_path(act, walking_style(act, max(cruise_mps(act), 0.7)))


@posture("jog", stands=False)
def jogging(act: StepContext) -> None:
    """Jogs at the speed of the path, or on the spot."""
    steps_along_path(act, jogging_style(act, cruise_mps(act)), jog=True, on_spot=act.direction == "spot")


@posture("turn", stands=False)
def turning(act: StepContext) -> None:
    """Turns with small steps on the spot, as in a slow walk."""
    steps_along_path(act, walking_style(act, 0.9))


@posture("march", stands=False)
def marching(act: StepContext) -> None:
    """High knees on the spot, each arm swinging with the opposite leg."""
    style = replace(
        walking_style(act, 1.3),
        steps_hz=act.tempo(1.5, 1.85, 2.2),
        spot_lift_m=act.uniform(0.13, 0.2),
        arm_swing_rad=act.uniform(0.35, 0.6),
        **MOVEMENTS["march"],
    )
    steps_along_path(act, style, jog=True, on_spot=True)


def cruise_mps(act: StepContext) -> float:
    """The highest speed of the step's moves between their ramps, in m/s; 0 without moves."""
    return max((move.speed_mps for move in act.moves), default=0.0)


def steps_along_path(act: StepContext, style: Style, *, jog: bool = False, on_spot: bool = False) -> None:
    """Steps along the root's path; a foot stays planted if its next position equals the last one, except when jogging.

    Args:
        act: Context whose controls are written.
        style: Gait parameters.
        jog: Lifts every foot at every step, even on the spot.
        on_spot: Steps throughout, although the root does not move.
    """
    from scipy.interpolate import CubicSpline

    act.stand()
    first_side = int(act.rng.integers(2))
    strikes = _strikes_s(act, style, first_side)
    sway_phase, sway_hz = act.rng.uniform(0, 2 * np.pi, 2), act.rng.uniform(0.35, 0.6)

    def weave_m(time_s: PerTime) -> PerTime:
        """Lateral sway to the left of pelvis and feet."""
        turn = np.sin(2 * np.pi * sway_hz * time_s + sway_phase[0])
        return style.weave_m * (turn + 0.5 * np.sin(4.4 * np.pi * sway_hz * time_s + sway_phase[1]))

    if style.weave_m:
        act.pelvis(left=weave_m(act.time_s))
    moving = _moving(act, on_spot=on_spot)
    for side in BOTH:
        own = np.array([k for k in range(len(strikes) - 2) if (k + first_side) % 2 == side])
        stance_s = (1 + style.double_support) * (strikes[own + 1] - strikes[own])
        places_m, yaws_rad = _footholds(act, style, strikes[own] + stance_s / 2, side, weave_m)
        falls = [
            Footfall(*fall) for fall in zip(strikes[own], strikes[own] + stance_s, places_m, yaws_rad, strict=True)
        ]
        _move_foot_along(act, falls, side, style, jog=jog)
    phase = np.asarray(CubicSpline(strikes, np.arange(len(strikes)) + first_side)(act.time_s))
    _move_trunk_and_arms(act, style, phase, moving)


class Footfall(NamedTuple):
    """One stance of a foot: strike and lift-off in seconds, position (x, y) and yaw."""

    strike_s: float
    off_s: float
    place_m: Float[np.ndarray, "2"]
    yaw_rad: float


def _strikes_s(act: StepContext, style: Style, first_side: int) -> Float[np.ndarray, " k"]:
    """Times (k,) of the foot strikes in seconds, alternating feet, from well before the motion to well after it."""
    period = 1 / style.steps_hz
    # From standing, the first foot leaves the floor at once; a motion under way may begin at any phase.
    under_way = act.first and not act.count
    lead = act.rng.uniform(0, period) if under_way else period * (1 - style.double_support) - 0.02
    anchor = act.start_s + lead
    low = int(np.floor((float(act.time_s[0]) - anchor) / period)) - 4
    high = int(np.ceil((float(act.time_s[-1]) - anchor) / period)) + 5
    strikes = anchor + np.arange(low, high) * period
    right = (np.arange(len(strikes)) + first_side) % 2 == RIGHT
    return strikes + style.uneven * period * right


def _footholds(
    act: StepContext, style: Style, middle_s: PerTime, side: int, weave_m: Callable[[PerTime], PerTime]
) -> tuple[Float[np.ndarray, "k 2"], Float[np.ndarray, " k"]]:
    """Positions (k, 2) and yaws (k,) of one foot in the stances with these middles."""
    path, h = act.path, act.height_m
    heading, share = path.facing_rad(middle_s), rise(path.speed_mps(middle_s) / style.stepping_mps)
    aside = OUTWARD[side] * (HALF_STANCE * h * (1 - share) + style.half_stance_m * share) + weave_m(middle_s)
    velocity = path.position_m(middle_s + 0.01) - path.position_m(middle_s - 0.01)
    cos, sin = np.cos(heading), np.sin(heading)
    back = np.where(share > 0, np.sign(velocity[:, 0] * cos + velocity[:, 1] * sin), 1.0)
    behind = -ANKLE_BEHIND * h - style.ahead_m * share * back
    place = path.position_m(middle_s) + np.stack([behind * cos - aside * sin, behind * sin + aside * cos], axis=-1)
    return place, heading + OUTWARD[side] * (TOES_OUT_RAD * (1 - share) + style.toes_out_rad * share)


def _moving(act: StepContext, *, on_spot: bool) -> PerTime:
    """(n,) 1 while the root moves or turns, 0 while it stands; C2.

    Short rests, as between a turn and the walk after it, are closed: the body would drop at once if the legs were
    straightened while the feet are apart.
    """
    from scipy import ndimage

    if on_spot:
        return act.edges(0.35, 0.35)
    time_s, path = act.time_s, act.path
    turning = np.abs(path.facing_rad(time_s + 1e-3) - path.facing_rad(time_s - 1e-3)) / 2e-3
    going = path.speed_mps(time_s) / max(0.8 * cruise_mps(act), 0.7)
    moving = np.asarray(1 - (1 - rise(going)) * (1 - rise(turning / 3.0)))
    rate_hz = (len(time_s) - 1) / max(float(time_s[-1] - time_s[0]), 1e-9)
    filled = ndimage.grey_closing(moving, size=2 * int(0.5 * SHORT_REST_S * rate_hz) + 1)
    share = np.clip((filled - moving) / np.maximum(1 - moving, 1e-6), 0.0, 1.0)
    smooth = ndimage.gaussian_filter1d(share, REST_SMOOTH_S * rate_hz)
    return np.asarray(1 - (1 - moving) * (1 - smooth))


def _move_foot_along(act: StepContext, falls: list[Footfall], side: int, style: Style, *, jog: bool) -> None:
    """Stance, then swing to the next position, for every footfall of one foot."""
    controls, time_s, ahead = act.controls, act.time_s, 0.0
    own = 1 + OUTWARD[side] * style.lopsided
    for fall, after in itertools.pairwise(falls):
        gap, swing = after.place_m - fall.place_m, after.strike_s - fall.off_s
        came, ahead = ahead, float(gap @ np.array([np.cos(fall.yaw_rad), np.sin(fall.yaw_rad)]))
        inside = (time_s >= fall.strike_s) & (time_s < after.strike_s)
        t = time_s[inside]
        long = float(np.hypot(*gap)) + 0.3 * abs(after.yaw_rad - fall.yaw_rad)
        effort = float(np.tanh((long / 0.15) ** 2))  # 0: the foot stays planted
        u = (t - fall.off_s) / swing
        controls.foot_m[inside, side, :2] = fall.place_m + travel(np.clip(u, 0, 1), *style.swing_ramps)[:, None] * gap
        high = own * style.lift_m * effort + (style.spot_lift_m * (1 - 0.5 * effort) if jog else 0.0)
        toes = own * style.toe_lift_m * min(abs(ahead) / 1.2, 1.15)
        controls.foot_m[inside, side, 2] = high * bump(u) + toes * bump(u / 0.7)
        controls.foot_rad[inside, side, 0] = fall.yaw_rad + rise(u) * (after.yaw_rad - fall.yaw_rad)
        pitch = own * _foot_pitch(t, fall, after, style, came, ahead)
        if jog:
            pitch = pitch + 0.2 * bump((t - fall.off_s + 0.08) / (swing + 0.08))
        controls.foot_rad[inside, side, 1] = pitch
        # A foot is unloaded before toe-off and fully loaded only after heel strike, so that the knee never extends at
        # speed, and the pelvis descends in time for the foot that is about to land.
        air = plateau(time_s, fall.off_s - 0.3 * swing, after.strike_s + 0.15 * swing, 0.55 * swing, 0.75 * swing)
        act.add(air, side, contact=-min(effort + float(jog), 1.0))


def _foot_pitch(t: PerTime, fall: Footfall, after: Footfall, style: Style, came_m: float, ahead_m: float) -> PerTime:
    """Foot pitch in radians: heel strike, flat, heel rise, toe-off, swing; scaled with the length of the steps."""
    came, goes = np.clip(np.array([came_m, ahead_m]) / 1.2, -0.35, 1.15)
    stance, swing = fall.off_s - fall.strike_s, after.strike_s - fall.off_s
    flat_s = max(0.22 * stance, SOLE_DOWN_S)
    down = -style.heel_strike_rad * max(came, 0.0) * (1 - rise((t - fall.strike_s) / flat_s))
    rises, folded = fall.strike_s + style.heel_rises * stance, fall.off_s + style.folded * swing
    up = style.toe_off_rad * abs(goes) * rise((t - rises) / (folded - rises))
    back = rise((t - folded) / (after.strike_s - folded))
    return down + up * (1 - back) - back * style.heel_strike_rad * max(goes, 0.0)


def _move_trunk_and_arms(act: StepContext, style: Style, phase: PerTime, moving: PerTime) -> None:
    """Trunk and arms from the step phase (n,): even at the left foot's strike, odd at the right foot's."""
    controls = act.controls
    left_ahead = np.cos(np.pi * phase) * moving  # the left leg is in front at its strike
    right_stance = -np.sin(np.pi * (phase - 0.1)) * moving  # +1 over the right foot, -1 over the left one
    high = np.cos(2 * np.pi * (phase - style.highest)) * moving
    stand = act.body.pelvis_height_m(style.sink) - style.bob_m
    controls.knee_room[:] = moving
    act.pelvis(left=-style.sway_m * right_stance, up=moving * (stand - controls.pelvis_m[:, 2]) + style.bob_m * high)
    _surge(act, style, phase, moving)
    act.add(right_stance, pelvis_roll=-0.05)
    act.add(moving, pelvis_pitch=0.4 * style.lean_rad)
    act.add(left_ahead, pelvis_yaw=-style.pelvis_yaw_rad)
    lame = 0.7 * style.uneven * np.maximum(np.sign(style.uneven) * right_stance, 0) ** 3  # over the bad leg
    act.add(1, spine_roll=0.05 * right_stance + lame)
    act.pelvis(up=-0.12 * np.abs(lame))
    act.add(moving, spine_pitch=0.6 * style.lean_rad, head_pitch=-0.8 * style.lean_rad)
    act.add(left_ahead, spine_yaw=style.twist_rad, head_yaw=style.pelvis_yaw_rad - style.twist_rad)
    lagging = np.cos(np.pi * (phase - ELBOW_LAG)) * moving
    for side in BOTH:
        sign = -OUTWARD[side]  # the arm goes with the other leg
        act.add(
            1,
            side,
            flexion=style.arm_swing_rad * (sign * left_ahead + 0.12 * moving) - style.arm_back_rad * moving,
            elbow=moving * (style.elbow_rad - 0.22) + style.elbow_swing_rad * sign * lagging,
            twist=-0.35 * moving * np.clip(style.elbow_rad, 0, 1),
        )


def _surge(act: StepContext, style: Style, phase: PerTime, moving: PerTime) -> None:
    """Speed variation of the pelvis, once a step; the trunk compensates part of it."""
    controls, heading = act.controls, act.controls.heading_rad
    turn = 2 * np.pi * (phase - style.fastest)
    surge_m = style.surge_mps / (2 * np.pi * style.steps_hz)
    ahead = surge_m * (np.sin(turn) + 0.5 * style.surge_sharp * np.sin(2 * turn)) * moving
    velocity = act.path.position_m(act.time_s + 0.01) - act.path.position_m(act.time_s - 0.01)
    speed = np.linalg.norm(velocity, axis=1)
    along = velocity / np.maximum(speed, 1e-6)[:, None] * np.tanh(speed / 0.005)[:, None]
    controls.pelvis_m[:, :2] += ahead[:, None] * along
    forward = along[:, 0] * np.cos(heading) + along[:, 1] * np.sin(heading)
    act.add(1, spine_pitch=-NOD * ahead * forward / (0.2 * act.height_m))


_MOST_OUT_OF_BALANCE = 0.65  # share of a stumble after which the trunk leans most
LUNGES_HZ = (0.58, 0.7, 0.9)  # steps per second of walking lunges: slowly, usually, quickly


@posture("sidestep", stands=False)
def sidestepping(act: StepContext) -> None:
    """One foot steps out, the other closes; the feet never cross."""
    speed, steps_hz = cruise_mps(act), act.tempo(1.5, 1.8, 2.3)
    style = replace(
        walking_style(act, max(speed, 0.4)),
        steps_hz=steps_hz,
        half_stance_m=0.05 * act.height_m + 0.5 * speed / steps_hz,
        **MOVEMENTS["sidestep"],
    )
    steps_along_path(act, style)


@posture("limp", stands=False)
def limping(act: StepContext) -> None:
    """Short stance on the bad leg, the trunk shifted over it, little arm swing."""
    style = walking_style(act, cruise_mps(act))
    bad = act.leg_side()
    style = replace(
        style,
        steps_hz=0.86 * style.steps_hz,
        uneven=act.uniform(0.1, 0.17) * (1 if bad == RIGHT else -1),
        arm_swing_rad=0.5 * style.arm_swing_rad,
        toe_off_rad=0.7 * style.toe_off_rad,
        lean_rad=style.lean_rad + 0.06,
        **MOVEMENTS["limp"],
    )
    steps_along_path(act, style)


@posture("stagger", stands=False)
def staggering(act: StepContext) -> None:
    """Feet set wide and unevenly, the body swaying over them, arms loose."""
    style = walking_style(act, cruise_mps(act))
    style = replace(
        style,
        steps_hz=0.9 * style.steps_hz,
        weave_m=act.uniform(0.05, 0.09),
        half_stance_m=1.9 * style.half_stance_m,
        uneven=act.uniform(-0.15, 0.15),
        **MOVEMENTS["stagger"],
    )
    steps_along_path(act, style)
    act.add(act.wander(0.25, 0.7), spine_roll=0.12)
    act.add(1, spine_pitch=0.1 + 0.09 * act.wander(0.25, 0.7))
    act.add(1, head_pitch=0.15 + 0.12 * act.wander(0.25, 0.7))
    for side in BOTH:
        act.add(act.wander(0.4, 1.0), side, flexion=0.2)
        act.add(1, side, abduction=0.15 + 0.12 * act.wander(0.4, 1.0))


@posture("walking_lunge", stands=False)
def walking_lunges(act: StepContext) -> None:
    """Long slow steps, each of them down until the thigh ahead is nearly level, the heel behind raised."""
    speed, h = max(cruise_mps(act), 0.3), act.height_m
    steps_hz = act.tempo(*LUNGES_HZ, spread=0.04)
    style = replace(
        walking_style(act, 0.8),
        steps_hz=steps_hz,
        half_stance_m=0.045 * h,
        bob_m=0.075 * h,
        surge_mps=0.75 * speed,
        **MOVEMENTS["walking_lunge"],
    )
    steps_along_path(act, style)


@posture("stumble", stands=False)
def stumbling(act: StepContext) -> None:
    """After a push the trunk lags behind, quick steps catch up, and the arms fly out for balance."""
    style = walking_style(act, 1.2)
    on_spot = act.direction == "spot"  # the feet are lifted but land in place
    style = replace(
        style,
        steps_hz=act.tempo(2.3, 2.7, 3.0),
        half_stance_m=1.5 * style.half_stance_m,
        spot_lift_m=0.05 if on_spot else style.spot_lift_m,
        **MOVEMENTS["stumble"],
    )
    steps_along_path(act, style, jog=on_spot, on_spot=on_spot)
    jolt, lasts_s = act.uniform(0.25, 0.45), max(min(act.duration_s, 1.5), 0.9)
    if act.style == FALLING_ON:  # ends with the trunk farthest ahead of the feet
        lasts_s = act.duration_s / _MOST_OUT_OF_BALANCE
    u = (act.time_s - act.start_s) / lasts_s
    early, late = bump(u / 0.6), bump((u - 0.3) / 0.7)
    heading = act.controls.heading_rad
    away = (act.moves[0].direction_rad if act.moves else float(heading[0]) + np.pi) - heading
    lean = jolt * (late - 0.8 * early)  # first behind the feet, then ahead of them
    act.add(lean, spine_pitch=np.cos(away), spine_roll=-np.sin(away), head_pitch=-0.6 * np.cos(away))
    for side in BOTH:
        act.add(late, side, abduction=act.uniform(0.4, 0.8))
        act.add(1, side, flexion=act.uniform(0.1, 0.6) * early + 0.3 * late, elbow=0.5 * (early + late))
