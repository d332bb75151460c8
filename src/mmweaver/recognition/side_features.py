"""Where on the body motion is: left or right, high or low, and which of these moves first or with which other.

Places count from the body's own median; sides are kept.
"""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.body_features import Row
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.timeline_features import FEWEST, of_the_body

QUARTERS = ("left_high", "right_high", "left_low", "right_low")


def side_features(window: PointRecording) -> Row:
    """Named features of one window; nan means too few points."""
    cloud = of_the_body(window.cloud)
    if len(cloud.frame) < FEWEST:
        return dict.fromkeys(_names(), np.nan)
    aside, up = cloud.x_m - np.median(cloud.x_m), cloud.z_m - np.median(cloud.z_m)
    row = _by_direction(cloud, aside, up)
    row |= _by_height(cloud, aside, up)
    row |= _by_quarter(cloud, aside, up, window.num_frames)
    row |= _static(window.cloud, cloud)
    return row


def _mean(values: np.ndarray, which: np.ndarray) -> float:
    return float(values[which].mean()) if which.any() else np.nan


def _by_direction(cloud: PointCloud, aside: np.ndarray, up: np.ndarray) -> Row:
    """Places of what approaches and of what recedes, and means weighted by squared speed."""
    speed = cloud.radial_velocity_mps**2
    row = {
        "side_energy_aside": float(np.average(aside, weights=speed)),
        "side_energy_up": float(np.average(up, weights=speed)),
        "side_skew_aside": float(np.mean(aside**3) / max(np.mean(aside**2) ** 1.5, 1e-9)),
        "side_skew_up": float(np.mean(up**3) / max(np.mean(up**2) ** 1.5, 1e-9)),
        "side_slant": float(np.mean(aside * up) / max(aside.std() * up.std(), 1e-9)),
    }
    for word, which in (("away", cloud.radial_velocity_mps > 0), ("near", cloud.radial_velocity_mps < 0)):
        row |= {f"side_{word}_aside": _mean(aside, which), f"side_{word}_up": _mean(up, which)}
    return row


def _by_height(cloud: PointCloud, aside: np.ndarray, up: np.ndarray) -> Row:
    """Side, spread and speed of the highest and lowest quarter of the points."""
    low, high = np.quantile(up, [0.25, 0.75])
    row: Row = {}
    for word, which in (("highest", up >= high), ("lowest", up <= low)):
        row |= {
            f"side_{word}_aside": _mean(aside, which), f"side_{word}_spread": float(aside[which].std()),
            f"side_{word}_speed": _mean(np.abs(cloud.radial_velocity_mps), which),
        }  # fmt: skip
    left, right = np.quantile(aside, [0.1, 0.9])
    row["side_leftmost_up"], row["side_rightmost_up"] = _mean(up, aside <= left), _mean(up, aside >= right)
    row["side_reach"] = float(right + left)  # positive: the right side reaches farther
    return row


def _by_quarter(cloud: PointCloud, aside: np.ndarray, up: np.ndarray, frames: int) -> Row:
    """Share, speed and variation over time of each quarter of the body, and which two go together."""
    quarter = 2 * (up < 0).astype(int) + (aside >= 0).astype(int)
    row: Row = {}
    curves = []
    for number, word in enumerate(QUARTERS):
        own = quarter == number
        row[f"side_{word}_share"] = float(own.mean())
        row[f"side_{word}_speed"] = _mean(np.abs(cloud.radial_velocity_mps), own)
        row[f"side_{word}_velocity"] = _mean(cloud.radial_velocity_mps, own)
        curves.append(np.bincount(cloud.frame[own], np.abs(cloud.radial_velocity_mps[own]), minlength=frames))
    smooth = np.stack([np.convolve(curve, np.ones(3) / 3, mode="same") for curve in curves])
    row["side_left_with_right"] = _correlation(smooth[0] + smooth[2], smooth[1] + smooth[3])
    row["side_high_with_low"] = _correlation(smooth[0] + smooth[1], smooth[2] + smooth[3])
    return row


def _correlation(one: np.ndarray, other: np.ndarray) -> float:
    if one.std() < 1e-9 or other.std() < 1e-9:
        return np.nan
    return float(np.corrcoef(one, other)[0, 1])


def _static(cloud: PointCloud, moving: PointCloud) -> Row:
    """Where motion is relative to the points at rest near it."""
    near = np.hypot(cloud.x_m - np.median(moving.x_m), cloud.y_m - np.median(moving.y_m)) < 0.6
    still = near & (np.abs(cloud.radial_velocity_mps) < 0.1)
    if still.sum() < FEWEST:
        return {"side_of_rest_aside": np.nan, "side_of_rest_up": np.nan}
    return {
        "side_of_rest_aside": float(np.median(moving.x_m) - np.median(cloud.x_m[still])),
        "side_of_rest_up": float(np.median(moving.z_m) - np.median(cloud.z_m[still])),
    }


def _names() -> list[str]:
    names = ["energy_aside", "energy_up", "skew_aside", "skew_up", "slant", "leftmost_up", "rightmost_up", "reach"]
    names += [f"{word}_{axis}" for word in ("away", "near", "of_rest") for axis in ("aside", "up")]
    names += [f"{word}_{what}" for word in ("highest", "lowest") for what in ("aside", "spread", "speed")]
    names += [f"{word}_{what}" for word in QUARTERS for what in ("share", "speed", "velocity")]
    return [f"side_{name}" for name in [*names, "left_with_right", "high_with_low"]]
