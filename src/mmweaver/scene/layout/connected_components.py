"""Connected components and dilation of masks."""

from typing import cast

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.shapes import Array

Mask = Bool[Array, "row column"]
Labels = Int[Array, "row column"]


def label_components(mask: Mask) -> tuple[Labels, int]:
    """Numbers the 4-connected components of a mask from 1, 0 elsewhere; also returns their count."""
    from scipy import ndimage

    labels, count = cast(tuple[np.ndarray, int], ndimage.label(mask))
    return labels, int(count)


def label_by_distance(
    mask: Mask, points_m: Float[Array, "row column 3"], reach_m: Float[Array, "row column"]
) -> tuple[Labels, int]:
    """Numbers the components of cells that are at most two cells apart in the grid and within `reach_m` in space."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    index = np.arange(mask.size).reshape(mask.shape)
    starts, ends = [], []
    for row, column in ((0, 1), (1, 0), (0, 2), (2, 0), (1, 1)):
        here = (slice(0, mask.shape[0] - row), slice(0, mask.shape[1] - column))
        there = (slice(row, None), slice(column, None))
        both = mask[here] & mask[there]
        distance_m = np.linalg.norm(points_m[there] - points_m[here], axis=-1)
        joined = both & (distance_m < reach_m[here] * max(row, column))
        starts.append(index[here][joined])
        ends.append(index[there][joined])
    start, end = np.concatenate(starts), np.concatenate(ends)
    graph = coo_array((np.ones(len(start)), (start, end)), shape=(mask.size, mask.size))
    _, label = connected_components(graph, directed=False)
    _, compact = np.unique(label[mask.ravel()], return_inverse=True)
    labels = np.zeros(mask.shape, int)
    labels[mask] = compact + 1
    return labels, int(compact.max(initial=-1)) + 1


def bounding_slices(labels: Labels) -> list[tuple[slice, slice]]:
    """The rows and columns that each numbered component spans."""
    from scipy import ndimage

    return cast(list[tuple[slice, slice]], ndimage.find_objects(labels))


def dilated(mask: Mask, steps: int = 1) -> Mask:
    """The mask and the cells within `steps` of it, along rows and columns.

    scipy's costs ten times as much on the small masks here.
    """
    grown = mask.copy()
    for _ in range(steps):
        before = grown.copy()
        grown[1:] |= before[:-1]
        grown[:-1] |= before[1:]
        grown[:, 1:] |= before[:, :-1]
        grown[:, :-1] |= before[:, 1:]
    return grown
