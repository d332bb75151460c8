"""Evidence from a class mask: cells of given classes, evidence for seats, and the points of landmarks."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Int

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import ClassMask, Plane, RgbdPhoto
from mmweaver.core.shapes import Array, Points
from mmweaver.scene.coco_stuff import LANDMARKS, NO_EVIDENCE, SITTABLE
from mmweaver.scene.layout.height_map import bounding_slices, grid_axes, label_components, square_index
from mmweaver.scene.photo.depth_grid import DepthGrid, GridBool

_MIN_PIXELS = 40
_SEAT_HEIGHTS_M = (0.25, 0.65)  # above the floor

GridClass = Int[Array, "y x"]
PixelMask = Bool[Array, "height width"]


def cells_of(grid: DepthGrid, photo: RgbdPhoto, names: frozenset[str]) -> GridBool | None:
    """Cells of a photo's grid that show one of the given classes.

    Args:
        grid: The photo's depth grid.
        photo: The photo, with or without a class mask.
        names: COCO-Stuff classes.

    Returns:
        Mask (row, column); None without a class mask or if no cell shows any of the classes.
    """
    if photo.classes is None or grid.class_index is None:
        return None
    found = np.isin(grid.class_index, indices_of(photo.classes, names))
    return found if found.any() else None


def indices_of(classes: ClassMask, names: frozenset[str]) -> list[int]:
    """Indices that a mask uses for classes of these names."""
    return [index for index, name in enumerate(classes.names) if name in names]


def regions_of(classes: ClassMask, names: frozenset[str], min_share: float) -> list[PixelMask]:
    """Connected regions of pixels of the given classes.

    Args:
        classes: Class mask of the photo.
        names: COCO-Stuff classes; adjacent pixels of different ones form one region.
        min_share: Smallest area of a region, as a share of the picture.

    Returns:
        Masks (height, width), one per region.
    """
    labels, count = label_components(np.isin(classes.index, indices_of(classes, names)))
    regions = [labels == label for label in range(1, count + 1)]
    return [region for region in regions if region.mean() >= min_share]


def seat_evidence(view: AlignedPhoto) -> GridClass | None:
    """Majority vote of the classes at seat height (0.25 to 0.65 m) in each square of the height map.

    Args:
        view: The photo in the radar's frame.

    Returns:
        (y, x): 1 for a chair, couch, bench or bed, -1 for other objects, 0 without evidence. None without a mask.
    """
    mask = view.photo.classes
    if mask is None:
        return None
    height_m = view.points_m[..., 2] - view.floor_z_m
    at_seat_height = (height_m > _SEAT_HEIGHTS_M[0]) & (height_m < _SEAT_HEIGHTS_M[1])
    vote = np.array([_vote(name) for name in mask.names])[mask.index[at_seat_height]]
    x_m, y_m = grid_axes()
    shape = (len(y_m), len(x_m))
    square = square_index(view.points_m[at_seat_height], shape)
    total = np.bincount(square[square >= 0], weights=vote[square >= 0], minlength=shape[0] * shape[1])
    return np.sign(total).astype(int).reshape(shape)


def _vote(name: str) -> int:
    if name in SITTABLE:
        return 1
    is_room = name.startswith(("wall", "floor", "ceiling", "carpet"))
    return 0 if name in NO_EVIDENCE or is_room else -1


def landmark_points(view: AlignedPhoto, planes: tuple[Plane, ...]) -> Iterator[tuple[str, Points]]:
    """Points of each connected region of a landmark's class.

    Where glass gives no depth, the points are those on the wall behind it.

    Args:
        view: The photo in the radar's frame.
        planes: Planes of the room, the walls among them.

    Yields:
        Kind of the landmark, and the region's points in metres, (point, 3), radar's frame.
    """
    mask = view.photo.classes
    if mask is None:
        return
    step = max(1, view.photo.intrinsics.width // 320)
    every = (slice(None, None, step), slice(None, None, step))
    index, points_m, rays = mask.index[every], view.points_m[every], view.rays[every]
    for kind in dict.fromkeys(LANDMARKS.values()):
        chosen = [i for i, name in enumerate(mask.names) if LANDMARKS.get(name) == kind]
        labels, _ = label_components(np.isin(index, chosen))
        for label, region in enumerate(bounding_slices(labels), start=1):
            cells = labels[region] == label
            if cells.sum() < _MIN_PIXELS:
                continue
            found_m = points_m[region][cells]
            measured = np.isfinite(found_m[:, 0])
            if measured.mean() < 0.5 and kind in ("door", "window"):
                found_m = _intersection_with_walls(rays[region][cells], planes)
                measured = np.isfinite(found_m[:, 0])
            if measured.sum() >= _MIN_PIXELS:
                yield kind, found_m[measured]


def _intersection_with_walls(rays: Points, planes: tuple[Plane, ...]) -> Points:
    """First intersection of rays from the radar with a wall, metres; nan if there is none."""
    nearest = np.full(len(rays), np.inf)
    for wall in (plane for plane in planes if plane.kind == "wall"):
        along = rays @ wall.normal
        distance = float(wall.normal @ wall.centre_m) / np.where(np.abs(along) < 1e-6, np.nan, along)
        offset_m = np.abs((rays * distance[:, None] - wall.centre_m) @ wall.axis_u)
        meets = (distance > 0) & (offset_m < wall.half_size_m[0] + 0.3)
        nearest = np.where(meets & (distance < nearest), distance, nearest)
    is_met = np.isfinite(nearest)[:, None]
    return np.where(is_met, rays * np.where(np.isfinite(nearest), nearest, 0.0)[:, None], np.nan)
