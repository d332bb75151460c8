"""Fuses the views of one room from several photos: planes, floor, seats, landmarks."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from mmweaver.core.records import FreeSpace, Landmark, Plane
from mmweaver.scene.affordances.landmarks import MIN_DISTANCE_M
from mmweaver.scene.layout.surfaces import AlignedGrid
from mmweaver.scene.multiview.registration import LevelPose
from mmweaver.scene.single_view import SingleView

SAME_PLANE_M, SAME_NORMAL = 0.1, np.cos(np.deg2rad(10))
GAP_M = 0.15  # between two parts of one plane
SAME_SEAT_M, SAME_LANDMARK_M = 0.4, 0.8


def joined_grid(seen: Sequence[SingleView], poses: Sequence[LevelPose]) -> AlignedGrid:
    """Concatenates the cells of all photos in the first camera's level frame.

    Args:
        seen: The room as each photo shows it.
        poses: Level pose of each photo.

    Returns:
        One row of cells, (1, cell); the grid of a single photo is returned unchanged.
    """
    if len(seen) == 1:
        return seen[0].room.grid

    def one_row(parts: list[np.ndarray]) -> np.ndarray:
        return np.concatenate([part.reshape(-1, *part.shape[2:]) for part in parts])[None]

    grids = [one.room.grid for one in seen]
    pairs = list(zip(grids, poses, strict=True))
    return AlignedGrid(
        points_m=one_row([pose.points(grid.points_m) for grid, pose in pairs]),
        normals=one_row([pose.directions(grid.normals) for grid, pose in pairs]),
        depth_m=one_row([grid.depth_m for grid in grids]),
        floor_z_m=seen[0].view.floor_z_m,
        focal_cells=one_row([np.full(grid.depth_m.shape, grid.focal_cells) for grid in grids]),
        eye_m=one_row([np.broadcast_to(pose.position_m, grid.points_m.shape) for grid, pose in pairs]),
    )


def joined_planes(planes: Sequence[Plane], is_whole: bool) -> Sequence[Plane]:
    """Merges planes of several photos that are parts of one surface: coplanar to 0.1 m and 10 degrees, and adjacent.

    Args:
        planes: Planes of all photos in one frame.
        is_whole: Whether several photos contribute; if not, `planes` is returned unchanged.

    Returns:
        Merged planes by decreasing area; the largest part determines kind, material and axes.
    """
    if not is_whole:
        return planes
    joined: list[Plane] = []
    for plane in sorted(planes, key=lambda one: -one.area_m2):
        at = next((index for index, one in enumerate(joined) if _is_one(one, plane)), None)
        if at is None:
            joined.append(plane)
        else:
            joined[at] = _joined(joined[at], plane)
    return joined


def _is_one(large: Plane, small: Plane) -> bool:
    """Whether two planes coincide and touch."""
    if (
        large.normal @ small.normal < SAME_NORMAL
        or abs((small.centre_m - large.centre_m) @ large.normal) > SAME_PLANE_M
    ):
        return False
    low, high = _extent(large, small)
    half = np.array(large.half_size_m) + GAP_M
    return bool((low < half).all() and (high > -half).all())


def _extent(large: Plane, small: Plane) -> tuple[np.ndarray, np.ndarray]:
    """Extent of the smaller plane's corners along the axes of the larger, from its centre."""
    local = (small.corners_m - large.centre_m) @ np.stack([large.axis_u, large.axis_v], axis=1)
    return local.min(axis=0), local.max(axis=0)


def _joined(large: Plane, small: Plane) -> Plane:
    low, high = _extent(large, small)
    half = np.array(large.half_size_m)
    return large.spanned(np.minimum(low, -half), np.maximum(high, half))


def joined_free_space(seen: Sequence[SingleView], poses: Sequence[LevelPose]) -> FreeSpace:
    """Fuses the floor maps: floor that any photo shows as free and none shows as blocked.

    Args:
        seen: The room as each photo shows it.
        poses: Level pose of each photo.

    Returns:
        Free floor on the first camera's grid; floor that the first camera sees is free in any case.
    """
    first = seen[0].free_space
    if len(seen) == 1:
        return first
    is_free, is_seen = np.zeros_like(first.is_free), np.zeros_like(first.is_free)
    is_blocked = np.zeros_like(first.is_free)
    for one, pose in zip(seen, poses, strict=True):
        own = one.free_space
        is_seen |= pose.looked_up(own.is_seen, own, first.x_m, first.y_m)
        is_free |= pose.looked_up(own.is_free, own, first.x_m, first.y_m)
        is_blocked |= pose.looked_up(one.height_map.is_blocked, own, first.x_m, first.y_m)
    is_free &= ~is_blocked | first.is_seen
    is_free &= np.hypot(first.x_m[None], first.y_m[:, None]) >= MIN_DISTANCE_M
    return FreeSpace(x_m=first.x_m, y_m=first.y_m, is_free=is_free, is_seen=is_seen & is_free)


def joined_places(places: Sequence[Any]) -> list[Any]:
    """Removes duplicate seats (within 0.4 m) or landmarks of one kind (within 0.8 m).

    Args:
        places: Seats or landmarks of all photos in one frame.

    Returns:
        The first of each group of duplicates, in the order given.
    """
    kept: list[Any] = []
    for place in places:
        apart_m = SAME_LANDMARK_M if isinstance(place, Landmark) else SAME_SEAT_M
        same = (one for one in kept if getattr(one, "kind", "") == getattr(place, "kind", ""))
        if all(np.linalg.norm((place.position_m - one.position_m)[:2]) > apart_m for one in same):
            kept.append(place)
    return kept
