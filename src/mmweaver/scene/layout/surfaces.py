"""The flat surfaces of a room: floor, ceiling, walls, table tops, furniture fronts."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Plane
from mmweaver.core.shapes import Array, Points, Vec3
from mmweaver.scene.layout.connected_patches import grown, labelled, linked
from mmweaver.scene.photo.depth_grid import GridBool, GridFloat, GridVectors, depth_tolerance_m

UP = np.array([0.0, 0.0, 1.0])
_MIN_SIZE_M = 0.3
_MIN_CELLS = 50
_MIN_FILL = 0.35  # share of a rectangle that is really seen, or hidden by something nearer
_LEVEL = np.cos(np.deg2rad(20))
_UPRIGHT = np.sin(np.deg2rad(20))
_SAME_FACING = np.cos(np.deg2rad(25))
_MIN_TOP_M = 0.25  # above the floor
_WALL_TOP_M = 1.75  # above the floor: a wall reaches higher than most furniture
_CEILING_M = 1.9  # above the floor
_MAX_UPRIGHT, _MAX_TOPS = 16, 12
_WIDER = 2.0  # a wall bends by more than its noise in a real sensor's picture
_HOUGH_M = 0.05
_STEEPER = np.array([1.0, 1.0, 5.0])
_HOUGH_ANGLES = 120


@dataclass(frozen=True, kw_only=True)
class LevelGrid:
    """The depth grid in the radar's frame."""

    points_m: GridVectors
    normals: GridVectors  # towards the radar
    depth_m: GridFloat  # along the optical axis
    floor_z_m: float
    focal_cells: float

    @property
    def tolerance_m(self) -> GridFloat:
        """How far a cell may lie from the plane it belongs to."""
        return 0.01 + depth_tolerance_m(self.depth_m)

    def spacing_m(self, normal: Vec3) -> GridFloat:
        """Somewhat more than the step from cell to cell on a surface of that normal: far, seen obliquely."""
        distance = np.linalg.norm(self.points_m, axis=-1)
        across = np.maximum(np.abs(self.points_m @ normal), 0.05)
        return 0.02 + 1.4 * np.square(distance) / (across * self.focal_cells)


@dataclass(frozen=True, kw_only=True)
class Surface:
    """A plane (its material still open) and the cells of the grid that lie on it."""

    plane: Plane
    cells: GridBool


def floor_cells(grid: LevelGrid) -> GridBool:
    """Cells on the floor: at its height, and not plainly upright."""
    near = np.abs(grid.points_m[..., 2] - grid.floor_z_m) < grid.tolerance_m + 0.015
    return near & ~(np.abs(grid.normals[..., 2]) < 0.7)


def find_surfaces(grid: LevelGrid) -> tuple[Surface, ...]:
    """All flat surfaces but the floor, larger ones first within a kind."""
    # What seems to lie below the floor is a mirror image in it, or light that came round about.
    is_above = grid.points_m[..., 2] > grid.floor_z_m - grid.tolerance_m
    open_cells = np.isfinite(grid.normals).all(axis=2) & ~floor_cells(grid) & is_above
    tops = _level_surfaces(grid, open_cells)
    for surface in tops:
        open_cells = open_cells & ~surface.cells
    return _upright_surfaces(grid, open_cells) + tops


# Upright: walls and panels -------------------------------------------------------------------------------------------
def _upright_surfaces(grid: LevelGrid, open_cells: GridBool) -> tuple[Surface, ...]:
    open_cells = open_cells & (np.abs(grid.normals[..., 2]) < _UPRIGHT)
    surfaces: list[Surface] = []
    for _ in range(_MAX_UPRIGHT):
        plane = _strongest_upright(grid.points_m[open_cells], grid.normals[open_cells])
        if plane is None:
            break
        normal, offset = _refined_upright(grid, open_cells, *plane)
        on_plane = open_cells & _is_on(grid, normal, offset, _WIDER)
        if on_plane.sum() < _MIN_CELLS:
            # The peak of the vote was a chance meeting of many small things: leave them out of the next vote.
            open_cells = open_cells & ~_is_on(grid, *plane)
            continue
        open_cells = open_cells & ~on_plane
        labels, count = labelled(grown(on_plane, 2))
        for label in range(1, count + 1):
            surface = _upright_surface(grid, normal, offset, on_plane & (labels == label))
            if surface is not None:
                surfaces.append(surface)
    return tuple(sorted(surfaces, key=lambda surface: (surface.plane.kind != "wall", -_area_m2(surface.plane))))


def _strongest_upright(points: Points, normals: Points) -> tuple[Vec3, float] | None:
    """Hough vote over direction and distance: the upright plane n . p = offset that most cells lie on."""
    if len(points) < _MIN_CELLS:
        return None
    direction = np.arctan2(normals[:, 1], normals[:, 0])
    angle_bin = np.round(direction / (2 * np.pi) * _HOUGH_ANGLES).astype(int)
    best = (0.0, 0, 0.0)
    for turn in range(_HOUGH_ANGLES):
        near = np.abs((angle_bin - turn + _HOUGH_ANGLES // 2) % _HOUGH_ANGLES - _HOUGH_ANGLES // 2) <= 3
        if near.sum() < _MIN_CELLS or near.sum() < best[0]:
            continue
        theta = 2 * np.pi * turn / _HOUGH_ANGLES
        offset = points[near, 0] * np.cos(theta) + points[near, 1] * np.sin(theta)
        bins = np.floor(offset / _HOUGH_M).astype(int)
        lowest = bins.min()
        votes = np.bincount(bins - lowest)
        votes = votes + np.pad(votes[1:], (0, 1))
        peak = int(np.argmax(votes))
        if votes[peak] > best[0]:
            best = (float(votes[peak]), turn, (peak + lowest + 1) * _HOUGH_M)
    if best[0] < _MIN_CELLS:
        return None
    theta = 2 * np.pi * best[1] / _HOUGH_ANGLES
    return np.array([np.cos(theta), np.sin(theta), 0.0]), best[2]


def _refined_upright(grid: LevelGrid, open_cells: GridBool, normal: Vec3, offset: float) -> tuple[Vec3, float]:
    """Least squares over the cells near the plane, kept exactly upright."""
    slack = 1.5
    for _ in range(4):
        chosen = open_cells & _is_on(grid, normal, offset, slack)
        if chosen.sum() < _MIN_CELLS // 2:
            break
        points, weight = grid.points_m[chosen][:, :2], 1 / np.square(grid.tolerance_m[chosen])
        centre = np.average(points, axis=0, weights=weight)
        spread = (points - centre) * np.sqrt(weight)[:, None]
        _, vectors = np.linalg.eigh(spread.T @ spread)
        flat = vectors[:, 0] * np.sign(vectors[:, 0] @ normal[:2] or 1.0)
        normal, offset, slack = np.array([flat[0], flat[1], 0.0]), float(centre @ flat), 1.0
    return normal, offset


def _upright_surface(grid: LevelGrid, normal: Vec3, offset: float, cells: GridBool) -> Surface | None:
    if cells.sum() < _MIN_CELLS:
        return None
    axis_u = np.cross(UP, normal)
    points = grid.points_m[cells]
    left, right = np.percentile(points @ axis_u, [1, 99])
    bottom, top = np.percentile(points[:, 2], [1, 99])
    is_wall = _is_wall(grid, normal, offset, (left, right, bottom, top), cells)
    if is_wall:
        # A wall stands on the floor, whatever hides its foot.
        bottom = grid.floor_z_m
    if min(right - left, top - bottom) < _MIN_SIZE_M:
        return None
    extents = (float(left), float(right), float(bottom), float(top))
    plane = _plane("wall" if is_wall else "panel", normal, offset, axis_u, UP, extents)
    if not is_wall and _fill(grid, plane, cells) < _MIN_FILL:
        return None
    return Surface(plane=plane, cells=cells)


def _is_wall(grid: LevelGrid, normal: Vec3, offset: float, extents: tuple[float, ...], cells: GridBool) -> bool:
    """High enough (or cut off by the picture's upper edge), wide enough, and hardly anything seen behind it."""
    left, right, bottom, top = extents
    is_cut = cells[_first_measured_row(grid)].sum() >= 0.3 * cells.any(axis=0).sum()
    if right - left < 2 * _MIN_SIZE_M or top - bottom < 2 * _MIN_SIZE_M:
        return False
    if top - grid.floor_z_m < (1.2 if is_cut else _WALL_TOP_M):
        return False
    behind = grid.points_m @ normal - offset < -0.15 - grid.tolerance_m
    rows = np.flatnonzero(cells.any(axis=1))
    columns = np.flatnonzero(cells.any(axis=0))
    seen_through = behind[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].sum()
    return bool(seen_through < 0.25 * cells.sum())


def _first_measured_row(grid: LevelGrid) -> tuple[np.ndarray, np.ndarray]:
    """Index of the topmost measured cells (three of each column)."""
    measured = np.isfinite(grid.depth_m)
    columns = np.flatnonzero(measured.any(axis=0))
    first = np.argmax(measured[:, columns], axis=0)
    last = len(measured) - 1
    rows = np.minimum(first[None, :] + np.arange(3)[:, None], last)
    return rows, np.broadcast_to(columns, rows.shape)


# Level: ceilings and tops ---------------------------------------------------------------------------------------------
def _level_surfaces(grid: LevelGrid, open_cells: GridBool) -> tuple[Surface, ...]:
    surfaces = []
    for sign in (1.0, -1.0):
        facing = open_cells & (sign * grid.normals[..., 2] > _LEVEL)
        above_floor = grid.points_m[..., 2] - grid.floor_z_m
        facing &= (above_floor > _MIN_TOP_M) if sign > 0 else (above_floor > _CEILING_M)
        surfaces += _peeled_levels(grid, facing, sign)
    return tuple(sorted(surfaces, key=lambda surface: -_area_m2(surface.plane)))


def _peeled_levels(grid: LevelGrid, facing: GridBool, sign: float) -> list[Surface]:
    """Takes the height with the most cells, its connected patches, and so on."""
    surfaces: list[Surface] = []
    for _ in range(_MAX_TOPS):
        heights = grid.points_m[facing][:, 2]
        if len(heights) < _MIN_CELLS:
            break
        bins = np.floor(heights / 0.02).astype(int)
        votes = np.convolve(np.bincount(bins - bins.min()), np.ones(3), mode="same")
        level_m = (int(np.argmax(votes)) + bins.min() + 0.5) * 0.02
        on_level = facing & (np.abs(grid.points_m[..., 2] - level_m) < 0.5 * grid.tolerance_m + 0.02)
        facing = facing & ~on_level
        # A step in height parts a table from the sofa behind it sooner than a gap does.
        labels, _ = linked(on_level, grid.points_m * _STEEPER, grid.spacing_m(UP))
        sizes = np.bincount(labels.ravel())
        for label in np.flatnonzero(sizes >= _MIN_CELLS)[1:]:
            surface = _level_surface(grid, labels == label, sign)
            if surface is not None:
                surfaces.append(surface)
    return surfaces


def _level_surface(grid: LevelGrid, cells: GridBool, sign: float) -> Surface | None:
    if cells.sum() < _MIN_CELLS:
        return None
    points = grid.points_m[cells]
    height = float(np.average(points[:, 2], weights=1 / np.square(grid.tolerance_m[cells])))
    normal = sign * UP
    axis_u = _tightest_axis(points[:, :2])
    axis_v = np.cross(normal, axis_u)
    left, right = np.percentile(points @ axis_u, [1, 99])
    near, far = np.percentile(points @ axis_v, [1, 99])
    if min(right - left, far - near) < _MIN_SIZE_M:
        return None
    extents = (float(left), float(right), float(near), float(far))
    plane = _plane("top" if sign > 0 else "ceiling", normal, sign * height, axis_u, axis_v, extents)
    if sign > 0 and _fill(grid, plane, cells) < _MIN_FILL:
        return None
    return Surface(plane=plane, cells=cells)


def _tightest_axis(points: Float[Array, "point 2"]) -> Vec3:
    """Direction of the smallest rectangle around points in the plane."""
    angles = np.deg2rad(np.arange(0, 90, 3))
    along = points[:, :1] * np.cos(angles) + points[:, 1:] * np.sin(angles)
    across = points[:, 1:] * np.cos(angles) - points[:, :1] * np.sin(angles)
    area = np.ptp(np.percentile(along, [2, 98], axis=0), axis=0) * np.ptp(
        np.percentile(across, [2, 98], axis=0), axis=0
    )
    angle = angles[np.argmin(area)]
    return np.array([np.cos(angle), np.sin(angle), 0.0])


# Both ---------------------------------------------------------------------------------------------------------------
def _is_on(grid: LevelGrid, normal: Vec3, offset: float, slack: float = 1.0) -> GridBool:
    near = np.abs(grid.points_m @ normal - offset) < slack * grid.tolerance_m + 0.005
    return near & (grid.normals @ normal > _SAME_FACING)


def _plane(
    kind: str, normal: Vec3, offset: float, axis_u: Vec3, axis_v: Vec3, extents: tuple[float, float, float, float]
) -> Plane:
    left, right, low, high = extents
    centre = offset * normal + (left + right) / 2 * axis_u + (low + high) / 2 * axis_v
    half_size_m = ((right - left) / 2, (high - low) / 2)
    return Plane(
        kind=kind, centre_m=centre, normal=normal, axis_u=axis_u, axis_v=axis_v, half_size_m=half_size_m, material=""
    )


def _fill(grid: LevelGrid, plane: Plane, cells: GridBool) -> float:
    """Share of the rectangle that cells lie on, counted in squares of 5 cm (wider where the cells lie wider apart)."""
    offsets = grid.points_m[cells] - plane.centre_m
    spacing = max(0.05, 1.5 * float(np.sqrt(4 * plane.half_size_m[0] * plane.half_size_m[1] / cells.sum())))
    u = np.floor((offsets @ plane.axis_u + plane.half_size_m[0]) / spacing).astype(int)
    v = np.floor((offsets @ plane.axis_v + plane.half_size_m[1]) / spacing).astype(int)
    total = np.ceil(2 * plane.half_size_m[0] / spacing) * np.ceil(2 * plane.half_size_m[1] / spacing)
    return len(set(zip(u.tolist(), v.tolist(), strict=True))) / float(total)


def _area_m2(plane: Plane) -> float:
    return 4 * plane.half_size_m[0] * plane.half_size_m[1]
