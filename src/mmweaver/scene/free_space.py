"""Where a body may stand."""

import numpy as np

from mmweaver.core.records import FreeSpace
from mmweaver.scene.height_map import HeightMap

_NEAREST_M = 0.5  # a body closer to the radar than this is not expected


def find_free_space(height_map: HeightMap) -> FreeSpace:
    """Free is floor that is seen, or that must go on where nothing stands: seen through, or under the picture's edge.

    Nothing behind a wall is free, nor beside the picture, nor within half a metre of the radar.
    """
    distance_m = np.hypot(height_map.x_m[None, :], height_map.y_m[:, None])
    is_open = height_map.is_floor_seen | height_map.is_seen_through | height_map.is_below_picture
    is_free = is_open & ~height_map.is_blocked & (distance_m >= _NEAREST_M)
    return FreeSpace(
        x_m=height_map.x_m,
        y_m=height_map.y_m,
        is_free=is_free,
        is_seen=height_map.is_floor_seen & is_free,
    )
