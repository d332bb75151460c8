"""Jumping, leaping, hopping, jumping jacks and squats: in flight the pelvis follows a ballistic curve."""

from dataclasses import dataclass

import numpy as np

from mmweaver.motion.animation.controls import OUTWARD
from mmweaver.motion.animation.profiles import PerTime, plateau, rise, sum_plateaus, through, travel
from mmweaver.motion.animation.standing import STAND_STRETCH, home_feet
from mmweaver.motion.animation.step_context import BOTH, StepContext, posture

GRAVITY_MPS2 = 9.81
LAUNCH_S, CATCH_S = 0.26, 0.3  # of a leap: acceleration before take-off, deceleration after landing


@dataclass(frozen=True, kw_only=True)
class Hop:
    """One flight: the pelvis takes off and lands at the same height.

    Attributes:
        off_s: Time of take-off in seconds.
        rise_m: Rise of the pelvis in between, metres.
    """

    off_s: float
    rise_m: float

    @property
    def speed_mps(self) -> float:
        """Upward speed at take-off in m/s."""
        return float(np.sqrt(2 * GRAVITY_MPS2 * self.rise_m))

    @property
    def flight_s(self) -> float:
        """Time of flight in seconds."""
        return 2 * self.speed_mps / GRAVITY_MPS2

    @property
    def land_s(self) -> float:
        """Time of landing in seconds."""
        return self.off_s + self.flight_s

    def progress(self, time_s: PerTime) -> PerTime:
        """Progress of the flight.

        Args:
            time_s: Times (n,) in seconds.

        Returns:
            0 until take-off, 1 after landing, smooth in between, (n,).
        """
        return rise((time_s - self.off_s) / self.flight_s)

    def sole_m(self, time_s: PerTime) -> PerTime:
        """Height of the soles, which follow the pelvis and accelerate and decelerate within a short ramp.

        Args:
            time_s: Times (n,) in seconds.

        Returns:
            Metres above the floor (n,).
        """
        from scipy.interpolate import CubicSpline

        ramp = min(0.07, 0.3 * self.flight_s)
        fine = np.linspace(self.off_s, self.land_s, 400)
        speed = -GRAVITY_MPS2 * (fine - (self.off_s + self.land_s) / 2)
        speed = speed * rise((fine - self.off_s) / ramp) * rise((self.land_s - fine) / ramp)
        height = CubicSpline(fine, speed).antiderivative()
        return np.where((time_s > self.off_s) & (time_s < self.land_s), height(np.clip(time_s, fine[0], fine[-1])), 0.0)

    def toes_down(self, time_s: PerTime, before_s: float, after_s: float) -> PerTime:
        """Plantar flexion: heels rise before take-off and come down after landing.

        Args:
            time_s: Times (n,) in seconds.
            before_s: Time before take-off at which the heels begin to rise.
            after_s: Time after landing at which they are down.

        Returns:
            0 to 1 (n,), largest early in flight.
        """
        up = rise((time_s - self.off_s + before_s) / (before_s + 0.35 * self.flight_s))
        half = 0.5 * rise((time_s - self.off_s - 0.35 * self.flight_s) / (0.6 * self.flight_s))
        down = 0.5 * rise((time_s - self.land_s + 0.03) / (after_s + 0.03))
        return up - half - down


def hop_all(
    act: StepContext, hops: list[Hop], dips_m: list[tuple[float, float, float]], ready_m: float, heels: float = 0.95
) -> None:
    """Writes pelvis height, soles, heels and contact of a sequence of hops.

    Take-off and landing are `ready_m` above the standing height: heels up, knees not quite straight, so that the
    soles can match the pelvis's speed within hundredths of a second.

    Args:
        act: Context whose controls are written.
        hops: Flights in temporal order.
        dips_m: Time in seconds, depth in metres and upward acceleration in m/s2 of the crouches in between.
        ready_m: Height of the pelvis at take-off and landing above standing, metres.
        heels: Amplitude of the foot pitch in radians.
    """
    time_s, controls = act.time_s, act.controls
    stand = act.body.pelvis_height_m(STAND_STRETCH)
    knots = [(time, stand - depth, 0.0, push) for time, depth, push in dips_m]
    for hop in hops:  # the quintic between take-off and landing is the parabola of free fall
        for at_s, speed_mps in ((hop.off_s, hop.speed_mps), (hop.land_s, -hop.speed_mps)):
            knots.append((at_s, stand + ready_m, speed_mps, -GRAVITY_MPS2))
    controls.pelvis_m[:, 2] = through(time_s, sorted(knots))
    controls.knee_room[:] = plateau(time_s, hops[0].off_s - 0.4, hops[-1].land_s + 0.5, 0.35, 0.4)
    for hop in hops:
        ramp_s = 0.3 * hop.flight_s
        act.add(hop.toes_down(time_s, 0.13, 0.12), foot_pitch=heels)
        controls.foot_m[:, :, 2] += hop.sole_m(time_s)[:, None]
        act.add(plateau(time_s, hop.off_s, hop.land_s, ramp_s, ramp_s), contact=-1)


@posture("jump", stands=False)
def jumping(act: StepContext) -> None:
    """Jumps on the spot: crouch with the arms back, take off, flight, soft landing, then the next jump or rest."""
    # Continuous jumping is mostly hopping from the ankles, twice per second, with quiet arms.
    keeps_hopping = not act.count and act.duration_s > 1.8 and act.rng.random() < 0.5
    act.stand()
    (hopping if keeps_hopping else _jumps)(act)


@posture("hop")
def hopping(act: StepContext) -> None:
    """Small quick jumps from the ankles, about two per second, the arms bent and almost still."""
    _bounce(act, act.start_s, act.duration_s)
    act.add(1, elbow=act.uniform(0.0, 1.1), flexion=0.1)


@posture("hop_one_leg")
def hopping_on_one_leg(act: StepContext) -> None:
    """The other leg stays lifted behind; the body leans over the hopping leg."""
    side = 1 - act.leg_side() if act.foot else int(act.rng.integers(2))
    ready_s, h, time_s, controls = 0.55, act.height_m, act.time_s, act.controls
    start_s = act.start_s - ready_s * act.first
    ends_s = np.inf if act.last else act.end_s + 0.6
    up = rise((time_s - start_s) / ready_s) * rise((ends_s - time_s) / 0.6)
    high = controls.pelvis_m[:, 2].copy()
    _bounce(act, start_s + ready_s, act.end_s - (start_s + ready_s), size=0.8)
    bob = controls.pelvis_m[:, 2] - high
    back = act.uniform(0.12, 0.2)
    rises_m = up * (0.14 * h + 0.5 * bob) - controls.foot_m[:, side, 2] * up
    act.move_foot(side, -back * h * up, -0.01 * h * up, rises_m)
    act.lean_over(1 - side, up)
    act.lift_weight(side, np.minimum(up, controls.contact[:, side]))
    act.add(up, side, foot_pitch=0.7)
    act.add(up, abduction=0.45, elbow=0.5)


def _bounce(act: StepContext, start_s: float, lasts_s: float, *, size: float = 1.0) -> None:
    """Hops at an even rate."""
    rate = act.tempo(1.7, 2.05, 2.35)
    count = act.count or max(1, round((lasts_s - 0.45) * rate))
    period = float(np.clip((lasts_s - 0.45) / count, 0.4, 0.62)) if act.count else 1 / rate
    high = act.uniform(0.025, 0.085) * size
    high = 0.06 + 0.5 * high if act.moves else high  # flights that cover distance are longer
    ground, first = period - Hop(off_s=0.0, rise_m=high).flight_s, start_s + 0.3
    hops = [Hop(off_s=first + k * period, rise_m=high) for k in range(count)]
    dips = [(first - 0.3, 0.0, 0.0)]
    dips += [(hop.off_s - ground / 2, 0.075, 14.0 if hop is not hops[0] else 8.0) for hop in hops]
    dips += [(hops[-1].land_s + 0.18, 0.07, 6.0), (hops[-1].land_s + 0.5, 0.0, 0.0)]
    hop_all(act, hops, dips, ready_m=-0.04, heels=0.8)
    if act.moves:
        _go_along(act, start_s, hops)
    # Hops are never exactly vertical: the trunk swings with each.
    turn = 2 * np.pi * (act.time_s - first) / period + act.rng.uniform(0, 2 * np.pi)
    act.pelvis(act.uniform(0.0, 0.018) * np.sin(turn))


def _carried(since_launch_s: PerTime, flight_s: float) -> PerTime:
    """Share (n,) of a distance covered by the pelvis: accelerating on the floor, uniform in flight, then braking."""
    whole_s = LAUNCH_S + flight_s + CATCH_S
    return travel(np.clip(since_launch_s / whole_s, 0, 1), LAUNCH_S / whole_s, CATCH_S / whole_s)


def _go_along(act: StepContext, start_s: float, hops: list[Hop]) -> None:
    """Feet follow the step's path in flight, an equal part per hop; the pelvis moves evenly from first to last."""
    time_s, path, controls, (move,) = act.time_s, act.path, act.controls, act.moves
    before_s = np.array([start_s - 0.001])
    start_m, heading_rad = path.position_m(before_s)[0], float(path.facing_rad(before_s)[0])
    even = _carried(time_s - (hops[0].off_s - LAUNCH_S), hops[-1].land_s - hops[0].off_s)
    in_flight = np.mean([hop.progress(time_s) for hop in hops], axis=0)
    facing_rad, stands_rad = (heading_rad + move.curvature_per_m * move.length_m * part for part in (even, in_flight))
    stands_m = start_m + move.shift_after_m(move.length_m * in_flight)
    was_m, was_rad = path.position_m(time_s), path.facing_rad(time_s)
    controls.pelvis_m[:, :2] += start_m + move.shift_after_m(move.length_m * even) - was_m
    act.add(1, heading=facing_rad - was_rad, foot_yaw=stands_rad - was_rad)
    controls.foot_m[:] += home_feet(act.body, stands_m, stands_rad) - home_feet(act.body, was_m, was_rad)


@posture("leap", stands=False)
def leaping(act: StepContext) -> None:
    """Jumps from place to place: the step's distance is covered in flight, in equal parts."""
    start, end = act.path.position_m(np.array([act.start_s - 0.001, act.end_s]))
    act.path = act.standing_path()
    act.stand()
    hops = _jumps(act)
    feet = sum(hop.progress(act.time_s) for hop in hops) / len(hops)
    body = sum(_carried(act.time_s - hop.off_s + LAUNCH_S, hop.flight_s) for hop in hops) / len(hops)
    act.controls.pelvis_m[:, :2] += np.asarray(body)[:, None] * (end - start)
    act.controls.foot_m[:, :, :2] += np.asarray(feet)[:, None, None] * (end - start)


def _jumps(act: StepContext) -> list[Hop]:
    height_m = act.uniform(0.2, 0.42) * act.by_speed(0.7, 1.0, 1.1)
    flight_s = Hop(off_s=0.0, rise_m=height_m).flight_s
    crouch_s, push_s, absorb_s, recover_s = 0.34, 0.25, 0.24, 0.36
    edge_s, between_s = crouch_s + push_s + absorb_s + recover_s, flight_s + absorb_s + push_s + 0.04
    count = act.count or max(act.fewest, int((act.duration_s - edge_s - flight_s) / between_s + 1.25))
    spare = max(act.duration_s - edge_s - flight_s - (count - 1) * between_s, 0.0)
    slower = min(0.5 * spare, 0.4)  # spare time slows down crouching and recovery
    crouch_s, recover_s, spare = crouch_s + slower, recover_s + slower, spare - 2 * slower
    period = between_s + (min(spare / (count - 1), 0.35) if count > 1 else 0.0)
    depth = act.uniform(0.19, 0.25)
    first = act.start_s + crouch_s + push_s
    hops = [Hop(off_s=first + k * period, rise_m=height_m) for k in range(count)]
    rest = hops[-1].land_s + absorb_s + recover_s
    dips = [(act.start_s, 0.0, 0.0), (act.start_s + crouch_s, depth, 9.0)]
    dips += [(hop.off_s - (period - flight_s) / 2, depth, 9.0) for hop in hops[1:]]
    dips += [(hops[-1].land_s + absorb_s, 0.8 * depth, 7.0), (rest, 0.0, 0.0)]
    hop_all(act, hops, dips, ready_m=-0.02 - 0.15 * max(height_m - 0.16, 0.0))
    pitch_rad, nod = act.uniform(0.4, 0.75), act.uniform(0.1, 0.45)
    trunk = act.plateau(act.start_s, first + 0.08, crouch_s, push_s + 0.2)
    back, forth = act.plateau(act.start_s, first + 0.06, crouch_s, push_s + 0.25), np.zeros_like(trunk)
    for hop in hops:
        gap = absorb_s if hop is hops[-1] else (period - flight_s) / 2
        after = recover_s if hop is hops[-1] else gap
        trunk = trunk + nod * act.plateau(hop.land_s - 0.1, hop.land_s + gap + after, gap + 0.1, after)
        forth = forth + act.plateau(hop.off_s - 0.4, hop.land_s + 0.2, 0.5, flight_s + 0.1)
    act.pelvis(-0.34 * pitch_rad * trunk)  # hips move back and the trunk leans forward over them
    act.add(trunk, pelvis_pitch=0.6 * pitch_rad, spine_pitch=0.5 * pitch_rad, head_pitch=-0.7 * pitch_rad)
    act.add(1, flexion=1.0 * forth - 0.5 * back, elbow=0.75 * forth + 0.15 * back)
    return hops


@posture("jumping_jacks")
def jumping_jacks(act: StepContext) -> None:
    """Legs apart with the arms overhead, and back, each with a small hop."""
    time_s, count = act.time_s, act.count
    half_s, lead = 0.5 / act.tempo(0.78, 0.92, 1.05), 0.0 if act.first else 0.35  # arms come down first
    if count:
        half_s = float(np.clip((act.duration_s - lead) / (2 * count), 0.46, 0.7))
    height_m = act.uniform(0.03, 0.045)
    ground_s = half_s - Hop(off_s=0.0, rise_m=height_m).flight_s
    count = count or max(1, int(np.ceil(act.duration_s / (2 * half_s) - 0.35)))
    begin = act.start_s + ground_s * 0.5 + lead
    hops = [Hop(off_s=begin + k * half_s, rise_m=height_m) for k in range(2 * count)]
    dips = [(act.start_s - 0.2, 0.0, 0.0)]
    dips += [(hop.off_s - ground_s / 2, 0.08, 5.0) for hop in hops]
    dips += [(hops[-1].land_s + ground_s / 2, 0.07, 5.0), (hops[-1].land_s + ground_s / 2 + 0.3, 0.0, 0.0)]
    hop_all(act, hops, dips, ready_m=-0.045)
    spread, lift = np.zeros_like(time_s), np.zeros_like(time_s)
    for k, hop in enumerate(hops):
        spread += (-1.0) ** k * hop.progress(time_s)
        lift += (-1.0) ** k * rise((time_s - (hop.off_s + hop.land_s) / 2) / half_s + 0.5)
    position, heading, half = act.path.position_m(time_s), act.path.facing_rad(time_s), act.uniform(0.115, 0.145)
    wide = home_feet(act.body, position, heading, 0.056 + half) - home_feet(act.body, position, heading)
    act.controls.foot_m[:] += spread[:, None, None] * wide
    for side in BOTH:
        act.add(spread, side, foot_yaw=OUTWARD[side] * 0.25)
    act.add(spread, knee_out=0.2)
    act.add(lift, abduction=act.uniform(2.55, 2.85), elbow=0.25)
    act.add(1, flexion=act.uniform(0.0, 0.35) + act.uniform(-0.1, 0.3) * lift)


@posture("squat")
def squatting(act: StepContext) -> None:
    """On feet wider than the hips, down until the knees are flexed by about 115 degrees, and up again.

    Depth, stance and pace are near those of the first subject of MARS; the arms move forward for balance.
    """
    rng, body, h = act.rng, act.body, act.height_m
    spans = act.in_turn(1 / act.tempo(0.3, 0.38, 0.6), 1.05, 3.6, fewest=act.fewest)
    wider = act.uniform(0.04, 0.095) * h  # how much farther out each foot stands
    for foot in BOTH:
        act.move_foot(foot, out=wider)
        act.add(1, foot, foot_yaw=OUTWARD[foot] * 0.2)
    down = sum_plateaus(spans, 0, 0.98, 0.45, 0.45)
    knee = np.radians(rng.uniform(120, 136))
    back, lean = act.uniform(0.085, 0.125) * h, act.uniform(0.4, 1.3)
    leg = np.sqrt(body.thigh_m**2 + body.shank_m**2 + 2 * body.thigh_m * body.shank_m * np.cos(knee))
    low = body.ankle_height_m + np.sqrt(leg**2 - back**2) + body.hip_below_pelvis_m * 0.95
    act.pelvis(-(back + 0.022 * h) * down, up=-down * (body.pelvis_height_m(STAND_STRETCH) - low))
    act.add(down, pelvis_pitch=0.42 * lean, spine_pitch=0.3 * lean, head_pitch=-0.45, knee_out=0.3)
    # arms hanging, or raised for balance
    act.add(down, flexion=float(rng.choice([rng.uniform(0.0, 0.5), rng.uniform(1.2, 1.9)])), abduction=-0.1)
