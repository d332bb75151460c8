"""What must stand where the camera saw only a part of a thing: the rest of legs, and legs under tops."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import Plane, Scene
from mmweaver.geometry.pinhole import project

Points = Float[np.ndarray, "point 3"]
_FOOT_M, _FEET_DOWN_M, _SOLE_M = 0.24, (0.04, 0.08, 0.12, 0.16), 0.035
_TABLE_M, _INSET_M = (0.35, 1.1), 0.05
_LEG_STEP_M, _TOP_M, _LEG_HALF_M = 0.05, 0.04, 0.025
_LEAST_UNSEEN = 0.6
_BEHIND_M, _BEHIND_PER_M2 = 0.065, 0.0035  # so far behind it, a measurement passed it by


def feet_of(points: Points, floor_z_m: float) -> Float[np.ndarray, "below 3"]:
    """Below points that are seen low over the floor: what ends there reaches the floor."""
    low = points[points[:, 2] < floor_z_m + _FOOT_M]
    down = np.concatenate([low - np.array([0.0, 0.0, step]) for step in _FEET_DOWN_M])
    return down[down[:, 2] > floor_z_m + _SOLE_M]


def legs_of(scene: Scene) -> Points:
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


def _may_be(scene: Scene, leg: Points) -> bool:
    """Whether most of it is hidden by something nearer, or lies outside the picture."""
    photo = scene.photo
    pixels, depth = project(leg @ scene.radar_from_camera, photo.intrinsics)
    rows, columns = photo.depth_m.shape
    column, row = np.nan_to_num(np.round(pixels), nan=-1.0).clip(-1, 1e6).astype(int).T
    inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows) & (depth > 0)
    measured = photo.depth_m[np.where(inside, row, 0), np.where(inside, column, 0)]
    seen_through = inside & (measured > depth + _BEHIND_M + _BEHIND_PER_M2 * np.square(depth))
    return bool((~seen_through).mean() >= _LEAST_UNSEEN)
