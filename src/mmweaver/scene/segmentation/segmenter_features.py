"""Input features of the built-in segmenter: mostly geometry, which is similar in rendered and in real rooms."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Array
from mmweaver.scene.layout.gravity import AlignedRoom, align_room
from mmweaver.scene.layout.height_map import CELL_M
from mmweaver.scene.photo.depth_grid import DepthGrid, GridFloat

# Standardised colour (3), height, slope (up . normal), 1 / depth, whether measured, proximity to a wall, membership of
# a wall, a vertical panel, a horizontal top, a ceiling, and the height of what is above the same floor square.
CHANNELS = 13
COLOURS, MEASURED, HEIGHT, SLOPE = slice(0, 3), 6, 3, 4
HEIGHT_UNIT_M = 2.5
STRIDE = 2  # of the depth grid's rows and columns
_NEAR_WALL_M, _ABOVE_M, _WIDTH_M = 1.0, 1.5, 0.15
_KINDS = ("wall", "panel", "top", "ceiling")

Features = Float[Array, "13 row column"]


def grid_features(grid: DepthGrid) -> Features:
    """Features of every second row and column of a depth grid.

    Args:
        grid: Depth grid of a photo.

    Returns:
        The 13 channels, float32, (13, row, column); 0 where nothing was measured.

    Raises:
        InputError: If the depth shows no surfaces.
    """
    return room_features(grid, align_room(grid))


def room_features(grid: DepthGrid, room: AlignedRoom) -> Features:
    """Features of a grid that is already aligned.

    Args:
        grid: Depth grid of a photo.
        room: Result of `gravity.align_room` for this grid.

    Returns:
        The 13 channels, float32, (13, row, column).
    """
    aligned = room.grid
    height = aligned.points_m[..., 2] - aligned.floor_z_m
    geometry = [
        height / HEIGHT_UNIT_M,
        aligned.normals[..., 2],
        1 / grid.depth_m,
        np.isfinite(grid.depth_m).astype(float),
        _wall_proximity(room),
    ]
    for kind in _KINDS:
        cells = [surface.cells for surface in room.surfaces if surface.plane.kind == kind]
        geometry.append(np.any(cells, axis=0).astype(float) if cells else np.zeros(height.shape))
    geometry.append(_height_above(aligned.points_m[..., 0], aligned.points_m[..., 1], height))
    stacked = np.concatenate([_standardised(grid.rgb), np.stack(geometry)])
    return np.nan_to_num(stacked[:, ::STRIDE, ::STRIDE]).astype(np.float32)


def _standardised(rgb: Float[Array, "row column 3"]) -> Float[Array, "3 row column"]:
    """Colours normalized for exposure and white balance: minus their mean, over the brightness' standard deviation."""
    spread = max(float(rgb.mean(axis=2).std()), 0.05)
    return np.moveaxis((rgb - rgb.mean(axis=(0, 1))) / spread, -1, 0) / 3


def _wall_proximity(room: AlignedRoom) -> GridFloat:
    """Proximity to a wall: 1 on or behind it, 0 from a metre in front of it; 0 beyond its ends."""
    near = np.zeros(room.grid.depth_m.shape)
    for surface in room.surfaces:
        if surface.plane.kind != "wall":
            continue
        offset = room.grid.points_m - surface.plane.centre_m
        inside = np.abs(offset @ surface.plane.axis_u) < surface.plane.half_size_m[0] + 0.3
        share = 1 - np.clip(np.nan_to_num(offset @ surface.plane.normal, nan=9.0) / _NEAR_WALL_M, 0, 1)
        near = np.maximum(near, np.where(inside, share, 0.0))
    return near


def _height_above(x: GridFloat, y: GridFloat, height: GridFloat) -> GridFloat:
    """Height of the highest point over the same place, above the cell, 0 to 1 in units of 1.5 m."""
    from scipy import ndimage

    known = np.isfinite(height)
    column = np.floor(np.where(known, x, 0) / CELL_M).astype(int)
    row = np.floor(np.where(known, y, 0) / CELL_M).astype(int)
    column, row = column - column[known].min(initial=0), row - row[known].min(initial=0)
    shape = (min(int(row[known].max(initial=0)) + 1, 400), min(int(column[known].max(initial=0)) + 1, 400))
    known &= (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
    top = np.full(shape, -1.0)
    np.maximum.at(top, (row[known], column[known]), np.minimum(height[known], 2.0))
    top = ndimage.maximum_filter(top, size=round(_WIDTH_M / CELL_M))
    there = top[np.where(known, row, 0), np.where(known, column, 0)]
    return np.where(known, np.clip((there - height) / _ABOVE_M, 0, 1), 0.0)
