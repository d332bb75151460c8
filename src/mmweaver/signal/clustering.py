"""Clusters of points of one frame: DBSCAN on position and radial velocity.

Reference: Ester et al., "A density-based algorithm for discovering clusters", KDD 1996.
"""

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

NOISE = -1


def dbscan(places: Float[np.ndarray, "point axis"], *, distance: float, fewest: int = 3) -> Int[np.ndarray, " point"]:
    """The cluster of each point, from 0 on; -1 for noise.

    A point with `fewest` points within `distance` (itself counted) is a core; cores within reach of each other are one
    cluster, and other points belong to the cluster of their nearest core within reach.

    Args:
        places: (point, axis).
        distance: reach.
        fewest: points of a core.

    >>> dbscan(np.array([[0.0], [0.1], [0.2], [5.0]]), distance=0.3, fewest=2).tolist()
    [0, 0, 0, -1]
    """
    count = len(places)
    labels = np.full(count, NOISE)
    if not count:
        return labels
    tree = KDTree(places)
    pairs = tree.query_pairs(distance, output_type="ndarray")
    neighbours = np.bincount(pairs.ravel(), minlength=count) + 1
    is_core = neighbours >= fewest
    linked = pairs[is_core[pairs].all(axis=1)]
    graph = coo_array((np.ones(len(linked)), (linked[:, 0], linked[:, 1])), shape=(count, count))
    component = connected_components(graph, directed=False)[1]
    core = np.flatnonzero(is_core)
    if len(core):
        _, labels[core] = np.unique(component[core], return_inverse=True)
        near_m, nearest = KDTree(places[core]).query(places)
        border = ~is_core & (near_m <= distance)
        labels[border] = labels[core[nearest[border]]]
    return labels
