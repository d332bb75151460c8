"""Smooth functions of time: at least C1, so that velocities are continuous, most of them C2. Shapes are preserved.

Repetitions as spans of time, and smooth keyframes within them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.safe_files.safe_text import read_toml

Values = Float[np.ndarray, "..."]


def rise(u: Values) -> Values:
    """Smooth step: 0 for u <= 0, 1 for u >= 1, a quintic in between; C2.

    Args:
        u: Progress, any shape.

    >>> rise(np.array([-1.0, 0.5, 2.0])).tolist()
    [0.0, 0.5, 1.0]
    """
    u = np.clip(u, 0.0, 1.0)
    square = u * u  # much cheaper than powers, and called per limb
    return np.asarray(square * u * (10 - 15 * u + 6 * square))


def rise_integral(u: Values) -> Values:
    """Integral of `rise` from 0 to u: 0 below 0, u - 1/2 above 1; C3.

    Args:
        u: Progress, any shape.
    """
    inside = np.clip(u, 0.0, 1.0)
    square = inside * inside
    return np.asarray(square * square * (2.5 - 3 * inside + square) + np.maximum(u - 1.0, 0.0))


def bump(u: Values) -> Values:
    """Smooth pulse: 0 outside (0, 1), 1 at 1/2; C2.

    Args:
        u: Progress, any shape.
    """
    u = np.clip(u, 0.0, 1.0)
    high = u * (1 - u)
    return np.asarray(64 * (high * high * high))


def wide_bump(u: Values) -> Values:
    """Smooth pulse: 0 outside (0, 1), 1 at 1/2, wider than `bump`; C1.

    Args:
        u: Progress, any shape.
    """
    u = np.clip(u, 0.0, 1.0)
    return np.asarray(16 * (u * (1 - u)) ** 2)


def raised_cosine(phase_rad: Values) -> Values:
    """Raised cosine: 0 at phase 0, 1 at pi, 0 at 2 pi.

    Args:
        phase_rad: Phase in radians, any shape.
    """
    return np.asarray(0.5 - 0.5 * np.cos(phase_rad))


def plateau(time_s: Values, start_s: float, end_s: float, up_s: float, down_s: float) -> Values:
    """Smooth window: 0 before the start, 1 in between, 0 after the end; C2.

    Args:
        time_s: Times in seconds, any shape.
        start_s: Time at which the rise begins.
        end_s: Time at which the fall ends.
        up_s: Duration of the rise.
        down_s: Duration of the fall.
    """
    return np.asarray(rise((time_s - start_s) / up_s) * rise((end_s - time_s) / down_s))


def travel(u: Values, ramp_in: float, ramp_out: float) -> Values:
    """Progress from 0 to 1 at constant speed, with ramps of the speed; C3.

    Without a ramp the progress continues at its speed outside [0, 1] (the motion was under way, or goes on).

    Args:
        u: Share of the time, any shape.
        ramp_in: Length of the first ramp as a share of the time; 0 for none.
        ramp_out: Length of the last ramp.

    Returns:
        Share of the distance.
    """
    total = 1 - ramp_in / 2 - ramp_out / 2
    start = ramp_in * rise_integral(np.asarray(u / ramp_in)) if ramp_in > 0 else u
    if ramp_out > 0:
        start = start - ramp_out * rise_integral(np.asarray((u - 1 + ramp_out) / ramp_out))
    return np.asarray(start / total)


def cap(x: Values, limit: Values | float, width: Values | float) -> Values:
    """Smooth upper limit: x below limit - width, never above limit; C3.

    Args:
        x: Values, any shape.
        limit: Upper limit.
        width: Width of the transition.
    """
    return x - 2 * width * rise_integral(np.asarray((x - limit + width) / (2 * width)))


def reached(x: Values, limit: float = 1.0) -> Values:
    """x up to 0.7 of the limit, then smoothly up to the limit and no farther; C3.

    Args:
        x: Values, any shape.
        limit: Upper limit.
    """
    return cap(x, limit, 0.3 * limit)


def larger(x: Values, least: Values | float, width: Values | float) -> Values:
    """Smooth maximum of x and `least`, above both.

    Args:
        x: Values, any shape.
        least: Lower limit.
        width: Width of the transition.
    """
    return np.asarray(0.5 * (x + least + np.sqrt((x - least) ** 2 + width**2)))


def softmin(values: Sequence[Values], width: Values | float) -> Values:
    """Smooth minimum of several functions, at most width * ln(count) below the exact one.

    Args:
        values: Functions of the same shape.
        width: Width of the transition.
    """
    stack = np.stack(values)
    low = stack.min(axis=0)
    return low - width * np.log(np.exp(-(stack - low) / width).sum(axis=0))


def through(time_s: Values, knots: Sequence[tuple[float, float, float, float]]) -> Values:
    """Quintic spline through knots; constant outside, C2 if at rest there.

    Args:
        time_s: Times in seconds, any shape.
        knots: Time, value, velocity and acceleration of each knot, in increasing order of time.
    """
    from scipy.interpolate import BPoly

    times = [knot[0] for knot in knots]
    curve = BPoly.from_derivatives(times, [list(knot[1:]) for knot in knots])
    return np.asarray(curve(np.clip(time_s, times[0], times[-1])))


def wander(time_s: Values, rng: np.random.Generator, *, slow_hz: float, fast_hz: float, count: int = 4) -> Values:
    """Smooth random function of unit standard deviation: `count` sines between two frequencies.

    Args:
        time_s: Times in seconds, any shape.
        rng: Random stream of frequencies and phases.
        slow_hz: Lowest frequency in Hz.
        fast_hz: Highest frequency in Hz.
        count: Number of sines.
    """
    frequency_hz = np.exp(rng.uniform(np.log(slow_hz), np.log(fast_hz), count))
    phase = rng.uniform(0, 2 * np.pi, count)
    waves = np.sin(2 * np.pi * np.multiply.outer(time_s, frequency_hz) + phase)
    return waves.sum(axis=-1) * np.sqrt(2 / count)


PerTime = Float[np.ndarray, " n"]
Number = float | int
Curve = Float[np.ndarray, "..."] | Number  # a function of time, or the same value at all times
MOVEMENTS: dict[str, dict[str, Any]] = read_toml(Path(__file__).with_name("library") / "movements.toml")


def spline_through(time_s: PerTime, times: Sequence[Number], values: Sequence[Number]) -> PerTime:
    """Quintic spline through keyframes, at rest at both ends and constant beyond; C2.

    Args:
        time_s: Times (n,) in seconds.
        times: Times of the keyframes, increasing.
        values: Values of the keyframes.
    """
    from scipy.interpolate import make_interp_spline

    rest = [(1, 0.0), (2, 0.0)]
    curve = make_interp_spline(np.asarray(times), np.asarray(values, dtype=float), k=5, bc_type=(rest, rest))
    return np.asarray(curve(np.clip(time_s, times[0], times[-1])))


@dataclass(frozen=True)
class Span:
    """One repetition of a movement; its methods take shares of its duration."""

    time_s: PerTime
    begin_s: float
    lasts_s: float

    def at(self, share: Number) -> float:
        """Time in seconds at a share of the duration."""
        return self.begin_s + share * self.lasts_s

    def plateau(self, begin: Number, end: Number, up: Number, down: Number) -> PerTime:
        """`profiles.plateau` at shares of the duration.

        Args:
            begin: Start.
            end: End.
            up: Duration of the rise.
            down: Duration of the fall.
        """
        return plateau(self.time_s, self.at(begin), self.at(end), up * self.lasts_s, down * self.lasts_s)

    def progress(self) -> PerTime:
        """Share of the duration that has passed (n,), not limited to 0 to 1."""
        return (self.time_s - self.begin_s) / self.lasts_s

    def keys(self, shares: Sequence[Number], values: Sequence[Number]) -> PerTime:
        """`spline_through` keyframes at shares of the duration.

        Args:
            shares: Shares of the keyframes, increasing.
            values: Values of the keyframes.
        """
        return spline_through(self.time_s, [self.at(share) for share in shares], values)

    def rows(self, movement: str, *names: str) -> list[PerTime]:
        """Keyframes of a movement in `movements.toml`, smoothly interpolated.

        Args:
            movement: Name of the movement.
            *names: Rows of its table.

        Returns:
            One curve (n,) per row.
        """
        record = MOVEMENTS[movement]
        return [self.keys(record["at"], record[name]) for name in names]


def sum_plateaus(spans: list[Span], begin: Number, end: Number, up: Number, down: Number) -> PerTime:
    """Sum over repetitions of the same plateau, (n,).

    Args:
        spans: Repetitions.
        begin: Start as a share of each repetition.
        end: End as a share.
        up: Duration of the rise as a share.
        down: Duration of the fall as a share.
    """
    return np.sum([span.plateau(begin, end, up, down) for span in spans], axis=0)
