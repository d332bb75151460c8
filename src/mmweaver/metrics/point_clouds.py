"""Distances between point clouds."""

import numpy as np
from jaxtyping import Float

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
