"""Infers geometry of partly visible objects: table legs, tops behind their rims, objects that reach the floor.

All points are (point, 3) in metres in the radar's frame; heights are above the floor.
"""

import numpy as np
from jaxtyping import Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import Plane, Scene

Points = Float[np.ndarray, "point 3"]
_LOW_M, _EXTENDED_DOWN_M = (
    0.24,
    (0.04, 0.08, 0.12, 0.16),
)  # objects below this height reach the floor; offsets of added points
_SOLE_M = 0.035  # lower points are floor
_TABLE_M = (0.35, 1.1)  # heights of level tops that stand on legs
_INSET_M, _LEG_STEP_M, _TOP_THICKNESS_M, _LEG_HALF_M = (
    0.05,
    0.05,
    0.04,
    0.025,
)  # legs: from the corner, spacing, top, width
_MIN_UNSEEN = 0.6  # a leg is plausible if this share of it is occluded or outside the picture
_RIM_M, _SLICE_M = (0.58, 1.05), 0.03  # heights of table tops, tested slice by slice
_THIN_M, _LONG_M = 0.12, 0.55  # maximum thickness and minimum length of a top
_CELL_M, _REACH_M = 0.05, 5.0  # grid for tops and legs, and its half side
_LEG_M, _LEG_THICK_M = (0.3, 0.55), 0.04  # a leg is visible below and above these heights, a seat is not
_GAP = 13  # cells: maximum gap in a top by chairs in front of it
_LOW_TOPS_M, _LOW_GAP = (0.2, 0.65), 7  # heights of beds and seats; gap between pixel rows in cells
_SEEN_BY_RIM_M, _TOP_DEPTH_M, _SPACING_M = 0.1, 0.8, 0.03  # a top at most this far below the camera shows its rim
_BEHIND_M, _BEHIND_PER_M2 = 0.065, 0.0035  # a measurement this far behind a point rules it out; noise grows with depth
_OCCLUDING_M = 0.15  # a measurement this far in front of a point occludes it; a nearer one may be the body itself
_LEG_HEIGHTS_M, _TO_SIDE_M = (0.15, 0.35, 0.55, 0.75), 0.2  # sample points on the legs of a walker
_BELOW_STEP_M, _BELOW_VOXEL_M = 0.05, 0.05


def extended_to_floor(points: Points, floor_z_m: float) -> Float[np.ndarray, "below 3"]:
    """Points below those measured low above the floor: such objects reach the floor.

    Args:
        points: Measured points.
        floor_z_m: Height of the floor, metres.

    Returns:
        The added points.
    """
    low = points[points[:, 2] < floor_z_m + _LOW_M]
    down = np.concatenate([low - np.array([0.0, 0.0, step]) for step in _EXTENDED_DOWN_M])
    return down[down[:, 2] > floor_z_m + _SOLE_M]


def table_legs(scene: Scene) -> Points:
    """Points of legs at the corners of level tops, unless the camera sees through them.

    Args:
        scene: The room.

    Returns:
        Points (point, 3).
    """
    legs = [
        _leg(scene, plane, u, v) for plane in scene.planes if _is_table(scene, plane) for u in (-1, 1) for v in (-1, 1)
    ]
    return np.concatenate([leg for leg in legs if _is_possible(scene, leg)] or [np.zeros((0, 3))])


def _is_table(scene: Scene, plane: Plane) -> bool:
    height_m = float(plane.centre_m[2]) - scene.floor_z_m
    return plane.kind == "top" and _TABLE_M[0] < height_m < _TABLE_M[1]


def _leg(scene: Scene, plane: Plane, u: int, v: int) -> Points:
    half_u, half_v = (max(half - _INSET_M, 0.0) for half in plane.half_size_m)
    corner = plane.centre_m + u * half_u * plane.axis_u + v * half_v * plane.axis_v
    height = np.arange(scene.floor_z_m + _LEG_STEP_M, float(corner[2]) - _TOP_THICKNESS_M, _LEG_STEP_M)
    sides = [corner + a * _LEG_HALF_M * plane.axis_u + b * _LEG_HALF_M * plane.axis_v for a in (-1, 1) for b in (-1, 1)]
    return np.concatenate([np.column_stack([np.tile(side[:2], (len(height), 1)), height]) for side in sides])


def table_tops(scene: Scene, points: Points) -> Float[np.ndarray, "top 3"]:
    """Points on table tops and rims, which are thin and long, and inferred points of tops that their rims occlude.

    Args:
        scene: The room.
        points: Measured points.

    Returns:
        Points of tops, (top, 3).
    """
    height = points[:, 2] - scene.floor_z_m
    column, row = np.floor((points[:, :2].T + _REACH_M) / _CELL_M).astype(int)
    side = int(2 * _REACH_M / _CELL_M)
    inside = (column >= 0) & (column < side) & (row >= 0) & (row < side)
    cell = np.where(inside, row * side + column, -1)
    in_band = inside & (height > _RIM_M[0]) & (height < _RIM_M[1])
    highest, lowest = np.full(side**2, -np.inf), np.full(side**2, np.inf)
    np.maximum.at(highest, cell[in_band], height[in_band])
    # Chairs below a top do not belong to it.
    near_top = in_band & (height > highest[cell] - 2 * _THIN_M)
    np.minimum.at(lowest, cell[near_top], height[near_top])
    thin = highest - lowest < _THIN_M
    is_top, between = np.zeros(side**2, bool), []
    for level in np.arange(*_RIM_M, _SLICE_M):
        at_level = _long_patches((thin & (np.abs(highest - level) <= _SLICE_M)).reshape(side, side))
        is_top |= at_level.ravel()
        row, column = np.nonzero(_between(at_level))
        middle = np.stack([column, row], axis=-1) * _CELL_M + 0.5 * _CELL_M - _REACH_M
        between.append(np.column_stack([middle, np.full(len(middle), level + scene.floor_z_m)]))
    tops = points[near_top & is_top[cell]]
    unseen = np.concatenate([*between, *(_rectangle(scene, plane) for plane in scene.planes)])
    # A chair's back hides the edge behind it by a few centimetres only: all points not seen through count.
    unseen = unseen[AlignedPhoto.of(scene).look_up(unseen).in_picture & ~_seen_through(scene, unseen)]
    return np.concatenate([tops, unseen, _behind_rims(scene, tops)])


def _rectangle(scene: Scene, plane: Plane) -> Points:
    """Points over the rectangle of a table top, which chairs in front of it occlude in part."""
    height_m = float(plane.centre_m[2]) - scene.floor_z_m
    if plane.kind != "top" or not _RIM_M[0] < height_m < _RIM_M[1]:
        return np.zeros((0, 3))
    u, v = (np.arange(-half, half + 1e-9, _CELL_M)[:, None] for half in plane.half_size_m)
    return (plane.centre_m + u[:, None] * plane.axis_u + v[None] * plane.axis_v).reshape(-1, 3)


def low_gap_points(scene: Scene, points: Points) -> Float[np.ndarray, "between 3"]:
    """Points between measured ones at one level: pixel rows are far apart on a bed seen at a grazing angle.

    Args:
        scene: The room.
        points: Measured points of low furniture.

    Returns:
        The added points, (between, 3).
    """
    side = int(2 * _REACH_M / _CELL_M)
    cell, inside = _cells(points, side)
    height = points[:, 2] - scene.floor_z_m
    found = [np.zeros((0, 3))]
    for level in np.arange(*_LOW_TOPS_M, _CELL_M):
        cells = np.zeros((side, side), bool)
        cells[tuple(cell[inside & (np.abs(height - level) <= _CELL_M)].T)] = True
        row, column = np.nonzero(_between(cells, _LOW_GAP))
        middle = np.stack([column, row], axis=-1) * _CELL_M + 0.5 * _CELL_M - _REACH_M
        found.append(np.column_stack([middle, np.full(len(middle), level + scene.floor_z_m)]))
    between = np.concatenate(found)
    return between[~_seen_through(scene, between)]


def _between(cells: np.ndarray, gap: int = _GAP) -> np.ndarray:
    """The gaps of less than `gap` cells between occupied cells, (y, x)."""
    from scipy import ndimage

    if not cells.any():
        return cells
    wide = ndimage.maximum_filter(cells, gap, mode="constant")
    return ndimage.minimum_filter(wide, gap, mode="constant", cval=1) & ~cells


def _long_patches(cells: np.ndarray) -> np.ndarray:
    """The occupied cells (y, x) of connected patches whose diagonal is at least `_LONG_M`."""
    from scipy import ndimage

    labels, _ = ndimage.label(cells, structure=np.ones((3, 3)))
    long = [0]
    for number, place in enumerate(ndimage.find_objects(labels), start=1):
        if place is not None and np.hypot(*(part.stop - part.start for part in place)) * _CELL_M >= _LONG_M:
            long.append(number)
    return np.isin(labels, long[1:])


def _behind_rims(scene: Scene, tops: Points) -> Float[np.ndarray, "behind 3"]:
    """Points behind rims at the camera's height or above, for a table's depth, unless seen through."""
    unseen = tops[tops[:, 2] > -_SEEN_BY_RIM_M]
    _, one_each = np.unique(np.rint(unseen / _SPACING_M).astype(int), axis=0, return_index=True)
    unseen = unseen[one_each]
    length = np.maximum(np.hypot(unseen[:, 0], unseen[:, 1]), 1e-6)
    steps = np.arange(_SPACING_M, _TOP_DEPTH_M, _SPACING_M)
    away = unseen[None] * np.array([1.0, 1.0, 0.0]) * (steps[:, None] / length[None])[..., None]
    behind = (unseen[None] + away).reshape(-1, 3)
    return behind[~_seen_through(scene, behind)]


def _is_possible(scene: Scene, leg: Points) -> bool:
    """Whether most of a leg is occluded or lies outside the picture."""
    return bool((~_seen_through(scene, leg)).mean() >= _MIN_UNSEEN)


def _seen_through(scene: Scene, points: Points) -> np.ndarray:
    """Whether something was measured behind each point, (point,), so that the point is free."""
    seen = AlignedPhoto.of(scene).look_up(points)
    return _behind_m(scene, points) > _BEHIND_M + _BEHIND_PER_M2 * np.square(seen.depth_m)


def occluded_share(scene: Scene, points: Float[np.ndarray, "body point 3"]) -> Float[np.ndarray, " body"]:
    """Share of each body's points that are occluded by a measurement well in front of them.

    Args:
        scene: The room.
        points: Points of the bodies in metres, (body, point, 3).

    Returns:
        Share 0 to 1, (body,).
    """
    return (_behind_m(scene, points) < -_OCCLUDING_M).mean(axis=-1)


def unseen_share(scene: Scene, points: Float[np.ndarray, "body point 3"]) -> Float[np.ndarray, " body"]:
    """Share of each body's points that are occluded or outside the picture.

    Args:
        scene: The room.
        points: Points of the bodies in metres, (body, point, 3).

    Returns:
        Share 0 to 1, (body,).
    """
    outside = ~AlignedPhoto.of(scene).look_up(points).in_picture
    return ((_behind_m(scene, points) < -_OCCLUDING_M) | outside).mean(axis=-1)


def occluded_along(
    scene: Scene, tracks_m: Float[np.ndarray, "track position 2"]
) -> Float[np.ndarray, "track position"]:
    """Occluded share of a walker's legs along tracks.

    Args:
        scene: The room.
        tracks_m: Positions (x, y) in metres, (track, position, 2).

    Returns:
        Share 0 to 1, (track, position).
    """
    to_sides = _TO_SIDE_M * np.array([(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    places = (tracks_m[:, :, None] + to_sides)[:, :, :, None]
    height = scene.floor_z_m + np.array(_LEG_HEIGHTS_M)
    shape = (*places.shape[:3], len(height))
    points = np.concatenate([np.broadcast_to(places, (*shape, 2)), np.broadcast_to(height, shape)[..., None]], axis=-1)
    occluded = _behind_m(scene, points.reshape(-1, 3)) < -_OCCLUDING_M
    return occluded.reshape(*tracks_m.shape[:2], -1).mean(axis=-1)


def upright_structures(scene: Scene, points: Points) -> Float[np.ndarray, "leg 3"]:
    """Points of upright structures, mostly table legs, and points just behind them; excludes the cushion of a seat.

    Args:
        scene: The room.
        points: Measured points.

    Returns:
        Points (leg, 3).
    """
    side = int(2 * _REACH_M / _CELL_M)
    low, high = np.zeros((side, side), bool), np.zeros((side, side), bool)
    height = points[:, 2] - scene.floor_z_m
    cell, inside = _cells(points, side)
    low[tuple(cell[inside & (height < _LEG_M[0])].T)] = True
    high[tuple(cell[inside & (height > _LEG_M[1]) & (height < _RIM_M[1])].T)] = True
    legs = points[inside & (low & high)[tuple(cell.T)] & (height < _RIM_M[1])]
    away = legs * _LEG_THICK_M / np.maximum(np.linalg.norm(legs, axis=1, keepdims=True), 1e-6)
    return np.concatenate([legs, legs + away])


def _cells(points: Points, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Row and column of each point's cell, (point, 2), 0 off the grid, and whether it is on the grid."""
    cell = np.floor((points[:, 1::-1] + _REACH_M) / _CELL_M).astype(int)
    inside = (cell.min(axis=1) >= 0) & (cell.max(axis=1) < side)
    return np.where(inside[:, None], cell, 0), inside


def below_tops(scene: Scene, tops: Points) -> Float[np.ndarray, "under 3"]:
    """Points of the space below table tops, unless the camera sees through it.

    Args:
        scene: The room.
        tops: Points of table tops.

    Returns:
        Points (under, 3).
    """
    _, one_each = np.unique(np.rint(tops[:, :2] / _BELOW_VOXEL_M).astype(int), axis=0, return_index=True)
    tops = tops[one_each]
    steps = np.arange(_BELOW_STEP_M, _RIM_M[1], _BELOW_STEP_M)
    below = (tops[None] - steps[:, None, None] * np.array([0.0, 0.0, 1.0])).reshape(-1, 3)
    below = below[below[:, 2] > scene.floor_z_m + _SOLE_M]
    return below[~_seen_through(scene, below)]


def _behind_m(scene: Scene, points: Float[np.ndarray, "*points 3"]) -> Float[np.ndarray, "*points"]:
    """Distance in metres by which the measurement lies behind each point, negative in front; nan without one."""
    seen = AlignedPhoto.of(scene).look_up(points)
    return np.where(seen.in_picture, scene.photo.depth_m[seen.row, seen.column] - seen.depth_m, np.nan)
