"""Jumping, hopping, jumping jacks and squats: the legs drive the pelvis; in flight it follows a ballistic curve."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import OUTWARD, shift_foot, shift_pelvis
from mmweaver.motion.animation.library.standing import STAND_STRETCH, home_feet, upright
from mmweaver.motion.animation.profiles import plateau, rise, through, travel
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
GRAVITY_MPS2 = 9.81
LAUNCH_S, CATCH_S = 0.26, 0.3  # of a leap: acceleration before take-off, deceleration after landing
Knot = tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True)
class Hop:
    """One flight: the pelvis takes off and lands at the same height and rises by `rise_m` in between."""

    off_s: float
    rise_m: float

    @property
    def speed_mps(self) -> float:
        return float(np.sqrt(2 * GRAVITY_MPS2 * self.rise_m))

    @property
    def flight_s(self) -> float:
        return 2 * self.speed_mps / GRAVITY_MPS2

    @property
    def land_s(self) -> float:
        return self.off_s + self.flight_s

    def knots(self, height_m: float) -> list[Knot]:
        """Knots of take-off and landing of the pelvis; the quintic between them is the parabola of free fall."""
        return [
            (self.off_s, height_m, self.speed_mps, -GRAVITY_MPS2),
            (self.land_s, height_m, -self.speed_mps, -GRAVITY_MPS2),
        ]

    def sole_m(self, time_s: Float[Array, " n"]) -> Float[Array, " n"]:
        """Height (n,) of the soles in metres: they follow the pelvis, accelerating and decelerating within `ramp`."""
        ramp = min(0.07, 0.3 * self.flight_s)
        fine = np.linspace(self.off_s, self.land_s, 400)
        speed = -GRAVITY_MPS2 * (fine - (self.off_s + self.land_s) / 2)
        speed = speed * rise((fine - self.off_s) / ramp) * rise((self.land_s - fine) / ramp)
        from scipy.interpolate import CubicSpline

        height = CubicSpline(fine, speed).antiderivative()
        return np.where((time_s > self.off_s) & (time_s < self.land_s), height(np.clip(time_s, fine[0], fine[-1])), 0.0)

    def air(self, time_s: Float[Array, " n"]) -> Float[Array, " n"]:
        """(n,) 1 in flight, 0 on the floor."""
        return plateau(time_s, self.off_s, self.land_s, 0.3 * self.flight_s, 0.3 * self.flight_s)

    def toes_down(self, time_s: Float[Array, " n"], before_s: float, after_s: float) -> Float[Array, " n"]:
        """Plantar flexion (n,): heels rise before take-off and come down after landing; largest early in flight."""
        up = rise((time_s - self.off_s + before_s) / (before_s + 0.35 * self.flight_s))
        half = 0.5 * rise((time_s - self.off_s - 0.35 * self.flight_s) / (0.6 * self.flight_s))
        down = 0.5 * rise((time_s - self.land_s + 0.03) / (after_s + 0.03))
        return up - half - down


def hop_all(
    controls: Controls,
    context: StepContext,
    hops: list[Hop],
    dips_m: list[tuple[float, float, float]],
    ready_m: float = -0.02,
    heels: float = 0.95,
) -> None:
    """Writes pelvis height, soles, heels and contact of hops with dips (time, depth, upward acceleration) in between.

    Take-off and landing are `ready_m` above the standing height: heels up, knees not quite straight, so that the
    soles can take up the pelvis's speed within hundredths of a second.
    """
    time_s, body = context.time_s, context.body
    stand = body.pelvis_height_m(STAND_STRETCH)
    knots: list[Knot] = [(time, stand - depth, 0.0, push) for time, depth, push in dips_m]
    for hop in hops:
        knots += hop.knots(stand + ready_m)
    knots.sort()
    controls.pelvis_m[:, 2] = through(time_s, knots)
    controls.knee_room[:] = plateau(time_s, hops[0].off_s - 0.4, hops[-1].land_s + 0.5, 0.35, 0.4)
    for hop in hops:
        pitch = heels * hop.toes_down(time_s, 0.13, 0.12)
        controls.foot_rad[:, :, 1] += pitch[:, None]
        controls.foot_m[:, :, 2] += hop.sole_m(time_s)[:, None]
        controls.contact[:] -= hop.air(time_s)[:, None]


def jumping(context: StepContext) -> Controls:
    """Jumps on the spot: crouch with the arms back, take off, flight, soft landing, then the next jump or rest."""
    # People who keep jumping mostly hop from the ankles, twice a second, with quiet arms.
    if not context.step.count and context.duration_s > 1.8 and context.rng.random() < 0.5:
        return hopping(context)
    return _jumps(context)[0]


def hopping(context: StepContext) -> Controls:
    """Small quick jumps from the ankles, about two a second, the arms bent and almost still."""
    controls = upright(context)
    bounce(controls, context, one_leg=False)
    controls.arm_rad[:, :, 3] += float(context.rng.uniform(0.0, 1.1))
    controls.arm_rad[:, :, 0] += 0.1
    return controls


def bounce(controls: Controls, context: StepContext, *, one_leg: bool) -> None:
    """Hops at an even rate over the step's time."""
    rate = context.tempo(1.7, 2.05, 2.35)
    count = context.step.count or max(1, round((context.duration_s - 0.45) * rate))
    period = float(np.clip((context.duration_s - 0.45) / count, 0.4, 0.62)) if context.step.count else 1 / rate
    high = float(context.rng.uniform(0.025, 0.085)) * (0.8 if one_leg else 1.0)
    high = 0.06 + 0.5 * high if context.moves else high  # flights that carry the body over the floor are longer
    ground = period - Hop(off_s=0.0, rise_m=high).flight_s
    first = context.start_s + 0.3
    hops = [Hop(off_s=first + k * period, rise_m=high) for k in range(count)]
    dips = [(first - 0.3, 0.0, 0.0)]
    dips += [(hop.off_s - ground / 2, 0.075, 14.0 if hop is not hops[0] else 8.0) for hop in hops]
    dips += [(hops[-1].land_s + 0.18, 0.07, 6.0), (hops[-1].land_s + 0.5, 0.0, 0.0)]
    hop_all(controls, context, hops, dips, ready_m=-0.04, heels=0.8)
    if context.moves:
        _go_along(controls, context, hops)
    # Hops are never quite vertical: the trunk swings to and fro with each.
    turn = 2 * np.pi * (context.time_s - first) / period + context.rng.uniform(0, 2 * np.pi)
    shift_pelvis(controls, float(context.rng.uniform(0.0, 0.018)) * np.sin(turn), 0.0, 0.0)


def _go_along(controls: Controls, context: StepContext, hops: list[Hop]) -> None:
    """Feet go along the step's way in flight, an equal part with each hop; the pelvis evenly from first to last."""
    time_s, (move,) = context.time_s, context.moves
    before_s = np.array([context.start_s - 0.001])
    start_m, heading_rad = context.path.position_m(before_s)[0], float(context.path.facing_rad(before_s)[0])
    begin_s, whole_s = hops[0].off_s - LAUNCH_S, hops[-1].land_s - hops[0].off_s + LAUNCH_S + CATCH_S
    even = travel(np.clip((time_s - begin_s) / whole_s, 0, 1), LAUNCH_S / whole_s, CATCH_S / whole_s)
    in_flight = np.mean([rise((time_s - hop.off_s) / hop.flight_s) for hop in hops], axis=0)
    facing_rad, stands_rad = (heading_rad + move.curvature_per_m * move.length_m * part for part in (even, in_flight))
    stands_m = start_m + move.shift_after_m(move.length_m * in_flight)
    was_m, was_rad = context.path.position_m(time_s), context.path.facing_rad(time_s)
    controls.pelvis_m[:, :2] += start_m + move.shift_after_m(move.length_m * even) - was_m
    controls.heading_rad[:] += facing_rad - was_rad
    stands = home_feet(context.body, stands_m, stands_rad) - home_feet(context.body, was_m, was_rad)
    controls.foot_m[:, :, :2] += stands[:, :, :2]
    controls.foot_rad[:, :, 0] += (stands_rad - was_rad)[:, None]


def leaping(context: StepContext) -> Controls:
    """Jumps from place to place: the step's distance is covered in flight, in equal parts."""
    time_s, path = context.time_s, context.path
    ends = np.array([context.start_s - 0.001, context.end_s])
    start, heading = path.position_m(ends)[0], float(path.facing_rad(ends)[0])
    here = RootPath(start_m=(float(start[0]), float(start[1])), heading_rad=heading)
    controls, hops = _jumps(replace(context, path=here))
    feet = sum(rise((time_s - hop.off_s) / hop.flight_s) for hop in hops) / len(hops)
    body = sum(_carried(time_s, hop) for hop in hops) / len(hops)
    shift_m = path.position_m(ends)[1] - start
    controls.pelvis_m[:, :2] += np.asarray(body)[:, None] * shift_m
    controls.foot_m[:, :, :2] += np.asarray(feet)[:, None, None] * shift_m
    return controls


def _carried(time_s: Float[Array, " n"], hop: Hop) -> Float[Array, " n"]:
    """Share (n,) of a leap that the pelvis has covered: accelerating on the floor, uniform in flight, then braking."""
    whole_s = LAUNCH_S + hop.flight_s + CATCH_S
    return travel(np.clip((time_s - hop.off_s + LAUNCH_S) / whole_s, 0, 1), LAUNCH_S / whole_s, CATCH_S / whole_s)


def _jumps(context: StepContext) -> tuple[Controls, list[Hop]]:
    controls, time_s, rng = upright(context), context.time_s, context.rng
    height_m = float(rng.uniform(0.2, 0.42)) * (0.7, 1.0, 1.1)[context.step.speed + 1]
    flight_s = Hop(off_s=0.0, rise_m=height_m).flight_s
    crouch_s, push_s, absorb_s, recover_s = 0.34, 0.25, 0.24, 0.36
    edge_s, between_s = crouch_s + push_s + absorb_s + recover_s, flight_s + absorb_s + push_s + 0.04
    fewest = 2 if context.step.several else 1
    count = context.step.count or max(fewest, int((context.duration_s - edge_s - flight_s) / between_s + 1.25))
    spare = max(context.duration_s - edge_s - flight_s - (count - 1) * between_s, 0.0)
    slower = min(0.5 * spare, 0.4)  # spare time slows down crouching and recovery
    crouch_s, recover_s, spare = crouch_s + slower, recover_s + slower, spare - 2 * slower
    period = between_s + (min(spare / (count - 1), 0.35) if count > 1 else 0.0)
    depth = float(rng.uniform(0.19, 0.25))
    first = context.start_s + crouch_s + push_s
    hops = [Hop(off_s=first + k * period, rise_m=height_m) for k in range(count)]
    rest = hops[-1].land_s + absorb_s + recover_s
    dips = [(context.start_s, 0.0, 0.0), (context.start_s + crouch_s, depth, 9.0)]
    dips += [(hop.off_s - (period - flight_s) / 2, depth, 9.0) for hop in hops[1:]]
    dips += [(hops[-1].land_s + absorb_s, 0.8 * depth, 7.0), (rest, 0.0, 0.0)]
    hop_all(controls, context, hops, dips, ready_m=-0.02 - 0.15 * max(height_m - 0.16, 0.0))
    pitch_rad, nod = float(rng.uniform(0.4, 0.75)), float(rng.uniform(0.1, 0.45))
    trunk = plateau(time_s, context.start_s, first + 0.08, crouch_s, push_s + 0.2)
    forth = np.zeros_like(time_s)
    back = plateau(time_s, context.start_s, first + 0.06, crouch_s, push_s + 0.25)
    for hop in hops:
        gap = absorb_s if hop is hops[-1] else (period - flight_s) / 2
        after = recover_s if hop is hops[-1] else gap
        trunk = trunk + nod * plateau(time_s, hop.land_s - 0.1, hop.land_s + gap + after, gap + 0.1, after)
        forth = forth + plateau(time_s, hop.off_s - 0.4, hop.land_s + 0.2, 0.5, flight_s + 0.1)
    _bend(controls, trunk, pitch_rad)
    controls.arm_rad[:, :, 0] += (1.0 * forth - 0.5 * back)[:, None]
    controls.arm_rad[:, :, 3] += (0.75 * forth + 0.15 * back)[:, None]
    return controls, hops


def _bend(controls: Controls, amount: Float[Array, " n"], pitch_rad: float) -> None:
    """Hips move back and the trunk leans forward over them, scaled by `amount` (n,)."""
    heading = controls.heading_rad
    for axis, part in ((0, np.cos(heading)), (1, np.sin(heading))):
        controls.pelvis_m[:, axis] -= 0.34 * pitch_rad * amount * part
    controls.pelvis_rad[:, 1] += 0.6 * pitch_rad * amount
    controls.spine_rad[:, 1] += 0.5 * pitch_rad * amount
    controls.head_rad[:, 0] -= 0.7 * pitch_rad * amount


def jumping_jacks(context: StepContext) -> Controls:
    """Legs apart with the arms overhead, and back, each with a small hop."""
    controls, time_s, rng = upright(context), context.time_s, context.rng
    half_s = 0.5 / context.tempo(0.78, 0.92, 1.05)
    count = context.step.count
    if count:
        lead = 0.0 if context.first else 0.35
        half_s = float(np.clip((context.duration_s - lead) / (2 * count), 0.46, 0.7))
    height_m = float(rng.uniform(0.03, 0.045))
    flight_s = Hop(off_s=0.0, rise_m=height_m).flight_s
    hops_wanted = 2 * count if count else 2 * max(1, int(np.ceil(context.duration_s / (2 * half_s) - 0.35)))
    ground_s = half_s - flight_s
    begin = (
        context.start_s + ground_s * 0.5 + (0.0 if context.first else 0.35)
    )  # arms of what was before come down first
    hops = [Hop(off_s=begin + k * half_s, rise_m=height_m) for k in range(hops_wanted)]
    dips = [(context.start_s - 0.2, 0.0, 0.0)]
    dips += [(hop.off_s - ground_s / 2, 0.08, 5.0) for hop in hops]
    dips += [(hops[-1].land_s + ground_s / 2, 0.07, 5.0), (hops[-1].land_s + ground_s / 2 + 0.3, 0.0, 0.0)]
    hop_all(controls, context, hops, dips, ready_m=-0.045, heels=0.95)
    spread, lift = np.zeros_like(time_s), np.zeros_like(time_s)
    for k, hop in enumerate(hops):
        sign = 1.0 if k % 2 == 0 else -1.0
        spread += sign * rise((time_s - hop.off_s) / hop.flight_s)
        centre, wide = (hop.off_s + hop.land_s) / 2, half_s
        lift += sign * rise((time_s - centre) / wide + 0.5)
    _spread_feet(controls, context, spread, float(rng.uniform(0.115, 0.145)))
    top = float(rng.uniform(2.55, 2.85))
    controls.arm_rad[:, :, 1] += (top * lift)[:, None]
    controls.arm_rad[:, :, 3] += (0.25 * lift)[:, None]
    controls.arm_rad[:, :, 0] += float(rng.uniform(0.0, 0.35)) + (float(rng.uniform(-0.1, 0.3)) * lift)[:, None]
    return controls


def _spread_feet(controls: Controls, context: StepContext, spread: Float[Array, " n"], half: float) -> None:
    """Half the distance between the feet grows by `half` (of the height) as `spread` (n,) goes to 1."""
    position, heading = context.path.position_m(context.time_s), context.path.facing_rad(context.time_s)
    near = home_feet(context.body, position, heading)
    wide = home_feet(context.body, position, heading, 0.056 + half)
    controls.foot_m[:, :, :2] += (spread[:, None, None] * (wide - near))[:, :, :2]
    for side, sign in ((LEFT, 1.0), (RIGHT, -1.0)):
        controls.foot_rad[:, side, 0] += sign * 0.25 * spread
    controls.knee_out_rad[:] += 0.2 * spread[:, None]


def squatting(context: StepContext) -> Controls:
    """On feet wider than the hips, down until the knees are flexed by about 115 degrees, and up again.

    Depth, stance and pace are near those of the first subject of MARS; arms go forward for balance.
    """
    controls, time_s, rng, body = upright(context), context.time_s, context.rng, context.body
    period = 1 / context.tempo(0.3, 0.38, 0.6)
    fewest = 2 if context.step.several else 1
    count = context.step.count or max(fewest, round(context.duration_s / period))
    period = float(np.clip(context.duration_s / count, 1.05, 3.6))
    wider = float(rng.uniform(0.04, 0.095)) * body.height_m  # how much farther out each foot stands
    for foot in (LEFT, RIGHT):
        shift_foot(controls, foot, 0.0, wider, 0.0)
        controls.foot_rad[:, foot, 0] += OUTWARD[foot] * 0.2
    down = np.zeros_like(time_s)
    for k in range(count):
        begin = context.start_s + k * period
        down += plateau(time_s, begin, begin + 0.98 * period, 0.45 * period, 0.45 * period)
    knee = np.radians(rng.uniform(120, 136))
    back = float(rng.uniform(0.085, 0.125)) * body.height_m
    lean = float(rng.uniform(0.4, 1.3))
    leg = np.sqrt(body.thigh_m**2 + body.shank_m**2 + 2 * body.thigh_m * body.shank_m * np.cos(knee))
    low = body.ankle_height_m + np.sqrt(leg**2 - back**2) + body.hip_below_pelvis_m * 0.95
    stand = body.pelvis_height_m(STAND_STRETCH)
    controls.pelvis_m[:, 2] -= down * (stand - low)
    heading = controls.heading_rad
    shift = (back + 0.022 * body.height_m) * down
    controls.pelvis_m[:, 0] -= shift * np.cos(heading)
    controls.pelvis_m[:, 1] -= shift * np.sin(heading)
    controls.pelvis_rad[:, 1] += 0.42 * lean * down
    controls.spine_rad[:, 1] += 0.3 * lean * down
    controls.head_rad[:, 0] -= 0.45 * down
    controls.knee_out_rad[:] += (0.3 * down)[:, None]
    lift_rad = float(rng.choice([rng.uniform(0.0, 0.5), rng.uniform(1.2, 1.9)]))  # arms hanging, or raised for balance
    controls.arm_rad[:, :, 0] += (lift_rad * down)[:, None]
    controls.arm_rad[:, :, 1] -= (0.1 * down)[:, None]
    return controls
