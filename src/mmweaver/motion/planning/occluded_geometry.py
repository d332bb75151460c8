"""What must stand where the camera saw only a part of a thing: the rest of legs, legs under tops, tops behind rims."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Plane, Scene
from mmweaver.geometry.aligned_photo import AlignedPhoto

Points = Float[np.ndarray, "point 3"]
_FOOT_M, _FEET_DOWN_M, _SOLE_M = 0.24, (0.04, 0.08, 0.12, 0.16), 0.035
_TABLE_M, _INSET_M = (0.35, 1.1), 0.05
_LEG_STEP_M, _TOP_M, _LEG_HALF_M = 0.05, 0.04, 0.025
_LEAST_UNSEEN = 0.6
_RIM_M, _SLICE_M, _THIN_M, _LONG_M = (0.58, 1.05), 0.03, 0.12, 0.55  # of a table's top: how high, thick and long
_SQUARE_M, _REACH_M = 0.05, 5.0
_LEG_M, _LEG_THICK_M = (0.3, 0.55), 0.04  # a leg is seen below a seat and above it
_GAP = 13  # squares: so wide do chairs before a table hide its top
_UNSEEN_M, _TOP_DEPTH_M, _ALONG_M = 0.1, 0.8, 0.03  # a top so little below the camera is seen by its rim alone
_BEHIND_M, _BEHIND_PER_M2 = 0.065, 0.0035  # so far behind it, a measurement passed it by
_BEFORE_M = 0.15  # the body itself is as thick
_LEGS_M, _ASIDE_M = (0.15, 0.35, 0.55, 0.75), 0.2  # where legs are as somebody goes about
_UNDER_STEP_M, _UNDER_GRAIN_M = 0.05, 0.05


def extended_to_floor(points: Points, floor_z_m: float) -> Float[np.ndarray, "below 3"]:
    """Below points that are seen low over the floor: what ends there reaches the floor."""
    low = points[points[:, 2] < floor_z_m + _FOOT_M]
    down = np.concatenate([low - np.array([0.0, 0.0, step]) for step in _FEET_DOWN_M])
    return down[down[:, 2] > floor_z_m + _SOLE_M]


def table_legs(scene: Scene) -> Points:
    """Legs under the corners of level tops, but where the camera sees that none are."""
    legs = [
        _leg(scene, plane, u, v) for plane in scene.planes if _is_table(scene, plane) for u in (-1, 1) for v in (-1, 1)
    ]
    return np.concatenate([leg for leg in legs if _may_be(scene, leg)] or [np.zeros((0, 3))])


def _is_table(scene: Scene, plane: Plane) -> bool:
    height_m = float(plane.centre_m[2]) - scene.floor_z_m
    return plane.kind == "top" and _TABLE_M[0] < height_m < _TABLE_M[1]


def _leg(scene: Scene, plane: Plane, u: int, v: int) -> Points:
    half_u, half_v = (max(half - _INSET_M, 0.0) for half in plane.half_size_m)
    corner = plane.centre_m + u * half_u * plane.axis_u + v * half_v * plane.axis_v
    height = np.arange(scene.floor_z_m + _LEG_STEP_M, float(corner[2]) - _TOP_M, _LEG_STEP_M)
    sides = [corner + a * _LEG_HALF_M * plane.axis_u + b * _LEG_HALF_M * plane.axis_v for a in (-1, 1) for b in (-1, 1)]
    return np.concatenate([np.column_stack([np.tile(side[:2], (len(height), 1)), height]) for side in sides])


def table_tops(scene: Scene, points: Points) -> Float[np.ndarray, "top 3"]:
    """Of the points those on tops and rims of tables, thin and long; and the tops behind rims that hide their own."""
    height = points[:, 2] - scene.floor_z_m
    column, row = np.floor((points[:, :2].T + _REACH_M) / _SQUARE_M).astype(int)
    side = int(2 * _REACH_M / _SQUARE_M)
    inside = (column >= 0) & (column < side) & (row >= 0) & (row < side)
    square = np.where(inside, row * side + column, -1)
    in_band = inside & (height > _RIM_M[0]) & (height < _RIM_M[1])
    highest, lowest = np.full(side**2, -np.inf), np.full(side**2, np.inf)
    np.maximum.at(highest, square[in_band], height[in_band])
    # Chairs below a top are none of its own.
    near_top = in_band & (height > highest[square] - 2 * _THIN_M)
    np.minimum.at(lowest, square[near_top], height[near_top])
    thin = highest - lowest < _THIN_M
    is_top, between = np.zeros(side**2, bool), []
    for level in np.arange(*_RIM_M, _SLICE_M):
        at_level = _long_patches((thin & (np.abs(highest - level) <= _SLICE_M)).reshape(side, side))
        is_top |= at_level.ravel()
        row, column = np.nonzero(_between(at_level))
        middle = np.stack([column, row], axis=-1) * _SQUARE_M + 0.5 * _SQUARE_M - _REACH_M
        between.append(np.column_stack([middle, np.full(len(middle), level + scene.floor_z_m)]))
    tops = points[near_top & is_top[square]]
    unseen = np.concatenate(between)
    unseen = unseen[_behind_m(scene, unseen) < -_BEFORE_M]
    return np.concatenate([tops, unseen, _behind_rims(scene, tops)])


def _between(squares: np.ndarray) -> np.ndarray:
    """What lies among squares, at most `_GAP` apart, and is none of them."""
    from scipy import ndimage

    if not squares.any():
        return squares
    wide = ndimage.maximum_filter(squares, _GAP, mode="constant")
    return ndimage.minimum_filter(wide, _GAP, mode="constant", cval=1) & ~squares


def _long_patches(squares: np.ndarray) -> np.ndarray:
    from scipy import ndimage

    labels, _ = ndimage.label(squares, structure=np.ones((3, 3)))  # pyright: ignore[reportGeneralTypeIssues]
    long = [0]
    for number, place in enumerate(ndimage.find_objects(labels), start=1):
        if place is not None and np.hypot(*(part.stop - part.start for part in place)) * _SQUARE_M >= _LONG_M:
            long.append(number)
    return np.isin(labels, long[1:])


def _behind_rims(scene: Scene, tops: Points) -> Float[np.ndarray, "behind 3"]:
    """A table's depth behind what is seen of it at the camera's height or above, where nothing farther is seen."""
    unseen = tops[tops[:, 2] > -_UNSEEN_M]
    _, one_each = np.unique(np.rint(unseen / _ALONG_M).astype(int), axis=0, return_index=True)
    unseen = unseen[one_each]
    length = np.maximum(np.hypot(unseen[:, 0], unseen[:, 1]), 1e-6)
    steps = np.arange(_ALONG_M, _TOP_DEPTH_M, _ALONG_M)
    away = unseen[None] * np.array([1.0, 1.0, 0.0]) * (steps[:, None] / length[None])[..., None]
    behind = (unseen[None] + away).reshape(-1, 3)
    return behind[~_seen_through(scene, behind)]


def _may_be(scene: Scene, leg: Points) -> bool:
    """Whether most of it is hidden by something nearer, or lies outside the picture."""
    return bool((~_seen_through(scene, leg)).mean() >= _LEAST_UNSEEN)


def _seen_through(scene: Scene, points: Points) -> np.ndarray:
    """Which points something was measured behind."""
    seen = AlignedPhoto.of(scene).look_up(points)
    return _behind_m(scene, points) > _BEHIND_M + _BEHIND_PER_M2 * np.square(seen.depth_m)


def occluded_share(scene: Scene, points: Points) -> float:
    """Of places, the share at which the camera saw something well before them: what stands there is not known."""
    return float((_behind_m(scene, points) < -_BEFORE_M).mean())


def unseen_share(scene: Scene, points: Points) -> float:
    """Of places, the share that is hidden or outside the picture."""
    return float(((_behind_m(scene, points) < -_BEFORE_M) | ~AlignedPhoto.of(scene).look_up(points).in_picture).mean())


def occluded_along(scene: Scene, tracks_m: Float[np.ndarray, "way place 2"]) -> Float[np.ndarray, "way place"]:
    """The share of legs and feet that the camera would not see at each place of each way."""
    aside = _ASIDE_M * np.array([(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    places = (tracks_m[:, :, None] + aside)[:, :, :, None]
    height = scene.floor_z_m + np.array(_LEGS_M)
    shape = (*places.shape[:3], len(height))
    points = np.concatenate([np.broadcast_to(places, (*shape, 2)), np.broadcast_to(height, shape)[..., None]], axis=-1)
    hidden = _behind_m(scene, points.reshape(-1, 3)) < -_BEFORE_M
    return hidden.reshape(*tracks_m.shape[:2], -1).mean(axis=-1)


def upright_structures(scene: Scene, points: Points) -> Float[np.ndarray, "leg 3"]:
    """Of points those of upright things, tables' legs mostly, and what is just behind them: no cushion of a seat."""
    side = int(2 * _REACH_M / _SQUARE_M)
    low, high = np.zeros((side, side), bool), np.zeros((side, side), bool)
    height = points[:, 2] - scene.floor_z_m
    square, inside = _squares(points, side)
    low[tuple(square[inside & (height < _LEG_M[0])].T)] = True
    high[tuple(square[inside & (height > _LEG_M[1]) & (height < _RIM_M[1])].T)] = True
    legs = points[inside & (low & high)[tuple(square.T)] & (height < _RIM_M[1])]
    away = legs * _LEG_THICK_M / np.maximum(np.linalg.norm(legs, axis=1, keepdims=True), 1e-6)
    return np.concatenate([legs, legs + away])


def _squares(points: Points, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Row and column of the square of each point (0 where none is), and whether there is one."""
    square = np.floor((points[:, 1::-1] + _REACH_M) / _SQUARE_M).astype(int)
    inside = (square.min(axis=1) >= 0) & (square.max(axis=1) < side)
    return np.where(inside[:, None], square, 0), inside


def below_tops(scene: Scene, tops: Points) -> Float[np.ndarray, "under 3"]:
    """What may be under tables' tops: everything but where something farther was seen below them."""
    _, one_each = np.unique(np.rint(tops[:, :2] / _UNDER_GRAIN_M).astype(int), axis=0, return_index=True)
    tops = tops[one_each]
    steps = np.arange(_UNDER_STEP_M, _RIM_M[1], _UNDER_STEP_M)
    below = (tops[None] - steps[:, None, None] * np.array([0.0, 0.0, 1.0])).reshape(-1, 3)
    below = below[below[:, 2] > scene.floor_z_m + _SOLE_M]
    return below[~_seen_through(scene, below)]


def _behind_m(scene: Scene, points: Points) -> Float[np.ndarray, " point"]:
    """How far behind each point something was measured, negative before it; nan where nothing was."""
    seen = AlignedPhoto.of(scene).look_up(points)
    return np.where(seen.in_picture, scene.photo.depth_m[seen.row, seen.column] - seen.depth_m, np.nan)
