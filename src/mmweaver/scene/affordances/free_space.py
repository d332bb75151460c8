"""Where a body may stand."""

import numpy as np

from mmweaver.core.records import FreeSpace
from mmweaver.core.shapes import GridMask
from mmweaver.scene.layout.connected_patches import places
from mmweaver.scene.layout.height_map import CELL_M, HeightMap

_EDGE_ON_M, _DEPTH_M = 0.13, 0.85
_TABLE_M = (0.3, 1.1)
_HOLLOW_M, _LONG_M = 0.4, 0.6  # below a table's rim, and how long it is at least: chairs are not as wide
_NEAREST_M = 0.5  # a body closer to the radar than this is not expected


def find_free_space(height_map: HeightMap, camera_height_m: float) -> FreeSpace:
    """Free is floor that is seen, or that must go on where nothing stands: seen through, or under the picture's edge.

    Nothing behind a wall is free, nor beside the picture, nor within half a metre of the radar, nor behind the edge of
    a thing as high as the camera or, where it is long and hollow below, higher: a table seen edge-on or from below
    hides its own top, and the floor is seen below it.
    """
    distance_m = np.hypot(height_map.x_m[None, :], height_map.y_m[:, None])
    is_open = height_map.is_floor_seen | height_map.is_seen_through | height_map.is_below_picture
    is_free = is_open & ~height_map.is_blocked & ~behind_edges(height_map, camera_height_m) & (distance_m >= _NEAREST_M)
    return FreeSpace(
        x_m=height_map.x_m,
        y_m=height_map.y_m,
        is_free=is_free,
        is_seen=height_map.is_floor_seen & is_free,
    )


def behind_edges(height_map: HeightMap, camera_height_m: float) -> GridMask:
    """Squares up to a table's depth behind rims at the camera's own height, and behind tables' rims above it."""
    over_m = np.nan_to_num(height_map.top_m, nan=-9.0) - camera_height_m
    is_table = (height_map.top_m > _TABLE_M[0]) & (height_map.top_m < _TABLE_M[1])
    level = is_table & ((np.abs(over_m) < _EDGE_ON_M) | _is_rim(height_map, is_table & (over_m > 0)))
    row, column = np.nonzero(level)
    x, y = height_map.x_m[column], height_map.y_m[row]
    length = np.maximum(np.hypot(x, y), 1e-6)
    hidden = np.zeros_like(level, dtype=bool)
    rows, columns = height_map.top_m.shape
    for far in np.arange(CELL_M / 2, _DEPTH_M, CELL_M / 2):
        a = np.floor((x * (1 + far / length) - height_map.x_m[0]) / CELL_M + 0.5).astype(int)
        b = np.floor((y * (1 + far / length) - height_map.y_m[0]) / CELL_M + 0.5).astype(int)
        inside = (a >= 0) & (a < columns) & (b >= 0) & (b < rows)
        hidden[b[inside], a[inside]] = True
    return hidden


def _is_rim(height_map: HeightMap, squares: GridMask) -> GridMask:
    """Of the squares those of patches that are hollow below and long."""
    from scipy import ndimage

    hollow = squares & (height_map.bottom_m > _HOLLOW_M)
    labels, _ = ndimage.label(hollow, structure=np.ones((3, 3)))  # pyright: ignore[reportGeneralTypeIssues]
    long = np.zeros_like(hollow)
    for number, place in enumerate(places(labels), start=1):
        if max(part.stop - part.start for part in place) * CELL_M >= _LONG_M:
            long[place] |= labels[place] == number
    return long
