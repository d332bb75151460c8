"""Building blocks of the library: moving pelvis, foot or hand, repetition, smooth keyframes."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.arm_reach import reach
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.standing import STAND_STRETCH
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]
OUTWARD = (1.0, -1.0)  # the sign of the body's y for what is outward on the left, on the right


def spline_through(time_s: PerTime, times: Sequence[float], values: Sequence[float]) -> PerTime:
    """A quintic spline (n,) through keyframes (times, values), at rest at both ends and constant beyond; C2."""
    from scipy.interpolate import make_interp_spline

    rest = [(1, 0.0), (2, 0.0)]
    curve = make_interp_spline(np.asarray(times), np.asarray(values, dtype=float), k=5, bc_type=(rest, rest))
    return np.asarray(curve(np.clip(time_s, times[0], times[-1])))


def sides(context: StepContext) -> tuple[int, ...]:
    """The arms that move: as the sentence says, else five times out of six the one that the person usually uses."""
    usual = context.step.usual_hand or "right"
    chosen = context.step.hand or (usual if context.rng.random() < 5 / 6 else {"right": "left"}.get(usual, "right"))
    return {"left": (LEFT,), "right": (RIGHT,), "both": (LEFT, RIGHT)}[chosen]


def one_side(context: StepContext) -> int:
    """The one arm that moves; of both, the right."""
    return sides(context)[-1]


def leg_side(context: StepContext) -> int:
    """The leg that moves: as the sentence says, else by the seed, the right one five times out of six."""
    chosen = context.step.foot or ("right" if context.rng.random() < 5 / 6 else "left")
    return LEFT if chosen == "left" else RIGHT


def repeats(context: StepContext, natural_s: float, least_s: float, most_s: float) -> list[tuple[float, float]]:
    """(start, duration) in seconds of each repetition: as many as the sentence asks for, else one.

    Several without a number are two, or more where the time allows it.
    """
    of_the_body = context.step.several and not context.step.upper
    several = max(2, int(context.duration_s / natural_s)) if of_the_body else 1
    count = context.step.count or several
    slower = (1.35, 1.0, 0.8)[context.step.speed + 1]
    wanted = natural_s / context.step.pace * slower * float(np.exp(context.rng.normal(0, 0.07)))
    each = float(np.clip(min(wanted, context.duration_s / count), least_s, most_s))
    spare = 0.0 if count > 1 else max(context.duration_s - each, 0.0)
    begin = context.start_s + min(0.1, 0.3 * spare)
    return [(begin + k * each, each) for k in range(count)]


def cycles(context: StepContext, rate_hz: float, low_hz: float, high_hz: float) -> tuple[float, float]:
    """Rate in Hz and end in seconds of a periodic movement; a count in the sentence fixes the rate within limits."""
    if not context.step.count:
        return rate_hz, context.end_s
    rate = float(np.clip(context.step.count / max(context.duration_s - 0.2, 0.1), low_hz, high_hz))
    return rate, context.start_s + context.step.count / rate


def vary(context: StepContext, value: float, spread: float = 0.12) -> float:
    """A size with log-normal variation, clipped at twice the spread, and with the person's habit."""
    return (
        value
        * context.habits.amplitude
        * float(np.exp(np.clip(context.rng.normal(0, spread), -2 * spread, 2 * spread)))
    )


def shift_pelvis(controls: Controls, ahead: PerTime | float, left: PerTime | float, up: PerTime | float) -> None:
    """Moves the pelvis ahead, to the body's left, and up; metres, (n,) or constant."""
    cos, sin = np.cos(controls.heading_rad), np.sin(controls.heading_rad)
    controls.pelvis_m[:, 0] += ahead * cos - left * sin
    controls.pelvis_m[:, 1] += ahead * sin + left * cos
    controls.pelvis_m[:, 2] += up


def shift_foot(
    controls: Controls, side: int, ahead: PerTime | float, out: PerTime | float, up: PerTime | float
) -> None:
    """Moves a foot ahead, outward and up; metres, (n,) or constant."""
    cos, sin = np.cos(controls.heading_rad), np.sin(controls.heading_rad)
    left = OUTWARD[side] * out
    controls.foot_m[:, side, 0] += ahead * cos - left * sin
    controls.foot_m[:, side, 1] += ahead * sin + left * cos
    controls.foot_m[:, side, 2] += up


def lift_weight(controls: Controls, side: int, air: PerTime) -> None:
    """Takes the weight off a foot as `air` (n,) goes to 1; both knees bend slightly."""
    controls.contact[:, side] -= air
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.8 * air)


def lean_over(controls: Controls, body: SkeletonProportions, side: int, share: PerTime) -> None:
    """Shifts the body over one foot as `share` (n,) goes to 1; the trunk stays upright."""
    left = OUTWARD[side] * 0.043 * body.height_m * share
    shift_pelvis(controls, 0.0, left, 0.0)
    controls.spine_rad[:, 0] += -OUTWARD[side] * 0.05 * share


def mix_arm(controls: Controls, side: int, arm: Float[Array, "n 4"], weight: PerTime) -> None:
    """Blends an arm's angles to `arm` (n, 4) as `weight` (n,) goes to 1."""
    controls.arm_rad[:, side] += weight[:, None] * (arm - controls.arm_rad[:, side])


def hand_to(
    controls: Controls, body: SkeletonProportions, side: int, target: Float[Array, "n 3"], weight: PerTime,
    elbow: tuple[float, float, float] = (-0.3, 0.5, -1.0),
) -> None:  # fmt: skip
    """Brings a wrist to a target (n, 3): ahead, outward and up of spine3 in the chest's frame, in body heights."""
    mix_arm(controls, side, reach(body, target * body.height_m, elbow=elbow), weight)


def place(ahead: PerTime | float, out: PerTime | float, up: PerTime | float, n: int) -> Float[Array, "n 3"]:
    """A target (n, 3) for `hand_to` from three curves (n,) or constants."""
    return np.stack([np.broadcast_to(np.asarray(part, dtype=float), (n,)) for part in (ahead, out, up)], axis=1)


def crouched(controls: Controls, body: SkeletonProportions, depth: PerTime, *, lean_rad: float) -> None:
    """Lowers the body by a share (n,) of the deepest squat: hips back, trunk forward, knees over the feet."""
    knee = np.radians(118.0)
    leg = np.sqrt(body.thigh_m**2 + body.shank_m**2 + 2 * body.thigh_m * body.shank_m * np.cos(knee))
    back = 0.12 * body.height_m
    low = body.ankle_height_m + np.sqrt(leg**2 - back**2) + 0.95 * body.hip_below_pelvis_m
    shift_pelvis(controls, -back * depth, 0.0, -depth * (body.pelvis_height_m(STAND_STRETCH) - low))
    controls.pelvis_rad[:, 1] += 0.6 * lean_rad * depth
    controls.spine_rad[:, 1] += 0.7 * lean_rad * depth
    controls.head_rad[:, 0] -= 0.5 * lean_rad * depth
    controls.knee_out_rad[:] += (0.2 * depth)[:, None]
