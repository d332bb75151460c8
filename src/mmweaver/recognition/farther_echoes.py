"""Multipath of a person over a wall or another body: moving points behind a nearer group that moves at the same time.

Such a path is always longer than the direct one, so of two groups that move at once the nearer is the person.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool

from mmweaver.recognition.point_recording import PointRecording, is_moving

AT_ONCE_S = 0.15
GROUP_M = 0.8  # from a point, within which others are of the same group
APART_M, BEHIND_M = 1.0, 0.6  # least distance and difference in range between a person and an echo
FEWEST, SHARE = 2, 0.5  # of points of the nearer group, in all and relative to those of the farther


def without_farther(window: PointRecording) -> PointRecording:
    """The window without moving points behind a nearer group of moving points."""
    cloud = window.cloud
    moving = np.flatnonzero(is_moving(cloud))
    if len(moving) <= FEWEST:
        return window
    frame, place_m = cloud.frame[moving], np.stack([cloud.x_m, cloud.y_m], axis=1)[moving]
    hidden = _is_farther(frame, place_m, cloud.range_m[moving], max(int(AT_ONCE_S * window.frame_rate_hz), 1))
    if not hidden.any():
        return window
    kept = np.ones(len(cloud.frame), bool)
    kept[moving[hidden]] = False
    return replace(window, cloud=cloud.select(kept))


def _is_farther(frame: np.ndarray, place_m: np.ndarray, range_m: np.ndarray, lag: int) -> Bool[np.ndarray, " point"]:
    """Of moving points in the order of frames: whether each belongs to the farther of two groups."""
    begin, end = np.searchsorted(frame, frame - lag), np.searchsorted(frame, frame + lag, side="right")
    count = end - begin
    one = np.repeat(np.arange(len(frame)), count)
    other = np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(begin, count)
    apart_m = np.hypot(*(place_m[one] - place_m[other]).T)
    own = np.bincount(one, apart_m < GROUP_M, minlength=len(frame))
    nearer = np.bincount(one, (apart_m > APART_M) & (range_m[other] < range_m[one] - BEHIND_M), minlength=len(frame))
    return (nearer >= FEWEST) & (nearer >= SHARE * own)
