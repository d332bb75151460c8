"""A shaded body painted into a photo: occluded where the measured depth is nearer, with a shadow where it touches.

Binary format between Python and the page: one JSON header, then little-endian arrays.

uint32   length n of the header, a multiple of 4
n bytes  JSON, padded with spaces; its key "arrays" maps a name to [type, shape, byte offset after the header]
...      the arrays in C order, each padded to 4 bytes
"""

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.shapes import Array, Points
from mmweaver.io.result_folder import plain
from mmweaver.viz.body_rasteriser import Body, BodyPixels, CapsulesInPicture, blend, rasterise, seen_width

TYPES = {"u1": "uint8", "i2": "int16", "i4": "int32", "f4": "float32"}


def pack(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> bytes:
    """Header and arrays as bytes.

    Args:
        header: Values for JSON.
        arrays: Arrays by name, uint8, int16, int32 or float32.

    Raises:
        ValueError: For an array of another type.
    """
    table: dict[str, list[Any]] = {}
    chunks: list[bytes] = []
    offset = 0
    for name, array in arrays.items():
        kind = array.dtype.str[1:]
        if kind not in TYPES:
            raise ValueError(f"{name} is {array.dtype}; the page reads {', '.join(TYPES.values())}")
        chunk = np.ascontiguousarray(array).astype(f"<{kind}", copy=False).tobytes()
        table[name] = [kind, list(array.shape), offset]
        chunk += b"\0" * (-len(chunk) % 4)
        chunks.append(chunk)
        offset += len(chunk)
    text = json.dumps(plain({**header, "arrays": table}), allow_nan=False, ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    return b"".join([struct.pack("<I", len(text)), text, *chunks])


def unpack(data: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """The header (without "arrays") and the arrays of `pack`.

    Raises:
        InputError: For bytes that are not of `pack`.
    """
    try:
        (length,) = struct.unpack_from("<I", data)
        header = parse_json(data[4 : 4 + length], "the header")
        listed = header.pop("arrays")
        if unknown := {kind for kind, _, _ in listed.values()} - set(TYPES):
            raise ValueError(f"no type is called {min(unknown)!r}")
        arrays = {
            name: np.frombuffer(data, f"<{kind}", int(np.prod(shape)), 4 + length + offset).reshape(shape)
            for name, (kind, shape, offset) in listed.items()
        }
    except (struct.error, ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        raise InputError(f"these bytes hold no sequence for the page: {error}") from None
    return header, arrays


NEAREST_M = 0.15  # capsules nearer to the camera are not drawn
OCCLUDED_BEYOND_M, EDGE_M = 0.12, 0.06  # depth behind the surface where occlusion begins, and width of the transition
OCCLUDED_ALPHA = 0.13  # opacity of occluded parts
SHADOW_REACH_M = 0.55  # reach of a capsule's shadow on surfaces around it
SHADOW_STRENGTH = 0.75
SHADOW_STEP_PX = 3  # shadows are smooth and computed for every third pixel


class BodyPainter:
    """Paints bodies into pictures of one photo.

    Args:
        aligned: The photo.
        size: Rows and columns of the pictures.
    """

    def __init__(self, aligned: AlignedPhoto, size: tuple[int, int]) -> None:
        photo = aligned.photo
        self._aligned, self._size, self._scale = aligned, size, size[1] / photo.depth_m.shape[1]
        row, column = (
            ((np.arange(new) + 0.5) * old / new).astype(int) for new, old in zip(size, photo.depth_m.shape, strict=True)
        )
        depth_m = photo.depth_m[row[:, None], column]
        self._depth_m = np.where(np.isfinite(depth_m), depth_m, np.inf).astype(np.float32)
        coarse = (row[::SHADOW_STEP_PX, None], column[::SHADOW_STEP_PX])
        surface_m = aligned.rays[coarse] * photo.depth_m[coarse][:, :, None] + aligned.camera_m
        self._surface_m = np.where(np.isfinite(surface_m), surface_m, 1e3).astype(np.float32)

    def paint(self, picture: Array, bodies: Sequence[tuple[Body, Sequence[float]]]) -> None:
        """Paints bodies into a picture.

        Args:
            picture: Picture (row, column, 3), uint8, changed in place.
            bodies: Bodies with their colours (0 to 1), the last one on top.
        """
        drawn = []
        for body, colour in bodies:
            capsules = self._capsules(body)
            seen = None if capsules is None else rasterise(capsules, self._size)
            if seen is not None:
                drawn.append((body, colour, seen))
        self._shade(picture, [body for body, *_ in drawn])
        for _, colour, seen in drawn:
            blend(picture, seen, np.asarray(colour, np.float32), self._alpha(seen))

    def _alpha(self, seen: BodyPixels) -> Float[Array, "row column"]:
        """Opacity of a body at each pixel."""
        hidden_m = np.where(seen.cover > 0.0, seen.depth_m, 0.0) - self._depth_m[seen.rows, seen.columns]
        return np.clip(1.0 - (hidden_m - OCCLUDED_BEYOND_M) / EDGE_M, OCCLUDED_ALPHA, 1.0)

    def _capsules(self, body: Body) -> CapsulesInPicture | None:
        """The capsules in pixels of the picture; None where all are behind the camera."""
        ends_px, depth_m = self._aligned.project(body.ends_m.astype(np.float64))
        ahead = (depth_m > NEAREST_M).all(axis=1)
        if not ahead.any():
            return None
        ends_px = (ends_px[ahead] + 0.5) * self._scale - 0.5
        depth_m, radius_m = depth_m[ahead], body.radius_m[ahead]
        wide_px = (body.wide[ahead] @ self._aligned.radar_from_camera)[:, :2]
        wider = seen_width(ends_px[:, 1] - ends_px[:, 0], wide_px, body.width_per_depth[ahead])
        radius_px = radius_m * wider[:, None] * self._aligned.photo.intrinsics.fx * self._scale / depth_m
        return CapsulesInPicture(ends_px=ends_px, depth_m=depth_m, radius_px=radius_px, radius_m=radius_m)

    def _shade(self, picture: Array, bodies: Sequence[Body]) -> None:
        """Darkens measured surfaces near the bodies, by the body that occludes most ambient light."""
        from PIL import Image

        surface_m = self._surface_m.reshape(-1, 3)
        light = np.ones(len(surface_m), np.float32)
        for body in bodies:
            near = np.flatnonzero(_is_near(surface_m, body.ends_m, SHADOW_REACH_M))
            light[near] = np.minimum(light[near], _unblocked(surface_m[near], body))
        coarse = Image.fromarray(np.rint(255 * light).astype(np.uint8).reshape(self._surface_m.shape[:2]))
        fine = np.asarray(coarse.resize(self._size[::-1], Image.Resampling.BILINEAR), np.uint16)
        picture[:] = picture * fine[:, :, None] // 255


def _is_near(points_m: Points, ends_m: Float[Array, "capsule 2 3"], reach_m: float) -> Bool[Array, " point"]:
    """Mask of the points within a distance of the bounding box of the capsules."""
    low, high = ends_m.min(axis=(0, 1)) - reach_m, ends_m.max(axis=(0, 1)) + reach_m
    return np.all((points_m > low) & (points_m < high), axis=1)


def _unblocked(points_m: Points, body: Body) -> Float[Array, " point"]:
    """Share of ambient light, 0 to 1, that spheres at the ends of the capsules leave at points."""
    centre_m = body.ends_m.reshape(-1, 3).astype(np.float32)
    square = (points_m**2).sum(axis=1)[:, None] + (centre_m**2).sum(axis=1) - 2.0 * points_m @ centre_m.T
    fading = np.maximum(1.0 - square / SHADOW_REACH_M**2, 0.0) ** 2
    blocked = np.minimum(0.6, body.radius_m.reshape(-1).astype(np.float32) ** 2 / np.maximum(square, 1e-4)) * fading
    return 1.0 - SHADOW_STRENGTH * (1.0 - np.exp(-1.5 * blocked.sum(axis=1)))
