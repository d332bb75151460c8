"""What the built-in segmenter sees of a photo: mostly geometry, for that is alike in rendered and in real rooms."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Array
from mmweaver.scene.layout.gravity_alignment import LevelRoom, level_room
from mmweaver.scene.layout.height_map import CELL_M
from mmweaver.scene.photo.depth_grid import DepthGrid, GridFloat

# Standardised colour 3; then height, slope (up . normal), 1 / depth, measured or not; how near before a wall; on a
# wall, an upright panel, a level top, a ceiling or not; and what is seen above a cell over the same place of the floor.
CHANNELS = 13
COLOURS, MEASURED, HEIGHT, SLOPE = slice(0, 3), 6, 3, 4
HEIGHT_UNIT_M = 2.5
EVERY = 2  # of the depth grid's rows and columns so many-th is looked at
_NEAR_WALL_M, _ABOVE_M, _WIDE_M = 1.0, 1.5, 0.15
_KINDS = ("wall", "panel", "top", "ceiling")

Features = Float[Array, "13 row column"]


def grid_features(grid: DepthGrid) -> Features:
    """The channels of every second cell each way; 0 where nothing was measured.

    Raises InputError where the depth shows no surfaces.
    """
    return room_features(grid, level_room(grid))


def room_features(grid: DepthGrid, room: LevelRoom) -> Features:
    """The same where the room has been turned level already."""
    level = room.grid
    height = level.points_m[..., 2] - level.floor_z_m
    geometry = [
        height / HEIGHT_UNIT_M, level.normals[..., 2], 1 / grid.depth_m, np.isfinite(grid.depth_m).astype(float),
        _near_wall(room),
    ]  # fmt: skip
    for kind in _KINDS:
        cells = [surface.cells for surface in room.surfaces if surface.plane.kind == kind]
        geometry.append(np.any(cells, axis=0).astype(float) if cells else np.zeros(height.shape))
    geometry.append(_above(level.points_m[..., 0], level.points_m[..., 1], height))
    stacked = np.concatenate([_standardised(grid.rgb), np.stack(geometry)])
    return np.nan_to_num(stacked[:, ::EVERY, ::EVERY]).astype(np.float32)


def _standardised(rgb: Float[Array, "row column 3"]) -> Float[Array, "3 row column"]:
    """Free of exposure and white balance: each colour less its mean, over the brightness' spread."""
    spread = max(float(rgb.mean(axis=2).std()), 0.05)
    return np.moveaxis((rgb - rgb.mean(axis=(0, 1))) / spread, -1, 0) / 3


def _near_wall(room: LevelRoom) -> GridFloat:
    """1 on a wall (or behind it), 0 from a metre before it on; no wall beside its ends."""
    near = np.zeros(room.grid.depth_m.shape)
    for surface in room.surfaces:
        if surface.plane.kind != "wall":
            continue
        away = room.grid.points_m - surface.plane.centre_m
        inside = np.abs(away @ surface.plane.axis_u) < surface.plane.half_size_m[0] + 0.3
        share = 1 - np.clip(np.nan_to_num(away @ surface.plane.normal, nan=9.0) / _NEAR_WALL_M, 0, 1)
        near = np.maximum(near, np.where(inside, share, 0.0))
    return near


def _above(x: GridFloat, y: GridFloat, height: GridFloat) -> GridFloat:
    """How much higher the highest point is that is seen over the same place, in shares of 1.5 m."""
    from scipy import ndimage

    known = np.isfinite(height)
    column = np.floor(np.where(known, x, 0) / CELL_M).astype(int)
    row = np.floor(np.where(known, y, 0) / CELL_M).astype(int)
    column, row = column - column[known].min(initial=0), row - row[known].min(initial=0)
    shape = (min(int(row[known].max(initial=0)) + 1, 400), min(int(column[known].max(initial=0)) + 1, 400))
    known &= (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
    top = np.full(shape, -1.0)
    np.maximum.at(top, (row[known], column[known]), np.minimum(height[known], 2.0))
    top = ndimage.maximum_filter(top, size=round(_WIDE_M / CELL_M))
    there = top[np.where(known, row, 0), np.where(known, column, 0)]
    return np.where(known, np.clip((there - height) / _ABOVE_M, 0, 1), 0.0)
