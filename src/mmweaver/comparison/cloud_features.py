"""Features of point clouds: how many points a frame has, how far they reach, how strong and how fast they are."""

from collections.abc import Callable

import numpy as np

from mmweaver.comparison.measured_feature import CannotSeeError, Feature, FrameValues
from mmweaver.comparison.signal_evidence import SignalEvidence
from mmweaver.core.records import PointCloud
from mmweaver.core.virtual_array import has_elevation

MOVING_MPS = 0.1
FEWEST_POINTS = 3


def points_a_frame(evidence: SignalEvidence) -> FrameValues:
    """Number of points of each frame within the common ranges."""
    return FrameValues(np.bincount(evidence.points.frame, minlength=evidence.num_point_frames).astype(float))


def of_points(number: Callable[[PointCloud], float]) -> Callable[[SignalEvidence], FrameValues]:
    """A feature that takes the points of each frame; frames of fewer than three points show nothing."""

    def measure(evidence: SignalEvidence) -> FrameValues:
        frames = [evidence.points.select(evidence.points.frame == at) for at in range(evidence.num_point_frames)]
        values = [number(one) if len(one.frame) >= FEWEST_POINTS else np.nan for one in frames]
        if not np.isfinite(values).any():
            raise CannotSeeError(f"no frame has {FEWEST_POINTS} points")
        return FrameValues(np.array(values))

    return measure


def points_height(evidence: SignalEvidence) -> FrameValues:
    """5th to 95th percentile of z of each frame in metres. Raises CannotSeeError for an array without elevation."""
    if not has_elevation(evidence.signal.cube.config):
        raise CannotSeeError("the array resolves no elevation")
    return of_points(lambda one: _reach_m(one.z_m))(evidence)


def _reach_m(values: np.ndarray) -> float:
    low, high = np.percentile(values, (5, 95))
    return float(high - low)


FEATURES = (
    Feature(
        name="points", title="points a frame", unit="points", tolerance=10.0,
        definition="points a frame within the common ranges", measure=points_a_frame,
        whole_frames=True,
    ),
    Feature(
        name="points_width", title="points, width", unit="m", tolerance=0.3,
        definition="5th to 95th percentile of x in a frame", measure=of_points(lambda one: _reach_m(one.x_m)),
        whole_frames=True,
    ),
    Feature(
        name="points_depth", title="points, depth", unit="m", tolerance=0.3,
        definition="5th to 95th percentile of y in a frame", measure=of_points(lambda one: _reach_m(one.y_m)),
        whole_frames=True,
    ),
    Feature(
        name="points_height", title="points, height", unit="m", tolerance=0.3,
        definition="5th to 95th percentile of z in a frame", measure=points_height,
        whole_frames=True,
    ),
    Feature(
        name="points_snr", title="points, SNR", unit="dB", tolerance=3.0,
        definition="median SNR of a frame's points", measure=of_points(lambda one: float(np.median(one.snr_db))),
        whole_frames=True,
    ),
    Feature(
        name="points_moving", title="points that move", unit="share", tolerance=0.1,
        definition=f"share of a frame's points with a radial speed above {MOVING_MPS} m/s",
        measure=of_points(lambda one: float((np.abs(one.radial_velocity_mps) > MOVING_MPS).mean())),
        whole_frames=True,
    ),
    Feature(
        name="points_speed", title="points, 95th percentile of speed", unit="m/s", tolerance=0.2,
        definition="95th percentile of the radial speed of a frame's points",
        measure=of_points(lambda one: float(np.percentile(np.abs(one.radial_velocity_mps), 95))),
        whole_frames=True,
    ),
)  # fmt: skip
