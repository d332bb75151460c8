"""Clustering of the points of a frame by DBSCAN on position and radial velocity.

Reference: Ester et al., "A density-based algorithm for discovering clusters", KDD 1996.
"""

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

NOISE = -1


def dbscan(places: Float[np.ndarray, "point axis"], *, distance: float, fewest: int = 3) -> Int[np.ndarray, " point"]:
    """Density-based clustering.

    A point with at least `fewest` points within `distance`, itself included, is a core. Cores within reach of each
    other form one cluster; other points belong to the cluster of their nearest core within reach.

    Args:
        places: Coordinates (point, axis).
        distance: Reach, in the unit of the coordinates.
        fewest: Minimum number of points within reach of a core.

    Returns:
        Cluster (point,) of each point, from 0; -1 for noise.

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
