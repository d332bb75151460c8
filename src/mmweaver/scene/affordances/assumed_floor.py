"""Floor that no line of sight shows and that is probably there: behind furniture, and before what fills the picture."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Plane
from mmweaver.core.shapes import Array, GridMask
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.scene.affordances.free_space import MIN_DISTANCE_M, behind_edges
from mmweaver.scene.layout.height_map import HeightMap, surface_behind_m

_UPPER_BODY_M = (1.2, 1.35, 1.5)  # heights above the floor at which somebody behind a table is seen
_BODY_M = 0.25  # from the centre of a standing body to what is next to it
_BODY_HEIGHTS_M = (0.1, 1.9)
_BEARINGS = 180  # of two degrees each


def find_assumed_floor(
    height_map: HeightMap, view: AlignedPhoto, walls: Sequence[Plane], is_free: GridMask
) -> GridMask:
    """Squares, none of them in `is_free`, on which nothing was measured and a body could be seen at least in part.

    A square counts if it lies in front of all walls, nearer than the farthest thing in its direction, and a line of
    sight passes above it at the height of a chest; or if it is nearer than anything measured in its direction. The
    depth of a table behind its edge is table.
    """
    x_m, y_m = height_map.x_m, height_map.y_m
    distance_m = np.hypot(x_m[None, :], y_m[:, None])
    nearest_m, farthest_m = _extent_m(view)
    bearing = _bearing(np.arctan2(x_m[None, :], y_m[:, None]))
    passes = np.zeros(distance_m.shape, bool)
    for height_m in _UPPER_BODY_M:
        passes |= surface_behind_m(x_m, y_m, height_m, view)[1] > 0.0
    behind = passes & (distance_m < farthest_m[bearing] - _BODY_M)
    before = distance_m < nearest_m[bearing] - _BODY_M
    possible = (behind | before) & (distance_m >= MIN_DISTANCE_M) & _is_inside(height_map, walls)
    return possible & ~is_free & ~height_map.is_blocked & ~behind_edges(height_map)


def _extent_m(view: AlignedPhoto) -> tuple[Float[Array, " bearing"], Float[Array, " bearing"]]:
    """The nearest and the farthest measured ground distance in each direction, at the heights of a body; 0 if none."""
    points = view.points_m[view.photo.depth_m > 0.3]
    height_m = points[:, 2] - view.floor_z_m
    points = points[(height_m > _BODY_HEIGHTS_M[0]) & (height_m < _BODY_HEIGHTS_M[1])]
    bearing, ground_m = _bearing(np.arctan2(points[:, 0], points[:, 1])), np.hypot(points[:, 0], points[:, 1])
    nearest, farthest = np.full(_BEARINGS, np.inf), np.zeros(_BEARINGS)
    np.minimum.at(nearest, bearing, ground_m)
    np.maximum.at(farthest, bearing, ground_m)
    return np.where(np.isfinite(nearest), nearest, 0.0), farthest


def _bearing(bearing_rad: Float[Array, "*shape"]) -> Array:
    return np.floor(np.rad2deg(bearing_rad) * _BEARINGS / 360).astype(int) % _BEARINGS


def _is_inside(height_map: HeightMap, walls: Sequence[Plane]) -> GridMask:
    """Squares at least half a body's width in front of every wall."""
    inside = np.ones((len(height_map.y_m), len(height_map.x_m)), bool)
    for wall in walls:
        x, y = height_map.x_m[None, :] - wall.centre_m[0], height_map.y_m[:, None] - wall.centre_m[1]
        inside &= x * wall.normal[0] + y * wall.normal[1] > 0.0
    return inside
