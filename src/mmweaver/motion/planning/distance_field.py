"""Distance to the nearest of many points, tabulated on a grid, so that a query is an interpolation."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.shapes import Points

Array = np.ndarray
CELL_M = 0.05
FARTHEST_M = 0.4  # distances are truncated here: thicker than any limb


@dataclass(frozen=True, kw_only=True)
class DistanceField:
    """Distances in metres at the centres of cubic cells, (x, y, z); outside the grid nothing is near."""

    low_m: Float[Array, "3"]  # corner of the grid
    distance_m: Float[Array, "x y z"]
    points_m: Float[Array, "occupied 3"]  # mean of the points in each occupied cell

    def at(self, positions_m: Float[Array, "*shape 3"]) -> Float[Array, "*shape"]:
        """Distance to the nearest point by trilinear interpolation.

        Args:
            positions_m: Positions in metres, (..., 3).

        Returns:
            Metres, truncated at `FARTHEST_M`.
        """
        from scipy.ndimage import map_coordinates

        cells = np.moveaxis((positions_m - self.low_m) / CELL_M - 0.5, -1, 0)
        return np.asarray(map_coordinates(self.distance_m, cells, order=1, cval=FARTHEST_M))


def distance_field(points_m: Points, low_m: Float[Array, "3"], high_m: Float[Array, "3"]) -> DistanceField:
    """Tabulates the distance to points in a box.

    A cell's distance is that to the mean of the points in the nearest occupied cell, which is exact to a third of a
    cell; a coarse grid thus resolves surfaces finer than itself.

    Args:
        points_m: Points in metres, (point, 3).
        low_m: Lower corner of the box, metres.
        high_m: Upper corner of the box, metres.

    Returns:
        The field, in cells of 5 cm.
    """
    from scipy.ndimage import distance_transform_edt

    shape = tuple(int(n) for n in np.ceil((high_m - low_m) / CELL_M))
    cells = np.floor((points_m - low_m) / CELL_M).astype(int)
    inside = ((cells >= 0) & (cells < shape)).all(axis=1)
    flat = np.ravel_multi_index(tuple(cells[inside].T), shape)
    count = np.bincount(flat, minlength=int(np.prod(shape)))
    occupied = np.flatnonzero(count)
    if not len(occupied):
        return DistanceField(low_m=low_m, distance_m=np.full(shape, FARTHEST_M, np.float32), points_m=np.zeros((0, 3)))
    sums = [np.bincount(flat, weights=points_m[inside, axis], minlength=len(count))[occupied] for axis in range(3)]
    means_m = np.stack(sums, axis=1) / count[occupied, None]
    number = np.zeros(len(count), np.int32)
    number[occupied] = np.arange(len(occupied))
    nearest = distance_transform_edt((count == 0).reshape(shape), return_distances=False, return_indices=True)
    assert nearest is not None
    nearest_mean = number.reshape(shape)[tuple(nearest)]
    squared = np.zeros(shape, np.float32)
    for axis in range(3):
        centre = (low_m[axis] + CELL_M * (np.arange(shape[axis]) + 0.5)).astype(np.float32)
        away = means_m[:, axis].astype(np.float32)[nearest_mean]
        away -= centre.reshape([-1 if other == axis else 1 for other in range(3)])
        squared += np.square(away, out=away)
    distance_m = np.minimum(np.sqrt(squared, out=squared), np.float32(FARTHEST_M))
    return DistanceField(low_m=low_m, distance_m=distance_m, points_m=means_m)


def thinned(points_m: Points) -> Float[Array, "cell 3"]:
    """Mean of the points in each occupied cell of 5 cm.

    Args:
        points_m: Points in metres, (point, 3).

    Returns:
        One point per occupied cell, (cell, 3).
    """
    if not len(points_m):
        return points_m
    cells = np.floor(points_m / CELL_M).astype(np.int64)
    keys = (cells[:, 0] * 100_000 + cells[:, 1]) * 100_000 + cells[:, 2]
    _, cell, count = np.unique(keys, return_inverse=True, return_counts=True)
    sums = [np.bincount(cell, weights=points_m[:, axis]) for axis in range(3)]
    return np.stack(sums, axis=1) / count[:, None]


def interior(field: DistanceField) -> Bool[Array, "x y z"]:
    """Occupied cells whose four neighbours on the same level are occupied too: the inside of solid objects.

    Args:
        field: Distance field.

    Returns:
        Mask of the field's cells, (x, y, z).
    """
    from scipy.ndimage import binary_erosion

    cells = np.floor((field.points_m - field.low_m) / CELL_M).astype(int)
    occupied = np.zeros(field.distance_m.shape, bool)
    occupied[tuple(cells.T)] = True
    cross = np.zeros((3, 3, 3), bool)
    cross[:, 1, 1] = cross[1, :, 1] = True
    return np.asarray(binary_erosion(occupied, cross))
