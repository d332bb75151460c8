"""The room from above: obstacles in each square of 5 cm, and which squares the camera has observed.

Connected components and dilation of masks.
"""

from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.pinhole import subsampled
from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import Array, GridMask, PerPoint, Points
from mmweaver.scene.photo.depth_grid import depth_tolerance_m, remove_outliers

Mask = Bool[Array, "row column"]
Labels = Int[Array, "row column"]


def label_components(mask: Mask) -> tuple[Labels, int]:
    """Labels the 4-connected components of a mask.

    Args:
        mask: Cells to label, (row, column).

    Returns:
        Labels (row, column), from 1, 0 outside the mask; and the number of components.
    """
    from scipy import ndimage

    labels, count = cast(tuple[np.ndarray, int], ndimage.label(mask))
    return labels, int(count)


def label_by_distance(
    mask: Mask, points_m: Float[Array, "row column 3"], reach_m: Float[Array, "row column"]
) -> tuple[Labels, int]:
    """Labels components of cells that are close both in the grid and in space.

    Args:
        mask: Cells to label, (row, column).
        points_m: Position of each cell in metres, (row, column, 3).
        reach_m: Largest distance in metres to a neighbour one cell away, (row, column); twice that for two cells.

    Returns:
        Labels (row, column), from 1, 0 outside the mask; and the number of components.
    """
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
    """Rows and columns spanned by each labelled component, in the order of the labels."""
    from scipy import ndimage

    return cast(list[tuple[slice, slice]], ndimage.find_objects(labels))


def dilated(mask: Mask, steps: int = 1) -> Mask:
    """Dilates a mask along rows and columns; ten times faster than scipy on the small masks used here.

    Args:
        mask: Cells, (row, column).
        steps: Number of dilations by one cell.

    Returns:
        The dilated mask, (row, column).
    """
    grown = mask.copy()
    for _ in range(steps):
        before = grown.copy()
        grown[1:] |= before[:-1]
        grown[:-1] |= before[1:]
        grown[:, 1:] |= before[:, :-1]
        grown[:, :-1] |= before[:, 1:]
    return grown


CELL_M = 0.05
HALF_WIDTH_M = 3.0
LENGTH_M = 5.0
_MIN_OBSTACLE_M, _HEAD_M = 0.08, 1.9  # above the floor: what lies between these heights obstructs a body
_MIN_DEPTH_M = 0.3  # nearer measurements are sensor errors or the camera's own stand
_PICTURE_WIDTH = 640  # pixels; larger pictures are subsampled to about this width
_MIN_POINTS = 3  # to occupy a square: two flying pixels may coincide
_MAX_POCKET_M2 = 0.4
SEAT_LEVELS_M = np.arange(0.26, 0.561, 0.04)
_NUM_BEARINGS = 360
_PROBE_HEIGHTS_M = np.arange(0.15, 1.8, 0.15)

GridMetres = Float[Array, "y x"]


@dataclass(frozen=True, kw_only=True)
class HeightMap:
    """A map of squares seen from above: rows along y, columns along x, radar's frame; heights above the floor, in m."""

    x_m: Float[Array, " x"]  # centres of the columns
    y_m: Float[Array, " y"]  # centres of the rows
    floor_z_m: float  # of the floor in the radar's frame
    top_m: GridMetres  # highest measured point up to head height; nan where nothing stands
    bottom_m: GridMetres  # lowest measured point of it; inf where nothing stands
    is_blocked: GridMask  # something stands there, or the square is enclosed by what does
    is_floor_seen: GridMask
    is_seen_through: GridMask  # lines of sight pass above the square to something farther
    is_clear_at: Bool[Array, "level y x"]  # lines of sight pass at each of SEAT_LEVELS_M: no surface there
    is_below_picture: GridMask  # between the camera and the floor seen at the picture's lower edge


def grid_axes() -> tuple[Float[Array, " x"], Float[Array, " y"]]:
    """Centres of the map's columns (x, -3 to 3 m) and rows (y, 0 to 5 m), in metres."""
    x_m = np.arange(-HALF_WIDTH_M, HALF_WIDTH_M - 1e-9, CELL_M) + CELL_M / 2
    y_m = np.arange(0, LENGTH_M - 1e-9, CELL_M) + CELL_M / 2
    return x_m, y_m


def square_index(points_m: Points, shape: tuple[int, int]) -> Int[Array, " point"]:
    """Flat index of the square below each point.

    Args:
        points_m: Points in the radar's frame, metres, (point, 3).
        shape: Shape of the map, (y, x).

    Returns:
        Index (point,); -1 outside the map.
    """
    column = np.floor((points_m[:, 0] + HALF_WIDTH_M) / CELL_M).astype(int)
    row = np.floor(points_m[:, 1] / CELL_M).astype(int)
    inside = (column >= 0) & (column < shape[1]) & (row >= 0) & (row < shape[0])
    return np.where(inside, row * shape[1] + column, -1)


def nearest_squares(
    x: Float[Array, "*places"], y: Float[Array, "*places"], x_m: Float[Array, " x"], y_m: Float[Array, " y"]
) -> tuple[Int[Array, "*places"], Int[Array, "*places"], Bool[Array, "*places"]]:
    """Rows and columns of the squares that contain the given places.

    Args:
        x: Coordinates of the places in metres, any shape.
        y: Coordinates of the places in metres, same shape.
        x_m: Centres of the map's columns, metres.
        y_m: Centres of the map's rows, metres.

    Returns:
        Row, column (0 outside the map), and whether the place is inside the map; all of the places' shape.
    """
    column = np.floor((x - x_m[0]) / CELL_M + 0.5).astype(int)
    row = np.floor((y - y_m[0]) / CELL_M + 0.5).astype(int)
    inside = (row >= 0) & (row < len(y_m)) & (column >= 0) & (column < len(x_m))
    return np.where(inside, row, 0), np.where(inside, column, 0), inside


def make_height_map(view: AlignedPhoto) -> HeightMap:
    """Bins the measured points into squares and traces lines of sight through the squares without points.

    Args:
        view: The photo in the radar's frame.

    Returns:
        The room from above, in squares of 5 cm, 6 m wide and 5 m long.
    """
    view = _subsampled(view)
    points_m = view.points_m[view.photo.depth_m > _MIN_DEPTH_M]
    x_m, y_m = grid_axes()
    shape = (len(y_m), len(x_m))

    height_m = points_m[:, 2] - view.floor_z_m
    lowest_m = _MIN_OBSTACLE_M + 0.5 * depth_tolerance_m(points_m[:, 1])
    square = square_index(points_m, shape)
    is_obstacle = (height_m > lowest_m) & (height_m < _HEAD_M) & (square >= 0)
    is_floor = (np.abs(height_m) <= lowest_m) & (square >= 0)
    num_squares = shape[0] * shape[1]
    obstacle_points = np.bincount(square[is_obstacle], minlength=num_squares).reshape(shape)
    floor_points = np.bincount(square[is_floor], minlength=num_squares).reshape(shape)
    seen_through, clear_at, below_picture = _lines_of_sight(x_m, y_m, view)
    top_m = _third_highest(square[is_obstacle], height_m[is_obstacle], shape)
    bottom_m = -np.nan_to_num(_third_highest(square[is_obstacle], -height_m[is_obstacle], shape), nan=-np.inf)
    return HeightMap(
        x_m=x_m,
        y_m=y_m,
        floor_z_m=view.floor_z_m,
        top_m=_fill_gaps(top_m, seen_through),
        bottom_m=bottom_m,
        is_blocked=_fill_pockets(obstacle_points >= _MIN_POINTS),
        is_floor_seen=floor_points >= 2,
        is_seen_through=seen_through,
        is_clear_at=clear_at,
        is_below_picture=below_picture,
    )


def _subsampled(view: AlignedPhoto) -> AlignedPhoto:
    """The photo at about `_PICTURE_WIDTH` columns, without outliers of the depth."""
    photo = view.photo
    step = max(1, round(photo.intrinsics.width / _PICTURE_WIDTH))
    every = (slice(None, None, step), slice(None, None, step))
    thinned = RgbdPhoto(
        rgb=photo.rgb[every],
        depth_m=remove_outliers(photo.depth_m[every]),
        intrinsics=subsampled(photo.intrinsics, step),
    )
    return replace(view, photo=thinned)


def _fill_pockets(is_blocked: GridMask) -> GridMask:
    """Also blocks small regions enclosed by blocked squares: a seat seen edge-on within a chair, gaps in a table."""
    labels, _ = label_components(~is_blocked)
    filled = is_blocked.copy()
    for label, region in enumerate(bounding_slices(labels), start=1):
        pocket = labels[region] == label
        if pocket.sum() < _MAX_POCKET_M2 / CELL_M**2:
            filled[region] |= pocket
    return filled


def _fill_gaps(top_m: GridMetres, seen_through: GridMask) -> GridMetres:
    """Fills squares between two of the same height that are at most three squares apart.

    A camera just above a surface samples it in rows far apart. Squares that are seen through stay empty.
    """
    reach = 3
    padded = np.pad(top_m, reach, constant_values=np.nan)
    rows, columns = top_m.shape

    def shifted(row: int, column: int) -> GridMetres:
        return padded[reach + row : reach + row + rows, reach + column : reach + column + columns]

    filled = top_m.copy()
    for row, column in ((0, 1), (1, 0), (1, 1), (1, -1)):
        for before in range(1, reach):
            for after in range(1, reach + 1 - before):
                one, other = shifted(-before * row, -before * column), shifted(after * row, after * column)
                same_height = np.isnan(filled) & ~seen_through & (np.abs(one - other) < 0.02)
                filled[same_height] = (one[same_height] + other[same_height]) / 2
    return filled


def _third_highest(square: Int[Array, " point"], height_m: PerPoint, shape: tuple[int, int]) -> GridMetres:
    """The height that `_MIN_POINTS` points of a square reach; nan where it has fewer."""
    order = np.lexsort((-height_m, square))
    square, height_m = square[order], height_m[order]
    rank = np.arange(len(square)) - np.searchsorted(square, square)
    chosen = rank == _MIN_POINTS - 1
    top = np.full(shape[0] * shape[1], np.nan)
    top[square[chosen]] = height_m[chosen]
    return top.reshape(shape)


def _lines_of_sight(
    x_m: Float[Array, " x"], y_m: Float[Array, " y"], view: AlignedPhoto
) -> tuple[GridMask, Bool[Array, "level y x"], GridMask]:
    """Lines of sight through the squares of the map.

    Returns three masks: squares seen through at half of the heights in view, squares clear at each seat height, and
    squares below the picture's lower edge. Behind a wall no height is seen through; behind a table the upper ones are.
    """
    shape = (len(y_m), len(x_m))
    num_in_view, num_passed = np.zeros(shape, int), np.zeros(shape, int)
    for height_m in _PROBE_HEIGHTS_M:
        in_view, behind_m = surface_behind_m(x_m, y_m, height_m, view)
        num_in_view += in_view
        num_passed += behind_m > -0.015
    clear_at = [surface_behind_m(x_m, y_m, height_m, view)[1] > 0.08 for height_m in SEAT_LEVELS_M]
    seen_through = (num_passed >= 1) & (2 * num_passed >= num_in_view)

    first_floor_m = _first_visible_floor_m(view)
    bearing = _bearing_bin(np.arctan2(x_m[None, :], y_m[:, None]))
    below = np.hypot(x_m[None, :], y_m[:, None]) < first_floor_m[bearing]
    return seen_through, np.stack(clear_at), below & ((num_in_view == 0) | seen_through)


def surface_behind_m(
    x_m: Float[Array, " x"], y_m: Float[Array, " y"], height_m: float, view: AlignedPhoto
) -> tuple[GridMask, GridMetres]:
    """How far behind a square the measured surface lies, at one height.

    Args:
        x_m: Centres of the map's columns, metres.
        y_m: Centres of the map's rows, metres.
        height_m: Height above the floor in metres.
        view: The photo in the radar's frame.

    Returns:
        Whether each square is in view, (y, x); and the depth of the measurement minus that of the square, corrected for
        the sensor's error, in metres, (y, x), nan where nothing is measured.
    """
    x, y = np.meshgrid(x_m, y_m)
    seen = view.look_up(np.stack([x, y, np.full(x.shape, view.floor_z_m + height_m)], axis=-1))
    measured_m = np.where(seen.in_picture, view.photo.depth_m[seen.row, seen.column], np.nan)
    return seen.in_picture, measured_m - seen.depth_m + depth_tolerance_m(seen.depth_m) - 0.015


def _first_visible_floor_m(view: AlignedPhoto) -> Float[Array, " bearing"]:
    """For each degree of bearing, the ground distance of the floor at the picture's lower edge; 0 where none is."""
    measured = np.isfinite(view.photo.depth_m)
    rows = np.arange(len(measured))[:, None]
    edge_row = np.where(measured, rows, -1).max(axis=0)
    num_rows = view.photo.intrinsics.height
    near_edge = measured & (rows > edge_row - 0.04 * num_rows)
    on_floor = near_edge & (np.abs(view.points_m[..., 2] - view.floor_z_m) < _MIN_OBSTACLE_M)
    share = on_floor.sum(axis=0) / np.maximum(near_edge.sum(axis=0), 1)
    on_floor &= (share > 0.5) & (edge_row > 0.6 * num_rows)
    x, y = view.points_m[on_floor][:, 0], view.points_m[on_floor][:, 1]
    nearest = np.full(_NUM_BEARINGS, np.inf)
    np.minimum.at(nearest, _bearing_bin(np.arctan2(x, y)), np.hypot(x, y))
    return np.where(np.isfinite(nearest), nearest, 0.0)


def _bearing_bin(bearing_rad: Float[Array, "..."]) -> Int[Array, "..."]:
    """Index of the degree of bearing, 0 to 359, any shape."""
    return np.floor(np.rad2deg(bearing_rad)).astype(int) % _NUM_BEARINGS
