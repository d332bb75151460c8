"""Walls beyond the picture: what a photo shows of a room, closed to the box that rooms are.

A radar's beam is wider than a camera's view, and what it hears most of a wall is the foot of the perpendicular from
itself, which for the walls at its sides lies outside the picture. Reference: decision 99.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.records import Plane
from mmweaver.core.shapes import Vec3
from mmweaver.scene.layout.surfaces import UP, LevelGrid
from mmweaver.scene.photo.depth_grid import GridBool

BEHIND_M = 0.5  # walls are taken to go on so far behind the radar
USUAL_MATERIAL = "plasterboard"
USUAL_HEIGHT_M = 2.5  # of a room whose ceiling is not seen
_BIN_M = 0.04
_SAME_FACING = np.cos(np.deg2rad(20))
_LEVEL = np.cos(np.deg2rad(45))
_SAME_PLANE_M = 0.12
_MIN_SUPPORT_M2 = 0.15  # seen of a wall; less may be a thing
_MIN_KNOWN_M2 = 0.05  # the same, where a mask says what is wall
_BEFORE_FRONT_M = 0.08
_MIN_TALL_M = 1.2  # above the floor reaches what is seen of a wall
_MAX_BEYOND = 0.04  # share of what is seen that may lie behind a wall (a window, a doorway)
_NEAREST_M = 0.3
_MIN_AGREEMENT = 0.8  # of the upright faces that stand along or across the room
_HALVES = ((0, 1, 2), (0, 2, 3))
_SET_BACK_M = 0.03  # of the wall that closes gaps, so that what was measured lies before it


@dataclass(frozen=True, kw_only=True)
class RoomLayout:
    """All faces of the room but the floor, and the triangles that close it where nothing was measured."""

    planes: tuple[Plane, ...]
    added: tuple[Plane, ...]  # those of `planes` whose rectangles reach beyond what was seen
    assumptions: tuple[str, ...]


@dataclass(frozen=True)
class _Side:
    """A wall found along one axis of the room: normal towards the radar, distance from it."""

    normal: Vec3
    distance_m: float


def close_room(grid: LevelGrid, planes: Sequence[Plane], is_wall: GridBool | None = None) -> RoomLayout:
    """Continues the walls that are seen until they meet, reach the ceiling, and pass the radar.

    `planes` are the room's faces without its floor; `is_wall` says which cells are known to show walls. Rooms that
    are not right-angled, and sides of which too little is seen, stay as they are.
    """
    front = _front(planes)
    unchanged = RoomLayout(planes=tuple(planes), added=(), assumptions=())
    if front is None:
        return unchanged
    right = np.cross(UP, front)  # of the room, seen from the radar
    sides = _found_sides(grid, front, is_wall)
    if not sides:
        return unchanged
    walls = _walls(sides, grid, -front, right, _ceiling_m(grid, planes), _wall_material(planes))
    kept = tuple(plane for plane in planes if not any(_is_part_of(plane, wall) for wall in walls))
    return RoomLayout(
        planes=(*walls, *kept), added=walls,
        assumptions=(
            UsualAssumption(f"Walls ({', '.join(sides)}) were continued until they meet, and past the radar."),
        ),
    )  # fmt: skip


def wall_faces(walls: Sequence[Plane]) -> tuple[np.ndarray, np.ndarray]:
    """The walls as two triangles each, somewhat behind what was measured of them: (vertex, 3), (face, 3)."""
    corners = [
        wall.centre_m - _SET_BACK_M * wall.normal + u * wall.half_size_m[0] * wall.axis_u
        + v * wall.half_size_m[1] * wall.axis_v
        for wall in walls for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]  # fmt: skip
    faces = [[4 * index + a, 4 * index + b, 4 * index + c] for index in range(len(walls)) for a, b, c in _HALVES]
    return np.array(corners).reshape(-1, 3), np.array(faces, dtype=int).reshape(-1, 3)


def _front(planes: Sequence[Plane]) -> Vec3 | None:
    """Normal of the room's front wall: the axis most nearly towards the radar of those that the faces agree on."""
    upright = [plane for plane in planes if plane.kind in ("wall", "panel")]
    if not upright:
        return None
    angle = np.array([np.arctan2(plane.normal[1], plane.normal[0]) for plane in upright])
    # a face tells its direction the better the longer it is
    weight = np.array([plane.half_size_m[0] ** 2 * plane.half_size_m[1] for plane in upright])
    mean = np.angle((weight * np.exp(4j * angle)).sum()) / 4
    for _ in range(3):  # walls agree to a degree; what stands across shall not turn them
        off = np.abs(np.angle(np.exp(4j * (angle - mean)))) / 4
        near = off < np.deg2rad(6)
        if weight[near].sum() < _MIN_AGREEMENT * weight.sum() * 0.6:
            return None
        mean = np.angle((weight[near] * np.exp(4j * angle[near])).sum()) / 4
    axes = mean + np.arange(4) * np.pi / 2
    facing = axes[np.argmin(np.sin(axes))]  # most nearly -y
    return np.array([np.cos(facing), np.sin(facing), 0.0])


def _found_sides(grid: LevelGrid, front: Vec3, is_wall: GridBool | None) -> dict[str, _Side]:
    """The walls that are seen, by where they stand."""
    right = np.cross(UP, front)  # of the room, seen from the radar
    found = {"front": _side(grid, front, is_wall)}
    known = is_wall
    if is_wall is not None and found["front"] is not None:
        # What is wall and stands before the front wall is of a side, even where too little is seen to fit a face.
        before = found["front"].distance_m + grid.points_m @ front > grid.tolerance_m + _BEFORE_FRONT_M
        known = is_wall & before & ~(np.abs(grid.normals[..., 2]) > _LEVEL)
    for name, normal in (("left", right), ("right", -right)):
        found[name] = _side(grid, normal, known, needs_faces=known is is_wall)
    return {name: side for name, side in found.items() if side is not None}


def _side(grid: LevelGrid, normal: Vec3, is_wall: GridBool | None, *, needs_faces: bool = True) -> _Side | None:
    """The outermost plane of that normal on which enough is seen, and behind which hardly anything is."""
    is_cell = np.isfinite(grid.depth_m)
    points = grid.points_m[is_cell]
    away = -(points @ normal)
    usable = away > _NEAREST_M
    if needs_faces:
        usable &= grid.normals[is_cell] @ normal > _SAME_FACING
    if is_wall is not None:
        usable &= is_wall[is_cell]
    if not usable.any():
        return None
    height = points[:, 2] - grid.floor_z_m
    area = _area_m2(points, normal, grid.focal_cells)
    bins = np.floor(away / _BIN_M).astype(int)
    wide = int(bins[usable].max()) + 2
    support = np.bincount(bins[usable], area[usable], minlength=wide)
    support = np.convolve(support, np.ones(3), mode="same")
    beyond = np.array([(away > (b + 3) * _BIN_M).mean() for b in range(wide)])
    least_m2 = _MIN_SUPPORT_M2 if is_wall is None else _MIN_KNOWN_M2
    for b in np.flatnonzero((support >= least_m2) & (beyond <= _MAX_BEYOND))[::-1]:
        while b > 0 and support[b - 1] > support[b]:
            b -= 1
        chosen = usable & (np.abs(bins - b) <= 1)
        if is_wall is None and not _is_tall(height[chosen]):
            continue
        distance = float(np.average(away[chosen], weights=1 / np.square(grid.tolerance_m[is_cell][chosen])))
        return _Side(normal, distance)
    return None


def _is_tall(height_m: np.ndarray) -> bool:
    low, high = np.percentile(height_m, [2, 98])
    return bool(high >= _MIN_TALL_M and high - low >= 0.4)


def _area_m2(points_m: np.ndarray, normal: Vec3, focal_cells: float) -> np.ndarray:
    """Of a face of that normal, what each cell shows."""
    distance = np.linalg.norm(points_m, axis=-1)
    across = np.maximum(np.abs(points_m @ normal), 0.05 * distance)
    return distance**3 / (across * focal_cells**2)


def _wall_material(planes: Sequence[Plane]) -> str:
    """Of most of what is seen of walls: a room's are alike, and doors, windows and cupboards stand before them."""
    area: dict[str, float] = {}
    for plane in planes:
        if plane.kind == "wall":
            area[plane.material] = area.get(plane.material, 0.0) + plane.half_size_m[0] * plane.half_size_m[1]
    return max(area, key=lambda name: area[name]) if area else USUAL_MATERIAL


def _lies_on(plane: Plane, normal: Vec3, distance: float) -> bool:
    return bool(plane.normal @ normal > _SAME_FACING and abs(plane.centre_m @ normal + distance) < _SAME_PLANE_M)


def _is_part_of(plane: Plane, wall: Plane) -> bool:
    """A piece of the wall itself, and not a picture or a window on it."""
    if not _lies_on(plane, wall.normal, -float(wall.centre_m @ wall.normal)):
        return False
    return plane.kind == "wall" or plane.material == wall.material


def _ceiling_m(grid: LevelGrid, planes: Sequence[Plane]) -> float:
    seen = [plane.centre_m[2] for plane in planes if plane.kind == "ceiling"]
    highest = float(np.nanpercentile(grid.points_m[..., 2], 99.5))
    return max(seen) if seen else max(grid.floor_z_m + USUAL_HEIGHT_M, highest)


def _walls(
    sides: dict[str, _Side], grid: LevelGrid, ahead: Vec3, right: Vec3, top_m: float, material: str
) -> tuple[Plane, ...]:
    """The sides as rectangles that meet."""
    points = grid.points_m[np.isfinite(grid.depth_m)]
    seen_left, seen_right = np.percentile(points @ right, [1, 99])
    far = sides["front"].distance_m if "front" in sides else float(np.percentile(points @ ahead, 99))
    left_m = -sides["left"].distance_m if "left" in sides else min(float(seen_left), -_NEAREST_M)
    right_m = sides["right"].distance_m if "right" in sides else max(float(seen_right), _NEAREST_M)
    corners = {
        "front": (left_m * right + far * ahead, right_m * right + far * ahead),
        "left": (left_m * right - BEHIND_M * ahead, left_m * right + far * ahead),
        "right": (right_m * right + far * ahead, right_m * right - BEHIND_M * ahead),
    }
    walls = []
    for name, side in sides.items():
        start, end = corners[name]
        height = top_m - grid.floor_z_m
        wall = Plane(
            kind="wall", centre_m=(start + end) / 2 + (grid.floor_z_m + height / 2) * UP, normal=side.normal,
            axis_u=np.cross(UP, side.normal), axis_v=UP,
            half_size_m=(float(np.linalg.norm(end - start)) / 2, float(height) / 2), material=material,
        )  # fmt: skip
        walls.append(wall)
    return tuple(walls)
