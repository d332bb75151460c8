"""Smooth functions of time: all at least C1, so that no velocity jumps, most of them C2. Shapes are kept."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

Values = Float[np.ndarray, "..."]


def rise(u: Values) -> Values:
    """Smooth step: 0 for u <= 0, 1 for u >= 1, a quintic between; C2.

    >>> rise(np.array([-1.0, 0.5, 2.0])).tolist()
    [0.0, 0.5, 1.0]
    """
    u = np.clip(u, 0.0, 1.0)
    square = u * u  # much cheaper than powers, and called for every limb
    return np.asarray(square * u * (10 - 15 * u + 6 * square))


def rise_integral(u: Values) -> Values:
    """Integral of `rise` from 0 to u: 0 below 0, u - 1/2 above 1; C3."""
    inside = np.clip(u, 0.0, 1.0)
    square = inside * inside
    return np.asarray(square * square * (2.5 - 3 * inside + square) + np.maximum(u - 1.0, 0.0))


def bump(u: Values) -> Values:
    """0 outside (0, 1), 1 at 1/2; C2."""
    u = np.clip(u, 0.0, 1.0)
    high = u * (1 - u)
    return np.asarray(64 * (high * high * high))


def wide_bump(u: Values) -> Values:
    """0 outside (0, 1), 1 at 1/2, wider than `bump`; C1."""
    u = np.clip(u, 0.0, 1.0)
    return np.asarray(16 * (u * (1 - u)) ** 2)


def raised_cosine(phase_rad: Values) -> Values:
    """0 at phase 0, 1 at pi, 0 at 2 pi, and so on."""
    return np.asarray(0.5 - 0.5 * np.cos(phase_rad))


def plateau(time_s: Values, start_s: float, end_s: float, up_s: float, down_s: float) -> Values:
    """0 before start, up to 1 within `up_s`, down to 0 within `down_s` before the end; C2."""
    return np.asarray(rise((time_s - start_s) / up_s) * rise((end_s - time_s) / down_s))


def travel(u: Values, ramp_in: float, ramp_out: float) -> Values:
    """Progress 0 to 1 over u in [0, 1] at constant speed, with speed ramps of these lengths; C3.

    Without a ramp the progress continues at its speed outside [0, 1] (the motion was under way, or goes on).
    """
    total = 1 - ramp_in / 2 - ramp_out / 2
    start = ramp_in * rise_integral(np.asarray(u / ramp_in)) if ramp_in > 0 else u
    if ramp_out > 0:
        start = start - ramp_out * rise_integral(np.asarray((u - 1 + ramp_out) / ramp_out))
    return np.asarray(start / total)


def cap(x: Values, limit: Values | float, width: Values | float) -> Values:
    """x where it is below limit - width, never above limit, smooth between; C3."""
    return x - 2 * width * rise_integral(np.asarray((x - limit + width) / (2 * width)))


def reached(x: Values, limit: float = 1.0) -> Values:
    """x up to 0.7 of the limit, then smoothly up to the limit and no farther; C3."""
    return cap(x, limit, 0.3 * limit)


def larger(x: Values, least: Values | float, width: Values | float) -> Values:
    """About the larger of x and `least`, smooth within about `width` of where they meet; above both."""
    return np.asarray(0.5 * (x + least + np.sqrt((x - least) ** 2 + width**2)))


def softmin(values: Sequence[Values], width: Values | float) -> Values:
    """A smooth minimum of several functions, at most width * ln(count) below the exact one."""
    stack = np.stack(values)
    low = stack.min(axis=0)
    return low - width * np.log(np.exp(-(stack - low) / width).sum(axis=0))


def through(time_s: Values, knots: Sequence[tuple[float, float, float, float]]) -> Values:
    """Quintic spline through knots of (time, value, velocity, acceleration); constant outside, C2 if at rest there."""
    from scipy.interpolate import BPoly

    times = [knot[0] for knot in knots]
    curve = BPoly.from_derivatives(times, [list(knot[1:]) for knot in knots])
    return np.asarray(curve(np.clip(time_s, times[0], times[-1])))


def wander(time_s: Values, rng: np.random.Generator, *, slow_hz: float, fast_hz: float, count: int = 4) -> Values:
    """A smooth random function of unit standard deviation: `count` sines between two frequencies."""
    frequency_hz = np.exp(rng.uniform(np.log(slow_hz), np.log(fast_hz), count))
    phase = rng.uniform(0, 2 * np.pi, count)
    waves = np.sin(2 * np.pi * np.multiply.outer(time_s, frequency_hz) + phase)
    return waves.sum(axis=-1) * np.sqrt(2 / count)
