"""Controls: the parameters from which a pose is solved, and their blending.

Activities are blended in these parameters, not in joints: feet stay planted and bones keep their lengths.

Personal movement habits: amplitude, and tempo variation over tens of seconds. The pace is `people.Person`'s.

A person has the same habits in every movement, so twenty seconds of one person resemble each other more than those of
two. Without them, a recogniser trained on generated motions would learn a single tempo.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.seeding import stream
from mmweaver.motion.animation.profiles import bump, plateau

Array = np.ndarray
_SPREAD = 0.06  # of amplitude between people, log-normal
_UNEVEN, _SLOW_HZ = (0.03, 0.14), (0.06, 0.2)  # relative drift of the tempo, and its frequency
_PAUSE_EVERY_S, _PAUSE_S, _SHORTEST_S = (5.0, 25.0), (0.5, 1.1), 4.0
_EDGE_S = 0.6  # at the ends of a step the tempo is even
_RATE_HZ = 60.0


@dataclass(frozen=True, kw_only=True)
class Habits:
    """Habits of one person; the default has none.

    Attributes:
        amplitude: Size of movements relative to the usual one.
        unevenness: Relative variation of the tempo over time.
        drift_hz: Frequency of this variation.
        phase_rad: Its phase at the start of a step.
        pause_every_s: Interval of pauses in a continuous movement.
        pause_s: Duration of a pause.
    """

    amplitude: float = 1.0
    unevenness: float = 0.0
    drift_hz: float = 0.1
    phase_rad: float = 0.0
    pause_every_s: float = np.inf
    pause_s: float = 0.8

    def warped(self, time_s: Float[Array, " n"], start_s: float, end_s: float) -> Float[Array, " n"]:
        """Warps time within a step, so that the tempo drifts and the person pauses now and then.

        Args:
            time_s: Times (n,) in seconds.
            start_s: Start of the step, seconds.
            end_s: End of the step, seconds.

        Returns:
            Times of an even movement reached at `time_s`, C2; identical to `time_s` outside the step, which still
            starts and ends as planned.
        """
        lasts = end_s - start_s
        if lasts < _SHORTEST_S or not (self.unevenness or np.isfinite(self.pause_every_s)):
            return time_s
        fine_s = np.linspace(start_s, end_s, max(int(lasts * _RATE_HZ), 2))
        inside = plateau(fine_s, start_s, end_s, _EDGE_S, _EDGE_S)
        rate = 1 + self.unevenness * inside * np.sin(2 * np.pi * self.drift_hz * (fine_s - start_s) + self.phase_rad)
        pauses_s = np.arange(start_s + 0.6 * self.pause_every_s, end_s - 2 * _EDGE_S, self.pause_every_s)
        for pause_s in pauses_s:
            rate = rate * (1 - 0.9 * bump((fine_s - pause_s) / (2 * self.pause_s)))
        gone_s = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]))]) * (fine_s[1] - fine_s[0])
        # The residual of drift and pauses is compensated away from the ends, where the tempo is fixed.
        share = np.concatenate([[0.0], np.cumsum(0.5 * (inside[1:] + inside[:-1]))]) * (fine_s[1] - fine_s[0])
        gone_s += (lasts - gone_s[-1]) * share / share[-1]
        from scipy.interpolate import CubicSpline

        within = np.clip(time_s, start_s, end_s)
        reached_s = start_s + np.asarray(CubicSpline(fine_s, gone_s, bc_type=((1, 1.0), (1, 1.0)))(within))
        return reached_s + (time_s - within)


NO_HABITS = Habits()


def habits_of(subject: int) -> Habits:
    """Samples the habits of a person, reproducibly.

    Args:
        subject: Number of the person, see `people.person_of`.

    Returns:
        The habits; the same for the same number.
    """
    rng = stream(subject, "motion", "habits")
    amplitude = np.exp(np.clip(rng.normal(0.0, _SPREAD), -2 * _SPREAD, 2 * _SPREAD))
    return Habits(
        amplitude=float(amplitude),
        unevenness=float(rng.uniform(*_UNEVEN)),
        drift_hz=float(rng.uniform(*_SLOW_HZ)),
        phase_rad=float(rng.uniform(0, 2 * np.pi)),
        pause_every_s=float(rng.uniform(*_PAUSE_EVERY_S)),
        pause_s=float(rng.uniform(*_PAUSE_S)),
    )


LEFT, RIGHT = 0, 1
OUTWARD = (1.0, -1.0)  # sign of the body's y that is outward on the left, on the right
FEET = ("foot_m", "foot_rad", "contact", "knee_out_rad")  # fields with a value per foot
TURNING = (0, 2)  # arm angles that wrap around: flexion and twist


@dataclass(frozen=True, kw_only=True)
class Controls:
    """Pose parameters at n times. Floor frame: x right, y away from the radar, z up from the floor; angles in radians.

    The body's own frame has x forward and y to its left. Arms: flexion (forward and up), abduction (outward), twist
    (outward about the upper arm), elbow flexion. Feet: the point of the floor under the ankle of the flat foot, its z
    being the height of the sole, then yaw and pitch (heel up positive).
    """

    pelvis_m: Float[Array, "n 3"]
    heading_rad: Float[Array, " n"]  # from +x towards +y
    pelvis_rad: Float[Array, "n 3"]  # roll (right side down), pitch (forward), yaw (to the left)
    spine_rad: Float[Array, "n 3"]  # roll, pitch, yaw, shared equally by three joints
    head_rad: Float[Array, "n 2"]  # pitch (chin down), yaw
    arm_rad: Float[Array, "n 2 4"]
    foot_m: Float[Array, "n 2 3"]
    foot_rad: Float[Array, "n 2 2"]
    knee_out_rad: Float[Array, "n 2"]  # how far the knees point outward of the feet
    knee_up_rad: Float[Array, " n"]  # where the knees point: 0 ahead, pi/2 up (on the back), -pi/2 down (belly)
    roll_over_rad: Float[Array, " n"]  # about the body's own long axis, to its left, of a lying body
    knee_room: Float[Array, " n"]  # 0: legs may be straight as in standing, 1: knees stay bent as in stepping
    contact: Float[Array, "n 2"]  # 1: the foot carries weight, 0: it is in the air

    def copy(self) -> "Controls":
        """A deep copy."""
        return replace(self, **{field.name: getattr(self, field.name).copy() for field in fields(self)})


# Single angles by name: the array of Controls, and the index within it.
CHANNELS: dict[str, tuple[str, int | None]] = {
    name: (array, index)
    for array, names in {
        "pelvis_rad": "pelvis_roll pelvis_pitch pelvis_yaw",
        "spine_rad": "spine_roll spine_pitch spine_yaw",
        "head_rad": "head_pitch head_yaw",
        "arm_rad": "flexion abduction twist elbow",
        "foot_rad": "foot_yaw foot_pitch",
    }.items()
    for index, name in enumerate(names.split())
}
CHANNELS |= {name.removesuffix("_rad"): (name, None) for name in ("knee_out_rad", "knee_up_rad", "roll_over_rad")}
CHANNELS |= {"heading": ("heading_rad", None), "contact": ("contact", None)}


def blend(parts: list[Controls], weights: list[Float[Array, " n"]], feet: list[Float[Array, "n 2"]]) -> Controls:
    """Weighted sum of Controls over the same times.

    Args:
        parts: Controls to blend.
        weights: Weight of each part (n,); they sum to 1 at each time.
        feet: Weights (n, 2) of the fields that have a value per foot.

    Returns:
        The blended Controls.
    """
    values: dict[str, Array] = {}
    for field in fields(Controls):
        shares = feet if field.name in FEET else weights
        values[field.name] = np.asarray(
            sum(scaled(getattr(part, field.name), share) for part, share in zip(parts, shares, strict=True))
        )
    return Controls(**values)


def scaled(values: Array, share: Array) -> Array:
    """Multiplies values by shares.

    Args:
        values: Values (n, ...).
        share: Shares (n,), or (n, 2) for fields with a value per foot.
    """
    return values * share.reshape(share.shape + (1,) * (values.ndim - share.ndim))


def mix_arm(controls: Controls, side: int, arm: Float[Array, "*n 4"], weight: Float[Array, "..."] | float) -> None:
    """Blends the angles of an arm in place.

    Args:
        controls: Controls whose `arm_rad` is modified.
        side: LEFT or RIGHT.
        arm: Flexion, abduction, twist and elbow flexion in radians, (4,) or (n, 4).
        weight: 0 keeps the angles, 1 replaces them; (n,) or a number.
    """
    controls.arm_rad[:, side] += np.asarray(weight)[..., None] * (arm - controls.arm_rad[:, side])


def whole_turns(gap_rad: Array) -> Array:
    """Nearest multiples of 2 pi.

    Args:
        gap_rad: Differences of angles in radians, any shape.

    Returns:
        Radians, same shape.
    """
    return np.asarray(2 * np.pi * np.round(gap_rad / (2 * np.pi)))


def _remove_whole_turns(before: Controls, part: Controls, at: int) -> None:
    """Removes whole turns from the arm angles of a part: arms that have circled do not unwind afterwards."""
    at = min(at, len(part.heading_rad) - 1)
    for angle in TURNING:
        part.arm_rad[..., angle] -= whole_turns(part.arm_rad[at, :, angle] - before.arm_rad[at, :, angle])


def blended(
    parts: list[Controls], starts_s: list[float], blends_s: list[float], time_s: Float[Array, " n"]
) -> Controls:
    """Concatenates parts; feet whose positions differ step over one after the other.

    Args:
        parts: Controls of each step, all at the times `time_s`.
        starts_s: Time around which each part takes over, seconds.
        blends_s: Duration of each transition, seconds.
        time_s: Increasing times (n,) in seconds.

    Returns:
        Controls at the same times.
    """
    from mmweaver.motion.animation.profiles import bump, rise

    for before, part, start_s in zip(parts, parts[1:], starts_s[1:], strict=False):
        _remove_whole_turns(before, part, int(np.searchsorted(time_s, start_s)))
    ups, foot_ups, lift = [np.ones_like(time_s)], [np.ones((len(time_s), 2))], np.zeros((len(time_s), 2))
    for k in range(1, len(parts)):
        u = (time_s - starts_s[k]) / blends_s[k] + 0.5
        each = np.stack([u / 0.6, (u - 0.4) / 0.6], axis=1)
        gap = np.linalg.norm(parts[k].foot_m[..., :2] - parts[k - 1].foot_m[..., :2], axis=-1)
        lift += bump(each) * 0.05 * np.tanh(gap**2 / 0.01)
        ups.append(rise(u))
        foot_ups.append(rise(each))
    ups.append(np.zeros_like(time_s))
    foot_ups.append(np.zeros((len(time_s), 2)))
    # Part k has the weight of blend k, as far as blend k + 1 has not taken over.
    weights = [ups[k] * (1 - ups[k + 1]) for k in range(len(parts))]
    foot_weights = [foot_ups[k] * (1 - foot_ups[k + 1]) for k in range(len(parts))]
    total, foot_total = np.sum(weights, axis=0), np.sum(foot_weights, axis=0)
    result = blend(parts, [w / total for w in weights], [w / foot_total for w in foot_weights])
    result.foot_m[..., 2] += lift
    return result
