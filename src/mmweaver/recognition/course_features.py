"""The course of a motion by its energy: where its brisk points are from its beginning to its end, and how fast.

`timeline_features` counts points, most of which are those of a body that hardly moves; here each weighs as its speed
cubed, so that a rest before or after a motion changes nothing.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.recognition.body_features import Row
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.timeline_features import FEWEST, of_the_body

SEGMENTS = 6
ENDS = (0.04, 0.96)  # quantiles of energy over time: when the motion begins and ends
LEAST_SHARE = 1e-3  # of the energy, in a segment that is known
CURVES = ("share", "velocity", "up", "out", "aside", "spread")


def course_features(window: PointRecording) -> Row:
    """Named features of one window; nan means too few points. Places count from the body's own median."""
    cloud = of_the_body(window.cloud)
    velocity = cloud.radial_velocity_mps
    if len(velocity) < FEWEST:
        curves = [f"course_{name}_{index}" for name in CURVES for index in range(SEGMENTS)]
        return dict.fromkeys([*curves, "course_lasts", "course_fastest_away", "course_fastest_near",
                              "course_peak_share", "course_away_share"], np.nan)  # fmt: skip
    energy = np.abs(velocity) ** 3
    middle_s = (cloud.frame + 0.5) / window.frame_rate_hz
    begin_s, end_s = _weighted_quantiles(middle_s, energy, ENDS) + np.array([-0.5, 0.5]) / window.frame_rate_hz
    place = (middle_s - begin_s) / (end_s - begin_s) * SEGMENTS
    # segments overlap by half, as a brisk motion has fewer frames than segments
    weight = np.clip(1 - np.abs(place - (np.arange(SEGMENTS) + 0.5)[:, None]), 0, None) * energy
    total = weight.sum(axis=1)

    def mean(values: np.ndarray) -> np.ndarray:
        """Of each segment (segment,)."""
        known = total > LEAST_SHARE * energy.sum()
        return np.where(known, weight @ values / np.maximum(total, 1e-12), np.nan)

    aside = cloud.x_m - np.median(cloud.x_m)
    range_m = cloud.range_m
    found = {
        "share": total / max(float(total.sum()), 1e-12), "velocity": mean(velocity),
        "up": mean(cloud.z_m - np.median(cloud.z_m)), "out": mean(range_m - np.median(range_m)), "aside": mean(aside),
        "spread": np.sqrt(np.maximum(mean(aside**2) - mean(aside) ** 2, 0)),
    }  # fmt: skip
    frames = np.bincount(cloud.frame, energy)
    return {
        **{f"course_{name}_{index}": float(found[name][index]) for name in CURVES for index in range(SEGMENTS)},
        "course_lasts": float(end_s - begin_s),
        "course_fastest_away": max(float(np.quantile(velocity, 0.98)), 0.0),
        "course_fastest_near": max(float(-np.quantile(velocity, 0.02)), 0.0),
        "course_peak_share": float(frames.max() / frames.sum()),
        "course_away_share": float(energy[velocity > 0].sum() / energy.sum()),
    }


def _weighted_quantiles(
    values: Float[np.ndarray, " point"], weights: Float[np.ndarray, " point"], shares: tuple[float, float]
) -> Float[np.ndarray, " share"]:
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    return np.interp(shares, below / below[-1], values[order])
