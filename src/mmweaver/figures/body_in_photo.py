"""A shaded body painted into a photo: occluded where the measured depth is nearer, with a shadow where it touches."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.shapes import Array, Points
from mmweaver.figures.body_rasteriser import Body, BodyPixels, CapsulesInPicture, rasterise, seen_width
from mmweaver.geometry.aligned_photo import AlignedPhoto

Colour = tuple[float, float, float]
NEAREST_M = 0.15  # capsules nearer to the camera are not drawn
OCCLUDED_BEYOND_M, EDGE_M = 0.12, 0.06  # behind the measured surface: hidden from, and completely so after
OCCLUDED_ALPHA = 0.13  # a hint of what furniture hides
SHADOW_REACH_M = 0.55  # of a capsule's end over surfaces about it
SHADOW_STRENGTH = 0.75
SHADOW_STEP_PX = 3  # shadows are smooth and computed for every third pixel


def project(points_m: Points, aligned: AlignedPhoto) -> Float[Array, "point 3"]:
    """Radar frame -> (column, row, depth in metres) in the photo; nan behind the camera.

    Reference: docs/conventions.md, "Camera".
    """
    pixels, depth_m = aligned.project(points_m)
    return np.where(depth_m[:, None] > 0.05, np.column_stack([pixels, depth_m]), np.nan)


@dataclass(frozen=True)
class PhotoPixels:
    """A photo as it appears in a picture: the photo's column and row (fractions) of each of the picture's."""

    aligned: AlignedPhoto
    column: Float[Array, " column"]
    row: Float[Array, " row"]

    @classmethod
    def whole(cls, aligned: AlignedPhoto, size: tuple[int, int]) -> "PhotoPixels":
        """The whole photo in a picture of (rows, columns)."""
        height, width = aligned.photo.rgb.shape[:2]
        row, column = ((np.arange(new) + 0.5) * old / new - 0.5 for new, old in zip(size, (height, width), strict=True))
        return cls(aligned, column, row)

    @property
    def per_photo_pixel(self) -> float:
        """Pixels of the picture per pixel of the photo."""
        return float(1.0 / (self.column[1] - self.column[0])) if len(self.column) > 1 else 1.0

    def capsules(self, body: Body) -> CapsulesInPicture | None:
        """The capsules in pixels of the picture; None where all are behind the camera."""
        ends_px, depth_m = self.aligned.project(body.ends_m.astype(np.float64))
        ahead = (depth_m > NEAREST_M).all(axis=1)
        if not ahead.any():
            return None
        scale = self.per_photo_pixel
        ends_px = (ends_px[ahead] - [self.column[0], self.row[0]]) * scale
        depth_m, radius_m = depth_m[ahead], body.radius_m[ahead]
        wide_px = (body.wide[ahead] @ self.aligned.radar_from_camera)[:, :2]
        wider = seen_width(ends_px[:, 1] - ends_px[:, 0], wide_px, body.width_per_depth[ahead])
        radius_px = radius_m * wider[:, None] * self.aligned.photo.intrinsics.fx * scale / depth_m
        return CapsulesInPicture(ends_px=ends_px, depth_m=depth_m, radius_px=radius_px, radius_m=radius_m)


class BodyPainter:
    """Paints bodies into pictures of one photo, all of the same size."""

    def __init__(self, pixels: PhotoPixels) -> None:
        photo = pixels.aligned.photo
        height, width = photo.depth_m.shape
        row = np.clip(np.round(pixels.row), 0, height - 1).astype(int)
        column = np.clip(np.round(pixels.column), 0, width - 1).astype(int)
        self._pixels, self._size = pixels, (len(row), len(column))
        depth_m = photo.depth_m[row[:, None], column]
        self._depth_m = np.where(np.isfinite(depth_m), depth_m, np.inf).astype(np.float32)
        coarse = (row[::SHADOW_STEP_PX, None], column[::SHADOW_STEP_PX])
        surface_m = pixels.aligned.rays[coarse] * photo.depth_m[coarse][:, :, None] + pixels.aligned.camera_m
        self._surface_m = np.where(np.isfinite(surface_m), surface_m, 1e3).astype(np.float32)

    def paint(self, picture: Array, bodies: Sequence[tuple[Body, Colour]]) -> None:
        """Paints bodies of a colour (0 to 1) into a picture (row, column, 3) uint8, the last one on top."""
        drawn = []
        for body, colour in bodies:
            capsules = self._pixels.capsules(body)
            seen = None if capsules is None else rasterise(capsules, self._size)
            if seen is not None:
                drawn.append((body, colour, seen))
        self._shade(picture, [(body, seen) for body, _, seen in drawn])
        for _, colour, seen in drawn:
            place = (seen.rows, seen.columns)
            hidden_m = np.where(seen.cover > 0.0, seen.depth_m, 0.0) - self._depth_m[place] - OCCLUDED_BEYOND_M
            alpha = seen.cover * np.clip(1.0 - hidden_m / EDGE_M, OCCLUDED_ALPHA, 1.0)
            shaded = seen.light[:, :, None] * (255.0 * np.asarray(colour, np.float32))
            below = picture[place].astype(np.float32)
            picture[place] = np.rint(below + alpha[:, :, None] * (shaded - below)).astype(np.uint8)

    def _shade(self, picture: Array, bodies: list[tuple[Body, BodyPixels]]) -> None:
        """Darkens measured surfaces near the bodies, each as the body that takes most ambient light from it does."""
        from PIL import Image

        light = np.ones(self._surface_m.shape[:2], np.float32)
        for body, seen in bodies:
            reach_px = (seen.rows.stop - seen.rows.start) // 4
            blocks = tuple(
                slice(max(span.start - reach_px, 0) // SHADOW_STEP_PX, (span.stop + reach_px) // SHADOW_STEP_PX)
                for span in (seen.rows, seen.columns)
            )
            part = light[blocks]
            surface_m = self._surface_m[blocks].reshape(-1, 3)
            near = np.flatnonzero(_within(surface_m, body.ends_m, SHADOW_REACH_M))
            flat = part.reshape(-1)  # a copy
            flat[near] = np.minimum(flat[near], _unblocked(surface_m[near], body))
            part[:] = flat.reshape(part.shape)
        rows, columns = (np.flatnonzero((light < 0.99).any(axis=1 - axis)) for axis in (0, 1))
        if not len(rows):
            return
        block = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
        place = tuple(slice(span.start * SHADOW_STEP_PX, span.stop * SHADOW_STEP_PX) for span in block)
        shown = picture[place]
        small = Image.fromarray(np.rint(255 * light[block]).astype(np.uint8))
        size = (small.width * SHADOW_STEP_PX, small.height * SHADOW_STEP_PX)
        fine = np.asarray(small.resize(size, Image.Resampling.BILINEAR), np.uint16)
        shown[:] = shown * fine[: shown.shape[0], : shown.shape[1], None] // 255


def _within(points_m: Points, ends_m: Float[Array, "capsule 2 3"], reach_m: float) -> Bool[Array, " point"]:
    """Which points lie within a distance of the box about the capsules."""
    low, high = ends_m.min(axis=(0, 1)) - reach_m, ends_m.max(axis=(0, 1)) + reach_m
    return np.all((points_m > low) & (points_m < high), axis=1)


def _unblocked(points_m: Points, body: Body) -> Float[Array, " point"]:
    """Share of ambient light that spheres at the ends of the capsules leave to points, 0 to 1."""
    centre_m = body.ends_m.reshape(-1, 3).astype(np.float32)
    square = (points_m**2).sum(axis=1)[:, None] + (centre_m**2).sum(axis=1) - 2.0 * points_m @ centre_m.T
    fading = np.maximum(1.0 - square / SHADOW_REACH_M**2, 0.0) ** 2
    blocked = np.minimum(0.6, body.radius_m.reshape(-1).astype(np.float32) ** 2 / np.maximum(square, 1e-4)) * fading
    return 1.0 - SHADOW_STRENGTH * (1.0 - np.exp(-1.5 * blocked.sum(axis=1)))
