"""Measures of a micro-Doppler spectrogram: cadence, torso, spread, limbs, symmetry."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Joints, PerDoppler, PerFrame
from mmweaver.core.skeleton import joint

Array = np.ndarray
Figures = dict[str, float]
Power = Float[Array, "frame doppler"]

LIMB_MPS = 0.4  # what differs so much from the pelvis is a limb
STEP_S = {"walking": (0.4, 0.85), "running": (0.25, 0.55)}  # lags at which a step is looked for
PROFILE_MPS = np.arange(-8.0, 8.01, 0.1)
DEFINITIONS: dict[str, tuple[str, str]] = {
    "cadence_hz": (
        "steps/s",
        "strongest autocorrelation of the envelope's width; steps of 0.4 to 0.85 s, running 0.25 to 0.55 s",
    ),
    "cadence_ratio": ("", "that cadence over the true one of the ankles: what the measure is worth"),
    "rhythm": ("", "that autocorrelation, 1 = strictly periodic"),
    "step_difference": ("", "median peak of the upper envelope in odd and in even steps: difference over mean"),
    "torso_ratio": ("", "velocity that halves a frame's energy, median over frames, over the pelvis's true one"),
    "torso_surge_mps": ("m/s", "that velocity's 5 to 95 % width over time: the torso slows down and speeds up"),
    "spread_mps": ("m/s", "width that holds 5 to 95 % of the energy, about the pelvis's velocity"),
    "upper_mps": ("m/s", "99 % of a frame's energy is slower than this, about the pelvis; 95th percentile over time"),
    "lower_mps": ("m/s", "1 % of a frame's energy is slower than this, about the pelvis; 5th percentile over time"),
    "limb_share": ("", "energy that differs by more than 0.4 m/s from the pelvis"),
    "ahead_share": ("", "energy that is faster than the pelvis by more than 0.4 m/s, of all limb energy"),
    "away_towards_overlap": ("", "common part of the energy profiles towards and away, 1 = the same"),
    "away_minus_towards": ("", "limb share away from the radar less that towards it"),
    "pelvis_surge_mps": ("m/s", "of the joints, not the radar: 5 to 95 % width of the pelvis's speed along the path"),
    "knee_ahead_mps": ("m/s", "of the joints, not the radar: knees ahead about the pelvis, 95th percentile over time"),
    "ankle_ahead_mps": (
        "m/s",
        "of the joints, not the radar: ankles ahead about the pelvis, 95th percentile over time",
    ),
    "elbow_ahead_mps": (
        "m/s",
        "of the joints, not the radar: elbows ahead about the pelvis, 95th percentile over time",
    ),
    "wrist_ahead_mps": (
        "m/s",
        "of the joints, not the radar: wrists ahead about the pelvis, 95th percentile over time",
    ),
}


@dataclass(frozen=True, kw_only=True)
class Spectrogram:
    """Share of each frame's energy at each velocity (rising, ahead positive), and the true velocity of the pelvis."""

    time_s: PerFrame
    velocity_mps: PerDoppler
    share: Power
    pelvis_mps: PerFrame

    def about_pelvis(self) -> Float[Array, "frame velocity"]:
        """Shares on PROFILE_MPS relative to the velocity of the pelvis; each frame sums to one."""
        rows = [
            np.interp(PROFILE_MPS + at, self.velocity_mps, share, left=0.0, right=0.0)
            for at, share in zip(self.pelvis_mps, self.share, strict=True)
        ]
        result = np.stack(rows)
        return result / np.maximum(result.sum(axis=1, keepdims=True), np.finfo(float).tiny)


def quantiles(share: Float[Array, "frame velocity"], velocity_mps: Array, part: float) -> PerFrame:
    """The velocity below which that share of the energy of each frame lies."""
    total = np.cumsum(share, axis=1)
    return np.array([np.interp(part * row[-1], row, velocity_mps) for row in total])


def spread_figures(seen: Spectrogram) -> Figures:
    """Figures that need no periodicity."""
    shares = seen.about_pelvis()
    profile = shares.mean(axis=0)
    low, high = (float(quantiles(profile[None], PROFILE_MPS, part)[0]) for part in (0.05, 0.95))
    ahead, behind = (float(profile[sign * PROFILE_MPS > LIMB_MPS].sum()) for sign in (1, -1))
    return {
        "spread_mps": high - low,
        "upper_mps": float(np.percentile(quantiles(shares, PROFILE_MPS, 0.99), 95)),
        "lower_mps": float(np.percentile(quantiles(shares, PROFILE_MPS, 0.01), 5)),
        "limb_share": ahead + behind,
        "ahead_share": ahead / max(ahead + behind, 1e-12),
    }


def gait_figures(seen: Spectrogram, lags_s: tuple[float, float]) -> Figures:
    """Those of `spread_figures`, and those of steps, whose duration is within `lags_s`."""
    shares = seen.about_pelvis()
    lower, upper = (quantiles(shares, PROFILE_MPS, part) for part in (0.01, 0.99))
    period_s = float(seen.time_s[1] - seen.time_s[0])
    lag_s, rhythm = step_lag(upper - lower, period_s, lags_s)
    middle = quantiles(seen.share, seen.velocity_mps, 0.5)
    return {
        "cadence_hz": 1 / lag_s,
        "rhythm": rhythm,
        "step_difference": step_difference(upper, lag_s / period_s),
        "torso_ratio": float(np.median(middle) / np.median(seen.pelvis_mps)),
        "torso_surge_mps": float(np.percentile(middle, 95) - np.percentile(middle, 5)),
        **spread_figures(seen),
    }


def step_lag(envelope: PerFrame, period_s: float, lags_s: tuple[float, float]) -> tuple[float, float]:
    """Lag in seconds of the strongest autocorrelation within `lags_s`, and that autocorrelation.

    Each lag is normalised by the overlapping parts, so that short clips are not biased towards short lags.
    """
    time = np.arange(len(envelope))
    left = envelope - np.polyval(np.polyfit(time, envelope, 1), time)
    last = min(int(lags_s[1] / period_s), len(left) * 2 // 3)
    lags = np.arange(max(int(lags_s[0] / period_s), 1), last + 1)
    similarity = np.array([_correlation(left[lag:], left[:-lag]) for lag in lags])
    best = int(similarity.argmax())
    shift = 0.0
    if 0 < best < len(lags) - 1:  # the top of a parabola through three lags
        before, at, after = similarity[best - 1 : best + 2]
        shift = 0.5 * (before - after) / min(before - 2 * at + after, -1e-12)
    return float((lags[best] + shift) * period_s), float(similarity[best])


def _correlation(one: Array, other: Array) -> float:
    norm = float(np.sqrt((one**2).sum() * (other**2).sum()))
    return float(one @ other) / norm if norm > 0 else 0.0


def step_difference(envelope: PerFrame, lag: float) -> float:
    """Peaks of successive steps, of `lag` frames each: |odd - even| over their mean; 0 = equal."""
    first = int(np.argmax(envelope[: max(int(2 * lag), 1)]) - lag / 2)
    starts = np.arange(first % lag, len(envelope) - lag + 1, lag)
    peaks = [float(envelope[int(start) : int(start + lag)].max()) for start in starts]
    if len(peaks) < 2:
        return 0.0
    odd, even = float(np.median(peaks[::2])), float(np.median(peaks[1::2]))
    return abs(odd - even) / max(0.5 * abs(odd + even), 1e-12)


def kinematic_figures(joints_m: Joints, rate_hz: float) -> Figures:
    """Speeds of limbs ahead of the pelvis along the path."""
    pelvis = joints_m[:, 0, :2]
    direction = (pelvis[-1] - pelvis[0]) / np.linalg.norm(pelvis[-1] - pelvis[0])
    low, high = np.percentile(np.gradient(pelvis @ direction, 1 / rate_hz), (5, 95))
    found = {"pelvis_surge_mps": float(high - low)}
    for part in ("knee", "ankle", "elbow", "wrist"):
        limbs = joints_m[:, [joint(f"left_{part}"), joint(f"right_{part}")], :2] - pelvis[:, None]
        found[f"{part}_ahead_mps"] = float(np.percentile(np.gradient(limbs @ direction, 1 / rate_hz, axis=0), 95))
    return found


def both_ways(towards: Spectrogram, away: Spectrogram, of_one: Callable[[Spectrogram], Figures]) -> Figures:
    """The mean of both directions, and how similar they are."""
    there, back = of_one(towards), of_one(away)
    profiles = [seen.about_pelvis().mean(axis=0) for seen in (towards, away)]
    return {
        **{name: 0.5 * (there[name] + back[name]) for name in there},
        "away_towards_overlap": float(np.minimum(*profiles).sum()),
        "away_minus_towards": back["limb_share"] - there["limb_share"],
    }
