"""What a class mask says of the room: where one can sit and where not, and where things with a name are."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Int

from mmweaver.core.records import ClassMask, Plane, RgbdPhoto
from mmweaver.core.shapes import Array, Points, Rotation
from mmweaver.geometry.pinhole import unproject
from mmweaver.scene.layout.connected_patches import labelled, places
from mmweaver.scene.layout.height_map import CELL_M, HALF_WIDTH_M, LENGTH_M
from mmweaver.scene.photo.depth_grid import DepthGrid, GridBool

LANDMARKS = {
    "door-stuff": "door", "door": "door", "window-other": "window", "window": "window", "window-blind": "window",
    "table": "table", "dining table": "table", "desk-stuff": "table", "desk": "table", "counter": "counter",
    "bed": "bed",
}  # fmt: skip
_MIN_CELLS = 40
SITTABLE = ("chair", "couch", "bench", "bed", "stool")
_NO_EVIDENCE = ("unlabeled", "furniture-other", "pillow", "blanket", "cloth", "textile-other", "rug", "person")
_LOWEST_M, _HIGHEST_M = 0.25, 0.65  # above the floor: where seats are

GridClass = Int[Array, "y x"]


def cells_of(grid: DepthGrid, photo: RgbdPhoto, names: frozenset[str]) -> GridBool | None:
    """The cells of a photo's grid that show one of these classes; None without a mask, or where it shows none."""
    if photo.classes is None or grid.class_index is None:
        return None
    found = np.isin(grid.class_index, numbers_of(photo.classes, names))
    return found if found.any() else None


def numbers_of(classes: ClassMask, names: frozenset[str]) -> list[int]:
    """The numbers that a mask has for classes of these names."""
    return [number for number, name in enumerate(classes.names) if name in names]


def regions_of(classes: ClassMask, names: frozenset[str], smallest: float) -> list[Bool[Array, "height width"]]:
    """The connected regions of pixels of these classes that are at least that share of the picture."""
    regions, count = labelled(np.isin(classes.index, numbers_of(classes, names)))
    each = [regions == region for region in range(1, count + 1)]
    return [region for region in each if region.mean() >= smallest]


def sittable_squares(photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float) -> GridClass | None:
    """1 where most of what lies at seat height in a square is a chair, couch, bench or bed, -1 where it is something
    else, 0 where nothing is known; on the squares of the height map. None without a mask.
    """
    mask = photo.classes
    if mask is None:
        return None
    value = np.array([_evidence(name) for name in mask.names])
    points = unproject(photo.depth_m, photo.intrinsics) @ radar_from_camera.T
    height = points[..., 2] - floor_z_m
    kept = (height > _LOWEST_M) & (height < _HIGHEST_M)
    points, sort = points[kept], value[mask.index[kept]]
    shape = (round(LENGTH_M / CELL_M), round(2 * HALF_WIDTH_M / CELL_M))
    column = np.floor((points[:, 0] + HALF_WIDTH_M) / CELL_M).astype(int)
    row = np.floor(points[:, 1] / CELL_M).astype(int)
    inside = (column >= 0) & (column < shape[1]) & (row >= 0) & (row < shape[0])
    total = np.bincount((row * shape[1] + column)[inside], weights=sort[inside], minlength=shape[0] * shape[1])
    return np.sign(total).astype(int).reshape(shape)


def _evidence(name: str) -> int:
    if name in SITTABLE:
        return 1
    is_room = name.startswith(("wall", "floor", "ceiling", "carpet"))
    return 0 if name in _NO_EVIDENCE or is_room else -1


def named_points(
    photo: RgbdPhoto, radar_from_camera: Rotation, planes: tuple[Plane, ...]
) -> Iterator[tuple[str, Points]]:
    """For each patch of pixels of a class that is a landmark: its kind and its points in the radar's frame.

    Where glass gives no depth, the points are those on the wall behind it.
    """
    mask = photo.classes
    if mask is None:
        return
    step = max(1, photo.intrinsics.width // 320)
    index = mask.index[::step, ::step]
    points = (unproject(photo.depth_m, photo.intrinsics) @ radar_from_camera.T)[::step, ::step]
    rays = (unproject(np.ones_like(photo.depth_m), photo.intrinsics) @ radar_from_camera.T)[::step, ::step]
    for kind in dict.fromkeys(LANDMARKS.values()):
        chosen = [i for i, name in enumerate(mask.names) if LANDMARKS.get(name) == kind]
        labels, _ = labelled(np.isin(index, chosen))
        for label, place in enumerate(places(labels), start=1):
            cells = labels[place] == label
            if cells.sum() < _MIN_CELLS:
                continue
            there = points[place][cells]
            measured = np.isfinite(there[:, 0])
            if measured.mean() < 0.5 and kind in ("door", "window"):
                there = _on_walls(rays[place][cells], planes)
                measured = np.isfinite(there[:, 0])
            if measured.sum() >= _MIN_CELLS:
                yield kind, there[measured]


def _on_walls(rays: Points, planes: tuple[Plane, ...]) -> Points:
    """Where rays from the radar first meet a wall; nan where they meet none."""
    reach = np.full(len(rays), np.inf)
    for wall in planes:
        if wall.kind != "wall":
            continue
        along = rays @ wall.normal
        distance = float(wall.normal @ wall.centre_m) / np.where(np.abs(along) < 1e-6, np.nan, along)
        aside = np.abs((rays * distance[:, None] - wall.centre_m) @ wall.axis_u)
        meets = (distance > 0) & (aside < wall.half_size_m[0] + 0.3)
        reach = np.where(meets & (distance < reach), distance, reach)
    return np.where(np.isfinite(reach)[:, None], rays * np.where(np.isfinite(reach), reach, 0.0)[:, None], np.nan)
