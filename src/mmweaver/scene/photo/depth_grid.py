"""A depth picture binned to a grid of about 160 x 120 cells, without flying pixels, with a normal for every cell.

Fills the holes of sparse depth: each small hole takes its nearest measurement.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.pinhole import binned, normalized_coordinates, unproject
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.shapes import Array, ClassPixels, DepthPixels

MAX_SPARSE = 0.65  # depth with a smaller share of measured pixels is filled
REACH = 1.6  # maximum distance of a filled pixel to its nearest measurement, in mean distances of measurements


def fill_scattered_holes(depth_m: DepthPixels) -> tuple[DepthPixels, tuple[str, ...]]:
    """Fills scattered holes of sparse depth, of which less than 65 % is measured, by the nearest measurement.

    No interpolation, so that edges stay sharp. Holes larger than the gaps between measurements remain.

    Args:
        depth_m: Depth in metres, (height, width), nan where missing.

    Returns:
        The filled depth, and a sentence that reports it if anything was filled.
    """
    from scipy.ndimage import distance_transform_edt

    measured = np.isfinite(depth_m)
    share = float(measured.mean())
    if share >= MAX_SPARSE or not measured.any():
        return depth_m, ()
    reach = REACH / np.sqrt(share)
    found: Any = distance_transform_edt(~measured, return_indices=True)
    distance, (row, column) = found
    filled = np.where(distance <= reach, depth_m[row, column], np.nan)
    sentence = (
        f"Only {100 * share:.0f} % of the pixels have a depth: holes were filled by the nearest measurement within"
        f" {reach:.0f} pixels."
    )
    return filled, (sentence,)


GridBool = Bool[Array, "row column"]
GridFloat = Float[Array, "row column"]
GridInt = Int[Array, "row column"]
GridVectors = Float[Array, "row column 3"]

_CELLS_ACROSS = 160
_NORMAL_RADIUS = 3  # cells: a window of 7 x 7
_MIN_NORMAL_SUPPORT = 12  # cells of that window on one surface
_MIN_CELL_SUPPORT = 0.35  # share of a cell's pixels with a measurement
_NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0))


@dataclass(frozen=True, kw_only=True)
class DepthGrid:
    """A grid of cells in the camera frame; nan where nothing was measured."""

    intrinsics: CameraIntrinsics  # in cells
    depth_m: GridFloat  # along the optical axis
    points_m: GridVectors
    normals: GridVectors  # unit, towards the camera; nan where no plane could be fitted
    rgb: GridVectors  # mean colour, 0 to 1
    class_index: GridInt | None = None  # most frequent class of the cell, if the photo has classes


def depth_tolerance_m(depth_m: Float[Array, "..."]) -> Float[Array, "..."]:
    """Largest plausible difference of two measurements of one surface.

    The error of structured light and stereo grows with depth squared.

    Args:
        depth_m: Depth in metres, any shape.

    Returns:
        Metres, same shape.
    """
    return 0.015 + 0.0035 * np.square(depth_m)


def make_grid(photo: RgbdPhoto) -> DepthGrid:
    """Bins a photo to cells of median depth (never between two surfaces), without outliers, and fits their normals.

    Args:
        photo: Photo with depth.

    Returns:
        Grid about 160 cells wide in the camera frame.
    """
    height, width = photo.depth_m.shape
    size = max(1, round(width / _CELLS_ACROSS))
    rows, columns = height // size, width // size
    depth = remove_outliers(_block_median(_blocks(photo.depth_m[: rows * size, : columns * size], size)))
    colours = photo.rgb[: rows * size, : columns * size].reshape(rows, size, columns, size, 3)
    intrinsics = binned(photo.intrinsics, size)
    return DepthGrid(
        intrinsics=intrinsics,
        depth_m=depth,
        points_m=unproject(depth, intrinsics),
        normals=_fitted_normals(depth, intrinsics),
        rgb=colours.mean(axis=(1, 3)) / 255.0,
        class_index=None if photo.classes is None else _most_common(photo.classes.index, size),
    )


def _most_common(index: ClassPixels, size: int) -> GridInt:
    """The most frequent class of each cell of size x size pixels."""
    rows, columns = index.shape[0] // size, index.shape[1] // size
    blocks = index[: rows * size, : columns * size].reshape(rows, size, columns, size)
    present = np.unique(index)
    shares = np.stack([(blocks == one).mean(axis=(1, 3)) for one in present])
    return present[np.argmax(shares, axis=0)].astype(np.int64)


def remove_outliers(depth_m: DepthPixels) -> DepthPixels:
    """Removes speckle and flying pixels: those whose depth fewer than two of their four neighbours share.

    Args:
        depth_m: Depth in metres, (height, width).

    Returns:
        The depth with these pixels set to nan.
    """
    padded = np.pad(depth_m, 1, constant_values=np.nan)
    support = np.zeros(depth_m.shape, int)
    # On a surface seen at a grazing angle, neighbours differ by more than the noise.
    limit = depth_tolerance_m(depth_m) + 0.03 * depth_m
    for row, column in _NEIGHBOURS:
        support += np.abs(_shifted(padded, row, column, 1) - depth_m) < limit
    return np.where(support >= 2, depth_m, np.nan)


def _blocks(depth_m: DepthPixels, size: int) -> Float[Array, "row column pixel"]:
    """The pixels of each block of size x size pixels."""
    rows, columns = depth_m.shape[0] // size, depth_m.shape[1] // size
    blocks = depth_m.reshape(rows, size, columns, size).transpose(0, 2, 1, 3)
    return blocks.reshape(rows, columns, size * size)


def _block_median(blocks: Float[Array, "row column pixel"]) -> GridFloat:
    """Median of each cell's measurements, metres: of the middle two the mean if they agree, else the nearer."""
    ordered = np.sort(blocks, axis=2)  # nan last
    count = np.isfinite(ordered).sum(axis=2)
    low = np.take_along_axis(ordered, (np.maximum(count - 1, 0) // 2)[..., None], axis=2)[..., 0]
    high = np.take_along_axis(ordered, np.minimum(count // 2, blocks.shape[2] - 1)[..., None], axis=2)[..., 0]
    median = np.where(high - low < depth_tolerance_m(low), (low + high) / 2, low)
    return np.where(count >= max(1, _MIN_CELL_SUPPORT * blocks.shape[2]), median, np.nan)


def _fitted_normals(depth_m: GridFloat, intrinsics: CameraIntrinsics) -> GridVectors:
    """Normals of least-squares planes through each cell's neighbours on the same surface.

    The inverse depth of a plane is linear in the picture, and a Kinect's noise is uniform in it.
    """
    rows, columns = depth_m.shape
    radius = _NORMAL_RADIUS
    inverse = np.pad(1 / depth_m, radius, constant_values=np.nan)
    centre = 1 / depth_m
    limit = (depth_tolerance_m(depth_m) + 0.04 * depth_m) / np.square(depth_m)
    # Sums of 1, u, v, uu, uv, vv, q, uq, vq over these neighbours; u, v: offset in cells, q: difference of 1/z.
    sums = np.zeros((9, rows, columns))
    for v in range(-radius, radius + 1):
        for u in range(-radius, radius + 1):
            difference = _shifted(inverse, v, u, radius) - centre
            same = np.abs(difference) < limit * max(1, abs(u), abs(v)) / 1.5
            value = np.where(same, difference, 0.0)
            for index, factor in enumerate((1, u, v, u * u, u * v, v * v)):
                if factor:
                    sums[index] += factor * same
            for index, factor in enumerate((1, u, v)):
                if factor:
                    sums[6 + index] += factor * value
    slope_u, slope_v, offset, is_determined = _fitted_planes(sums)
    # 1/z = a x + b y + c in normalised coordinates is the plane (a, b, c) . P = 1.
    x, y = normalized_coordinates(intrinsics)
    a, b = slope_u * intrinsics.fx, slope_v * intrinsics.fy
    normal = -np.stack([a, b, centre + offset - a * x - b * y], axis=-1)
    length = np.linalg.norm(normal, axis=-1)
    usable = is_determined & np.isfinite(depth_m)
    return np.where(usable[..., None], normal / np.where(usable, length, 1.0)[..., None], np.nan)


def _fitted_planes(sums: Float[Array, "9 row column"]) -> tuple[GridFloat, GridFloat, GridFloat, GridBool]:
    """Slopes and offset of the planes q = slope_u u + slope_v v + offset, and where they are well determined."""
    n, u, v, uu, uv, vv, q, uq, vq = sums
    count = np.maximum(n, 1)
    cuu, cuv, cvv = uu - u * u / count, uv - u * v / count, vv - v * v / count
    cuq, cvq = uq - u * q / count, vq - v * q / count
    determinant = cuu * cvv - cuv * cuv
    is_determined = (n >= _MIN_NORMAL_SUPPORT) & (determinant > 0.05 * np.square(n))
    safe = np.where(is_determined, determinant, 1.0)
    slope_u = (cuq * cvv - cvq * cuv) / safe
    slope_v = (cvq * cuu - cuq * cuv) / safe
    return slope_u, slope_v, (q - slope_u * u - slope_v * v) / count, is_determined


def _shifted(padded: Float[Array, "a b"], rows: int, columns: int, pad: int) -> Float[Array, "c d"]:
    """The unpadded array, each element replaced by that `rows` below and `columns` to the right."""
    height, width = padded.shape
    return padded[pad + rows : height - pad + rows, pad + columns : width - pad + columns]
