"""The pinhole camera. Camera frame: x right, y down, z forward (the optical axis); pixel centres at integers."""

from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.shapes import Array, DepthPixels


def pixel_coordinates(x_m: Any, y_m: Any, depth_m: Any, fx: Any, fy: Any, cx: Any, cy: Any) -> tuple[Any, Any]:
    """Perspective projection of points in the camera frame.

    Plain arithmetic on numpy arrays or torch tensors; shapes broadcast. The caller ensures positive depth.

    Args:
        x_m: Coordinate to the right in metres.
        y_m: Coordinate downwards in metres.
        depth_m: Depth along the optical axis in metres.
        fx: Horizontal focal length in pixels.
        fy: Vertical focal length in pixels.
        cx: Column of the principal point.
        cy: Row of the principal point.

    Returns:
        Columns and rows in pixels.
    """
    return fx * x_m / depth_m + cx, fy * y_m / depth_m + cy


def project(
    points_camera: Float[Array, "*points 3"], intrinsics: CameraIntrinsics
) -> tuple[Float[Array, "*points 2"], Float[Array, "*points"]]:
    """Projects points of the camera frame into the picture.

    Args:
        points_camera: Points in metres, (..., 3).
        intrinsics: The camera.

    Returns:
        Pixels (column, row), (..., 2), nan where the depth is not positive; and depth in metres, (...,).

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
    """Normalised image coordinates of a pinhole camera.

    Args:
        intrinsics: The camera.

    Returns:
        x / z of each column, (width,), and y / z of each row, (height, 1).
    """
    x = (np.arange(intrinsics.width) - intrinsics.cx) / intrinsics.fx
    y = (np.arange(intrinsics.height) - intrinsics.cy) / intrinsics.fy
    return x, y[:, None]


def unproject(depth: DepthPixels, intrinsics: CameraIntrinsics) -> Float[Array, "height width 3"]:
    """Back-projects a depth image.

    Args:
        depth: Depth along the optical axis in metres, (height, width); nan stays nan.
        intrinsics: The camera.

    Returns:
        Points in the camera frame in metres, (height, width, 3).
    """
    x, y = normalized_coordinates(intrinsics)
    return np.stack([depth * x, depth * y, depth], axis=-1)


def viewing_rays(intrinsics: CameraIntrinsics) -> Float[Array, "height width 3"]:
    """Viewing direction of each pixel in the camera frame, scaled so that depth times ray is the point."""
    return unproject(np.ones((intrinsics.height, intrinsics.width)), intrinsics)


def subsampled(intrinsics: CameraIntrinsics, step: int) -> CameraIntrinsics:
    """Intrinsics of the picture `[::step, ::step]`.

    Args:
        intrinsics: Camera of the full picture.
        step: Subsampling factor; pixel (0, 0) is kept.

    Returns:
        Camera of the subsampled picture.
    """
    return CameraIntrinsics(
        fx=intrinsics.fx / step,
        fy=intrinsics.fy / step,
        cx=intrinsics.cx / step,
        cy=intrinsics.cy / step,
        width=-(-intrinsics.width // step),
        height=-(-intrinsics.height // step),
    )


def binned(intrinsics: CameraIntrinsics, size: int) -> CameraIntrinsics:
    """Intrinsics of a picture whose pixels are blocks of size x size pixels.

    The picture edge stays at -0.5, since pixel centres lie at integers.

    Args:
        intrinsics: Camera of the full picture.
        size: Block size in pixels; incomplete blocks are dropped.

    Returns:
        Camera of the binned picture.
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
    """Intrinsics of the same view resampled to another size; the picture edge stays at -0.5.

    Args:
        intrinsics: Camera of the original picture.
        width: New width in pixels.
        height: New height in pixels.

    Returns:
        Camera of the resampled picture.
    """
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
    """Intrinsics of a picture rotated clockwise by 90 degrees."""
    return CameraIntrinsics(
        fx=intrinsics.fy,
        fy=intrinsics.fx,
        cx=intrinsics.height - 1 - intrinsics.cy,
        cy=intrinsics.cx,
        width=intrinsics.height,
        height=intrinsics.width,
    )
