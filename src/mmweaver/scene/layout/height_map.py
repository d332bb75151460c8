"""The room from above: what stands in each square of 5 cm, and which squares the camera can judge."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.shapes import Array, DepthPixels, GridMask, PerPoint, Points, Rotation
from mmweaver.geometry.pinhole import project, unproject
from mmweaver.scene.layout.connected_patches import labelled, places
from mmweaver.scene.photo.depth_grid import depth_tolerance_m, drop_strays

CELL_M = 0.05
HALF_WIDTH_M = 3.0
LENGTH_M = 5.0
_LOWEST_M, _HEAD_M = 0.08, 1.9  # above the floor: what stands between them stops a body
_NEAREST_M = 0.3  # what seems nearer is the sensor's error, or the camera's own stand
_PICTURE_WIDTH = 640  # pixels; larger pictures are thinned to about this
_MIN_POINTS = 3  # to block a square: two flying pixels may meet
_MAX_POCKET_M2 = 0.4
SEAT_LEVELS_M = np.arange(0.26, 0.561, 0.04)
_NUM_BEARINGS = 360
_PROBE_HEIGHTS_M = np.arange(0.15, 1.8, 0.15)

GridMetres = Float[Array, "y x"]


@dataclass(frozen=True, kw_only=True)
class HeightMap:
    """Squares from above, rows along y, columns along x; heights count from the floor."""

    x_m: Float[Array, " x"]  # centres
    y_m: Float[Array, " y"]
    top_m: GridMetres  # of what stands there, up to head height; nan where nothing does
    bottom_m: GridMetres  # the lowest that is seen of it; inf where nothing stands
    is_blocked: GridMask  # something stands there, or it is enclosed by what does
    is_floor_seen: GridMask
    is_seen_through: GridMask  # lines of sight pass over it to something farther
    is_bare: Bool[Array, "level y x"]  # seen through at each of SEAT_LEVELS_M: no surface there
    is_below_picture: GridMask  # between the camera and floor seen at the picture's lower edge


def make_height_map(photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float) -> HeightMap:
    """Sorts every pixel's point into squares, and follows lines of sight through the squares where none fell."""
    step = max(1, round(photo.intrinsics.width / _PICTURE_WIDTH))
    depth = drop_strays(photo.depth_m[::step, ::step])
    intrinsics = _thinned(photo.intrinsics, step, depth.shape)
    points = unproject(depth, intrinsics)[depth > _NEAREST_M] @ radar_from_camera.T
    x_m = np.arange(-HALF_WIDTH_M, HALF_WIDTH_M - 1e-9, CELL_M) + CELL_M / 2
    y_m = np.arange(0, LENGTH_M - 1e-9, CELL_M) + CELL_M / 2
    shape = (len(y_m), len(x_m))

    height = points[:, 2] - floor_z_m
    lowest = _LOWEST_M + 0.5 * depth_tolerance_m(points[:, 1])
    stands = (height > lowest) & (height < _HEAD_M)
    lies = np.abs(height) <= lowest
    square = _squares(points, shape)
    count = np.bincount(square[stands & (square >= 0)], minlength=shape[0] * shape[1]).reshape(shape)
    floor_count = np.bincount(square[lies & (square >= 0)], minlength=shape[0] * shape[1]).reshape(shape)
    kept = stands & (square >= 0)
    seen_through, bare, below = _lines_of_sight(x_m, y_m, floor_z_m, depth, intrinsics, radar_from_camera)
    return HeightMap(
        x_m=x_m,
        y_m=y_m,
        top_m=without_gaps(_third_highest(square[kept], height[kept], shape), seen_through),
        bottom_m=-np.nan_to_num(_third_highest(square[kept], -height[kept], shape), nan=-np.inf),
        is_blocked=_without_pockets(count >= _MIN_POINTS),
        is_floor_seen=floor_count >= 2,
        is_seen_through=seen_through,
        is_bare=bare,
        is_below_picture=below,
    )


def _without_pockets(is_blocked: GridMask) -> GridMask:
    """Also blocks small places ringed by blocked squares: the seat seen edge-on within a chair, gaps in a table."""
    labels, _ = labelled(~is_blocked)
    filled = is_blocked.copy()
    for label, place in enumerate(places(labels), start=1):
        pocket = labels[place] == label
        if pocket.sum() < _MAX_POCKET_M2 / CELL_M**2:
            filled[place] |= pocket
    return filled


def without_gaps(top_m: GridMetres, seen_through: GridMask) -> GridMetres:
    """Also gives a height to squares between two of the same height, at most three squares apart.

    A camera little above a surface sees it in rows far apart. Squares that are seen through stay empty.
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
                level = np.isnan(filled) & ~seen_through & (np.abs(one - other) < 0.02)
                filled[level] = (one[level] + other[level]) / 2
    return filled


def _thinned(camera: CameraIntrinsics, step: int, shape: tuple[int, ...]) -> CameraIntrinsics:
    return CameraIntrinsics(
        fx=camera.fx / step, fy=camera.fy / step, cx=camera.cx / step, cy=camera.cy / step,
        width=shape[1], height=shape[0],
    )  # fmt: skip


def _squares(points: Points, shape: tuple[int, int]) -> Int[Array, " point"]:
    """Index of the square under each point; -1 outside the map."""
    column = np.floor((points[:, 0] + HALF_WIDTH_M) / CELL_M).astype(int)
    row = np.floor(points[:, 1] / CELL_M).astype(int)
    inside = (column >= 0) & (column < shape[1]) & (row >= 0) & (row < shape[0])
    return np.where(inside, row * shape[1] + column, -1)


def _third_highest(square: Int[Array, " point"], height: PerPoint, shape: tuple[int, int]) -> GridMetres:
    """Height that `_MIN_POINTS` points of a square reach; nan where it has fewer."""
    order = np.lexsort((-height, square))
    square, height = square[order], height[order]
    rank = np.arange(len(square)) - np.searchsorted(square, square)
    chosen = rank == _MIN_POINTS - 1
    top = np.full(shape[0] * shape[1], np.nan)
    top[square[chosen]] = height[chosen]
    return top.reshape(shape)


def _lines_of_sight(
    x_m: Float[Array, " x"],
    y_m: Float[Array, " y"],
    floor_z_m: float,
    depth: DepthPixels,
    camera: CameraIntrinsics,
    radar_from_camera: Rotation,
) -> tuple[GridMask, Bool[Array, "level y x"], GridMask]:
    """Which squares are seen through at half of the heights in view, at which seat heights they are, and which lie
    under the picture's lower edge.

    Behind a wall no height is seen through; behind a table the upper ones are.
    """
    shape = (len(y_m), len(x_m))
    in_view, passed = np.zeros(shape, int), np.zeros(shape, int)
    for height in _PROBE_HEIGHTS_M:
        inside, beyond_m = _beyond_m(x_m, y_m, floor_z_m + height, depth, camera, radar_from_camera)
        in_view += inside
        passed += beyond_m > -0.015
    bare = [_beyond_m(x_m, y_m, floor_z_m + height, depth, camera, radar_from_camera)[1] for height in SEAT_LEVELS_M]
    seen_through = (passed >= 1) & (2 * passed >= in_view)

    floor_from_m = _floor_begins_m(depth, camera, radar_from_camera, floor_z_m)
    bearing = _bearing_bin(np.arctan2(x_m[None, :], y_m[:, None]))
    below = np.hypot(x_m[None, :], y_m[:, None]) < floor_from_m[bearing]
    return seen_through, np.stack(bare) > 0.08, below & ((in_view == 0) | seen_through)


def _beyond_m(
    x_m: Float[Array, " x"],
    y_m: Float[Array, " y"],
    z_m: float,
    depth: DepthPixels,
    camera: CameraIntrinsics,
    rotation: Rotation,
) -> tuple[GridMask, GridMetres]:
    """Which squares' centres at a height are in view, and how far behind them the measured surface lies.

    The sensor's error is taken off; nan where nothing is measured.
    """
    column, row, distance = _projected(x_m, y_m, z_m, camera, rotation)
    inside = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
    measured = np.where(inside, depth[np.where(inside, row, 0), np.where(inside, column, 0)], np.nan)
    return inside, measured - distance + depth_tolerance_m(distance) - 0.015


def _projected(
    x_m: Float[Array, " x"], y_m: Float[Array, " y"], z_m: float, camera: CameraIntrinsics, rotation: Rotation
) -> tuple[Int[Array, "y x"], Int[Array, "y x"], GridMetres]:
    """Column, row (far outside the picture where behind the camera) and depth of the squares' centres at a height."""
    x, y = np.meshgrid(x_m, y_m)
    pixels, depth = project(np.stack([x.ravel(), y.ravel(), np.full(x.size, z_m)], axis=1) @ rotation, camera)
    pixels = np.clip(np.nan_to_num(np.round(pixels), nan=-1e6), -1e6, 1e6).astype(int)
    return pixels[:, 0].reshape(x.shape), pixels[:, 1].reshape(x.shape), depth.reshape(x.shape)


def _floor_begins_m(
    depth: DepthPixels, camera: CameraIntrinsics, rotation: Rotation, floor_z_m: float
) -> Float[Array, " bearing"]:
    """For each degree of bearing, from how far the floor is seen at the picture's lower edge; 0 = nowhere."""
    measured = np.isfinite(depth)
    rows = np.arange(len(depth))[:, None]
    edge_row = np.where(measured, rows, -1).max(axis=0)
    near_edge = measured & (rows > edge_row - 0.04 * camera.height)
    points = unproject(depth, camera) @ rotation.T
    on_floor = near_edge & (np.abs(points[..., 2] - floor_z_m) < _LOWEST_M)
    share = on_floor.sum(axis=0) / np.maximum(near_edge.sum(axis=0), 1)
    on_floor &= (share > 0.5) & (edge_row > 0.6 * camera.height)
    x, y = points[on_floor][:, 0], points[on_floor][:, 1]
    nearest = np.full(_NUM_BEARINGS, np.inf)
    np.minimum.at(nearest, _bearing_bin(np.arctan2(x, y)), np.hypot(x, y))
    return np.where(np.isfinite(nearest), nearest, 0.0)


def _bearing_bin(bearing_rad: Float[Array, "..."]) -> Int[Array, "..."]:
    return np.floor(np.rad2deg(bearing_rad)).astype(int) % _NUM_BEARINGS
