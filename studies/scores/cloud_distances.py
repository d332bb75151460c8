"""Distances between point clouds of frames."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PointCloud

One = Float[np.ndarray, "one 3"]
Other = Float[np.ndarray, "other 3"]


def chamfer_m(one: One, other: Other) -> float:
    """Mean distance in metres from a point to the nearest of the other set, averaged over both directions.

    Distances are not squared. Both sets must have points.

    >>> chamfer_m(np.zeros((1, 3)), np.array([[0.0, 0, 0], [0, 3.0, 4.0]]))
    1.25
    """
    there, back = nearest_m(one, other)
    return float((there.mean() + back.mean()) / 2)


def nearest_m(one: One, other: Other) -> tuple[Float[np.ndarray, " one"], Float[np.ndarray, " other"]]:
    """Distance in metres of each point of either set from the nearest of the other, (one,) and (other,)."""
    from scipy.spatial import KDTree

    there, _ = KDTree(other).query(one)
    back, _ = KDTree(one).query(other)
    return np.asarray(there), np.asarray(back)


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
