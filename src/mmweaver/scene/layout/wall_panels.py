"""Flat panels on a room's walls of another material than the wall: windows, mirrors, doors, screens.

A pane of glass reflects more than the wall around it and is a specular reflector of its own, though a depth camera sees
a hole there or only the wall. Reference: docs/decisions/class-mask.md.
"""

from collections.abc import Sequence

import numpy as np

from mmweaver.core.records import Plane
from mmweaver.core.shapes import Points
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.scene.coco_stuff import DOORS, GLASS, MATERIAL, MIRRORS, SCREENS
from mmweaver.scene.layout.class_evidence import PixelMask, regions_of
from mmweaver.scene.photo.depth_grid import depth_tolerance_m

MIN_SHARE = 0.004  # of the picture
MIN_AREA_M2, MIN_SIDE_M = 0.15, 0.3
_MAX_OFFSET_M = 0.06  # how far a frame or a leaf may stand before its wall
_MIN_ON_WALL = 0.6  # share of a region's measured pixels that must lie on the wall
_EXTENT_PERCENTILES = (2, 98)
_SAME_NORMAL, _SAME_PLANE_M = 0.95, 0.1


def find_wall_panels(view: AlignedPhoto, walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """Panels for the windows, mirrors, doors and screens that the photo's class mask shows on `walls`."""
    classes = view.photo.classes
    if classes is None or not walls:
        return ()
    found = []
    for name in classes.names:
        if name not in GLASS | MIRRORS | DOORS | SCREENS:
            continue
        for region in regions_of(classes, frozenset({name}), MIN_SHARE):
            panel = _panel(region, view, walls, MATERIAL[name])
            if panel is not None:
                found.append(panel)
    return tuple(found)


def with_wall_panels(planes: Sequence[Plane], panels: Sequence[Plane], walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """The panels and all planes that none of them covers; `walls` always stay."""

    def is_kept(plane: Plane) -> bool:
        return any(plane is wall for wall in walls) or not any(_covers(panel, plane) for panel in panels)

    return (*panels, *filter(is_kept, planes))


def _covers(panel: Plane, plane: Plane) -> bool:
    offset = plane.centre_m - panel.centre_m
    return bool(
        panel.normal @ plane.normal > _SAME_NORMAL
        and abs(offset @ panel.normal) < _SAME_PLANE_M
        and abs(offset @ panel.axis_u) < panel.half_size_m[0]
        and abs(offset @ panel.axis_v) < panel.half_size_m[1]
    )


def _panel(region: PixelMask, view: AlignedPhoto, walls: Sequence[Plane], material: str) -> Plane | None:
    """The region as a rectangle on the wall that its measured pixels lie on; None where they lie on no wall."""
    depth_m, rays = view.photo.depth_m[region], view.rays[region]
    measured = np.isfinite(depth_m)
    if not measured.any():
        return None
    for wall in walls:
        with np.errstate(divide="ignore"):
            wall_depth_m = float(wall.normal @ wall.centre_m) / (rays @ wall.normal)
        tolerance_m = _MAX_OFFSET_M + depth_tolerance_m(np.maximum(depth_m, 0))
        on_wall = measured & (np.abs(wall_depth_m - depth_m) < tolerance_m)
        if on_wall.sum() < _MIN_ON_WALL * measured.sum():
            continue
        projected_m = (rays * wall_depth_m[:, None])[on_wall | ~measured & (wall_depth_m > 0)]
        offset_m = float(np.median((rays * depth_m[:, None])[on_wall] @ wall.normal - wall.centre_m @ wall.normal))
        return _rectangle(projected_m, wall, max(offset_m, 0.01), material)
    return None


def _rectangle(points_m: Points, wall: Plane, offset_m: float, material: str) -> Plane | None:
    """The bounding rectangle of points on a wall, moved off it by `offset_m`; None if it is too small."""
    local = points_m - wall.centre_m
    left, right = np.percentile(local @ wall.axis_u, _EXTENT_PERCENTILES)
    low, high = np.percentile(local @ wall.axis_v, _EXTENT_PERCENTILES)
    half = (float(right - left) / 2, float(high - low) / 2)
    if 2 * min(half) < MIN_SIDE_M or 4 * half[0] * half[1] < MIN_AREA_M2:
        return None
    middle = wall.centre_m + (left + right) / 2 * wall.axis_u + (low + high) / 2 * wall.axis_v
    return Plane(
        kind="panel", centre_m=middle + offset_m * wall.normal, normal=wall.normal, axis_u=wall.axis_u,
        axis_v=wall.axis_v, half_size_m=half, material=material,
    )  # fmt: skip
