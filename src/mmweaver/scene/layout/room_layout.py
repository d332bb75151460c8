"""Room layout: the walls that a photo shows in part, extended to the cuboid of the room.

A radar's beam is wider than a camera's view. A wall's strongest echo is the specular one, from the foot of the
perpendicular, which for the side walls lies outside the picture. Reference: docs/decisions/walls.md.
"""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.records import Plane
from mmweaver.core.shapes import PerPoint, Vec3
from mmweaver.scene.layout.surfaces import UP, AlignedGrid
from mmweaver.scene.photo.depth_grid import GridBool

BEHIND_M = 0.5  # side walls extend this far behind the radar
DEFAULT_MATERIAL = "plasterboard"
DEFAULT_HEIGHT_M = 2.5  # of a room whose ceiling is not visible
_BIN_M = 0.04
_SAME_FACING = np.cos(np.deg2rad(20))
_HORIZONTAL = np.cos(np.deg2rad(45))
_SAME_PLANE_M = 0.12
_MIN_VISIBLE_M2 = 0.15  # visible area of a wall; less may be furniture
_MIN_LABELLED_M2 = 0.05  # the same, where a class mask labels it as wall
_BEFORE_FRONT_M = 0.08
_MIN_WALL_TOP_M = 1.2  # above the floor: the visible part of a wall reaches at least this high
_MAX_BEYOND = 0.04  # share of all points that may lie behind a wall (seen through a window or doorway)
_MIN_DISTANCE_M = 0.3
_NEAREST_BACK_M = 0.05  # a radar may stand close before a wall
_MIN_AGREEMENT = 0.8  # share of the vertical area that is parallel or perpendicular to the room's axes


@dataclass(frozen=True, kw_only=True)
class RoomLayout:
    """All planes of the room except the floor."""

    planes: tuple[Plane, ...]
    extended: tuple[Plane, ...]  # those of `planes` that extend beyond the measurements
    assumptions: tuple[str, ...]


@dataclass(frozen=True)
class _Wall:
    """A wall across one axis of the room: its normal, towards the radar, and its distance from it."""

    normal: Vec3
    distance_m: float


def estimate_layout(
    grid: AlignedGrid, planes: Sequence[Plane], is_wall: GridBool | None = None, *, is_whole: bool = False
) -> RoomLayout:
    """Extends the visible walls until they meet, reach the ceiling, and pass the radar.

    Rooms that are not rectangular, and walls of which too little is visible, are left unchanged.

    Args:
        grid: Depth grid in the radar's frame.
        planes: Planes of the room except the floor.
        is_wall: Cells that a class mask labels as wall, (row, column); None without a mask.
        is_whole: The grid covers the room all around, so that there may be a wall behind the radar, and a ceiling spans
            the room from wall to wall.

    Returns:
        All planes except the floor, those extended beyond the measurements, and an assumption that reports it.
    """
    front = _front_normal(planes)
    unchanged = RoomLayout(planes=tuple(planes), extended=(), assumptions=())
    if front is None:
        return unchanged
    right = np.cross(UP, front)  # of the room, seen from the radar
    found = _find_walls(grid, front, is_wall)
    back = _find_wall(grid, -front, is_wall, nearest_m=_NEAREST_BACK_M) if is_whole else None
    found |= {} if back is None else {"back": back}
    if not found:
        return unchanged
    walls = _rectangles(found, grid, -front, right, _ceiling_m(grid, planes), _wall_material(planes))
    seen_ceilings = [plane for plane in planes if plane.kind == "ceiling"]
    ceiling: tuple[Plane, ...] = ()
    if is_whole and seen_ceilings:
        largest = max(seen_ceilings, key=lambda plane: plane.area_m2)
        ceiling = (_span_walls(largest, walls),)
        planes = [plane for plane in planes if plane.kind != "ceiling"]
    kept = tuple(plane for plane in planes if not any(_is_part_of(plane, wall) for wall in walls))
    note = UsualAssumption(f"Walls ({', '.join(found)}) were extended until they meet, and past the radar.")
    return RoomLayout(planes=(*walls, *ceiling, *kept), extended=(*walls, *ceiling), assumptions=(note,))


def _span_walls(ceiling: Plane, walls: Sequence[Plane]) -> Plane:
    """A ceiling that covers the area enclosed by the walls, aligned with them."""
    u, v = walls[0].axis_u, np.cross(ceiling.normal, walls[0].axis_u)
    ends = [wall.centre_m + side * wall.half_size_m[0] * wall.axis_u for wall in walls for side in (-1, 1)]
    along = np.array(ends) @ np.stack([u, v], axis=1)
    low, high = along.min(axis=0), along.max(axis=0)
    return replace(ceiling, centre_m=ceiling.centre_m[2] * UP, axis_u=u, axis_v=v).spanned(low, high)


def _front_normal(planes: Sequence[Plane]) -> Vec3 | None:
    """Normal of the wall opposite the radar: of the room's four axes, the one that points most nearly at the radar."""
    azimuth = room_azimuth_rad(planes)
    if azimuth is None:
        return None
    axes = azimuth + np.arange(4) * np.pi / 2
    facing = axes[np.argmin(np.sin(axes))]  # most nearly -y
    return np.array([np.cos(facing), np.sin(facing), 0.0])


def room_azimuth_rad(planes: Sequence[Plane]) -> float | None:
    """Orientation of a rectangular room: the robust mean azimuth of its vertical planes, modulo 90 degrees.

    Args:
        planes: Planes of the room; only walls and panels count, weighted by their size.

    Returns:
        Azimuth of one of the room's axes in radians, from +x towards +y; None if the planes disagree.
    """
    vertical = [plane for plane in planes if plane.kind in ("wall", "panel")]
    if not vertical:
        return None
    angle = np.array([np.arctan2(plane.normal[1], plane.normal[0]) for plane in vertical])
    # The longer a plane is, the more precise is its azimuth.
    weight = np.array([plane.half_size_m[0] ** 2 * plane.half_size_m[1] for plane in vertical])
    mean = np.angle((weight * np.exp(4j * angle)).sum()) / 4
    for _ in range(3):  # the mean of the inliers: walls agree to a degree, furniture may stand askew
        deviation = np.abs(np.angle(np.exp(4j * (angle - mean)))) / 4
        near = deviation < np.deg2rad(6)
        if weight[near].sum() < _MIN_AGREEMENT * weight.sum() * 0.6:
            return None
        mean = np.angle((weight[near] * np.exp(4j * angle[near])).sum()) / 4
    return float(mean)


def _find_walls(grid: AlignedGrid, front: Vec3, is_wall: GridBool | None) -> dict[str, _Wall]:
    """The visible walls among front, left and right."""
    right = np.cross(UP, front)  # of the room, seen from the radar
    found = {"front": _find_wall(grid, front, is_wall)}
    candidates = is_wall
    if is_wall is not None and found["front"] is not None:
        # Wall cells before the front wall belong to a side wall, even where their normals could not be fitted.
        before = found["front"].distance_m + grid.points_m @ front > grid.tolerance_m + _BEFORE_FRONT_M
        candidates = is_wall & before & ~(np.abs(grid.normals[..., 2]) > _HORIZONTAL)
    for name, normal in (("left", right), ("right", -right)):
        found[name] = _find_wall(grid, normal, candidates, check_normals=candidates is is_wall)
    return {name: wall for name, wall in found.items() if wall is not None}


def _find_wall(
    grid: AlignedGrid,
    normal: Vec3,
    is_wall: GridBool | None,
    *,
    check_normals: bool = True,
    nearest_m: float = _MIN_DISTANCE_M,
) -> _Wall | None:
    """The farthest plane of that normal with enough visible area and hardly any point behind it."""
    is_cell = np.isfinite(grid.depth_m)
    points = grid.points_m[is_cell]
    distance_m = -(points @ normal)
    usable = distance_m > nearest_m
    if check_normals:
        usable &= grid.normals[is_cell] @ normal > _SAME_FACING
    if is_wall is not None:
        usable &= is_wall[is_cell]
    if not usable.any():
        return None
    height_m = points[:, 2] - grid.floor_z_m
    area_m2 = _cell_area_m2(grid, is_cell, normal)
    distance_bin = np.floor(distance_m / _BIN_M).astype(int)
    num_bins = int(distance_bin[usable].max()) + 2
    visible_m2 = np.bincount(distance_bin[usable], area_m2[usable], minlength=num_bins)
    visible_m2 = np.convolve(visible_m2, np.ones(3), mode="same")
    share_beyond = np.array([(distance_m > (b + 3) * _BIN_M).mean() for b in range(num_bins)])
    min_m2 = _MIN_VISIBLE_M2 if is_wall is None else _MIN_LABELLED_M2
    for b in np.flatnonzero((visible_m2 >= min_m2) & (share_beyond <= _MAX_BEYOND))[::-1]:
        while b > 0 and visible_m2[b - 1] > visible_m2[b]:
            b -= 1
        chosen = usable & (np.abs(distance_bin - b) <= 1)
        if is_wall is None and not _is_tall(height_m[chosen]):
            continue
        weights = 1 / np.square(grid.tolerance_m[is_cell][chosen])
        return _Wall(normal, float(np.average(distance_m[chosen], weights=weights)))
    return None


def _is_tall(height_m: PerPoint) -> bool:
    low, high = np.percentile(height_m, [2, 98])
    return bool(high >= _MIN_WALL_TOP_M and high - low >= 0.4)


def _cell_area_m2(grid: AlignedGrid, is_cell: GridBool, normal: Vec3) -> PerPoint:
    """The area that each of some cells covers of a surface with that normal, m2."""
    seen_m = (grid.points_m - grid.eye_m)[is_cell]
    focal = np.broadcast_to(grid.focal_cells, is_cell.shape)[is_cell]
    distance_m = np.linalg.norm(seen_m, axis=-1)
    normal_distance_m = np.maximum(np.abs(seen_m @ normal), 0.05 * distance_m)
    return distance_m**3 / (normal_distance_m * focal**2)


def _wall_material(planes: Sequence[Plane]) -> str:
    """The material of most of the visible wall area: the walls of a room are assumed alike."""
    area: dict[str, float] = defaultdict(float)
    for plane in planes:
        if plane.kind == "wall":
            area[plane.material] += plane.area_m2
    return max(area, key=area.__getitem__, default=DEFAULT_MATERIAL)


def _is_part_of(plane: Plane, wall: Plane) -> bool:
    """Whether a plane is a piece of the wall itself, and not a picture or a window on it."""
    off_m = abs((plane.centre_m - wall.centre_m) @ wall.normal)
    on_wall = plane.normal @ wall.normal > _SAME_FACING and off_m < _SAME_PLANE_M
    return bool(on_wall and (plane.kind == "wall" or plane.material == wall.material))


def _ceiling_m(grid: AlignedGrid, planes: Sequence[Plane]) -> float:
    """Height of the ceiling in the radar's frame: measured, or assumed above all that is visible."""
    seen = [plane.centre_m[2] for plane in planes if plane.kind == "ceiling"]
    highest = float(np.nanpercentile(grid.points_m[..., 2], 99.5))
    return max(seen) if seen else max(grid.floor_z_m + DEFAULT_HEIGHT_M, highest)


def _rectangles(
    found: dict[str, _Wall], grid: AlignedGrid, ahead: Vec3, right: Vec3, top_m: float, material: str
) -> tuple[Plane, ...]:
    """The walls as rectangles that meet; a wall that was not found is replaced by the extent of the points."""
    points = grid.points_m[np.isfinite(grid.depth_m)]
    seen_left, seen_right = np.percentile(points @ right, [1, 99])
    far_m = found["front"].distance_m if "front" in found else float(np.percentile(points @ ahead, 99))
    left_m = -found["left"].distance_m if "left" in found else min(float(seen_left), -_MIN_DISTANCE_M)
    right_m = found["right"].distance_m if "right" in found else max(float(seen_right), _MIN_DISTANCE_M)
    behind_m = found["back"].distance_m if "back" in found else BEHIND_M
    corners = {
        "front": (left_m * right + far_m * ahead, right_m * right + far_m * ahead),
        "left": (left_m * right - behind_m * ahead, left_m * right + far_m * ahead),
        "right": (right_m * right + far_m * ahead, right_m * right - behind_m * ahead),
        "back": (right_m * right - behind_m * ahead, left_m * right - behind_m * ahead),
    }
    height_m = top_m - grid.floor_z_m
    middle_m = (grid.floor_z_m + height_m / 2) * UP
    return tuple(
        Plane(
            kind="wall",
            centre_m=(start + end) / 2 + middle_m,
            normal=wall.normal,
            axis_u=np.cross(UP, wall.normal),
            axis_v=UP,
            half_size_m=(float(np.linalg.norm(end - start)) / 2, float(height_m) / 2),
            material=material,
        )
        for wall, (start, end) in ((wall, corners[name]) for name, wall in found.items())
    )
