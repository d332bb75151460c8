"""Augmentation of generated windows: points are dropped, clutter and false points added, time and sides reversed.

Which weak points a real board reports (thresholds, antennas, cables, furniture) is unknown beforehand, so a recogniser
should not depend on it. A copy costs a hundredth of a new window.
"""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import STILL_MPS, PointRecording
from mmweaver.recognition.window_features import SPEED_EDGES_MPS

FARTHEST_M, ASIDE_RAD = 9.0, 1.1  # of static cells in a furnished room


@dataclass(frozen=True, kw_only=True)
class WindowAugmentation:
    """Limits of the augmentation; each copy samples its own values.

    Moving and static points are kept with a probability between the given minimum and 1, whole frames are dropped, and
    some points of the slowest velocity are reported as static. Up to `most_objects` static objects add up to three
    neighbouring range cells each, detected always or intermittently, and in `crowded_share` of the copies up to
    `most_crowded` single cells all around; `false_points` is the largest mean number of moving false alarms. Points
    less than up to `snr_cut_db` above the weakest are dropped, as a less sensitive radar drops them. `reversed_share`
    of the copies are reversed in time (with the sign of velocity), `reflected_share` are reflected left-right: by
    default half, 0 where order or sides matter.
    """

    least_moving: float = 0.35
    least_static: float = 0.2
    frames_lost: float = 0.15
    slow_to_static: float = 0.3
    most_objects: int = 4
    crowded_share: float = 0.0
    most_crowded: int = 30
    false_points: float = 1.0
    tilt_rad: float = 0.05
    cell_m: float = 0.0436  # range and velocity steps of the radar
    velocity_step_mps: float = 0.615
    snr_cut_db: float = 0.0
    reversed_share: float = 0.5
    reflected_share: float = 0.5


Points = tuple[np.ndarray, np.ndarray]  # frame (point,), columns (point, 4): x, y, z, radial velocity


def augmented(
    window: PointRecording, rng: np.random.Generator, how: WindowAugmentation | None = None
) -> PointRecording:
    """One augmented copy of a window; `snr_db` becomes nan."""
    how = how or WindowAugmentation()
    cloud, frames = window.cloud, window.num_frames
    columns = np.stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps], axis=1)
    if how.snr_cut_db and np.isfinite(cloud.snr_db).any():
        weakest_db = float(np.nanmin(cloud.snr_db)) + rng.uniform(0, how.snr_cut_db)
        cloud = cloud.select(~(cloud.snr_db < weakest_db))
        columns = np.stack([cloud.x_m, cloud.y_m, cloud.z_m, cloud.radial_velocity_mps], axis=1)
    body = _thinned(cloud.frame.astype(int), columns, frames, how, rng)
    body = _reversed(body, frames, how, rng)
    parts = [body, *_static_objects(frames, how, rng), _false_points(frames, how, rng), *_crowd(frames, how, rng)]
    frame, columns = np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])
    order = np.argsort(frame, kind="stable")
    frame, (x, y, z, velocity) = frame[order], columns[order].T
    tilt = rng.normal(0, how.tilt_rad)
    return replace(
        window,
        cloud=PointCloud(
            frame=frame, x_m=x, y_m=y * np.cos(tilt) - z * np.sin(tilt), z_m=z * np.cos(tilt) + y * np.sin(tilt),
            radial_velocity_mps=velocity, snr_db=np.full(len(frame), np.nan),
        ),
    )  # fmt: skip


def _thinned(
    frame: np.ndarray, columns: np.ndarray, frames: int, how: WindowAugmentation, rng: np.random.Generator
) -> Points:
    """Drops points, frames, and the velocity of slow points; three copies in ten drop no single points."""
    speed = np.abs(columns[:, 3])
    spared = rng.random() < 0.3
    moving, static = (1.0 if spared else rng.uniform(least, 1.0) for least in (how.least_moving, how.least_static))
    kept = rng.random(len(frame)) < np.where(speed > STILL_MPS, moving, static)
    kept &= (rng.random(frames) >= rng.uniform(0, how.frames_lost))[frame]
    columns = columns.copy()
    stops = (speed < SPEED_EDGES_MPS[1]) & (rng.random(len(frame)) < rng.uniform(0, how.slow_to_static))
    columns[stops, 3] = 0.0
    return frame[kept], columns[kept]


def _reversed(points: Points, frames: int, how: WindowAugmentation, rng: np.random.Generator) -> Points:
    """Reverses time and reflects left-right, each in its share of copies."""
    frame, columns = points
    backwards, reflected = rng.random(2) < (how.reversed_share, how.reflected_share)
    columns = columns * np.array([-1.0 if reflected else 1.0, 1.0, 1.0, -1.0 if backwards else 1.0])
    return (frames - 1 - frame if backwards else frame), columns


def _static_objects(frames: int, how: WindowAugmentation, rng: np.random.Generator) -> list[Points]:
    """Static objects at any range, detected always or intermittently."""
    found = []
    for _ in range(int(rng.integers(how.most_objects + 1))):
        nearest_m, aside = rng.uniform(0.9, 5.5), rng.normal(0, 0.3)
        share = float(rng.choice([1.0, 0.98, 0.9, 0.6, 0.3, 0.1]))
        for cell in range(int(rng.integers(1, 4))):
            frame = np.flatnonzero(rng.random(frames) < share)
            range_m = nearest_m + cell * how.cell_m
            place = [range_m * np.sin(aside), range_m * np.cos(aside), rng.normal(0, 0.3), 0.0]
            found.append((frame, np.tile(place, (len(frame), 1))))
    return found


def _crowd(frames: int, how: WindowAugmentation, rng: np.random.Generator) -> list[Points]:
    """A furnished room: static cells all around, most of them detected nearly always."""
    if rng.random() >= how.crowded_share:
        return []
    number = int(rng.integers(1, how.most_crowded + 1))
    share = rng.choice([1.0, 0.98, 0.9, 0.6, 0.3, 0.1], number)
    range_m, aside = rng.uniform(0.3, FARTHEST_M, number), rng.uniform(-ASIDE_RAD, ASIDE_RAD, number)
    up_m = rng.normal(0, 0.5, number)
    frame, which = np.nonzero(rng.random((frames, number)) < share)
    place = np.stack([range_m * np.sin(aside), range_m * np.cos(aside), up_m, np.zeros(number)], axis=1)
    return [(frame, place[which])]


def _false_points(frames: int, how: WindowAugmentation, rng: np.random.Generator) -> Points:
    """Moving false alarms."""
    number = int(rng.poisson(float(rng.choice([0.0, 0.0, how.false_points / 4, how.false_points]))))
    range_m, aside = rng.uniform(1, 5, number), rng.normal(0, 0.4, number)
    velocity = rng.choice([-1.0, 1.0], number) * how.velocity_step_mps * rng.choice([1.0, 2.0], number)
    columns = np.stack([range_m * np.sin(aside), range_m * np.cos(aside), rng.normal(0, 0.4, number), velocity], axis=1)
    return rng.integers(frames, size=number), columns
