"""How similar two sets of point clouds are, frame by frame and as a whole."""

from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from studies.scores.cloud_distances import chamfer_m, hausdorff_m

RESAMPLES = 100
RANGE_EDGES_M = np.array([1.4, 1.7, 1.9, 2.1, 2.4])
FEWEST_IN_RANGE = 30  # points of either side, for a median that means something

METRICS = {
    "chamfer_m": ("m", "half of both mean distances to the nearest point; frames in which both have points"),
    "hausdorff_m": ("m", "greatest distance to the nearest point; frames in which both have points"),
    "centroid_m": ("m", "distance of the mean places; frames in which both have points"),
    "extent_m": ("m", "mean absolute difference of the standard deviations along x, y, z"),
    "empty": ("", "share of recorded frames in which ours has no point"),
    "points": ("", "points a frame"),
    "points_error": ("", "mean absolute difference of the points a frame"),
    "points_correlation": ("", "correlation of the points a frame over the frames"),
    "doppler": ("", "total variation distance of the velocity histograms of all points, 0 to 1"),
    "speed_correlation": ("", "correlation of the mean |radial velocity| a frame over the frames"),
    "intensity_db": ("dB", "root mean square difference of the median intensities in four range bins of 1.4 to 2.4 m"),
}


@dataclass(frozen=True, kw_only=True)
class CloudScores:
    """Value and 95 % interval over the pieces of each metric; a metric that does not apply is missing."""

    num_frames: int
    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]

    def value(self, name: str) -> float:
        return self.values[name]

    def line(self) -> str:
        """All values on one line."""
        return "  ".join(f"{name} {value:.3f}" for name, value in self.values.items())

    def metrics(self, floor: "CloudScores") -> dict[str, Any]:
        """The metrics of a result row, with `floor` as the baseline."""
        return {
            name: {
                "value": round(value, 4),
                "interval_95": [round(end, 4) for end in self.intervals[name]],
                "unit": METRICS[name][0],
                "definition": METRICS[name][1],
                "version": 1,
                "baseline": {"centroid": round(floor.values[name], 4)} if name in floor.values else None,
            }
            for name, value in self.values.items()
        }


def part_of(cloud: PointCloud, frame: int) -> PointCloud:
    """The points of one frame, as a cloud of the same type."""
    chosen = cloud.frame == frame
    return type(cloud)(**{field.name: getattr(cloud, field.name)[chosen] for field in fields(cloud)})


def score(ours: list[tuple[PointCloud, ...]], real: list[tuple[PointCloud, ...]]) -> CloudScores:
    """Scores of our clouds against the real ones, the same pieces and frames of both.

    Intervals: bootstrap over the pieces.
    """
    frames = [[_frame(a, b) for a, b in zip(one, other, strict=True)] for one, other in zip(ours, real, strict=True)]
    values = _values(frames)
    rng = stream(0, "bootstrap")
    resampled = [_values([frames[at] for at in rng.integers(len(frames), size=len(frames))]) for _ in range(RESAMPLES)]
    intervals = {}
    for name in values:
        known = [sample[name] for sample in resampled if name in sample]
        intervals[name] = (float(np.quantile(known, 0.025)), float(np.quantile(known, 0.975)))
    return CloudScores(num_frames=sum(map(len, frames)), values=values, intervals=intervals)


@dataclass(frozen=True)
class _Frame:
    count: tuple[int, int]
    distances: np.ndarray | None  # chamfer, hausdorff, centroid, extent
    velocity: tuple[np.ndarray, np.ndarray]
    loudness: tuple[np.ndarray, np.ndarray]  # (point, range and intensity in dB)


def _frame(ours: PointCloud, real: PointCloud) -> _Frame:
    a, b = _places(ours), _places(real)
    distances = None
    if len(a) and len(b):
        centroid = float(np.linalg.norm(a.mean(axis=0) - b.mean(axis=0)))
        extent = float(np.abs(a.std(axis=0) - b.std(axis=0)).mean())
        distances = np.array([chamfer_m(a, b), hausdorff_m(a, b), centroid, extent])
    return _Frame(
        count=(len(a), len(b)),
        distances=distances,
        velocity=(ours.radial_velocity_mps, real.radial_velocity_mps),
        loudness=(_loudness(ours), _loudness(real)),
    )


def _places(cloud: PointCloud) -> np.ndarray:
    return np.stack([cloud.x_m, cloud.y_m, cloud.z_m], axis=1)


def _loudness(cloud: PointCloud) -> np.ndarray:
    intensity = getattr(cloud, "intensity", np.full(len(cloud.x_m), np.nan))
    return np.stack([np.linalg.norm(_places(cloud), axis=1), 20 * np.log10(np.maximum(intensity, 0.5))], axis=1)


def _values(pieces: list[list[_Frame]]) -> dict[str, float]:
    frames = [frame for piece in pieces for frame in piece]
    count = np.array([frame.count for frame in frames], float)
    values: dict[str, float] = {}
    both = [frame.distances for frame in frames if frame.distances is not None]
    if both:
        names = ("chamfer_m", "hausdorff_m", "centroid_m", "extent_m")
        values.update(zip(names, map(float, np.mean(both, axis=0)), strict=True))
    values["empty"] = float(np.mean(count[:, 0] == 0))
    values["points"] = float(count[:, 0].mean())
    values["points_error"] = float(np.abs(count[:, 0] - count[:, 1]).mean())
    _put(values, "points_correlation", _correlation(count[:, 0], count[:, 1]))
    _put(values, "doppler", _doppler(frames))
    speeds = np.array([[np.abs(v).mean() if len(v) else 0.0 for v in frame.velocity] for frame in frames])
    _put(values, "speed_correlation", _correlation(speeds[:, 0], speeds[:, 1]))
    _put(values, "intensity_db", _intensity(frames))
    return values


def _put(values: dict[str, float], name: str, value: float) -> None:
    if np.isfinite(value):
        values[name] = value


def _correlation(one: np.ndarray, other: np.ndarray) -> float:
    if not np.isfinite(one).all() or one.std() == 0 or other.std() == 0:
        return float("nan")
    return float(np.corrcoef(one, other)[0, 1])


def _doppler(frames: list[_Frame]) -> float:
    ours, real = (np.concatenate([frame.velocity[side] for frame in frames]) for side in (0, 1))
    if not len(ours) or not np.isfinite(ours).all():
        return float("nan")
    step = 0.356
    edges = (np.arange(-10, 12) - 0.5) * step
    one, other = (np.histogram(np.clip(v, edges[0], edges[-1]), edges)[0] / len(v) for v in (ours, real))
    return float(np.abs(one - other).sum() / 2)


def _intensity(frames: list[_Frame]) -> float:
    ours, real = (np.concatenate([frame.loudness[side] for frame in frames]) for side in (0, 1))
    if not len(ours) or np.isnan(ours[:, 1]).any():
        return float("nan")
    gaps = []
    for low, high in pairwise(RANGE_EDGES_M):
        one, other = (side[(side[:, 0] >= low) & (side[:, 0] < high), 1] for side in (ours, real))
        if min(len(one), len(other)) >= FEWEST_IN_RANGE:
            gaps.append(np.median(one) - np.median(other))
    return float(np.sqrt(np.mean(np.square(gaps)))) if gaps else float("nan")
