"""Floor on which a body may stand: visible or inferred, and assumed behind furniture."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import FreeSpace, Plane
from mmweaver.core.shapes import Array, GridMask
from mmweaver.scene.layout.connected_components import bounding_slices
from mmweaver.scene.layout.height_map import CELL_M, HeightMap, nearest_squares, surface_behind_m

_EDGE_ON_M, _TABLE_DEPTH_M = 0.13, 0.85
_TABLE_HEIGHTS_M = (0.3, 1.1)
_MIN_CLEARANCE_M, _MIN_LENGTH_M = 0.4, 0.6  # below a table's rim, and along it: chairs are not as wide
MIN_DISTANCE_M = 0.5  # of a body from the radar


def find_free_space(height_map: HeightMap) -> FreeSpace:
    """Floor that is visible, or inferred where nothing stands: squares seen through, or below the picture's edge.

    Not free are places behind walls, outside the picture's width, within half a metre of the radar, and behind the
    edge of a table at the camera's height or above it: seen edge-on or from below, a table occludes its own top while
    the floor below it is visible.

    Args:
        height_map: The room from above.

    Returns:
        The free squares on the height map's grid, and those of them that were measured.
    """
    distance_m = np.hypot(height_map.x_m[None, :], height_map.y_m[:, None])
    is_open = height_map.is_floor_seen | height_map.is_seen_through | height_map.is_below_picture
    is_free = is_open & ~height_map.is_blocked & ~hidden_by_tables(height_map) & (distance_m >= MIN_DISTANCE_M)
    return FreeSpace(
        x_m=height_map.x_m,
        y_m=height_map.y_m,
        is_free=is_free,
        is_seen=height_map.is_floor_seen & is_free,
    )


def hidden_by_tables(height_map: HeightMap) -> GridMask:
    """Squares occluded by a table that is seen edge-on or from below.

    Args:
        height_map: The room from above.

    Returns:
        Mask (y, x): squares up to 0.85 m, the depth of a table, behind the edges of surfaces at the camera's own height
        and behind the rims of tables above it.
    """
    above_camera_m = np.nan_to_num(height_map.top_m, nan=-9.0) + height_map.floor_z_m
    is_table = (height_map.top_m > _TABLE_HEIGHTS_M[0]) & (height_map.top_m < _TABLE_HEIGHTS_M[1])
    is_edge_on = np.abs(above_camera_m) < _EDGE_ON_M
    is_edge = is_table & (is_edge_on | _is_rim(height_map, is_table & (above_camera_m > 0)))
    row, column = np.nonzero(is_edge)
    x, y = height_map.x_m[column], height_map.y_m[row]
    distance = np.maximum(np.hypot(x, y), 1e-6)
    occluded = np.zeros_like(is_edge, dtype=bool)
    for behind in np.arange(CELL_M / 2, _TABLE_DEPTH_M, CELL_M / 2):
        farther = 1 + behind / distance
        b, a, inside = nearest_squares(x * farther, y * farther, height_map.x_m, height_map.y_m)
        occluded[b[inside], a[inside]] = True
    return occluded


def _is_rim(height_map: HeightMap, squares: GridMask) -> GridMask:
    """Those of the squares in components that are long and hollow below."""
    from scipy import ndimage

    hollow = squares & (height_map.bottom_m > _MIN_CLEARANCE_M)
    labels, _ = ndimage.label(hollow, structure=np.ones((3, 3)))
    is_rim = np.zeros_like(hollow)
    for label, region in enumerate(bounding_slices(labels), start=1):
        if max(part.stop - part.start for part in region) * CELL_M >= _MIN_LENGTH_M:
            is_rim[region] |= labels[region] == label
    return is_rim


_UPPER_BODY_M = (1.2, 1.35, 1.5)  # heights above the floor at which a body behind a table is visible
_BODY_M = 0.25  # from the centre of a standing body to adjacent objects
_BODY_HEIGHTS_M = (0.1, 1.9)
_BEARINGS = 180  # of two degrees each


def find_assumed_floor(
    height_map: HeightMap, view: AlignedPhoto, walls: Sequence[Plane], is_free: GridMask
) -> GridMask:
    """Unmeasured squares on which a body would be visible at least in part.

    A square counts if it lies in front of all walls, nearer than the farthest measurement at its bearing, and a line of
    sight passes above it at chest height; or if it is nearer than any measurement at its bearing. The depth of a table
    behind its edge counts as table.

    Args:
        height_map: The room from above.
        view: The photo in the radar's frame.
        walls: Walls of the room, normals towards the room.
        is_free: Squares already known to be free, (y, x).

    Returns:
        Mask (y, x), disjoint from `is_free`.
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
    return possible & ~is_free & ~height_map.is_blocked & ~hidden_by_tables(height_map)


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
