"""Generated windows as other people would have filled them: faster or wider, elsewhere, seen in part.

A copy costs a hundredth of a simulated performance. Motions stay what they are: neither order nor sides change.
"""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording, index_runs, is_moving

BRISK_STEPS = 1.0  # velocities above so many steps of the radar are those of limbs
FEWEST = 10  # brisk points of a motion that may be seen in part
NEAREST_M = 0.3


@dataclass(frozen=True, kw_only=True)
class PerformanceVariation:
    """Limits of what differs between a generated window and its copy; each copy samples its own values.

    `tempo` and `size`: standard deviations of the logarithm of the pace and of the extent of the moving points about
    their median. `shift_m`: the largest change of range. `turn_rad`: standard deviation of the change of azimuth.
    `cut_share`: of the copies of single performances, those of which the beginning or the end is missing, up to
    `most_cut` of the motion. `hidden_share`: of the copies, those in which a limb returns little in a part of its way
    (the earlier or later, the higher or lower, or approaching or receding).
    """

    tempo: float = 0.2
    size: float = 0.1
    shift_m: float = 0.3
    turn_rad: float = 0.25
    cut_share: float = 0.35
    most_cut: float = 0.5
    hidden_share: float = 0.35


def varied(
    source: PointRecording, first: int, num_frames: int, rng: np.random.Generator, velocity_step_mps: float,
    max_velocity_mps: float, how: PerformanceVariation, *, once: bool,
) -> PointRecording:  # fmt: skip
    """`num_frames` frames of `source`, beginning about frame `first`, of another performance of the same motion.

    Frames beyond the end of `source` are empty. Velocities stay multiples of the radar's step, below its largest.
    """
    pace = float(np.exp(how.tempo * rng.normal()))
    if not once:  # what goes on has no end: no copy reads beyond it
        first = max(min(first, int(source.num_frames - num_frames * pace)), 0)
        pace = min(pace, source.num_frames / num_frames)
    wanted = first + np.floor(np.arange(num_frames) * pace).astype(int)
    cloud = _frames(source.cloud, wanted)
    if once:
        cloud = _cut(cloud, rng, velocity_step_mps, how)
    cloud = _partly_hidden(cloud, rng, velocity_step_mps, how)
    cloud = _resized(cloud, float(np.exp(how.size * rng.normal())), pace, velocity_step_mps, max_velocity_mps)
    cloud = _elsewhere(cloud, rng.uniform(-how.shift_m, how.shift_m), how.turn_rad * rng.normal())
    return replace(source, cloud=cloud, num_frames=num_frames, first_frame=source.first_frame + first, joints_m=None)


def _frames(cloud: PointCloud, wanted: np.ndarray) -> PointCloud:
    """The points of these frames (frame,), which do not fall, as frames 0, 1, ..."""
    frame, place = index_runs(np.searchsorted(cloud.frame, wanted), np.searchsorted(cloud.frame, wanted, side="right"))
    names = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
    return PointCloud(frame=frame, **{name: getattr(cloud, name)[place] for name in names})


def _brisk(cloud: PointCloud, velocity_step_mps: float) -> np.ndarray:
    return np.abs(cloud.radial_velocity_mps) > (BRISK_STEPS + 0.1) * velocity_step_mps


def _cut(
    cloud: PointCloud, rng: np.random.Generator, velocity_step_mps: float, how: PerformanceVariation
) -> PointCloud:
    """Without the beginning or the end of its motion, as recordings are cut; time counts from the first point."""
    brisk = _brisk(cloud, velocity_step_mps)
    if rng.random() > how.cut_share or brisk.sum() < FEWEST:
        return cloud
    begin, end = np.quantile(cloud.frame[brisk], [0.02, 0.98])
    missing = rng.uniform(0, how.most_cut) * (end - begin)
    cloud = cloud.select(cloud.frame >= begin + missing if rng.random() < 0.5 else cloud.frame <= end - missing)
    return replace(cloud, frame=cloud.frame - cloud.frame[0]) if len(cloud.frame) else cloud


def _partly_hidden(
    cloud: PointCloud, rng: np.random.Generator, velocity_step_mps: float, how: PerformanceVariation
) -> PointCloud:
    """Without most of the brisk points of one part of the way: skin reflects like a mirror, and limbs turn."""
    brisk = _brisk(cloud, velocity_step_mps)
    if rng.random() > how.hidden_share or brisk.sum() < FEWEST:
        return cloud
    along = (cloud.frame, cloud.z_m, cloud.radial_velocity_mps)[int(rng.integers(3))] * rng.choice([-1.0, 1.0])
    beyond = along > np.quantile(along[brisk], rng.uniform(0.4, 0.8))
    return cloud.select(~(brisk & beyond & (rng.random(len(along)) < rng.uniform(0.6, 1.0))))


def _resized(
    cloud: PointCloud, size: float, pace: float, velocity_step_mps: float, max_velocity_mps: float
) -> PointCloud:
    """Moving points `size` times as far from their median, all velocities as much and `pace` times as fast."""
    moving = is_moving(cloud)
    if not moving.any():
        return cloud
    places = np.stack([cloud.x_m, cloud.y_m, cloud.z_m], axis=1)
    middle = np.median(places[moving], axis=0)
    places = np.where(moving[:, None], middle + size * (places - middle), places)
    velocity = np.round(cloud.radial_velocity_mps * size * pace / velocity_step_mps) * velocity_step_mps
    folded = (velocity + max_velocity_mps) % (2 * max_velocity_mps) - max_velocity_mps
    x, y, z = places.T
    return replace(cloud, x_m=x, y_m=y, z_m=z, radial_velocity_mps=np.where(moving, folded, 0.0))


def _elsewhere(cloud: PointCloud, farther_m: float, turn_rad: float) -> PointCloud:
    """All points farther away and turned about the radar."""
    range_m = cloud.range_m
    scale = np.maximum(range_m + farther_m, NEAREST_M) / np.maximum(range_m, 1e-6)
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    x, y = scale * cloud.x_m, scale * cloud.y_m
    return replace(cloud, x_m=x * cos - y * sin, y_m=x * sin + y * cos, z_m=scale * cloud.z_m)
