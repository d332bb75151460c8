"""The pinhole camera. Camera frame: x right, y down, z forward (the optical axis); pixel centres at whole numbers."""

from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.shapes import Array, DepthPixels


def pixel_coordinates(x_m: Any, y_m: Any, depth_m: Any, fx: Any, fy: Any, cx: Any, cy: Any) -> tuple[Any, Any]:
    """Perspective projection of points in the camera frame: their columns and rows, in pixels.

    Plain arithmetic, for numpy arrays and torch tensors alike; shapes broadcast. The caller keeps `depth_m` positive.
    """
    return fx * x_m / depth_m + cx, fy * y_m / depth_m + cy


def project(
    points_camera: Float[Array, "*points 3"], intrinsics: CameraIntrinsics
) -> tuple[Float[Array, "*points 2"], Float[Array, "*points"]]:
    """Projects points of the camera frame, in metres: their pixels (column, row) and their depth in metres.

    The pixel is nan where the depth is not positive.

    >>> camera = CameraIntrinsics(fx=500.0, fy=500.0, cx=320.0, cy=240.0, width=640, height=480)
    >>> pixels, depth = project(np.array([[0.2, -0.1, 2.0]]), camera)
    >>> pixels.tolist(), depth.tolist()
    ([[370.0, 215.0]], [2.0])
    """
    depth = points_camera[..., 2]
    in_front = np.where(depth > 0, depth, np.nan)
    column, row = pixel_coordinates(
        points_camera[..., 0],
        points_camera[..., 1],
        in_front,
        intrinsics.fx,
        intrinsics.fy,
        intrinsics.cx,
        intrinsics.cy,
    )
    return np.stack([column, row], axis=-1), depth


def normalized_coordinates(intrinsics: CameraIntrinsics) -> tuple[Float[Array, " width"], Float[Array, "height 1"]]:
    """x / z of every column, (width,), and y / z of every row, (height, 1)."""
    x = (np.arange(intrinsics.width) - intrinsics.cx) / intrinsics.fx
    y = (np.arange(intrinsics.height) - intrinsics.cy) / intrinsics.fy
    return x, y[:, None]


def unproject(depth: DepthPixels, intrinsics: CameraIntrinsics) -> Float[Array, "height width 3"]:
    """The point of every pixel in the camera frame, metres, from its depth along the optical axis; nan stays nan."""
    x, y = normalized_coordinates(intrinsics)
    return np.stack([depth * x, depth * y, depth], axis=-1)


def viewing_rays(intrinsics: CameraIntrinsics) -> Float[Array, "height width 3"]:
    """The direction of every pixel in the camera frame, scaled to a depth of 1: depth times ray is the point."""
    return unproject(np.ones((intrinsics.height, intrinsics.width)), intrinsics)


def subsampled(intrinsics: CameraIntrinsics, step: int) -> CameraIntrinsics:
    """The intrinsics of the picture `[::step, ::step]`, whose pixel (0, 0) is that of the whole picture."""
    return CameraIntrinsics(
        fx=intrinsics.fx / step,
        fy=intrinsics.fy / step,
        cx=intrinsics.cx / step,
        cy=intrinsics.cy / step,
        width=-(-intrinsics.width // step),
        height=-(-intrinsics.height // step),
    )


def binned(intrinsics: CameraIntrinsics, size: int) -> CameraIntrinsics:
    """The intrinsics of a picture whose pixels are blocks of size x size pixels; incomplete blocks are left out.

    Pixel centres lie at whole numbers, so the picture's edge, at -0.5, stays in place.
    """
    return CameraIntrinsics(
        fx=intrinsics.fx / size,
        fy=intrinsics.fy / size,
        cx=(intrinsics.cx + 0.5) / size - 0.5,
        cy=(intrinsics.cy + 0.5) / size - 0.5,
        width=intrinsics.width // size,
        height=intrinsics.height // size,
    )


def resized(intrinsics: CameraIntrinsics, width: int, height: int) -> CameraIntrinsics:
    """The intrinsics of the same view resampled to width x height pixels; the picture's edge, at -0.5, stays."""
    scale_x, scale_y = width / intrinsics.width, height / intrinsics.height
    return CameraIntrinsics(
        fx=intrinsics.fx * scale_x,
        fy=intrinsics.fy * scale_y,
        cx=(intrinsics.cx + 0.5) * scale_x - 0.5,
        cy=(intrinsics.cy + 0.5) * scale_y - 0.5,
        width=width,
        height=height,
    )


def rotated_clockwise(intrinsics: CameraIntrinsics) -> CameraIntrinsics:
    """The intrinsics of a picture rotated by 90 degrees clockwise."""
    return CameraIntrinsics(
        fx=intrinsics.fy,
        fy=intrinsics.fx,
        cx=intrinsics.height - 1 - intrinsics.cy,
        cy=intrinsics.cx,
        width=intrinsics.height,
        height=intrinsics.width,
    )
