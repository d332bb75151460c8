"""The room from above: what stands in each square of 5 cm, and which squares the camera can judge."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.shapes import Array, DepthPixels, GridMask, PerPoint, Points, Rotation
from mmweaver.geometry.pinhole import project, unproject
from mmweaver.scene.depth_grid import depth_tolerance_m, drop_strays

CELL_M = 0.05
HALF_WIDTH_M = 3.0
LENGTH_M = 5.0
_LOWEST_M, _HEAD_M = 0.08, 1.9  # above the floor: what stands between them stops a body
_PICTURE_WIDTH = 640  # pixels; larger pictures are thinned to about this
_MIN_POINTS = 3  # to block a square: two flying pixels may meet
_PROBE_HEIGHTS_M = np.arange(0.15, 1.8, 0.15)

GridMetres = Float[Array, "y x"]


@dataclass(frozen=True, kw_only=True)
class HeightMap:
    """Squares from above, rows along y, columns along x; heights count from the floor."""

    x_m: Float[Array, " x"]  # centres
    y_m: Float[Array, " y"]
    top_m: GridMetres  # of what stands there, up to head height; nan where nothing does
    is_blocked: GridMask
    is_floor_seen: GridMask
    is_seen_through: GridMask  # lines of sight pass over it to something farther
    is_below_picture: GridMask  # between the camera and floor seen at the picture's lower edge


def make_height_map(photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float) -> HeightMap:
    """Sorts every pixel's point into squares, and follows lines of sight through the squares where none fell."""
    step = max(1, round(photo.intrinsics.width / _PICTURE_WIDTH))
    depth = drop_strays(photo.depth_m[::step, ::step])
    intrinsics = _thinned(photo.intrinsics, step, depth.shape)
    points = unproject(depth, intrinsics)[np.isfinite(depth)] @ radar_from_camera.T
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
    seen_through, below = _lines_of_sight(x_m, y_m, floor_z_m, depth, intrinsics, radar_from_camera)
    return HeightMap(
        x_m=x_m,
        y_m=y_m,
        top_m=_third_highest(square[kept], height[kept], shape),
        is_blocked=count >= _MIN_POINTS,
        is_floor_seen=floor_count >= 2,
        is_seen_through=seen_through,
        is_below_picture=below,
    )


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
) -> tuple[GridMask, GridMask]:
    """Which squares are seen through at half of the heights in view, and which lie under the picture's lower edge.

    Behind a wall no height is seen through; behind a table the upper ones are.
    """
    shape = (len(y_m), len(x_m))
    in_view, passed = np.zeros(shape, int), np.zeros(shape, int)
    for height in _PROBE_HEIGHTS_M:
        column, row, distance = _projected(x_m, y_m, floor_z_m + height, camera, radar_from_camera)
        inside = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
        measured = np.where(inside, depth[np.where(inside, row, 0), np.where(inside, column, 0)], np.nan)
        in_view += inside
        passed += measured > distance - depth_tolerance_m(distance)
    seen_through = (passed >= 1) & (2 * passed >= in_view)

    column, row, _ = _projected(x_m, y_m, floor_z_m, camera, radar_from_camera)
    edge_row, edge_is_floor = _lower_edge(depth, camera, radar_from_camera, floor_z_m)
    across = (column >= 0) & (column < camera.width)
    safe = np.where(across, column, 0)
    below = across & (row > edge_row[safe]) & edge_is_floor[safe]
    return seen_through, below & ((in_view == 0) | seen_through)


def _projected(
    x_m: Float[Array, " x"], y_m: Float[Array, " y"], z_m: float, camera: CameraIntrinsics, rotation: Rotation
) -> tuple[Int[Array, "y x"], Int[Array, "y x"], GridMetres]:
    """Column, row (far outside the picture where behind the camera) and depth of the squares' centres at a height."""
    x, y = np.meshgrid(x_m, y_m)
    pixels, depth = project(np.stack([x.ravel(), y.ravel(), np.full(x.size, z_m)], axis=1) @ rotation, camera)
    pixels = np.clip(np.nan_to_num(np.round(pixels), nan=-1e6), -1e6, 1e6).astype(int)
    return pixels[:, 0].reshape(x.shape), pixels[:, 1].reshape(x.shape), depth.reshape(x.shape)


def _lower_edge(
    depth: DepthPixels, camera: CameraIntrinsics, rotation: Rotation, floor_z_m: float
) -> tuple[Int[Array, " column"], GridMask]:
    """For each picture column its lowest measured row, and whether the floor is seen there."""
    measured = np.isfinite(depth)
    rows = np.arange(len(depth))[:, None]
    edge_row = np.where(measured, rows, -1).max(axis=0)
    points = unproject(depth, camera) @ rotation[2]
    near_edge = measured & (rows > edge_row - 0.04 * camera.height)
    on_floor = near_edge & (np.abs(points - floor_z_m) < _LOWEST_M)
    share = on_floor.sum(axis=0) / np.maximum(near_edge.sum(axis=0), 1)
    return edge_row, (share > 0.5) & (edge_row > 0.6 * camera.height)
