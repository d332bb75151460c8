"""Features of point clouds: points per frame, extent, SNR and speed."""

from collections.abc import Callable

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.virtual_array import has_elevation
from mmweaver.evaluation.finding import FrameValues, Measure, feature
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence

MOVING_MPS = 0.1
MIN_POINTS = 3


@feature("points", "points per frame", "points", 10.0, whole_frames=True)
def points_per_frame(evidence: SignalEvidence) -> FrameValues:
    """Points per frame within the common ranges."""
    return FrameValues(np.bincount(evidence.points.frame, minlength=len(evidence.signal.cube.values)).astype(float))


def per_cloud(number: Callable[[PointCloud], float]) -> Measure:
    """Builds a feature from a function of each frame's points.

    Args:
        number: Maps the points of a frame to a value; frames with fewer than three points yield nan.

    Returns:
        The feature's measure, which raises CannotSeeError if no frame has three points.
    """

    def measure(evidence: SignalEvidence) -> FrameValues:
        clouds = [evidence.points.select(evidence.points.frame == at) for at in range(len(evidence.signal.cube.values))]
        values = [number(one) if len(one.frame) >= MIN_POINTS else np.nan for one in clouds]
        if not np.isfinite(values).any():
            raise CannotSeeError(f"no frame has {MIN_POINTS} points")
        return FrameValues(np.array(values))

    return measure


@feature("points_height", "points, height", "m", 0.3, whole_frames=True)
def points_height(evidence: SignalEvidence) -> FrameValues:
    """5th to 95th percentile of z in a frame. Raises CannotSeeError for an array without elevation.

    Raises:
        CannotSeeError: If the array has no elevation, or no frame has three points.
    """
    if not has_elevation(evidence.signal.cube.config):
        raise CannotSeeError("the array resolves no elevation")
    return per_cloud(lambda one: _extent_m(one.z_m))(evidence)


def _extent_m(values: np.ndarray) -> float:
    low, high = np.percentile(values, (5, 95))
    return float(high - low)


for _name, _title, _unit, _tolerance, _definition, _number in (
    ("width", "width", "m", 0.3, "5th to 95th percentile of x in a frame", lambda one: _extent_m(one.x_m)),
    ("depth", "depth", "m", 0.3, "5th to 95th percentile of y in a frame", lambda one: _extent_m(one.y_m)),
    ("snr", "SNR", "dB", 3.0, "median SNR of a frame's points", lambda one: float(np.median(one.snr_db))),
    (
        "moving",
        "share that moves",
        "share",
        0.1,
        f"share of a frame's points with a radial speed above {MOVING_MPS} m/s",
        lambda one: float((np.abs(one.radial_velocity_mps) > MOVING_MPS).mean()),
    ),
    (
        "speed",
        "95th percentile of speed",
        "m/s",
        0.2,
        "95th percentile of the radial speed of a frame's points",
        lambda one: float(np.percentile(np.abs(one.radial_velocity_mps), 95)),
    ),
):
    _declare = feature(
        f"points_{_name}", f"points, {_title}", _unit, _tolerance, definition=_definition, whole_frames=True
    )
    _declare(per_cloud(_number))
