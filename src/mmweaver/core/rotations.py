"""Rotations between the camera frame and a level frame, and unit vectors."""

import numpy as np

from mmweaver.core.shapes import Rotation, Vec3


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) of length 1; those of length 0 stay."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def directions(azimuth_rad: np.ndarray, elevation_rad: np.ndarray) -> np.ndarray:
    """Unit vectors (..., 3) of azimuths (positive to the right, +x) and elevations (positive upwards, +z)."""
    level = np.cos(elevation_rad)
    return np.stack([np.sin(azimuth_rad) * level, np.cos(azimuth_rad) * level, np.sin(elevation_rad)], -1)


def level_from_camera(up_camera: Vec3) -> Rotation:
    """The rotation into the level frame (x right, y horizontal direction of the optical axis, z up).

    `up_camera` is the unit vector against gravity in the camera frame (x right, y down, z forward); it must not lie
    along the optical axis.

    >>> level_from_camera(np.array([0.0, -1.0, 0.0])).round().astype(int).tolist()
    [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    """
    forward = np.array([0.0, 0.0, 1.0])
    y_axis = forward - (forward @ up_camera) * up_camera
    y_axis /= np.linalg.norm(y_axis)
    return np.stack([np.cross(y_axis, up_camera), y_axis, up_camera])


def pitch_and_roll_rad(radar_from_camera: Rotation) -> tuple[float, float]:
    """Pitch (positive: the camera points down) and roll (positive: it leans to its right) of the camera, radians."""
    up_camera = radar_from_camera[2]
    pitch = np.arcsin(np.clip(-up_camera[2], -1, 1))
    roll = np.arctan2(-up_camera[0], -up_camera[1])
    return float(pitch), float(roll)
