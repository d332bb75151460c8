"""Which way is up, and how far below the camera the floor lies."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import Array, PerPoint, Points, Vec3
from mmweaver.scene.photo.depth_grid import DepthGrid, GridBool, depth_tolerance_m

Normals = Float[Array, "normal 3"]

_MAX_TILT_RAD = np.deg2rad(55)
_FLAT = np.cos(np.deg2rad(12))  # a normal this near to up belongs to something horizontal
_UPRIGHT = np.sin(np.deg2rad(8))  # one this near to level belongs to something vertical
_MAX_LEAN = np.sin(np.deg2rad(9))  # of a wall, before it is no witness
_NEAREST_FLOOR_M = 0.25  # a camera closer to the floor than this is not expected
_GUESSED_HEIGHT_M = 1.2
_MIN_FLOOR_CELLS = 60
_HEIGHT_BIN_M = 0.02


@dataclass(frozen=True, kw_only=True)
class Gravity:
    """Up in the camera's frame, the floor's height (negative), and what had to be assumed."""

    up_camera: Vec3
    floor_z_m: float
    has_floor: bool
    assumptions: tuple[str, ...]


def find_gravity(grid: DepthGrid) -> Gravity:
    """Finds the floor: the lowest large level surface, at right angles to the upright ones.

    Without a floor in sight, up is taken from the walls, else from a level camera, and the floor is assumed; it says
    so. Raises InputError where there is no surface at all.
    """
    usable = np.isfinite(grid.normals).all(axis=2) & np.isfinite(grid.depth_m)
    points, normals = grid.points_m[usable], grid.normals[usable]
    if len(points) < 2 * _MIN_FLOOR_CELLS:
        raise InputError("the depth picture shows no surfaces, only scattered points; give a depth picture of a room")
    up = _vertical(normals)
    if up is not None:
        found = _floor(points, normals, up)
        if found is not None:
            return Gravity(up_camera=found[0], floor_z_m=found[1], has_floor=True, assumptions=())
    return _without_floor(points, normals, up)


def corrected_by_walls(gravity: Gravity, grid: DepthGrid, floor: GridBool, walls: Sequence[GridBool]) -> Gravity:
    """Weighs the floor's own slope against the walls', which must be upright.

    Each is trusted by its length over the sensor's error: that error is one of the whole surface (a dark or shiny
    floor seems deeper to a time-of-flight camera), so the number of cells does not count.
    """
    if not gravity.has_floor or floor.sum() < _MIN_FLOOR_CELLS:
        return gravity
    squares = np.zeros((3, 3))
    for cells in walls:
        points = grid.points_m[cells]
        _, vectors = np.linalg.eigh(np.cov(points.T))
        normal = vectors[:, 0]
        if abs(normal @ gravity.up_camera) < _MAX_LEAN:
            squares += np.outer(normal, normal) * np.square(np.std(points @ gravity.up_camera) / _error_m(points))
    points = grid.points_m[floor]
    values, vectors = np.linalg.eigh(np.cov(points.T))
    for value, along in zip(values[1:], vectors.T[1:], strict=True):
        squares += np.outer(along, along) * value / np.square(_error_m(points))
    _, vectors = np.linalg.eigh(squares)
    up = vectors[:, 0] * np.sign(vectors[:, 0] @ gravity.up_camera)
    return replace(gravity, up_camera=up, floor_z_m=float(np.median(points @ up)))


def _error_m(points: Points) -> float:
    return float(np.median(depth_tolerance_m(points[:, 2])))


def _vertical(normals: Points) -> Vec3 | None:
    """The direction near the camera's up that most surfaces are level or upright to; None if none are level."""
    tilt_cosine = -normals[:, 1]
    candidates = normals[tilt_cosine > np.cos(_MAX_TILT_RAD)]
    if len(candidates) < _MIN_FLOOR_CELLS:
        return None
    hypotheses = candidates[np.linspace(0, len(candidates) - 1, min(150, len(candidates))).astype(int)]
    alignment = hypotheses @ normals.T
    level, upright = (alignment > _FLAT).sum(axis=1), (np.abs(alignment) < _UPRIGHT).sum(axis=1)
    # A level surface is a must, walls are a witness: a sloped one finds few at right angles to it.
    best = hypotheses[np.argmax(np.minimum(level, len(normals) // 4) + 0.7 * upright)]
    for _ in range(4):
        alignment = normals @ best
        best = _most_upright(normals[alignment > _FLAT], normals[np.abs(alignment) < _UPRIGHT], best)
    return best


def _most_upright(level: Normals, upright: Float[Array, "other 3"], near: Vec3) -> Vec3:
    """The unit vector along the level surfaces' normals and across the upright ones', in least squares."""
    _, vectors = np.linalg.eigh(upright.T @ upright - level.T @ level)
    up = vectors[:, 0]
    return up if up @ near > 0 else -up


def _floor(points: Points, normals: Points, up: Vec3) -> tuple[Vec3, float] | None:
    """The lowest level surface of some size, fitted by a plane: (up, height)."""
    height = points @ up
    tolerance = depth_tolerance_m(points[:, 2])
    facing = (normals @ up > _FLAT) & (height < -_NEAREST_FLOOR_M)
    for level_m in _levels(height[facing], (np.square(points[:, 2]) / 1.0)[facing]):
        chosen = facing & (np.abs(height - level_m) < tolerance + 0.04)
        below = (height < level_m - 3 * tolerance - 0.10).mean()
        if chosen.sum() < _MIN_FLOOR_CELLS or below > 0.06:
            continue
        fitted = _fitted(points, chosen, up)
        if fitted is not None:
            return fitted
    return None


def _levels(height: PerPoint, weight: PerPoint) -> Float[Array, " level"]:
    """Heights at which much level surface lies, lowest first. A cell's surface grows with its depth squared."""
    if len(height) == 0:
        return np.zeros(0)
    edges = np.arange(height.min() - 0.1, 0.1, _HEIGHT_BIN_M)
    area = np.convolve(np.histogram(height, edges, weights=weight)[0], np.ones(4), mode="same")
    count = np.convolve(np.histogram(height, edges)[0], np.ones(4), mode="same")
    padded = np.pad(area, 4)
    highest = np.max([padded[shift : shift + len(area)] for shift in range(9)], axis=0)
    is_peak = (area == highest) & (area > 0.04 * area.max()) & (count > _MIN_FLOOR_CELLS / 2)
    return edges[:-1][is_peak] + _HEIGHT_BIN_M / 2


def _fitted(points: Points, chosen: np.ndarray, up: Vec3) -> tuple[Vec3, float] | None:
    """Least-squares plane through the chosen points and what joins them; keeps `up` where the floor seen is small."""
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


def _without_floor(points: Points, normals: Points, up: Vec3 | None) -> Gravity:
    """Up from what is level or upright, else from a level camera; the floor just below everything seen."""
    sentences = ["No floor is in sight."]
    if up is None:
        up = _vertical(-normals)  # a ceiling is as level as a floor
    if up is None:
        up = np.array([0.0, -1.0, 0.0])
        walls = normals[np.abs(normals @ up) < np.sin(np.deg2rad(25))]
        if len(walls) >= 4 * _MIN_FLOOR_CELLS:
            # The level camera as a weak witness: one wall alone leaves a turn about its normal open.
            up = _most_upright(np.tile(up * np.sqrt(0.02 * len(walls)), (1, 1)), walls, up)
            sentences.append("Up was taken from the walls.")
        else:
            sentences.append("The camera was taken to be level.")
    else:
        sentences.append("Up was taken from level and upright surfaces.")
    lowest_m = float(np.percentile(points @ up, 0.5))
    floor_z_m = min(-_GUESSED_HEIGHT_M, lowest_m)
    sentences.append(f"The floor was taken to lie {-floor_z_m:.2f} m below the camera.")
    return Gravity(up_camera=up, floor_z_m=floor_z_m, has_floor=False, assumptions=(" ".join(sentences),))
