"""Connected patches of a mask."""

from typing import cast

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.shapes import Array


def labelled(mask: Bool[Array, "row column"]) -> tuple[Int[Array, "row column"], int]:
    """Numbers the patches of cells that touch by their sides from 1; 0 elsewhere. Also gives how many there are."""
    from scipy import ndimage

    labels, count = cast(tuple[np.ndarray, int], ndimage.label(mask))
    return labels, int(count)


def linked(
    cells: Bool[Array, "row column"], points: Float[Array, "row column 3"], reach_m: Float[Array, "row column"]
) -> tuple[Int[Array, "row column"], int]:
    """Numbers the patches of cells, up to two cells apart in the grid, that lie within each one's reach in space."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    index = np.arange(cells.size).reshape(cells.shape)
    starts, ends = [], []
    for row, column in ((0, 1), (1, 0), (0, 2), (2, 0), (1, 1)):
        here = (slice(0, cells.shape[0] - row), slice(0, cells.shape[1] - column))
        there = (slice(row, None), slice(column, None))
        both = cells[here] & cells[there]
        distance = np.linalg.norm(points[there] - points[here], axis=-1)
        joined = both & (distance < reach_m[here] * max(row, column))
        starts.append(index[here][joined])
        ends.append(index[there][joined])
    start, end = np.concatenate(starts), np.concatenate(ends)
    graph = coo_array((np.ones(len(start)), (start, end)), shape=(cells.size, cells.size))
    _, label = connected_components(graph, directed=False)
    _, compact = np.unique(label[cells.ravel()], return_inverse=True)
    labels = np.zeros(cells.shape, int)
    labels[cells] = compact + 1
    return labels, int(compact.max(initial=-1)) + 1


def places(labels: Int[Array, "row column"]) -> list[tuple[slice, slice]]:
    """The rows and columns that each numbered patch spans."""
    from scipy import ndimage

    return cast(list[tuple[slice, slice]], ndimage.find_objects(labels))


def grown(mask: Bool[Array, "row column"], steps: int = 1) -> Bool[Array, "row column"]:
    """The mask and the cells within so many steps of it."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_dilation(mask, iterations=steps), bool)
