"""A logged point cloud for the playback page, with maps of the detections, as a board's data port gives no cube."""

from typing import Any

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.viz.sequence import MAX_FRAMES, Playback, as_bytes
from mmweaver.viz.theme import evenly_spaced

_RANGES, _VELOCITIES, _AZIMUTHS = 64, 33, 61
_UNKNOWN_DB = 10.0  # for points without an SNR
_MIN_FAR_M, _MIN_FAST_MPS = 1.0, 0.5  # minimum ends of the axes


def point_log_playback(points: PointCloud, frame_period_s: float, radar: str, meta: dict[str, Any]) -> Playback:
    """A point cloud as a `Playback`; a cell contains the SNR of its strongest point in decibels, 0 without points.

    Args:
        points: Points of all frames.
        frame_period_s: Frame period in seconds.
        radar: Name of the radar.
        meta: Entries of the header.
    """
    count = int(points.frame.max()) + 1 if len(points.frame) else 1
    shown = evenly_spaced(count, MAX_FRAMES)
    place_of = np.full(count, -1)
    place_of[shown] = np.arange(len(shown))
    points = points.select(place_of[points.frame] >= 0)
    frame = place_of[points.frame]
    level_db = np.where(np.isfinite(points.snr_db), points.snr_db, _UNKNOWN_DB)
    velocity = np.nan_to_num(points.radial_velocity_mps)
    xyz_m = np.stack([points.x_m, points.y_m, points.z_m], axis=-1)
    range_m, azimuth_rad = np.linalg.norm(xyz_m, axis=-1), np.arctan2(points.x_m, points.y_m)
    far_m = _end(np.percentile(range_m, 99) if len(range_m) else 0.0, _MIN_FAR_M)
    fast_mps = _end(np.abs(velocity).max(initial=0.0), _MIN_FAST_MPS)
    edges = {
        "range": (0.0, far_m, _RANGES),
        "doppler": (-fast_mps, fast_mps, _VELOCITIES),
        "azimuth": (-np.pi / 2, np.pi / 2, _AZIMUTHS),
    }
    cell = {
        "range": _cell(range_m, *edges["range"]),
        "doppler": _cell(velocity, *edges["doppler"]),
        "azimuth": _cell(azimuth_rad, *edges["azimuth"]),
    }
    high_db = max(float(level_db.max(initial=0.0)), 1.0)

    def strongest(*axes: str, moving: bool = False) -> np.ndarray:
        """Levels of the cells as bytes (frame, *axes)."""
        values = np.zeros((len(shown), *(edges[axis][2] for axis in axes)))
        chosen = np.all([cell[axis] >= 0 for axis in axes], axis=0) & (velocity != 0 if moving else True)
        np.maximum.at(values, (frame[chosen], *(cell[axis][chosen] for axis in axes)), level_db[chosen])
        return as_bytes(values, 0.0, high_db)

    arrays = {
        "range_doppler": strongest("range", "doppler"),
        "range_doppler_moving": strongest("range", "doppler", moving=True),
        "range_azimuth": strongest("range", "azimuth"),
        "range_azimuth_moving": strongest("range", "azimuth", moving=True),
        "range_time": strongest("range"),
        "micro_doppler": strongest("doppler"),
        "points": np.column_stack([xyz_m, velocity, level_db]).astype(np.float32),
        "point_frame": frame.astype(np.int32),
    }
    header = {
        "kind": "sequence",
        "frames": len(shown),
        "frames_in_all": count,
        "time_s": shown * frame_period_s,
        "frame_period_s": frame_period_s,
        "range_m": edges["range"][:2],
        "velocity_mps": edges["doppler"][:2],
        "azimuth_rad": edges["azimuth"][:2],
        "db": {"low": 0.0, "high": high_db, "noise": 0.0, "unit": "dB SNR of points"},
        "people": 0,
        "bones": [],
        "pelvis": 0,
        "radar": radar,
        "meta": meta,
    }
    return Playback(header=header, arrays=arrays)


def _end(value: float, least: float) -> float:
    """End of an axis, 5 % beyond the values."""
    return max(1.05 * float(value), least)


def _cell(values: np.ndarray, low: float, high: float, count: int) -> np.ndarray:
    """Index of each value's cell; -1 outside the axis."""
    index = np.floor((values - low) / (high - low) * count)
    return np.where((index >= 0) & (index < count), index, -1).astype(int)
