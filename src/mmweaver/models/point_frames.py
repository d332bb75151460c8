"""Point clouds as tables of fixed size, the input of the pose network."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import PointCloud

MAX_POINTS = 40  # per frame; the strongest are kept
COLUMNS = 5  # x right, y ahead, z up in metres, radial velocity in m/s, strength over the recording's median in dB
REACH_M = 1.2  # of a body around the median of its points; points farther away belong to the room
MIN_MOVING = 5  # moving points from which on their median is the person's position
MOVING_MPS = 0.05
DEFAULT_PLACE_M = (0.0, 2.0, 0.0)  # of a person in a window without points


@dataclass(frozen=True, kw_only=True)
class PointFrames:
    """Points of consecutive frames, padded to the same number per frame."""

    values: Float[np.ndarray, "frame point 5"]
    is_there: Bool[np.ndarray, "frame point"]

    def part(self, first: int, num_frames: int) -> "PointFrames":
        """Consecutive frames.

        Args:
            first: First frame.
            num_frames: Number of frames.
        """
        own = slice(first, first + num_frames)
        return PointFrames(values=self.values[own], is_there=self.is_there[own])


def point_frames(cloud: PointCloud, num_frames: int) -> PointFrames:
    """The table of a point cloud.

    Args:
        cloud: Points of all frames; without SNR and intensity their strength is 0.
        num_frames: Number of frames, from 0.
    """
    strength_db = strength_over_median_db(cloud)
    order = np.lexsort((-strength_db, cloud.frame))
    frame = cloud.frame[order]
    place = np.arange(len(frame)) - np.searchsorted(frame, frame)
    kept = (place < MAX_POINTS) & (frame >= 0) & (frame < num_frames)
    rows = (cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps, strength_db)
    values = np.zeros((num_frames, MAX_POINTS, COLUMNS), np.float32)
    is_there = np.zeros((num_frames, MAX_POINTS), bool)
    values[frame[kept], place[kept]] = np.stack(rows, axis=1)[order][kept]
    is_there[frame[kept], place[kept]] = True
    return PointFrames(values=values, is_there=is_there)


def strength_over_median_db(cloud: PointCloud) -> Float[np.ndarray, " point"]:
    """Strength of points relative to the median of all: SNR, or intensity (an amplitude) where there is no SNR.

    Args:
        cloud: The points.

    Returns:
        Strength (point,) in dB; 0 where unknown.
    """
    strength_db = np.asarray(cloud.snr_db, float)
    intensity = getattr(cloud, "intensity", None)
    if intensity is not None and not np.isfinite(strength_db).any():
        strength_db = 20 * np.log10(np.maximum(np.asarray(intensity, float), 1e-6))
    found = np.isfinite(strength_db)
    if not found.any():
        return np.zeros(len(strength_db))
    return np.where(found, strength_db - np.median(strength_db[found]), 0.0)


def middle_m(frames: PointFrames) -> Float[np.ndarray, "3"]:
    """Position of the person in a window: the median of its points, of moving ones if there are enough.

    Args:
        frames: Points of the window.

    Returns:
        Position (3,) in metres.
    """
    points = frames.values[frames.is_there]
    moving = points[np.abs(points[:, 3]) > MOVING_MPS]
    chosen = moving if len(moving) >= MIN_MOVING else points
    if not len(chosen):
        return np.array(DEFAULT_PLACE_M, np.float32)
    return np.median(chosen[:, :3], axis=0).astype(np.float32)


def near(frames: PointFrames, middle: Float[np.ndarray, "3"]) -> PointFrames:
    """The points that may belong to a person at a position.

    Args:
        frames: Points of the window.
        middle: Position (3,) in metres.
    """
    close = (np.abs(frames.values[..., :3] - middle) <= REACH_M).all(axis=-1)
    return PointFrames(values=frames.values, is_there=frames.is_there & close)
