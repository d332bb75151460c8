"""What hangs flat on a room's walls and is made of something else: windows, mirrors, doors, screens.

A pane of glass returns more than the wall it hangs in, and stands alone as a mirror for the radar's waves, though a
depth camera sees a hole there or nothing but the wall. Reference: decision 101.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool

from mmweaver.core.records import Plane, RgbdPhoto
from mmweaver.core.shapes import Array, Rotation
from mmweaver.geometry.pinhole import unproject
from mmweaver.scene.coco_stuff import DOORS, GLASS, MATERIAL, MIRRORS, SCREENS
from mmweaver.scene.layout.class_evidence import regions_of
from mmweaver.scene.photo.depth_grid import depth_tolerance_m

SMALLEST = 0.004  # of the picture
MIN_AREA_M2, MIN_SIDE_M = 0.15, 0.3
_OFF_WALL_M = 0.06  # how far a frame or a leaf may stand before its wall
_ON_WALL = 0.6  # share of what was measured of a thing that must lie on the wall
_EDGES = (2, 98)  # percentiles
_SAME_FACING, _SAME_PLANE_M = 0.95, 0.1


def hung_panels(photo: RgbdPhoto, radar_from_camera: Rotation, walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """Panels in the radar's frame for the windows, mirrors, doors and screens that a photo's mask shows on `walls`."""
    if photo.classes is None or not walls:
        return ()
    rays = unproject(np.ones_like(photo.depth_m), photo.intrinsics) @ radar_from_camera.T
    found = []
    for name in photo.classes.names:
        if name not in GLASS | MIRRORS | DOORS | SCREENS:
            continue
        for pixels in regions_of(photo.classes, frozenset({name}), SMALLEST):
            panel = _on_a_wall(pixels, photo, rays, walls, MATERIAL[name])
            if panel is not None:
                found.append(panel)
    return tuple(found)


def with_hung(planes: Sequence[Plane], hung: Sequence[Plane], walls: Sequence[Plane]) -> tuple[Plane, ...]:
    """All planes, less those that were found in the depth where a hung one is; `walls` stay."""
    return (
        *hung,
        *(
            plane
            for plane in planes
            if any(plane is wall for wall in walls) or not any(_covers(h, plane) for h in hung)
        ),
    )


def _covers(hung: Plane, plane: Plane) -> bool:
    offset = plane.centre_m - hung.centre_m
    return bool(
        hung.normal @ plane.normal > _SAME_FACING
        and abs(offset @ hung.normal) < _SAME_PLANE_M
        and abs(offset @ hung.axis_u) < hung.half_size_m[0]
        and abs(offset @ hung.axis_v) < hung.half_size_m[1]
    )


def _on_a_wall(
    pixels: Bool[Array, "height width"], photo: RgbdPhoto, rays: np.ndarray, walls: Sequence[Plane], material: str
) -> Plane | None:
    """The region as a rectangle on the wall that it lies on, if it lies on one."""
    depth, ways = photo.depth_m[pixels], rays[pixels]
    measured = np.isfinite(depth)
    if not measured.any():
        return None
    for wall in walls:
        with np.errstate(divide="ignore"):
            at_wall = float(wall.normal @ wall.centre_m) / (ways @ wall.normal)
        slack = _OFF_WALL_M + depth_tolerance_m(np.maximum(depth, 0))
        on_wall = measured & (np.abs(at_wall - depth) < slack)
        if on_wall.sum() < _ON_WALL * measured.sum():
            continue
        places = (ways * at_wall[:, None])[on_wall | ~measured & (at_wall > 0)]
        before = float(np.median((ways * depth[:, None])[on_wall] @ wall.normal - wall.centre_m @ wall.normal))
        return _rectangle(places, wall, max(before, 0.01), material)
    return None


def _rectangle(places_m: np.ndarray, wall: Plane, before_m: float, material: str) -> Plane | None:
    local = places_m - wall.centre_m
    left, right = np.percentile(local @ wall.axis_u, _EDGES)
    low, high = np.percentile(local @ wall.axis_v, _EDGES)
    half = (float(right - left) / 2, float(high - low) / 2)
    if 2 * min(half) < MIN_SIDE_M or 4 * half[0] * half[1] < MIN_AREA_M2:
        return None
    middle = wall.centre_m + (left + right) / 2 * wall.axis_u + (low + high) / 2 * wall.axis_v
    return Plane(
        kind="panel", centre_m=middle + before_m * wall.normal, normal=wall.normal, axis_u=wall.axis_u,
        axis_v=wall.axis_v, half_size_m=half, material=material,
    )  # fmt: skip
