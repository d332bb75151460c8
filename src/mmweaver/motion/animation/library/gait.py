"""Walking, jogging and turning: feet planted along the root's path, the body driven by the phase of the steps."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.geometry.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.standing import ANKLE_BEHIND, HALF_STANCE, SIDE_SIGN, TOES_OUT_RAD, upright
from mmweaver.motion.animation.profiles import bump, plateau, rise, travel
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
GRAVITY_MPS2 = 9.81
SHORT_REST_S, REST_SMOOTH_S = 0.6, 0.06  # between two movements of the root, in which nobody comes to rest
SOLE_DOWN_S = 0.07  # at the least, from the strike of the heel until the sole is flat
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
    swing_ramps: tuple[float, float]  # shares of the swing in which the foot accelerates and decelerates
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


def walking_style(context: StepContext, speed_mps: float) -> Style:
    """Gait of a walk: step rate from speed (walk ratio about 0.42 m s; longer legs step slower), the rest from it."""
    rng, height_m = context.rng, context.body.height_m
    share = min(speed_mps / 1.3, 1.4)
    steps_hz = 1.87 * max(share, 0.25) ** 0.55 * (REFERENCE_HEIGHT_M / height_m) ** 0.5 * np.exp(rng.normal(0, 0.03))
    vigour = share**1.5 * np.exp(rng.normal(0, 0.3))
    leg_m, reach_m = context.body.leg_m, 0.46 * speed_mps / float(steps_hz)  # of the leading leg when its heel strikes
    drop_m = leg_m - (leg_m**2 - min(reach_m, 0.5 * leg_m) ** 2) ** 0.5
    return Style(
        steps_hz=float(steps_hz), double_support=-0.045, half_stance_m=0.034 * height_m,
        toes_out_rad=0.09 + rng.normal(0, 0.02), ahead_m=-0.005 * share,
        heel_strike_rad=0.32 * share**0.5, toe_off_rad=0.85 * share**0.6, heel_rises=0.88, folded=0.27,
        swing_ramps=(0.52, 0.28), toe_lift_m=0.057, lift_m=0.03, spot_lift_m=0.0,
        arm_swing_rad=0.19 * vigour, arm_back_rad=0.0, elbow_rad=0.42 + rng.normal(0, 0.1),
        elbow_swing_rad=0.18 * vigour, lean_rad=0.035 + rng.normal(0, 0.015), bob_m=0.27 * drop_m, highest=0.51,
        surge_mps=0.19 * share**0.5, surge_sharp=0.3, fastest=0.04, sink=0.972, pelvis_yaw_rad=0.09 * share,
        twist_rad=0.16 * share, sway_m=0.018, lopsided=float(np.clip(rng.normal(0, 0.06), -0.12, 0.12)),
    )  # fmt: skip


def jogging_style(context: StepContext, speed_mps: float) -> Style:
    """Short contacts with flight between them; the pelvis bobs so that in flight it falls freely."""
    rng, height_m = context.rng, context.body.height_m
    steps_hz = context.tempo(2.35, 2.6, 2.9, 0.08)
    share = min(speed_mps / 2.0, 1.7)  # of an easy indoor jog
    vigour = np.exp(rng.normal(0, 0.12))
    return Style(
        steps_hz=steps_hz, double_support=-0.57 - 0.2 * max(share - 0.8, 0.0),
        half_stance_m=0.036 * height_m, toes_out_rad=0.08, ahead_m=0.055 * share,
        heel_strike_rad=0.12 * share, toe_off_rad=0.85 + 0.27 * share, heel_rises=0.49, folded=0.24,
        swing_ramps=(0.56, 0.34), toe_lift_m=0.08 * share, lift_m=0.03 + 0.03 * share, spot_lift_m=0.13 * vigour,
        arm_swing_rad=(0.19 + 0.05 * share) * vigour, arm_back_rad=0.3, elbow_rad=1.8 + rng.normal(0, 0.15),
        elbow_swing_rad=0.1, lean_rad=0.07 + 0.07 * share,
        bob_m=(1.0 + 0.28 * min(share, 1.4)) * GRAVITY_MPS2 / (2 * np.pi * steps_hz) ** 2, highest=0.62,
        surge_mps=0.22 * share, surge_sharp=0.0, fastest=0.47, sink=0.965, pelvis_yaw_rad=0.03, twist_rad=0.3,
        sway_m=0.005, lopsided=float(np.clip(rng.normal(0, 0.06), -0.12, 0.12)),
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Footfall:
    """One stance of a foot: strike and lift-off in seconds, position (x, y) and yaw."""

    strike_s: float
    off_s: float
    place_m: Float[Array, "2"]
    yaw_rad: float


def walking(context: StepContext) -> Controls:
    return stepping(context, walking_style(context, max(cruise_mps(context), 0.7)), jog=False)


def jogging(context: StepContext) -> Controls:
    return stepping(context, jogging_style(context, cruise_mps(context)), jog=True)


def turning(context: StepContext) -> Controls:
    """Small steps on the spot; as in a slow walk."""
    return stepping(context, walking_style(context, 0.9), jog=False)


def cruise_mps(context: StepContext) -> float:
    """The highest speed of the step's moves, between their ramps, in m/s."""
    return max((move.speed_mps for move in context.moves), default=0.0)


def stepping(context: StepContext, style: Style, *, jog: bool) -> Controls:
    """Steps along the root's path. A foot whose next position equals its last one stays planted, unless jogging."""
    controls = upright(context)
    time_s = context.time_s
    first_side = int(context.rng.integers(2))
    strikes = _clock(context, style, first_side)
    aside = _weave(controls, context, style)
    moving = _moving(context, time_s, jog)
    for side in (LEFT, RIGHT):
        own = [k for k in range(len(strikes) - 2) if (k + first_side) % 2 == side]
        falls = _footfalls(context, style, strikes, np.array(own), side, aside)
        _write_foot(controls, time_s, falls, side, style, jog)
    from scipy.interpolate import CubicSpline

    phase = np.asarray(CubicSpline(strikes, np.arange(len(strikes)) + first_side)(time_s))
    _write_trunk_and_arms(controls, context, style, phase, moving)
    return controls


def _clock(context: StepContext, style: Style, first_side: int) -> Float[Array, " k"]:
    """Times (k,) of the foot strikes in seconds, alternating feet, from well before the motion to well after it."""
    period = 1 / style.steps_hz
    # From standing, the first foot leaves the floor at once; a motion under way may begin at any phase.
    lead = context.rng.uniform(0, period) if context.first else period * (1 - style.double_support) - 0.02
    begin, end = float(context.time_s[0]), float(context.time_s[-1])
    anchor = context.start_s + lead
    low = int(np.floor((begin - anchor) / period)) - 4
    high = int(np.ceil((end - anchor) / period)) + 5
    strikes = anchor + np.arange(low, high) * period
    right = (np.arange(len(strikes)) + first_side) % 2 == RIGHT
    return strikes + style.uneven * period * right


def _weave(
    controls: Controls, context: StepContext, style: Style
) -> Callable[[Float[Array, " k"]], Float[Array, " k"]]:
    """Adds lateral sway to the pelvis; returns it as a function of time (to the left, metres) for the feet."""
    phase, rate = context.rng.uniform(0, 2 * np.pi, 2), context.rng.uniform(0.35, 0.6)

    def aside(time_s: Float[Array, " k"]) -> Float[Array, " k"]:
        slow = np.sin(2 * np.pi * rate * time_s + phase[0]) + 0.5 * np.sin(4.4 * np.pi * rate * time_s + phase[1])
        return style.weave_m * slow

    if style.weave_m:
        left = aside(context.time_s)
        controls.pelvis_m[:, 0] -= left * np.sin(controls.heading_rad)
        controls.pelvis_m[:, 1] += left * np.cos(controls.heading_rad)
    return aside


def _footfalls(
    context: StepContext, style: Style, strikes: Float[Array, " strike"], own: Int[Array, " k"], side: int,
    weave: Callable[[Float[Array, " k"]], Float[Array, " k"]],
) -> list[Footfall]:  # fmt: skip
    """The stances of one foot, whose strikes are `own`; the path is evaluated once for all of them."""
    stance = (1 + style.double_support) * (strikes[own + 1] - strikes[own])
    middle = strikes[own] + stance / 2
    path: RootPath = context.path
    heading = path.facing_rad(middle)
    share = rise(path.speed_mps(middle) / 0.6)
    height_m = context.body.height_m
    aside = SIDE_SIGN[side] * (HALF_STANCE * height_m * (1 - share) + style.half_stance_m * share) + weave(middle)
    velocity = path.position_m(middle + 0.01) - path.position_m(middle - 0.01)
    cos, sin = np.cos(heading), np.sin(heading)
    back = np.where(share > 0, np.sign(velocity[:, 0] * cos + velocity[:, 1] * sin), 1.0)
    behind = -ANKLE_BEHIND * height_m - style.ahead_m * share * back
    place = path.position_m(middle) + np.stack([behind * cos - aside * sin, behind * sin + aside * cos], axis=-1)
    yaw = heading + SIDE_SIGN[side] * (TOES_OUT_RAD * (1 - share) + style.toes_out_rad * share)
    return [
        Footfall(strike_s=float(strikes[k]), off_s=float(strikes[k]) + float(lasts), place_m=at, yaw_rad=float(angle))
        for k, lasts, at, angle in zip(own, stance, place, yaw, strict=True)
    ]


def _moving(context: StepContext, time_s: Float[Array, " n"], jog: bool) -> Float[Array, " n"]:
    """(n,) 1 while the root moves or turns, 0 while it stands; C2."""
    if jog and context.step.direction == "spot":
        start = np.ones_like(time_s) if context.first else rise((time_s - context.start_s) / 0.35)
        end = np.ones_like(time_s) if context.last else rise((context.end_s - time_s) / 0.35)
        return np.asarray(start * end)
    turning = np.abs(context.path.facing_rad(time_s + 1e-3) - context.path.facing_rad(time_s - 1e-3)) / 2e-3
    going = context.path.speed_mps(time_s) / max(0.8 * cruise_mps(context), 0.7)
    return _without_dips(time_s, np.asarray(1 - (1 - rise(going)) * (1 - rise(turning / 3.0))))


def _without_dips(time_s: Float[Array, " n"], moving: Float[Array, " n"]) -> Float[Array, " n"]:
    """The same without short rests, as between a turn and the walk after it: who straightens the legs while the feet
    are apart drops at once."""
    from scipy import ndimage

    rate_hz = (len(time_s) - 1) / max(float(time_s[-1] - time_s[0]), 1e-9)
    filled = ndimage.grey_closing(moving, size=2 * int(0.5 * SHORT_REST_S * rate_hz) + 1)
    share = np.clip((filled - moving) / np.maximum(1 - moving, 1e-6), 0.0, 1.0)
    smooth = ndimage.gaussian_filter1d(share, REST_SMOOTH_S * rate_hz)
    return np.asarray(1 - (1 - moving) * (1 - smooth))


def _write_foot(
    controls: Controls, time_s: Float[Array, " n"], falls: list[Footfall], side: int, style: Style, jog: bool
) -> None:
    """Stance, then swing to the next position, for every footfall of one foot."""
    before = 0.0
    for fall, after in itertools.pairwise(falls):
        gap = after.place_m - fall.place_m
        ahead = float(gap @ np.array([np.cos(fall.yaw_rad), np.sin(fall.yaw_rad)]))
        came, before = before, ahead
        inside = (time_s >= fall.strike_s) & (time_s < after.strike_s)
        t = time_s[inside]
        long = float(np.hypot(*gap)) + 0.3 * abs(after.yaw_rad - fall.yaw_rad)
        effort = float(np.tanh((long / 0.15) ** 2))  # 0: the foot stays planted
        u = (t - fall.off_s) / (after.strike_s - fall.off_s)
        across = travel(np.clip(u, 0, 1), *style.swing_ramps)
        controls.foot_m[inside, side, :2] = fall.place_m + across[:, None] * gap
        own = 1 + SIDE_SIGN[side] * style.lopsided
        high = own * style.lift_m * effort + (style.spot_lift_m * (1 - 0.5 * effort) if jog else 0.0)
        controls.foot_m[inside, side, 2] = high * bump(u) + own * style.toe_lift_m * min(abs(ahead) / 1.2, 1.15) * bump(
            u / 0.7
        )
        controls.foot_rad[inside, side, 0] = fall.yaw_rad + rise(u) * (after.yaw_rad - fall.yaw_rad)
        pitch = own * _pitch(t, fall, after, style, came, ahead)
        if jog:
            pitch = pitch + 0.2 * bump((t - fall.off_s + 0.08) / (after.strike_s - fall.off_s + 0.08))
        controls.foot_rad[inside, side, 1] = pitch
        # A foot is unloaded before toe-off and fully loaded only after heel strike: so the knee is never extended at
        # speed, and the pelvis comes down in time for the foot that is about to land.
        swing = after.strike_s - fall.off_s
        air = plateau(time_s, fall.off_s - 0.3 * swing, after.strike_s + 0.15 * swing, 0.55 * swing, 0.75 * swing)
        controls.contact[:, side] -= air * min(effort + float(jog), 1.0)


def _pitch(
    t: Float[Array, " n"], fall: Footfall, after: Footfall, style: Style, came_m: float, ahead_m: float
) -> Float[Array, " n"]:
    """Foot pitch in radians: heel strike, flat, heel rise, toe-off, swing; scaled with the length of the steps."""
    came, goes = np.clip(np.array([came_m, ahead_m]) / 1.2, -0.35, 1.15)
    stance, swing = fall.off_s - fall.strike_s, after.strike_s - fall.off_s
    flat_s = max(0.22 * stance, SOLE_DOWN_S)
    down = -style.heel_strike_rad * max(came, 0.0) * (1 - rise((t - fall.strike_s) / flat_s))
    rises, folded = fall.strike_s + style.heel_rises * stance, fall.off_s + style.folded * swing
    up = style.toe_off_rad * abs(goes) * rise((t - rises) / (folded - rises))
    back = rise((t - folded) / (after.strike_s - folded))
    return down + up * (1 - back) - back * style.heel_strike_rad * max(goes, 0.0)


def _write_trunk_and_arms(
    controls: Controls, context: StepContext, style: Style, phase: Float[Array, " n"], moving: Float[Array, " n"]
) -> None:
    """`phase` (n,) counts steps: even at the left foot's strike, odd at the right one's."""
    body, heading = context.body, controls.heading_rad
    left_ahead = np.cos(np.pi * phase) * moving  # the left leg is in front at its strike
    right_stance = -np.sin(np.pi * (phase - 0.1)) * moving  # +1 over the right foot, -1 over the left one
    high = np.cos(2 * np.pi * (phase - style.highest)) * moving
    stand = body.pelvis_height_m(style.sink) - style.bob_m
    controls.knee_room[:] = moving
    controls.pelvis_m[:, 2] += moving * (stand - controls.pelvis_m[:, 2]) + style.bob_m * high
    sway = -style.sway_m * right_stance
    controls.pelvis_m[:, 0] -= sway * np.sin(heading)
    controls.pelvis_m[:, 1] += sway * np.cos(heading)
    _surge(controls, context, style, phase, moving)
    controls.pelvis_rad[:, 0] -= 0.05 * right_stance
    controls.pelvis_rad[:, 1] += 0.4 * style.lean_rad * moving
    controls.pelvis_rad[:, 2] -= style.pelvis_yaw_rad * left_ahead
    lame = 0.7 * style.uneven * np.maximum(np.sign(style.uneven) * right_stance, 0) ** 3  # over the bad leg
    controls.spine_rad[:, 0] += 0.05 * right_stance + lame
    controls.pelvis_m[:, 2] -= 0.12 * np.abs(lame)
    controls.spine_rad[:, 1] += 0.6 * style.lean_rad * moving
    controls.spine_rad[:, 2] += style.twist_rad * left_ahead
    controls.head_rad[:, 1] -= (style.twist_rad - style.pelvis_yaw_rad) * left_ahead
    controls.head_rad[:, 0] -= 0.8 * style.lean_rad * moving
    lagging = np.cos(np.pi * (phase - ELBOW_LAG)) * moving
    for side in (LEFT, RIGHT):
        arm, sign = controls.arm_rad[:, side], -SIDE_SIGN[side]  # the arm goes with the other leg
        arm[:, 0] += style.arm_swing_rad * (sign * left_ahead + 0.12 * moving) - style.arm_back_rad * moving
        arm[:, 3] += moving * (style.elbow_rad - 0.22) + style.elbow_swing_rad * sign * lagging
        arm[:, 2] -= 0.35 * moving * np.clip(style.elbow_rad, 0, 1)


def _surge(
    controls: Controls, context: StepContext, style: Style, phase: Float[Array, " n"], moving: Float[Array, " n"]
) -> None:
    """Speed variation of the pelvis, once a step; the trunk compensates part of it."""
    surge_m = style.surge_mps / (2 * np.pi * style.steps_hz)
    turn = 2 * np.pi * (phase - style.fastest)
    ahead = surge_m * (np.sin(turn) + 0.5 * style.surge_sharp * np.sin(2 * turn)) * moving
    velocity = context.path.position_m(context.time_s + 0.01) - context.path.position_m(context.time_s - 0.01)
    speed = np.linalg.norm(velocity, axis=1)
    along = velocity / np.maximum(speed, 1e-6)[:, None] * np.tanh(speed / 0.005)[:, None]
    controls.pelvis_m[:, :2] += ahead[:, None] * along
    forward = along[:, 0] * np.cos(controls.heading_rad) + along[:, 1] * np.sin(controls.heading_rad)
    controls.spine_rad[:, 1] -= NOD * ahead * forward / (0.2 * context.body.height_m)
