"""Continuity at a seam: a motion starts with the position, velocity and acceleration with which the previous one ended.

The difference at the seam is added to the new motion and fades by a quintic, the minimum-jerk movement (Flash and
Hogan, J. Neurosci. 1985). It is added to the controls, not to the joints, so that bones keep their lengths; the feet
step over one after the other.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import FEET, TURNING, Array, Controls, scaled, whole_turns
from mmweaver.motion.animation.profiles import bump

FADING_S = 0.6
LANDING_S = 0.06  # minimum for a sole that is still in the air
STEP_SHARE = 0.55  # share of that time in which one foot steps over
ROLLED = ("pelvis_rad", "knee_up_rad", "foot_rad")  # angles that wrap around in a forward roll
STEP_HEIGHT_M, SHUFFLE_M = 0.05, 0.1  # of a step over much more than the second


@dataclass(frozen=True, kw_only=True)
class ControlsState:
    """Controls (1, ...) at one instant with their first and second time derivatives."""

    value: Controls
    rate: Controls
    acceleration: Controls

    @classmethod
    def at(cls, controls: Controls, time_s: Float[Array, " n"], at_s: float) -> "ControlsState":
        """The state at one instant, by cubic splines.

        Args:
            controls: Controls at the times `time_s`.
            time_s: Increasing times (n,) in seconds.
            at_s: Instant in seconds, within `time_s`.

        Returns:
            Values, rates and accelerations; angles of a roll are unwrapped first.
        """
        from scipy.interpolate import CubicSpline

        near = np.abs(time_s - at_s) < 0.2
        parts = {field.name: getattr(controls, field.name)[near] for field in fields(Controls)}
        for name in ROLLED:
            parts[name] = np.unwrap(parts[name], axis=0)
        flat = [part.reshape(len(part), -1) for part in parts.values()]
        spline = CubicSpline(time_s[near], np.concatenate(flat, axis=1), axis=0)
        ends = np.cumsum([part.shape[1] for part in flat])[:-1]
        value, rate, acceleration = (
            Controls(
                **{
                    name: values.reshape(1, *part.shape[1:])
                    for (name, part), values in zip(parts.items(), np.split(spline(at_s, order), ends), strict=True)
                }
            )
            for order in range(3)
        )
        return cls(value=value, rate=rate, acceleration=acceleration)


def carried_over(controls: Controls, time_s: Float[Array, " n"], before: ControlsState) -> Controls:
    """Makes a motion begin in a given state.

    Args:
        controls: Controls of the motion at the times `time_s`.
        time_s: Increasing times (n,) in seconds; the seam is at 0.
        before: State at the seam.

    Returns:
        The controls, modified within FADING_S after the seam.
    """
    own = ControlsState.at(controls, time_s, 0.0)
    u = np.clip(time_s / FADING_S, 0.0, 1.0)
    each = np.clip(np.stack([u / STEP_SHARE, (u - 1 + STEP_SHARE) / STEP_SHARE], axis=1), 0.0, 1.0)
    changed: dict[str, Array] = {}
    for field in fields(Controls):
        gaps = [
            getattr(one, field.name) - getattr(other, field.name)
            for one, other in (
                (before.value, own.value),
                (before.rate, own.rate),
                (before.acceleration, own.acceleration),
            )
        ]
        if field.name in ("heading_rad", *ROLLED):
            gaps[0] = np.asarray(gaps[0] - whole_turns(gaps[0]))
        if field.name == "arm_rad":
            gaps[0][..., TURNING] -= whole_turns(gaps[0][..., TURNING])
        values = getattr(controls, field.name)
        shares = _moving_and_left(u, FADING_S)
        shares = (_left(each), *shares[1:]) if field.name in FEET else shares
        offset = sum(scaled(np.broadcast_to(gap, values.shape), share) for share, gap in zip(shares, gaps, strict=True))
        changed[field.name] = values + offset
        if field.name in ("contact", "knee_room"):  # shares: extrapolating their rates would exceed 0 and 1
            known = np.stack([values, np.broadcast_to(getattr(before.value, field.name), values.shape)])
            low, high = np.minimum(known.min(axis=0), 0.0), np.maximum(known.max(axis=0), 1.0)
            changed[field.name] = np.clip(changed[field.name], low, high)
        if field.name == "foot_m":
            changed["foot_m"][..., 2] = _landed(values[..., 2], time_s, [gap[..., 2] for gap in gaps])
            gap_m = np.linalg.norm(gaps[0][0, :, :2], axis=-1)
            changed["foot_m"][..., 2] += bump(each) * STEP_HEIGHT_M * np.tanh((gap_m / SHUFFLE_M) ** 2)
        if field.name == "foot_rad":
            changed["foot_rad"][..., 1] = _landed(values[..., 1], time_s, [gap[..., 1] for gap in gaps])
    return replace(controls, **changed)


def _landed(own: Array, time_s: Float[Array, " n"], gaps: list[Array]) -> Array:
    """Heights or pitches (n, 2) of feet with the residual of a flight, which fades the faster the sooner it would end.

    With the usual fading time, a sole that descends fast would penetrate the floor, and the toes would pass level.
    """
    tried_s, u = np.linspace(FADING_S, LANDING_S, 28)[:, None], np.linspace(0.0, 1.0, 25)
    landed = own.copy()
    for side in range(own.shape[1]):
        gap, rate, acceleration = (float(one[0, side]) for one in gaps)
        left = gap * (1 + 3 * u + 6 * u**2) + rate * tried_s * (u + 3 * u**2) + acceleration * tried_s**2 / 2 * u**2
        stays = (left * (1.0 if gap >= 0 else -1.0) >= -1e-9).all(axis=1)
        lasts_s = float(tried_s[int(np.argmax(stays)) if stays.any() else -1, 0])
        shares = _moving_and_left(time_s / lasts_s, lasts_s)
        landed[:, side] += sum(share * one for share, one in zip(shares, (gap, rate, acceleration), strict=True))
    return landed


def _moving_and_left(u: Float[Array, " n"], lasts_s: float) -> tuple[Array, Array, Array]:
    """What a gap, a rate and an acceleration of 1 at time 0 contribute until `lasts_s`."""
    u = np.clip(u, 0.0, 1.0)
    left = (1 - u) ** 3
    return _left(u), left * (u + 3 * u**2) * lasts_s, left * u**2 / 2 * lasts_s**2


def _left(u: Array) -> Array:
    """1 at 0, 0 from 1 on, smooth to the second derivative at both ends."""
    return np.asarray((1 - u) ** 3 * (1 + 3 * u + 6 * u**2))
