"""Gravity direction and camera height from a depth grid, and the grid aligned with them.

The upward direction is the floor's normal, refined by the walls.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError
from mmweaver.core.rotations import level_from_camera
from mmweaver.core.shapes import Array, PerPoint, Points, Rotation, Vec3
from mmweaver.scene.layout.surfaces import AlignedGrid, Surface, find_surfaces, floor_cells
from mmweaver.scene.photo.depth_grid import DepthGrid, GridBool, depth_tolerance_m

Normals = Float[Array, "normal 3"]

_MAX_TILT_RAD = np.deg2rad(55)
_HORIZONTAL = np.cos(np.deg2rad(12))  # cosine between up and the normal of a horizontal surface, at least
_VERTICAL = np.sin(np.deg2rad(8))  # the same of a vertical surface, at most
_MAX_WALL_LEAN = np.sin(np.deg2rad(9))  # walls that lean more are ignored
_MIN_CAMERA_HEIGHT_M = 0.25
_DEFAULT_CAMERA_HEIGHT_M = 1.2
_MIN_FLOOR_CELLS = 60
_HEIGHT_BIN_M = 0.02


@dataclass(frozen=True, kw_only=True)
class Gravity:
    """The gravity direction in the camera frame and the floor's height."""

    up_camera: Vec3  # unit vector against gravity
    floor_z_m: float  # relative to the camera, so negative
    has_floor: bool  # whether the floor is visible
    assumptions: tuple[str, ...]


def find_gravity(grid: DepthGrid) -> Gravity:
    """Finds the floor: the lowest large horizontal surface, perpendicular to the vertical ones.

    Where no floor is visible, up follows from the walls, else from the assumption of a level camera, and the camera
    height is assumed.

    Args:
        grid: Depth grid in the camera frame.

    Returns:
        Up and floor height; `assumptions` reports what was not measured.

    Raises:
        InputError: If the depth shows no surfaces.
    """
    usable = np.isfinite(grid.normals).all(axis=2) & np.isfinite(grid.depth_m)
    points, normals = grid.points_m[usable], grid.normals[usable]
    if len(points) < 2 * _MIN_FLOOR_CELLS:
        raise InputError("the depth picture shows no surfaces, only scattered points; give a depth picture of a room")
    up = _up_direction(normals)
    if up is not None:
        found = _floor(points, normals, up)
        if found is not None:
            return Gravity(up_camera=found[0], floor_z_m=found[1], has_floor=True, assumptions=())
    return _assumed_gravity(points, normals, up)


def refined_by_walls(gravity: Gravity, grid: DepthGrid, floor: GridBool, walls: Sequence[GridBool]) -> Gravity:
    """Gravity as the least-squares compromise of the floor's normal and the walls', which must be vertical.

    Each surface is weighted by its extent over the sensor's error. That error is systematic over a surface (a dark or
    shiny floor appears deeper to a time-of-flight camera), so the number of cells does not reduce it.

    Args:
        gravity: First estimate, from the floor.
        grid: Depth grid in the camera frame.
        floor: Cells of the floor, (row, column).
        walls: Cells of each wall, (row, column); walls that lean by more than 9 degrees are ignored.

    Returns:
        The refined gravity; unchanged where too little of the floor is visible.
    """
    if not gravity.has_floor or floor.sum() < _MIN_FLOOR_CELLS:
        return gravity
    scatter = np.zeros((3, 3))
    for cells in walls:
        points = grid.points_m[cells]
        _, vectors = np.linalg.eigh(np.cov(points.T))
        normal = vectors[:, 0]
        if abs(normal @ gravity.up_camera) < _MAX_WALL_LEAN:
            scatter += np.outer(normal, normal) * np.square(np.std(points @ gravity.up_camera) / _error_m(points))
    points = grid.points_m[floor]
    values, vectors = np.linalg.eigh(np.cov(points.T))
    for value, along in zip(values[1:], vectors.T[1:], strict=True):
        scatter += np.outer(along, along) * value / np.square(_error_m(points))
    _, vectors = np.linalg.eigh(scatter)
    up = vectors[:, 0] * np.sign(vectors[:, 0] @ gravity.up_camera)
    return replace(gravity, up_camera=up, floor_z_m=float(np.median(points @ up)))


def _error_m(points: Points) -> float:
    """The sensor's typical error at points of the camera frame."""
    return float(np.median(depth_tolerance_m(points[:, 2])))


def _up_direction(normals: Points) -> Vec3 | None:
    """The direction, near the camera's up, to which most surfaces are horizontal or vertical.

    Returns None if no surface is horizontal.
    """
    tilt_cosine = -normals[:, 1]
    candidates = normals[tilt_cosine > np.cos(_MAX_TILT_RAD)]
    if len(candidates) < _MIN_FLOOR_CELLS:
        return None
    hypotheses = candidates[np.linspace(0, len(candidates) - 1, min(150, len(candidates))).astype(int)]
    alignment = hypotheses @ normals.T
    horizontal = np.count_nonzero(alignment > _HORIZONTAL, axis=1)
    vertical = np.count_nonzero(np.abs(alignment, out=alignment) < _VERTICAL, axis=1)
    # Walls distinguish a horizontal surface from a sloped one, to which few others are perpendicular.
    best = hypotheses[np.argmax(np.minimum(horizontal, len(normals) // 4) + 0.7 * vertical)]
    for _ in range(4):
        alignment = normals @ best
        best = _fitted_up(normals[alignment > _HORIZONTAL], normals[np.abs(alignment) < _VERTICAL], best)
    return best


def _fitted_up(horizontal: Normals, vertical: Float[Array, "other 3"], near: Vec3) -> Vec3:
    """The unit vector parallel to horizontal surfaces' normals and perpendicular to vertical ones', least squares."""
    _, vectors = np.linalg.eigh(vertical.T @ vertical - horizontal.T @ horizontal)
    up = vectors[:, 0]
    return up if up @ near > 0 else -up


def _floor(points: Points, normals: Points, up: Vec3) -> tuple[Vec3, float] | None:
    """The plane of the lowest horizontal surface of sufficient size: its normal and its height in metres."""
    height = points @ up
    tolerance = depth_tolerance_m(points[:, 2])
    facing_up = (normals @ up > _HORIZONTAL) & (height < -_MIN_CAMERA_HEIGHT_M)
    area = np.square(points[:, 2])  # a cell covers an area that grows with its depth squared
    for peak_m in _height_peaks_m(height[facing_up], area[facing_up]):
        chosen = facing_up & (np.abs(height - peak_m) < tolerance + 0.04)
        share_below = (height < peak_m - 3 * tolerance - 0.10).mean()
        if chosen.sum() < _MIN_FLOOR_CELLS or share_below > 0.06:
            continue
        fitted = _fitted_plane(points, chosen, up)
        if fitted is not None:
            return fitted
    return None


def _height_peaks_m(height: PerPoint, area: PerPoint) -> Float[Array, " peak"]:
    """Heights, lowest first, at which the histogram of horizontal area has a peak."""
    if len(height) == 0:
        return np.zeros(0)
    edges = np.arange(height.min() - 0.1, 0.1, _HEIGHT_BIN_M)
    binned = np.convolve(np.histogram(height, edges, weights=area)[0], np.ones(4), mode="same")
    count = np.convolve(np.histogram(height, edges)[0], np.ones(4), mode="same")
    padded = np.pad(binned, 4)
    local_maximum = np.max([padded[shift : shift + len(binned)] for shift in range(9)], axis=0)
    is_peak = (binned == local_maximum) & (binned > 0.04 * binned.max()) & (count > _MIN_FLOOR_CELLS / 2)
    return edges[:-1][is_peak] + _HEIGHT_BIN_M / 2


def _fitted_plane(points: Points, chosen: Bool[Array, " point"], up: Vec3) -> tuple[Vec3, float] | None:
    """Weighted least-squares plane, re-fitted to its inliers: normal and offset; None where it leaves `up` or them.

    Where the visible floor is small, its normal stays `up`.
    """
    normal, offset = up, float(np.median(points[chosen] @ up))
    tolerance = depth_tolerance_m(points[:, 2])
    for _ in range(4):
        weight = 1 / np.square(tolerance[chosen])
        centre = np.average(points[chosen], axis=0, weights=weight)
        spread = (points[chosen] - centre) * np.sqrt(weight)[:, None]
        values, vectors = np.linalg.eigh(spread.T @ spread)
        extent_m = np.sqrt(values[1] / weight.sum())
        if extent_m > 0.15:
            normal = vectors[:, 0] * np.sign(vectors[:, 0] @ up)
        offset = float(centre @ normal)
        chosen = np.abs(points @ normal - offset) < tolerance
        if normal @ up < np.cos(np.deg2rad(6)) or chosen.sum() < _MIN_FLOOR_CELLS:
            return None
    return normal, offset


def _assumed_gravity(points: Points, normals: Points, up: Vec3 | None) -> Gravity:
    """Up from horizontal or vertical surfaces, else from a level camera; the floor just below all points."""
    sentences = ["No floor is visible."]
    if up is None:
        up = _up_direction(-normals)  # a ceiling is as horizontal as a floor
    if up is None:
        up = np.array([0.0, -1.0, 0.0])
        walls = normals[np.abs(normals @ up) < np.sin(np.deg2rad(25))]
        if len(walls) >= 4 * _MIN_FLOOR_CELLS:
            # The level camera is a weak prior: a single wall leaves the rotation about its normal open.
            up = _fitted_up(np.tile(up * np.sqrt(0.02 * len(walls)), (1, 1)), walls, up)
            sentences.append("The gravity direction was estimated from the walls.")
        else:
            sentences.append("The camera was assumed to be level.")
    else:
        sentences.append("The gravity direction was estimated from horizontal and vertical surfaces.")
    lowest_m = float(np.percentile(points @ up, 0.5))
    floor_z_m = min(-_DEFAULT_CAMERA_HEIGHT_M, lowest_m)
    sentences.append(f"The floor was assumed {-floor_z_m:.2f} m below the camera.")
    return Gravity(up_camera=up, floor_z_m=floor_z_m, has_floor=False, assumptions=(" ".join(sentences),))


@dataclass(frozen=True, kw_only=True)
class AlignedRoom:
    """A depth grid in the radar's frame and its planar surfaces, the floor excepted."""

    gravity: Gravity
    radar_from_camera: Rotation
    grid: AlignedGrid
    surfaces: tuple[Surface, ...]


def align_room(grid: DepthGrid, gravity: Gravity | None = None) -> AlignedRoom:
    """Aligns a depth grid with gravity and segments its planar surfaces.

    Args:
        grid: Depth grid in the camera frame.
        gravity: Gravity if known; None estimates it by `room_gravity`.

    Returns:
        The grid in the radar's frame, its surfaces, and the rotation between the frames.

    Raises:
        InputError: If the depth shows no surfaces.
    """
    gravity = room_gravity(grid) if gravity is None else gravity
    radar_from_camera = level_from_camera(gravity.up_camera)
    aligned = _aligned(grid, radar_from_camera, gravity.floor_z_m)
    return AlignedRoom(
        gravity=gravity, radar_from_camera=radar_from_camera, grid=aligned, surfaces=find_surfaces(aligned)
    )


def room_gravity(grid: DepthGrid) -> Gravity:
    """Estimates gravity from the floor and refines it by the walls found with that first estimate.

    Args:
        grid: Depth grid in the camera frame.

    Returns:
        Up in the camera frame and the floor's height.

    Raises:
        InputError: If the depth shows no surfaces.
    """
    gravity = find_gravity(grid)
    first = _aligned(grid, level_from_camera(gravity.up_camera), gravity.floor_z_m)
    walls = [surface.cells for surface in find_surfaces(first) if surface.plane.kind == "wall"]
    return refined_by_walls(gravity, grid, floor_cells(first), walls)


def _aligned(grid: DepthGrid, radar_from_camera: Rotation, floor_z_m: float) -> AlignedGrid:
    """The grid rotated into the radar's frame."""
    return AlignedGrid(
        points_m=grid.points_m @ radar_from_camera.T,
        normals=grid.normals @ radar_from_camera.T,
        depth_m=grid.depth_m,
        floor_z_m=floor_z_m,
        focal_cells=grid.intrinsics.fx,
    )
