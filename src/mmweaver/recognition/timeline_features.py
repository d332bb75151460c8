"""What happens first and what last: height, range, side and velocity of the moving points over the course of a window.

Raising an arm and letting it fall differ in their order alone. Places count from the body's own median, so that they
say nothing of where the radar stands; sides are kept, as a left arm is none of the right.
"""

import itertools

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.body_features import Row
from mmweaver.recognition.point_recordings import PointRecording, is_moving

SEGMENTS = 6
FEWEST = 6  # moving points for any order
ENDS = (0.05, 0.95)  # quantiles of the times of moving points: when motion begins and ends
BODY_M = 1.2  # points farther than this from the body's median are another echo


def timeline_features(window: PointRecording) -> Row:
    """Named features of one window; nan means too few points."""
    cloud = of_the_body(window.cloud)
    time_s = cloud.frame / window.frame_rate_hz
    velocity = cloud.radial_velocity_mps
    range_m = cloud.range_m
    places = {"up": cloud.z_m, "out": range_m, "aside": cloud.x_m}
    if len(time_s) < FEWEST:
        return dict.fromkeys(_names(), np.nan)
    begin_s, end_s = np.quantile(time_s, ENDS)
    part = np.clip((time_s - begin_s) / max(end_s - begin_s, 1e-9) * SEGMENTS, 0, SEGMENTS - 1).astype(int)
    count = np.bincount(part, minlength=SEGMENTS)
    known = count > 0

    def mean(values: np.ndarray) -> np.ndarray:
        """Mean of each segment (segment,), nan without points."""
        total = np.bincount(part, values, minlength=SEGMENTS)
        return np.where(known, total / np.maximum(count, 1), np.nan)

    row: Row = {"order_lasts": float(end_s - begin_s)}
    curves = {"share": count / len(part), "velocity": mean(velocity), "speed": mean(np.abs(velocity))}
    for name, values in places.items():
        curves[name] = mean(values - np.median(values))
    for name, curve in curves.items():
        row |= {f"order_{name}_{index}": float(value) for index, value in enumerate(curve)}
    row |= _extremes(velocity, places)
    row |= _turns(time_s, velocity, begin_s, end_s)
    return row


def of_the_body(cloud: PointCloud) -> PointCloud:
    """Moving points near their median."""
    moving = cloud.select(is_moving(cloud))
    if not len(moving.frame):
        return moving
    far_m = [np.abs(axis - np.median(axis)) for axis in (moving.x_m, moving.y_m, moving.z_m)]
    return moving.select(np.max(far_m, axis=0) < BODY_M)


def _extremes(velocity: np.ndarray, places: dict[str, np.ndarray]) -> Row:
    """Where the fast points are among all, and how far points spread."""
    speed = np.abs(velocity)
    fast = speed >= np.quantile(speed, 0.8)
    row: Row = {}
    for name, values in places.items():
        low, middle, high = np.quantile(values, [0.1, 0.5, 0.9])
        row[f"reach_{name}_above"], row[f"reach_{name}_below"] = float(high - middle), float(middle - low)
        row[f"fast_{name}"] = float(values[fast].mean() - middle)
    return row


def _turns(time_s: np.ndarray, velocity: np.ndarray, begin_s: float, end_s: float) -> Row:
    """When the body approaches and recedes most, and how often that changes."""
    lasts_s = max(end_s - begin_s, 1e-9)
    away, near = velocity > 0, velocity < 0
    when = {
        word: float((np.average(time_s[which], weights=np.abs(velocity[which])) - begin_s) / lasts_s)
        if which.any() else np.nan
        for word, which in (("away", away), ("near", near))
    }  # fmt: skip
    edges = np.arange(begin_s, end_s + 0.2, 0.2)
    momentum = np.histogram(time_s, edges, weights=velocity)[0] if len(edges) > 1 else np.zeros(1)
    signs = np.sign(momentum[momentum != 0])
    changes = int((np.diff(signs) != 0).sum())
    return {
        "order_away": when["away"], "order_near": when["near"], "order_away_less_near": when["away"] - when["near"],
        "turns": float(changes), "turns_hz": changes / max(lasts_s, 0.2), "order_tilt": float(velocity.mean()),
    }  # fmt: skip


def _names() -> list[str]:
    curves = [
        f"order_{name}_{index}"
        for name, index in itertools.product(("share", "velocity", "speed", "up", "out", "aside"), range(SEGMENTS))
    ]
    reaches = [f"{word}_{name}" for name in ("up", "out", "aside") for word in ("fast",)]
    reaches += [f"reach_{name}_{side}" for name in ("up", "out", "aside") for side in ("above", "below")]
    ends = ["order_lasts", "order_away", "order_near", "order_away_less_near", "turns", "turns_hz", "order_tilt"]
    return [*curves, *reaches, *ends]
