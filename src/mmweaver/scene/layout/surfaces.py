"""Segments the planar surfaces of a room: floor, ceiling, walls, table tops, furniture fronts.

Materials of surfaces: from the class of each pixel where a mask gives one, else guessed from geometry and colour.

Metal and glass are never guessed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import Plane, Seat
from mmweaver.core.shapes import Array, Points, Vec3
from mmweaver.scene.coco_stuff import material_of
from mmweaver.scene.layout.height_map import dilated, label_by_distance, label_components
from mmweaver.scene.photo.depth_grid import GridBool, GridFloat, GridInt, GridVectors, depth_tolerance_m

UP = np.array([0.0, 0.0, 1.0])
_MIN_SIZE_M = 0.3
_MIN_CELLS = 50
_MIN_FILL = 0.35  # share of a rectangle that its cells cover
_HORIZONTAL = np.cos(np.deg2rad(20))
_VERTICAL = np.sin(np.deg2rad(20))
_SAME_FACING = np.cos(np.deg2rad(25))
_MIN_TOP_M = 0.25  # above the floor
_WALL_TOP_M = 1.75  # above the floor: a wall reaches higher than most furniture
_CEILING_M = 1.9  # above the floor
_MAX_VERTICAL, _MAX_HORIZONTAL = 16, 12  # planes that are searched for
_WALL_TOLERANCE = 2.0  # times the tolerance of a cell: real sensors bend walls by more than their noise
_HOUGH_BIN_M = 0.05
_HOUGH_ANGLES = 120
_HOUGH_REACH = 3  # angles: normals are noisy
_HEIGHT_WEIGHT = np.array([1.0, 1.0, 5.0])  # in the distance of neighbours: steps in height separate surfaces


@dataclass(frozen=True, kw_only=True)
class AlignedGrid:
    """The depth grid in the radar's frame."""

    points_m: GridVectors
    normals: GridVectors  # unit, towards the radar
    depth_m: GridFloat  # along the optical axis
    floor_z_m: float
    focal_cells: float | GridFloat  # focal length in cells
    eye_m: Vec3 | GridVectors = field(default_factory=lambda: np.zeros(3))  # of the camera that measured a cell

    @property
    def tolerance_m(self) -> GridFloat:
        """Maximum distance of a cell from the plane to which it belongs, (row, column)."""
        return 0.01 + depth_tolerance_m(self.depth_m)

    def spacing_m(self, normal: Vec3) -> GridFloat:
        """Upper bound on the distance between neighbouring cells on a surface.

        It grows with distance and with the obliqueness of the view.

        Args:
            normal: Normal of the surface, (3,).

        Returns:
            Metres, (row, column).
        """
        distance_m = np.linalg.norm(self.points_m, axis=-1)
        normal_distance_m = np.maximum(np.abs(self.points_m @ normal), 0.05)
        return 0.02 + 1.4 * np.square(distance_m) / (normal_distance_m * self.focal_cells)


@dataclass(frozen=True, kw_only=True)
class Surface:
    """A plane, whose material is not known yet, and the cells of the grid that lie on it."""

    plane: Plane
    cells: GridBool


def floor_cells(grid: AlignedGrid) -> GridBool:
    """Cells at the floor's height that are not clearly vertical, (row, column)."""
    near = np.abs(grid.points_m[..., 2] - grid.floor_z_m) < grid.tolerance_m + 0.015
    return near & ~(np.abs(grid.normals[..., 2]) < 0.7)


def find_surfaces(grid: AlignedGrid) -> tuple[Surface, ...]:
    """Segments all planar surfaces except the floor.

    Planes are peeled off one by one: the strongest peak of a Hough transform, its inliers, the next peak.

    Args:
        grid: Depth grid in the radar's frame.

    Returns:
        Walls, vertical panels, then horizontal surfaces; by decreasing area within each.
    """
    # Points below the floor are specular reflections in it, or multipath of the depth sensor.
    is_above = grid.points_m[..., 2] > grid.floor_z_m - grid.tolerance_m
    open_cells = np.isfinite(grid.normals).all(axis=2) & ~floor_cells(grid) & is_above
    horizontal = _horizontal_surfaces(grid, open_cells)
    for surface in horizontal:
        open_cells = open_cells & ~surface.cells
    return _vertical_surfaces(grid, open_cells) + horizontal


# Vertical: walls and panels ------------------------------------------------------------------------------------------
def _vertical_surfaces(grid: AlignedGrid, open_cells: GridBool) -> tuple[Surface, ...]:
    """Walls first, then panels, each by decreasing area."""
    open_cells = open_cells & (np.abs(grid.normals[..., 2]) < _VERTICAL)
    surfaces: list[Surface] = []
    for _ in range(_MAX_VERTICAL):
        plane = _strongest_vertical(grid.points_m[open_cells], grid.normals[open_cells])
        if plane is None:
            break
        normal, offset = _refined_vertical(grid, open_cells, *plane)
        on_plane = open_cells & _is_on(grid, normal, offset, _WALL_TOLERANCE)
        if on_plane.sum() < _MIN_CELLS:
            # The peak was a coincidence of many small objects: exclude them from the next vote.
            open_cells = open_cells & ~_is_on(grid, *plane)
            continue
        open_cells = open_cells & ~on_plane
        labels, count = label_components(dilated(on_plane, 2))
        for label in range(1, count + 1):
            surface = _vertical_surface(grid, normal, offset, on_plane & (labels == label))
            if surface is not None:
                surfaces.append(surface)
    return tuple(sorted(surfaces, key=lambda surface: (surface.plane.kind != "wall", -surface.plane.area_m2)))


def _strongest_vertical(points: Points, normals: Points) -> tuple[Vec3, float] | None:
    """Hough transform over azimuth and offset: the vertical plane n . p = offset that most points lie on."""
    if len(points) < _MIN_CELLS:
        return None
    direction = np.arctan2(normals[:, 1], normals[:, 0])
    angle_bin = np.round(direction / (2 * np.pi) * _HOUGH_ANGLES).astype(int) % _HOUGH_ANGLES
    window = np.arange(-_HOUGH_REACH, _HOUGH_REACH + 1)
    count = np.bincount(angle_bin, minlength=_HOUGH_ANGLES)
    num_near = count[(np.arange(_HOUGH_ANGLES)[:, None] + window) % _HOUGH_ANGLES].sum(axis=1)
    best = (0.0, 0, 0.0)
    for candidate in range(_HOUGH_ANGLES):
        if num_near[candidate] < max(_MIN_CELLS, best[0]):
            continue
        is_near = np.zeros(_HOUGH_ANGLES, bool)
        is_near[(candidate + window) % _HOUGH_ANGLES] = True
        near = is_near[angle_bin]
        theta = 2 * np.pi * candidate / _HOUGH_ANGLES
        offset = points[near, 0] * np.cos(theta) + points[near, 1] * np.sin(theta)
        bins = np.floor(offset / _HOUGH_BIN_M).astype(int)
        lowest = bins.min()
        votes = np.bincount(bins - lowest)
        votes = votes + np.pad(votes[1:], (0, 1))
        peak = int(np.argmax(votes))
        if votes[peak] > best[0]:
            best = (float(votes[peak]), candidate, (peak + lowest + 1) * _HOUGH_BIN_M)
    if best[0] < _MIN_CELLS:
        return None
    theta = 2 * np.pi * best[1] / _HOUGH_ANGLES
    return np.array([np.cos(theta), np.sin(theta), 0.0]), best[2]


def _refined_vertical(grid: AlignedGrid, open_cells: GridBool, normal: Vec3, offset: float) -> tuple[Vec3, float]:
    """Weighted least-squares fit to the cells near the plane, constrained to be vertical."""
    tolerance_factor = 1.5
    for _ in range(4):
        chosen = open_cells & _is_on(grid, normal, offset, tolerance_factor)
        if chosen.sum() < _MIN_CELLS // 2:
            break
        points, weight = grid.points_m[chosen][:, :2], 1 / np.square(grid.tolerance_m[chosen])
        centre = np.average(points, axis=0, weights=weight)
        spread = (points - centre) * np.sqrt(weight)[:, None]
        _, vectors = np.linalg.eigh(spread.T @ spread)
        flat = vectors[:, 0] * np.sign(vectors[:, 0] @ normal[:2] or 1.0)
        normal, offset, tolerance_factor = np.array([flat[0], flat[1], 0.0]), float(centre @ flat), 1.0
    return normal, offset


def _vertical_surface(grid: AlignedGrid, normal: Vec3, offset: float, cells: GridBool) -> Surface | None:
    """The bounding rectangle of cells on a vertical plane as wall or panel; None where it is too small or sparse."""
    if cells.sum() < _MIN_CELLS:
        return None
    axis_u = np.cross(UP, normal)
    points = grid.points_m[cells]
    left, right = np.percentile(points @ axis_u, [1, 99])
    bottom, top = np.percentile(points[:, 2], [1, 99])
    is_wall = _is_wall(grid, normal, offset, (left, right, bottom, top), cells)
    if is_wall:
        # A wall reaches the floor, even where its foot is occluded.
        bottom = grid.floor_z_m
    if min(right - left, top - bottom) < _MIN_SIZE_M:
        return None
    extents = (float(left), float(right), float(bottom), float(top))
    plane = _plane("wall" if is_wall else "panel", normal, offset, axis_u, UP, extents)
    if not is_wall and _fill(grid, plane, cells) < _MIN_FILL:
        return None
    return Surface(plane=plane, cells=cells)


def _is_wall(grid: AlignedGrid, normal: Vec3, offset: float, extents: tuple[float, ...], cells: GridBool) -> bool:
    """High enough (or cut off by the picture's upper edge), wide enough, and hardly any point behind it."""
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


def _first_measured_row(grid: AlignedGrid) -> tuple[Int[Array, "3 column"], Int[Array, "3 column"]]:
    """Rows and columns, (3, column) each, of the three topmost measured cells of every column."""
    measured = np.isfinite(grid.depth_m)
    columns = np.flatnonzero(measured.any(axis=0))
    first = np.argmax(measured[:, columns], axis=0)
    last = len(measured) - 1
    rows = np.minimum(first[None, :] + np.arange(3)[:, None], last)
    return rows, np.broadcast_to(columns, rows.shape)


# Horizontal: ceilings and tops --------------------------------------------------------------------------------------
def _horizontal_surfaces(grid: AlignedGrid, open_cells: GridBool) -> tuple[Surface, ...]:
    """Tops and ceilings by decreasing area."""
    surfaces = []
    for sign in (1.0, -1.0):
        facing = open_cells & (sign * grid.normals[..., 2] > _HORIZONTAL)
        above_floor = grid.points_m[..., 2] - grid.floor_z_m
        facing &= (above_floor > _MIN_TOP_M) if sign > 0 else (above_floor > _CEILING_M)
        surfaces += _peeled_surfaces(grid, facing, sign)
    return tuple(sorted(surfaces, key=lambda surface: -surface.plane.area_m2))


def _peeled_surfaces(grid: AlignedGrid, facing: GridBool, sign: float) -> list[Surface]:
    """Takes the height with the most cells, the connected components of its cells, then the next height."""
    surfaces: list[Surface] = []
    for _ in range(_MAX_HORIZONTAL):
        heights = grid.points_m[facing][:, 2]
        if len(heights) < _MIN_CELLS:
            break
        bins = np.floor(heights / 0.02).astype(int)
        votes = np.convolve(np.bincount(bins - bins.min()), np.ones(3), mode="same")
        height_m = (int(np.argmax(votes)) + bins.min() + 0.5) * 0.02
        at_height = facing & (np.abs(grid.points_m[..., 2] - height_m) < 0.5 * grid.tolerance_m + 0.02)
        facing = facing & ~at_height
        labels, _ = label_by_distance(at_height, grid.points_m * _HEIGHT_WEIGHT, grid.spacing_m(UP))
        sizes = np.bincount(labels.ravel())
        for label in np.flatnonzero(sizes >= _MIN_CELLS)[1:]:
            surface = _horizontal_surface(grid, labels == label, sign)
            if surface is not None:
                surfaces.append(surface)
    return surfaces


def _horizontal_surface(grid: AlignedGrid, cells: GridBool, sign: float) -> Surface | None:
    """The tightest rectangle around cells at one height; None where it is too small or sparse."""
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
    """Direction of the minimum-area bounding rectangle of points in the plane."""
    angles = np.deg2rad(np.arange(0, 90, 3))
    along = points[:, :1] * np.cos(angles) + points[:, 1:] * np.sin(angles)
    across = points[:, 1:] * np.cos(angles) - points[:, :1] * np.sin(angles)
    area = np.ptp(np.percentile(along, [2, 98], axis=0), axis=0) * np.ptp(
        np.percentile(across, [2, 98], axis=0), axis=0
    )
    angle = angles[np.argmin(area)]
    return np.array([np.cos(angle), np.sin(angle), 0.0])


# Both ---------------------------------------------------------------------------------------------------------------
def _is_on(grid: AlignedGrid, normal: Vec3, offset: float, tolerance_factor: float = 1.0) -> GridBool:
    """Inliers of the plane n . p = offset: near it, and with a similar normal."""
    near = np.abs(grid.points_m @ normal - offset) < tolerance_factor * grid.tolerance_m + 0.005
    return near & (grid.normals @ normal > _SAME_FACING)


def _plane(
    kind: str, normal: Vec3, offset: float, axis_u: Vec3, axis_v: Vec3, extents: tuple[float, float, float, float]
) -> Plane:
    """The rectangle with these extents (left, right, low, high) along the axes, on the plane n . p = offset; metres."""
    left, right, low, high = extents
    plane = Plane(
        kind=kind,
        centre_m=offset * normal,
        normal=normal,
        axis_u=axis_u,
        axis_v=axis_v,
        half_size_m=(0.0, 0.0),
        material="",
    )
    return plane.spanned((left, low), (right, high))


def _fill(grid: AlignedGrid, plane: Plane, cells: GridBool) -> float:
    """Share of the plane's rectangle that cells cover, in squares of 5 cm or of the cells' spacing if that is wider."""
    offsets = grid.points_m[cells] - plane.centre_m
    spacing = max(0.05, 1.5 * float(np.sqrt(plane.area_m2 / cells.sum())))
    u = np.floor((offsets @ plane.axis_u + plane.half_size_m[0]) / spacing).astype(int)
    v = np.floor((offsets @ plane.axis_v + plane.half_size_m[1]) / spacing).astype(int)
    total = np.ceil(2 * plane.half_size_m[0] / spacing) * np.ceil(2 * plane.half_size_m[1] / spacing)
    return len(set(zip(u.tolist(), v.tolist(), strict=True))) / float(total)


# ITU-R P.2040-3, table 3, and upholstery (fabric), which it does not list.
MATERIAL_NAMES = (
    "concrete",
    "brick",
    "plasterboard",
    "wood",
    "glass",
    "ceiling_board",
    "chipboard",
    "plywood",
    "marble",
    "floorboard",
    "metal",
    "fabric",
)

ASSUMPTION = (
    "Materials were guessed from geometry and colour: walls plasterboard, a warm and saturated floor floorboard and any"
    " other concrete, seats fabric if wide or of no wooden colour, the rest wood or chipboard by colour."
)

ASSUMPTION_OF_CLASSES = (
    "Materials follow from the class of each pixel (COCO-Stuff to ITU-R P.2040) where it says one; elsewhere they were"
    " guessed from geometry and colour: walls plasterboard, a warm and saturated floor floorboard and any other"
    " concrete, seats fabric if wide or of no wooden colour, the rest wood or chipboard by colour."
)

_BY_KIND = {"wall": "plasterboard", "ceiling": "ceiling_board"}  # of surfaces; others by colour
_SEAT_REACH_M = 0.55
_SOFA_M = 0.8  # a seat of at least this width is upholstered, whatever its colour


def floor_material(colours: Float[Array, "cell 3"]) -> str:
    """Guesses the floor's material from its colour.

    Args:
        colours: Colours 0 to 1 of the floor's cells, (cell, 3).

    Returns:
        "floorboard" if the colour is that of wood, else "concrete".
    """
    return "floorboard" if _is_wooden(colours) else "concrete"


def cell_materials(
    grid: AlignedGrid,
    rgb: GridVectors,
    surfaces: Sequence[Surface],
    is_floor: GridBool,
    seats: Sequence[Seat],
) -> tuple[GridInt, tuple[str, ...]]:
    """Guesses materials from geometry and colour.

    Args:
        grid: Depth grid in the radar's frame.
        rgb: Colour of each cell, 0 to 1, (row, column, 3).
        surfaces: Planar surfaces except the floor.
        is_floor: Cells of the floor, (row, column).
        seats: Seats of the room; wide ones, and those not of a wooden colour, are upholstered.

    Returns:
        Index into MATERIAL_NAMES of every cell, (row, column); and the material of each surface.
    """
    wooden = _wooden_cells(rgb)
    material = np.where(wooden, MATERIAL_NAMES.index("wood"), MATERIAL_NAMES.index("chipboard"))
    names = [
        _BY_KIND.get(surface.plane.kind) or ("wood" if _is_wooden(rgb[surface.cells]) else "chipboard")
        for surface in surfaces
    ]
    for surface, name in zip(surfaces, names, strict=True):
        material[surface.cells] = MATERIAL_NAMES.index(name)
    fixed = is_floor.copy()
    highest_seat_m = max((float(seat.position_m[2]) for seat in seats), default=0.0)
    for surface in surfaces:
        is_table = surface.plane.kind == "top" and surface.plane.centre_m[2] > highest_seat_m + 0.1
        if is_table or surface.plane.kind in ("wall", "ceiling"):
            fixed |= surface.cells
    for cells in _upholstered(grid, rgb, ~fixed, seats):
        material[cells] = MATERIAL_NAMES.index("fabric")
        for index, surface in enumerate(surfaces):
            if (cells & surface.cells).sum() > 0.3 * min(cells.sum(), surface.cells.sum()):
                names[index] = "fabric"
                material[surface.cells] = MATERIAL_NAMES.index("fabric")
    material[is_floor] = MATERIAL_NAMES.index(floor_material(rgb[is_floor]))
    return material, tuple(names)


def apply_class_materials(
    material: GridInt,
    names: tuple[str, ...],
    class_index: GridInt,
    class_names: tuple[str, ...],
    surfaces: Sequence[Surface],
    is_floor: GridBool,
) -> tuple[GridInt, tuple[str, ...]]:
    """Replaces the guesses of `cell_materials` where the class of a cell implies a material.

    A surface, or the floor, takes the majority's material if the classes of more than half of its cells imply one.

    Args:
        material: Guessed index into MATERIAL_NAMES of each cell, (row, column).
        names: Guessed material of each surface.
        class_index: Class of each cell, (row, column), index into `class_names`.
        class_names: COCO-Stuff classes of the mask.
        surfaces: Planar surfaces except the floor.
        is_floor: Cells of the floor, (row, column).

    Returns:
        The corrected `material` and `names`.
    """
    of_class = np.array([MATERIAL_NAMES.index(m) if (m := material_of(name)) else -1 for name in class_names])
    implied = of_class[np.clip(class_index, 0, len(of_class) - 1)]
    guessed, material = material, np.where(implied >= 0, implied, material)
    new = list(names)
    for index, surface in enumerate(surfaces):
        majority = _majority(implied[surface.cells])
        if majority is not None:
            new[index] = MATERIAL_NAMES[majority]
            material[surface.cells] = np.where(implied[surface.cells] >= 0, implied[surface.cells], majority)
    majority = _majority(implied[is_floor])
    material[is_floor] = guessed[is_floor] if majority is None else majority
    return material, tuple(new)


def _majority(implied: Int[Array, " cell"]) -> int | None:
    """The most frequent material of the cells that have one (-1: none); None if fewer than half have one."""
    known = implied[implied >= 0]
    return int(np.bincount(known).argmax()) if len(known) > 0.5 * len(implied) else None


def _upholstered(grid: AlignedGrid, rgb: GridVectors, open_cells: GridBool, seats: Sequence[Seat]) -> list[GridBool]:
    """The cells around each seat that is as wide as a sofa or not of a wooden colour."""
    found = []
    above_floor = grid.points_m[..., 2] - grid.floor_z_m
    for seat in seats:
        offset = grid.points_m - seat.position_m
        cells = open_cells & (np.hypot(offset[..., 0], offset[..., 1]) < _SEAT_REACH_M)
        cells &= (above_floor > 0.12) & (above_floor < 1.2)
        if cells.sum() < 20:
            continue
        if max(seat.size_m) >= _SOFA_M or not _is_wooden(rgb[cells]):
            found.append(cells)
    return found


def _is_wooden(colours: Float[Array, "cell 3"]) -> bool:
    """Whether the median of colours (cell, 3) is that of wood."""
    return bool(len(colours)) and bool(_wooden_cells(np.median(colours, axis=0)))


def _wooden_cells(rgb: Float[Array, "*cells 3"]) -> Bool[Array, "*cells"] | np.bool_:
    """Whether colours, 0 to 1, are those of wood: hues from yellow to red-brown, saturated, not too dark."""
    red, green, blue = rgb[..., 0], rgb[..., 1], rgb[..., 2]
    span = np.maximum(red - blue, 1e-6)
    hue_deg = 60 * (green - blue) / span
    saturation = (red - blue) / np.maximum(red, 1e-6)
    return (red >= green) & (green >= blue) & (hue_deg > 8) & (hue_deg < 52) & (saturation > 0.3) & (red > 0.12)
