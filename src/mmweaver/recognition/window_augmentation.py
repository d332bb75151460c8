"""Copies of generated windows: other performances of the same motion, as reported by worse boards in worse rooms.

`varied` changes tempo, extent, position and visibility of a motion; neither order nor sides change. `augmented` drops
points and adds clutter and false alarms: which weak points a real board reports (thresholds, antennas, cables,
furniture) is unknown beforehand. A copy costs a hundredth of a simulated performance.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import STILL_MPS, PointRecording, index_runs, is_moving
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.window_features import SPEED_EDGES_MPS

BRISK_STEPS = 1.1  # velocity of limbs, minimum in steps of the radar
FEWEST = 10  # minimum number of brisk points of a motion that may be partly hidden
NEAREST_M = 0.3
FARTHEST_M, ASIDE_RAD = 9.0, 1.1  # of static cells in a furnished room
DETECTED = (1.0, 0.98, 0.9, 0.6, 0.3, 0.1)  # shares of frames in which static objects are detected

Values = np.ndarray | float
Points = tuple[np.ndarray, np.ndarray]  # frame (point,), columns (point, 4): x, y, z, radial velocity


@dataclass(frozen=True, kw_only=True)
class PerformanceVariation:
    """Limits of the difference between a generated window and its copy; each copy samples its own values.

    Attributes:
        tempo: Standard deviation of the logarithm of the tempo.
        size: Standard deviation of the logarithm of the extent of the moving points around their median.
        shift_m: Maximum change of range.
        turn_rad: Standard deviation of the change of azimuth.
        cut_share: Share of the copies of single performances whose beginning or end is missing.
        most_cut: Maximum missing share of the motion.
        hidden_share: Share of the copies in which a limb returns little in a part of its path (the earlier or later,
            the higher or lower, or approaching or receding).
    """

    tempo: float = 0.2
    size: float = 0.1
    shift_m: float = 0.3
    turn_rad: float = 0.25
    cut_share: float = 0.35
    most_cut: float = 0.5
    hidden_share: float = 0.35


@dataclass(frozen=True, kw_only=True)
class WindowAugmentation:
    """Limits of the augmentation; each copy samples its own values.

    Moving and static points are kept with a probability between the given minimum and 1, whole frames are dropped, and
    some points of the slowest velocity are reported as static. Up to `most_objects` static objects add up to three
    neighbouring range cells each, detected always or intermittently, and in `crowded_share` of the copies up to
    `most_crowded` single cells all around; `false_points` is the largest mean number of moving false alarms. Points
    within up to `snr_cut_db` of the weakest are dropped, as by a less sensitive radar. `reversed_share` of the copies
    are reversed in time (with the sign of velocity), `reflected_share` are reflected left-right: by default half, 0
    where order or sides matter.
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


# other performances -------------------------------------------------------------------------------------------------
def varied(
    source: PointRecording,
    first: int,
    num_frames: int,
    rng: np.random.Generator,
    radar: Quantisation,
    how: PerformanceVariation,
    *,
    once: bool,
) -> PointRecording:
    """Another performance of the same motion.

    Velocities remain multiples of the radar's step, below its maximum.

    Args:
        source: The recording.
        first: Approximate first frame.
        num_frames: Number of frames; those beyond the end of `source` are empty.
        rng: Random stream.
        radar: Steps of range and velocity.
        how: Limits of the variation.
        once: Whether `source` is a single performance, which copies may cut.
    """
    pace = float(np.exp(how.tempo * rng.normal()))
    if not once:  # a continuing activity has no end, so no copy reads beyond the recording
        first = max(min(first, int(source.num_frames - num_frames * pace)), 0)
        pace = min(pace, source.num_frames / num_frames)
    cloud = _frames(source.cloud, first + np.floor(np.arange(num_frames) * pace).astype(int))
    if once:
        cloud = _cut(cloud, rng, radar, how)
    cloud = _partly_hidden(cloud, rng, radar, how)
    cloud = _resized(cloud, float(np.exp(how.size * rng.normal())), pace, radar)
    cloud = _elsewhere(cloud, rng.uniform(-how.shift_m, how.shift_m), how.turn_rad * rng.normal())
    return replace(source, cloud=cloud, num_frames=num_frames, first_frame=source.first_frame + first, joints_m=None)


def _frames(cloud: PointCloud, wanted: np.ndarray) -> PointCloud:
    """The points of selected frames (frame,), in ascending order, renumbered 0, 1, ..."""
    frame, place = index_runs(np.searchsorted(cloud.frame, wanted), np.searchsorted(cloud.frame, wanted, side="right"))
    return replace(cloud.select(place), frame=frame)


def _brisk(cloud: PointCloud, radar: Quantisation) -> Bool[np.ndarray, " point"]:
    return np.abs(cloud.radial_velocity_mps) > BRISK_STEPS * radar.velocity_step_mps


def _cut(cloud: PointCloud, rng: np.random.Generator, radar: Quantisation, how: PerformanceVariation) -> PointCloud:
    """Removes the beginning or the end of a motion, as recordings are cut; time counts from the first point."""
    brisk = _brisk(cloud, radar)
    if rng.random() > how.cut_share or brisk.sum() < FEWEST:
        return cloud
    begin, end = np.quantile(cloud.frame[brisk], [0.02, 0.98])
    missing = rng.uniform(0, how.most_cut) * (end - begin)
    cloud = cloud.select(cloud.frame >= begin + missing if rng.random() < 0.5 else cloud.frame <= end - missing)
    return replace(cloud, frame=cloud.frame - cloud.frame[0]) if len(cloud.frame) else cloud


def _partly_hidden(
    cloud: PointCloud, rng: np.random.Generator, radar: Quantisation, how: PerformanceVariation
) -> PointCloud:
    """Removes most of the brisk points of one part of the path: skin reflects specularly, and limbs turn."""
    brisk = _brisk(cloud, radar)
    if rng.random() > how.hidden_share or brisk.sum() < FEWEST:
        return cloud
    along = (cloud.frame, cloud.z_m, cloud.radial_velocity_mps)[int(rng.integers(3))] * rng.choice([-1.0, 1.0])
    beyond = along > np.quantile(along[brisk], rng.uniform(0.4, 0.8))
    return cloud.select(~(brisk & beyond & (rng.random(len(along)) < rng.uniform(0.6, 1.0))))


def _resized(cloud: PointCloud, size: float, pace: float, radar: Quantisation) -> PointCloud:
    """Scales moving points about their median by `size`, and velocities by `size` and `pace`."""
    moving = is_moving(cloud)
    if not moving.any():
        return cloud
    step, most = radar.velocity_step_mps, radar.max_velocity_mps
    velocity = np.round(cloud.radial_velocity_mps * size * pace / step) * step
    columns = {"radial_velocity_mps": np.where(moving, (velocity + most) % (2 * most) - most, 0.0)}
    for name in ("x_m", "y_m", "z_m"):
        place = getattr(cloud, name)
        middle = np.median(place[moving])
        columns[name] = np.where(moving, middle + size * (place - middle), place)
    return replace(cloud, **columns)


def _elsewhere(cloud: PointCloud, farther_m: float, turn_rad: float) -> PointCloud:
    """Moves all points in range, and rotates them about the radar."""
    range_m = cloud.range_m
    scale = np.maximum(range_m + farther_m, NEAREST_M) / np.maximum(range_m, 1e-6)
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    x, y = scale * cloud.x_m, scale * cloud.y_m
    return replace(cloud, x_m=x * cos - y * sin, y_m=x * sin + y * cos, z_m=scale * cloud.z_m)


# worse boards and rooms ---------------------------------------------------------------------------------------------
def augmented(
    window: PointRecording, rng: np.random.Generator, how: WindowAugmentation | None = None
) -> PointRecording:
    """One augmented copy of a window; `snr_db` becomes nan.

    Args:
        window: Points of one window.
        rng: Random stream.
        how: Limits of the augmentation; by default `WindowAugmentation()`.
    """
    how = how or WindowAugmentation()
    cloud, frames = window.cloud, window.num_frames
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
    turned = {"y_m": y * np.cos(tilt) - z * np.sin(tilt), "z_m": z * np.cos(tilt) + y * np.sin(tilt)}
    unknown = np.full(len(frame), np.nan)
    return replace(window, cloud=PointCloud(frame=frame, x_m=x, radial_velocity_mps=velocity, snr_db=unknown, **turned))


def _thinned(
    frame: np.ndarray, columns: np.ndarray, frames: int, how: WindowAugmentation, rng: np.random.Generator
) -> Points:
    """Drops points, frames, and the velocity of slow points; three copies in ten drop no single points."""
    speed = np.abs(columns[:, 3])
    spared = rng.random() < 0.3
    moving, static = (1.0 if spared else rng.uniform(least, 1.0) for least in (how.least_moving, how.least_static))
    kept = rng.random(len(frame)) < np.where(speed > STILL_MPS, moving, static)
    kept &= (rng.random(frames) >= rng.uniform(0, how.frames_lost))[frame]
    stops = (speed < SPEED_EDGES_MPS[1]) & (rng.random(len(frame)) < rng.uniform(0, how.slow_to_static))
    columns[stops, 3] = 0.0
    return frame[kept], columns[kept]


def _reversed(points: Points, frames: int, how: WindowAugmentation, rng: np.random.Generator) -> Points:
    """Reverses time and reflects left-right, each in its share of the copies."""
    frame, columns = points
    backwards, reflected = rng.random(2) < (how.reversed_share, how.reflected_share)
    columns = columns * np.array([-1.0 if reflected else 1.0, 1.0, 1.0, -1.0 if backwards else 1.0])
    return (frames - 1 - frame if backwards else frame), columns


def _columns(range_m: Values, aside: Values, up_m: Values, velocity: Values) -> np.ndarray:
    """Columns of points at these ranges and azimuths."""
    return np.stack(np.broadcast_arrays(range_m * np.sin(aside), range_m * np.cos(aside), up_m, velocity), axis=-1)


def _static_objects(frames: int, how: WindowAugmentation, rng: np.random.Generator) -> list[Points]:
    """Static objects at any range, detected always or intermittently."""
    found = []
    for _ in range(int(rng.integers(how.most_objects + 1))):
        nearest_m, aside = rng.uniform(0.9, 5.5), rng.normal(0, 0.3)
        share = float(rng.choice(DETECTED))
        for cell in range(int(rng.integers(1, 4))):
            frame = np.flatnonzero(rng.random(frames) < share)
            place = _columns(nearest_m + cell * how.cell_m, aside, rng.normal(0, 0.3), 0.0)
            found.append((frame, np.tile(place, (len(frame), 1))))
    return found


def _crowd(frames: int, how: WindowAugmentation, rng: np.random.Generator) -> list[Points]:
    """A furnished room: static cells all around, most of them detected nearly always."""
    if rng.random() >= how.crowded_share:
        return []
    number = int(rng.integers(1, how.most_crowded + 1))
    share = rng.choice(DETECTED, number)
    range_m, aside = rng.uniform(0.3, FARTHEST_M, number), rng.uniform(-ASIDE_RAD, ASIDE_RAD, number)
    place = _columns(range_m, aside, rng.normal(0, 0.5, number), 0.0)
    frame, which = np.nonzero(rng.random((frames, number)) < share)
    return [(frame, place[which])]


def _false_points(frames: int, how: WindowAugmentation, rng: np.random.Generator) -> Points:
    """Moving false alarms."""
    number = int(rng.poisson(float(rng.choice([0.0, 0.0, how.false_points / 4, how.false_points]))))
    range_m, aside = rng.uniform(1, 5, number), rng.normal(0, 0.4, number)
    velocity = rng.choice([-1.0, 1.0], number) * how.velocity_step_mps * rng.choice([1.0, 2.0], number)
    columns = _columns(range_m, aside, rng.normal(0, 0.4, number), velocity)
    return rng.integers(frames, size=number), columns
