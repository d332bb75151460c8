"""Distances between point clouds of frames."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.metrics.point_clouds import One, Other, chamfer_m, nearest_m


def hausdorff_m(one: One, other: Other) -> float:
    """Largest distance in metres from a point of either set to the nearest of the other. Both sets must have points.

    >>> hausdorff_m(np.zeros((1, 3)), np.array([[0.0, 0, 0], [0, 3.0, 4.0]]))
    5.0
    """
    there, back = nearest_m(one, other)
    return float(max(there.max(), back.max()))


def cloud_distances_m(
    prediction: PointCloud, truth: PointCloud, *, num_frames: int, missing_m: float
) -> tuple[float, float]:
    """(Hausdorff, Chamfer), each the mean over the frames.

    A frame where only one cloud has points counts `missing_m` (the far end of the radar's range), a frame where both
    are empty counts 0.
    """
    distances: list[tuple[float, float]] = []
    for frame in range(num_frames):
        p, t = _points(prediction, frame), _points(truth, frame)
        if len(p) and len(t):
            distances.append((hausdorff_m(p, t), chamfer_m(p, t)))
        else:
            distances.append((missing_m, missing_m) if len(p) or len(t) else (0.0, 0.0))
    hausdorff, chamfer = np.mean(np.array(distances), axis=0)
    return float(hausdorff), float(chamfer)


def _points(cloud: PointCloud, frame: int) -> One:
    chosen = cloud.frame == frame
    return np.stack([cloud.x_m[chosen], cloud.y_m[chosen], cloud.z_m[chosen]], axis=1)
