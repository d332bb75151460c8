"""Place and order of motion on the body: features of the moving points near their median.

Raising an arm and lowering it differ in order alone. Positions are relative to the median of the body, so they do not
depend on the position of the radar; sides are kept, since left and right arms differ.
"""

import itertools
from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording, is_moving
from mmweaver.recognition.window_features import Row, correlation, mean_of

FEWEST = 6  # moving points for any order
BODY_M, NEAR_M = 1.2, 0.6  # from the body's median: maximum of moving points, and of static points of the body
SEGMENTS = 6
ENDS = (0.05, 0.95)  # quantiles of the times of moving points: when motion begins and ends
ENERGY_ENDS = (0.04, 0.96)  # the same by energy
MIN_ENERGY = 1e-3  # minimum share of the energy in a segment with known values
QUARTERS = ("left_high", "right_high", "left_low", "right_low")


def _curves(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{name}_{segment}" for name, segment in itertools.product(names, range(SEGMENTS)))


# The order of columns is that of existing recognisers.
TIMELINE = (
    *(f"order_{name}" for name in _curves(("share", "velocity", "speed", "up", "out", "aside"))),
    *["fast_up", "fast_out", "fast_aside", "reach_up_above", "reach_up_below", "reach_out_above", "reach_out_below"],
    *["reach_aside_above", "reach_aside_below", "order_lasts", "order_away", "order_near", "order_away_less_near"],
    *["turns", "turns_hz", "order_tilt"],
)
SIDES = tuple(
    f"side_{name}"
    for name in [
        "energy_aside",
        "energy_up",
        "skew_aside",
        "skew_up",
        "slant",
        "leftmost_up",
        "rightmost_up",
        "reach",
        "away_aside",
        "away_up",
        "near_aside",
        "near_up",
        "of_rest_aside",
        "of_rest_up",
        "highest_aside",
        "highest_spread",
        "highest_speed",
        "lowest_aside",
        "lowest_spread",
        "lowest_speed",
        "left_high_share",
        "left_high_speed",
        "left_high_velocity",
        "right_high_share",
        "right_high_speed",
        "right_high_velocity",
        "left_low_share",
        "left_low_speed",
        "left_low_velocity",
        "right_low_share",
        "right_low_speed",
        "right_low_velocity",
        "left_with_right",
        "high_with_low",
    ]
)
COURSE = tuple(
    f"course_{name}"
    for name in (
        *_curves(("share", "velocity", "up", "out", "aside", "spread")),
        *["lasts", "fastest_away", "fastest_near", "peak_share", "away_share"],
    )
)


def spatiotemporal_features(window: PointRecording) -> Row:
    """Named features of one window; nan where there are too few points."""
    body = near_median(window.cloud)
    if len(body.frame) < FEWEST:
        return dict.fromkeys((*TIMELINE, *SIDES, *COURSE), np.nan)
    return {**_timeline(window, body), **_sides(window, body), **_course(window, body)}


def near_median(cloud: PointCloud) -> PointCloud:
    """Moving points within BODY_M of their median along each axis."""
    moving = cloud.select(is_moving(cloud))
    if not len(moving.frame):
        return moving
    far_m = [np.abs(axis - np.median(axis)) for axis in (moving.x_m, moving.y_m, moving.z_m)]
    return moving.select(np.max(far_m, axis=0) < BODY_M)


# the timeline of all moving points ----------------------------------------------------------------------------------
def _timeline(window: PointRecording, body: PointCloud) -> Row:
    """Height, range, side and velocity over the course of a window."""
    time_s, velocity = body.frame / window.frame_rate_hz, body.radial_velocity_mps
    places = {"up": body.z_m, "out": body.range_m, "aside": body.x_m}
    begin_s, end_s = np.quantile(time_s, ENDS)
    part = np.clip((time_s - begin_s) / max(end_s - begin_s, 1e-9) * SEGMENTS, 0, SEGMENTS - 1).astype(int)
    count = np.bincount(part, minlength=SEGMENTS)

    def mean(values: np.ndarray) -> np.ndarray:
        """Mean of each segment (segment,), nan without points."""
        return np.where(count > 0, np.bincount(part, values, minlength=SEGMENTS) / np.maximum(count, 1), np.nan)

    curves = {"share": count / len(part), "velocity": mean(velocity), "speed": mean(np.abs(velocity))}
    curves |= {name: mean(values - np.median(values)) for name, values in places.items()}
    row: Row = {"order_lasts": end_s - begin_s, **_segment_row("order", curves)}
    speed = np.abs(velocity)
    fast = speed >= np.quantile(speed, 0.8)
    for name, values in places.items():
        low, middle, high = np.quantile(values, [0.1, 0.5, 0.9])
        row[f"reach_{name}_above"], row[f"reach_{name}_below"] = high - middle, middle - low
        row[f"fast_{name}"] = values[fast].mean() - middle
    return row | _turns(time_s, velocity, begin_s, end_s)


def _segment_row(word: str, curves: Mapping[str, np.ndarray]) -> Row:
    return {f"{word}_{name}_{index}": value for name, curve in curves.items() for index, value in enumerate(curve)}


def _turns(time_s: np.ndarray, velocity: np.ndarray, begin_s: float, end_s: float) -> Row:
    """Times of the strongest approach and recession, and the rate of their changes."""
    lasts_s = max(end_s - begin_s, 1e-9)
    away, near = (
        float((np.average(time_s[which], weights=np.abs(velocity[which])) - begin_s) / lasts_s)
        if which.any()
        else np.nan
        for which in (velocity > 0, velocity < 0)
    )
    edges = np.arange(begin_s, end_s + 0.2, 0.2)
    momentum = np.histogram(time_s, edges, weights=velocity)[0] if len(edges) > 1 else np.zeros(1)
    changes = int((np.diff(np.sign(momentum[momentum != 0])) != 0).sum())
    return {
        "order_away": away,
        "order_near": near,
        "order_away_less_near": away - near,
        "turns": changes,
        "turns_hz": changes / max(lasts_s, 0.2),
        "order_tilt": velocity.mean(),
    }


# sides and heights --------------------------------------------------------------------------------------------------
def _sides(window: PointRecording, body: PointCloud) -> Row:
    """Place of motion on the body: left or right, high or low, and which of these move together."""
    aside, up = body.x_m - np.median(body.x_m), body.z_m - np.median(body.z_m)
    velocity, speed = body.radial_velocity_mps, np.abs(body.radial_velocity_mps)
    row = {
        "side_energy_aside": np.average(aside, weights=velocity**2),
        "side_energy_up": np.average(up, weights=velocity**2),
        "side_skew_aside": np.mean(aside**3) / max(np.mean(aside**2) ** 1.5, 1e-9),
        "side_skew_up": np.mean(up**3) / max(np.mean(up**2) ** 1.5, 1e-9),
        "side_slant": np.mean(aside * up) / max(aside.std() * up.std(), 1e-9),
    }
    for word, which in (("away", velocity > 0), ("near", velocity < 0)):
        row |= {f"side_{word}_aside": mean_of(aside[which]), f"side_{word}_up": mean_of(up[which])}
    low, high = np.quantile(up, [0.25, 0.75])
    for word, which in (("highest", up >= high), ("lowest", up <= low)):
        row[f"side_{word}_aside"], row[f"side_{word}_spread"] = mean_of(aside[which]), aside[which].std()
        row[f"side_{word}_speed"] = mean_of(speed[which])
    left, right = np.quantile(aside, [0.1, 0.9])
    row["side_leftmost_up"], row["side_rightmost_up"] = mean_of(up[aside <= left]), mean_of(up[aside >= right])
    row["side_reach"] = right + left  # positive: the right side reaches farther
    quarter, curves = 2 * (up < 0).astype(int) + (aside >= 0).astype(int), []
    for number, word in enumerate(QUARTERS):
        own = quarter == number
        row[f"side_{word}_share"] = own.mean()
        row[f"side_{word}_speed"], row[f"side_{word}_velocity"] = mean_of(speed[own]), mean_of(velocity[own])
        curve = np.bincount(body.frame[own], speed[own], minlength=window.num_frames)
        curves.append(np.convolve(curve, np.ones(3) / 3, mode="same"))
    row["side_left_with_right"] = correlation(curves[0] + curves[2], curves[1] + curves[3])
    row["side_high_with_low"] = correlation(curves[0] + curves[1], curves[2] + curves[3])
    return row | _rest_offsets(window.cloud, body)


def _rest_offsets(cloud: PointCloud, body: PointCloud) -> Row:
    """Position of motion relative to the static points near it."""
    near = np.hypot(cloud.x_m - np.median(body.x_m), cloud.y_m - np.median(body.y_m)) < NEAR_M
    rest = cloud.select(near & (np.abs(cloud.radial_velocity_mps) < 0.1))
    if len(rest.frame) < FEWEST:
        return {"side_of_rest_aside": np.nan, "side_of_rest_up": np.nan}
    return {
        "side_of_rest_aside": np.median(body.x_m) - np.median(rest.x_m),
        "side_of_rest_up": np.median(body.z_m) - np.median(rest.z_m),
    }


# the course of brisk motion -----------------------------------------------------------------------------------------
def _course(window: PointRecording, body: PointCloud) -> Row:
    """Position and speed of brisk points from the beginning to the end of motion.

    The timeline counts points, most of which belong to a body that hardly moves; here each is weighted by its speed
    cubed, so that rest before or after a motion changes nothing.
    """
    velocity = body.radial_velocity_mps
    energy = np.abs(velocity) ** 3
    middle_s = (body.frame + 0.5) / window.frame_rate_hz
    begin_s, end_s = _weighted_quantiles(middle_s, energy, ENERGY_ENDS) + np.array([-0.5, 0.5]) / window.frame_rate_hz
    place = (middle_s - begin_s) / (end_s - begin_s) * SEGMENTS
    # segments overlap by half, since a brisk motion has fewer frames than segments
    weight = np.clip(1 - np.abs(place - (np.arange(SEGMENTS) + 0.5)[:, None]), 0, None) * energy
    total = weight.sum(axis=1)

    def mean(values: np.ndarray) -> np.ndarray:
        """Of each segment (segment,)."""
        return np.where(total > MIN_ENERGY * energy.sum(), weight @ values / np.maximum(total, 1e-12), np.nan)

    aside, range_m = body.x_m - np.median(body.x_m), body.range_m
    curves = {
        "share": total / max(float(total.sum()), 1e-12),
        "velocity": mean(velocity),
        "up": mean(body.z_m - np.median(body.z_m)),
        "out": mean(range_m - np.median(range_m)),
        "aside": mean(aside),
        "spread": np.sqrt(np.maximum(mean(aside**2) - mean(aside) ** 2, 0)),
    }
    frames = np.bincount(body.frame, energy)
    return {
        **_segment_row("course", curves),
        "course_lasts": end_s - begin_s,
        "course_fastest_away": max(float(np.quantile(velocity, 0.98)), 0.0),
        "course_fastest_near": max(float(-np.quantile(velocity, 0.02)), 0.0),
        "course_peak_share": frames.max() / frames.sum(),
        "course_away_share": energy[velocity > 0].sum() / energy.sum(),
    }


def _weighted_quantiles(
    values: Float[np.ndarray, " point"], weights: Float[np.ndarray, " point"], shares: tuple[float, float]
) -> Float[np.ndarray, " share"]:
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    return np.interp(shares, below / below[-1], values[order])
