"""The pinhole camera. Camera frame: x right, y down, z forward; pixel centres at whole numbers."""

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.shapes import Array, DepthPixels, PerPoint, Points


def unproject(depth: DepthPixels, intrinsics: CameraIntrinsics) -> Float[Array, "height width 3"]:
    """Depth along the optical axis in metres -> the point of every pixel, camera frame; nan stays nan."""
    height, width = depth.shape
    x = (np.arange(width) - intrinsics.cx) / intrinsics.fx
    y = (np.arange(height) - intrinsics.cy) / intrinsics.fy
    return np.stack([depth * x, depth * y[:, None], depth], axis=-1)


def project(points_camera: Points, intrinsics: CameraIntrinsics) -> tuple[Float[Array, "point 2"], PerPoint]:
    """Points in the camera frame -> pixels (column, row) and depth in metres; nan pixels where depth is not positive.

    >>> camera = CameraIntrinsics(fx=500.0, fy=500.0, cx=320.0, cy=240.0, width=640, height=480)
    >>> pixels, depth = project(np.array([[0.2, -0.1, 2.0]]), camera)
    >>> pixels.tolist(), depth.tolist()
    ([[370.0, 215.0]], [2.0])
    """
    depth = points_camera[:, 2]
    in_front = np.where(depth > 0, depth, np.nan)
    column = intrinsics.fx * points_camera[:, 0] / in_front + intrinsics.cx
    row = intrinsics.fy * points_camera[:, 1] / in_front + intrinsics.cy
    return np.stack([column, row], axis=1), depth
