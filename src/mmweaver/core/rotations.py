"""Rotations between the camera frame and a level frame, and unit vectors."""

import numpy as np

from mmweaver.core.shapes import Rotation, Vec3


def unit(vectors: np.ndarray) -> np.ndarray:
    """Normalises vectors.

    Args:
        vectors: Vectors, (..., 3).

    Returns:
        Unit vectors, (..., 3); zero vectors stay zero.
    """
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def directions(azimuth_rad: np.ndarray, elevation_rad: np.ndarray) -> np.ndarray:
    """Unit vectors of given angles.

    Args:
        azimuth_rad: Azimuth in radians, positive to the right (+x).
        elevation_rad: Elevation in radians, positive upwards (+z).

    Returns:
        Unit vectors, (..., 3).
    """
    level = np.cos(elevation_rad)
    return np.stack([np.sin(azimuth_rad) * level, np.cos(azimuth_rad) * level, np.sin(elevation_rad)], -1)


def level_from_camera(up_camera: Vec3) -> Rotation:
    """Rotation from the camera frame to the level frame (x right, y horizontal part of the optical axis, z up).

    Args:
        up_camera: Unit vector against gravity in the camera frame (x right, y down, z forward), (3,); must not be
            parallel to the optical axis.

    Returns:
        Rotation matrix.

    >>> level_from_camera(np.array([0.0, -1.0, 0.0])).round().astype(int).tolist()
    [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    """
    forward = np.array([0.0, 0.0, 1.0])
    y_axis = forward - (forward @ up_camera) * up_camera
    y_axis /= np.linalg.norm(y_axis)
    return np.stack([np.cross(y_axis, up_camera), y_axis, up_camera])


def pitch_and_roll_rad(radar_from_camera: Rotation) -> tuple[float, float]:
    """Pitch and roll of the camera.

    Args:
        radar_from_camera: Rotation from the camera frame to the level frame.

    Returns:
        Pitch (positive: the camera points down) and roll (positive: it tilts to its right) in radians.
    """
    up_camera = radar_from_camera[2]
    pitch = np.arcsin(np.clip(-up_camera[2], -1, 1))
    roll = np.arctan2(-up_camera[0], -up_camera[1])
    return float(pitch), float(roll)
