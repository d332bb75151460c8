"""Makes a motion begin exactly as the one before it left off: place, velocity and acceleration of every control.

The difference at the seam is added to the new motion and fades by a quintic, the movement of least jerk (Flash and
Hogan, J. Neurosci. 1985). It is added to the controls, not to the joints, so that bones keep their lengths; feet step
over one after the other.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import TURNING, Array, Controls, whole_turns
from mmweaver.motion.animation.profiles import bump

FADING_S = 0.6
STEP_SHARE = 0.55  # of that time, in which one foot steps over
STEP_HEIGHT_M, SHUFFLE_M = 0.05, 0.1  # of a step over much more than the second


@dataclass(frozen=True, kw_only=True)
class ControlsState:
    """Controls (1, ...) at one instant, their rates a second and the rates of these."""

    value: Controls
    rate: Controls
    acceleration: Controls

    @classmethod
    def at(cls, controls: Controls, time_s: Float[Array, " n"], at_s: float) -> "ControlsState":
        """Of controls at times (n,), at a time within them."""
        from scipy.interpolate import CubicSpline

        near = np.abs(time_s - at_s) < 0.2
        parts = {field.name: getattr(controls, field.name)[near] for field in fields(Controls)}
        flat = [part.reshape(len(part), -1) for part in parts.values()]
        spline = CubicSpline(time_s[near], np.concatenate(flat, axis=1), axis=0)
        ends = np.cumsum([part.shape[1] for part in flat])[:-1]
        value, rate, acceleration = (
            Controls(**{
                name: values.reshape(1, *part.shape[1:])
                for (name, part), values in zip(parts.items(), np.split(spline(at_s, order), ends), strict=True)
            })
            for order in range(3)
        )  # fmt: skip
        return cls(value=value, rate=rate, acceleration=acceleration)


def carried_over(controls: Controls, time_s: Float[Array, " n"], before: ControlsState) -> Controls:
    """The controls, changed within FADING_S from time 0 such that they begin in the state `before`."""
    own = ControlsState.at(controls, time_s, 0.0)
    u = np.clip(time_s / FADING_S, 0.0, 1.0)
    each = np.clip(np.stack([u / STEP_SHARE, (u - 1 + STEP_SHARE) / STEP_SHARE], axis=1), 0.0, 1.0)
    changed: dict[str, Array] = {}
    for field in fields(Controls):
        gaps = [
            getattr(one, field.name) - getattr(other, field.name)
            for one, other in (
                (before.value, own.value), (before.rate, own.rate), (before.acceleration, own.acceleration),
            )
        ]  # fmt: skip
        if field.name in ("heading_rad", "foot_rad"):
            gaps[0] = _smallest_turn(gaps[0], is_yaw_first=field.name == "foot_rad")
        if field.name == "arm_rad":
            gaps[0][..., TURNING] -= whole_turns(gaps[0][..., TURNING])
        values = getattr(controls, field.name)
        of_feet = field.name in ("foot_m", "foot_rad", "contact", "knee_out_rad")
        shares = (_left(each if of_feet else u), *_moving(u))
        offset = sum(_over(share, values.ndim) * gap for share, gap in zip(shares, gaps, strict=True))
        changed[field.name] = values + offset
        if field.name == "foot_m":
            gap_m = np.linalg.norm(gaps[0][0, :, :2], axis=-1)
            changed["foot_m"][..., 2] += bump(each) * STEP_HEIGHT_M * np.tanh((gap_m / SHUFFLE_M) ** 2)
    return replace(controls, **changed)


def _left(u: Array) -> Array:
    """1 at 0, 0 from 1 on, smooth to the second derivative at both ends."""
    return np.asarray((1 - u) ** 3 * (1 + 3 * u + 6 * u**2))


def _moving(u: Float[Array, " n"]) -> tuple[Array, Array]:
    """What a rate and an acceleration of one at 0 leave, without any at 1."""
    left = (1 - u) ** 3
    return left * (u + 3 * u**2) * FADING_S, left * u**2 / 2 * FADING_S**2


def _over(share: Array, ndim: int) -> Array:
    return share.reshape(share.shape + (1,) * (ndim - share.ndim))


def _smallest_turn(gap_rad: Array, *, is_yaw_first: bool) -> Array:
    """Differences of headings without whole turns; of a foot only its yaw is a heading."""
    rest = gap_rad - whole_turns(gap_rad)
    if not is_yaw_first:
        return np.asarray(rest)
    return np.stack([rest[..., 0], gap_rad[..., 1]], axis=-1)
