"""Reads colour pictures as 8-bit RGB and depth pictures in metres; anything else is rejected in one line.

Reads one frame of a video by PyAV (extras `capture` and `phone`).
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.regular_files import foreign_errors, open_regular
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.core.safe_files.safe_pictures import MAX_PIXELS, open_picture
from mmweaver.core.shapes import DepthPixels, RgbPixels

NO_VIDEO = "damaged or no video ({reason}); is it whole? or give the picture with --rgb"


def read_video_frame(path: Path, index: int, extra: str = "capture") -> RgbPixels:
    """Decodes one frame of a video; the frames before it are decoded too, since most codecs store differences.

    Args:
        path: Video, by its suffix MP4/MOV or AVI.
        index: Number of the frame, from 0.
        extra: Extra to suggest if PyAV is missing.

    Returns:
        The frame, uint8 RGB, (height, width, 3).

    Raises:
        InputError: If PyAV is missing, or the file is not a video, is damaged, or has no such frame.
    """
    need(extra, f"{path} is a video, which", "av")
    import av

    kind = "mov" if path.suffix.lower() in (".mp4", ".mov", ".m4v") else "avi"
    if index < 0:
        raise InputError(f"{path} has no frame {index}; choose one from 0")
    count = 0
    # One fixed format on the opened file: playlists, which name other files and hosts, are not followed.
    with (
        open_regular(path) as file,
        foreign_errors(path, NO_VIDEO),
        av.open(file, "r", format=kind) as container,
    ):
        if not container.streams.video:
            raise InputError(f"{path} holds no video")
        # A damaged frame is an error; by default it would be filled from its neighbours.
        container.streams.video[0].codec_context.options = {"err_detect": "explode"}
        for frame in container.decode(video=0):
            if count == index:
                if frame.width * frame.height > MAX_PIXELS:
                    raise InputError(f"{path} has frames of {frame.width} x {frame.height} pixels; give a smaller one")
                return frame.to_ndarray(format="rgb24")
            count += 1
    raise InputError(f"{path} has {count} frames; choose one from 0 to {count - 1}")


_MIN_SIDE = 32
_PLAUSIBLE_MEDIAN_M = (0.2, 20.0)
_MAX_HOLES = 0.9
_POSSIBLE_M = (0.01, 100.0)  # no depth camera measures beyond
_MAX_IMPOSSIBLE = 0.01
# Units in use: metres, centimetres, millimetres, TUM's 1/5000 m, 1/4000 m, 0.1 mm.
_KNOWN_UNITS_M = (1.0, 0.01, 0.001, 0.0002, 0.00025, 0.0001)
_UINT16_SATURATED = 65535


@dataclass(frozen=True, kw_only=True)
class Turned:
    """Orientation of a picture in its file, and the lens that took it."""

    stored_size: tuple[int, int]  # (width, height)
    orientation: int  # EXIF's; 1 = it was upright
    focal_35mm: float | None = None  # millimetres on 35 mm film, from EXIF


def read_rgb(path: Path) -> tuple[RgbPixels, Turned]:
    """Reads a colour picture and rotates it upright.

    Args:
        path: Any picture that Pillow reads; 16-bit grey is reduced to 8 bits, transparency blended on white.

    Returns:
        The upright picture, uint8, (height, width, 3), and its orientation in the file.

    Raises:
        InputError: If the file is damaged or holds no colours.
    """
    picture = open_picture(path)
    image = picture.image
    turned = Turned(stored_size=picture.stored_size, orientation=picture.orientation, focal_35mm=picture.focal_35mm)
    if image.mode.startswith("I;16") or image.mode == "I":
        grey = np.clip(np.asarray(image).astype(np.int64) // 256, 0, 255).astype(np.uint8)
        return np.repeat(grey[:, :, None], 3, axis=2), turned
    if image.mode == "F":
        raise InputError(f"{path} holds floating-point values, not colours; --rgb needs a photo (PNG or JPEG)")
    with foreign_errors(path, "damaged ({reason}); give a whole picture file"):
        return np.array(_blend_on_white(image)), turned


def read_depth(path: Path, unit_m: float | None) -> tuple[DepthPixels, Turned]:
    """Reads a depth picture.

    Args:
        path: 16-bit PNG, TIFF, or .npy.
        unit_m: Metres per count of integers; None for millimetres. Floats are in metres.

    Returns:
        Depth in metres, (height, width), nan without a measurement, and its orientation in the file.

    Raises:
        InputError: If it cannot be depth: 8-bit or colour pictures, pictures without measurements, a wrong unit, or
            more than 1 % of values outside 0.01 to 100 m.
    """
    raw, turned = read_depth_values(path)
    return depth_in_metres(path, raw, unit_m), turned


def read_depth_values(path: Path) -> tuple[np.ndarray, Turned]:
    """Reads a depth picture as stored.

    Args:
        path: 16-bit PNG, TIFF, or .npy.

    Returns:
        Counts or floats, (height, width), and its orientation in the file.

    Raises:
        InputError: If it cannot be depth: 8-bit or colour pictures, or other sizes.
    """
    if path.suffix.lower() == ".npy":
        raw = _raw_npy(path)
        turned = Turned(stored_size=(raw.shape[1], raw.shape[0]), orientation=1)
    else:
        raw, turned = _raw_picture(path)
    if raw.size > MAX_PIXELS or min(raw.shape) < _MIN_SIDE:
        raise InputError(f"{path} has {raw.shape[1]} x {raw.shape[0]} pixels; make it {_MIN_SIDE} to 8000 on a side")
    return raw, turned


def depth_in_metres(path: Path, raw: np.ndarray, unit_m: float | None) -> DepthPixels:
    """Depth of stored values.

    Args:
        path: The file, for messages.
        raw: Counts or floats, (height, width).
        unit_m: Metres per count of integers; None for millimetres. Floats are in metres.

    Returns:
        Depth in metres, (height, width), nan without a measurement.

    Raises:
        InputError: If there are no measurements, or more than 1 % of values are outside 0.01 to 100 m.
    """
    counts = raw.dtype.kind in "ui"
    used_unit_m = (0.001 if unit_m is None else unit_m) if counts else 1.0
    with np.errstate(all="ignore"):  # float64 of a signalling NaN or a longer float
        depth = raw.astype(np.float64)
        depth *= used_unit_m
        measured = np.isfinite(depth) & (depth > 0)
        if raw.dtype == np.uint16:
            measured &= raw < _UINT16_SATURATED
        _check_measured(path, measured)
        _check_unit(path, float(np.median(depth[measured])), used_unit_m, counts)
        possible = measured & (depth >= _POSSIBLE_M[0]) & (depth <= _POSSIBLE_M[1])
    _check_possible(path, depth, measured, possible)
    depth[~possible] = np.nan
    return depth


def _check_possible(path: Path, depth: np.ndarray, measured: np.ndarray, possible: np.ndarray) -> None:
    """A few implausible values are holes; many mean another unit, another marker of holes, or damage."""
    low, high = _POSSIBLE_M
    share = 1 - np.count_nonzero(possible) / np.count_nonzero(measured)
    if share > _MAX_IMPOSSIBLE:
        odd = float(np.median(depth[measured & ~possible]))
        raise InputError(
            f"{path}: {100 * share:.1f} % of the depth values are not within {low:g} to {high:g} m (such as {odd:.4g}"
            " m); set pixels without a measurement to 0, or give an undamaged file"
        )


def _check_measured(path: Path, measured: np.ndarray) -> None:
    share = measured.mean()
    if share == 0:
        raise InputError(f"{path}: every depth value is zero, negative or not finite; give one with measurements")
    if share < 1 - _MAX_HOLES:
        raise InputError(
            f"{path}: only {100 * share:.1f} % of the pixels have a depth; {100 * (1 - _MAX_HOLES):.0f} % are needed"
        )


def _check_unit(path: Path, median_m: float, unit_m: float, counts: bool) -> None:
    low, high = _PLAUSIBLE_MEDIAN_M
    if low <= median_m <= high:
        return
    ratio = np.array([median_m / unit_m * unit for unit in _KNOWN_UNITS_M])
    best = int(np.argmin(np.abs(np.log(ratio / 2.5))))
    hint = ""
    if low <= ratio[best] <= high:
        unit = _KNOWN_UNITS_M[best]
        remedy = f"set depth_unit_m to {unit:g} in camera.json" if counts else f"multiply it by {unit:g}"
        hint = f"; {remedy} (the median would be {ratio[best]:.2f} m)"
    raise InputError(
        f"{path}: the median depth is {median_m:.4g} m, not within {low:g} to {high:g} m: the unit seems wrong{hint}"
    )


def _raw_picture(path: Path) -> tuple[np.ndarray, Turned]:
    picture = open_picture(path)
    image = picture.image
    if image.mode in ("1", "L", "P"):
        raise InputError(f"{path} has 8 bits a pixel; depth must be a 16-bit PNG or a .npy in metres")
    if not (image.mode.startswith("I;16") or image.mode in ("I", "F")):
        raise InputError(f"{path} is a colour picture ({image.mode}), not depth; give a 16-bit PNG or a .npy in metres")
    raw = np.array(image)
    turned = Turned(stored_size=picture.stored_size, orientation=picture.orientation)
    return raw.astype(np.uint16) if image.mode.startswith("I;16") else raw, turned


def _raw_npy(path: Path) -> np.ndarray:
    raw = read_npy(path, mapped=True)
    if raw.dtype.kind not in "fui":
        raise InputError(f"{path} holds values of type {raw.dtype}; depth must be real numbers")
    if raw.dtype == np.uint8 or raw.dtype == np.int8:
        raise InputError(f"{path} has 8 bits a pixel; depth must be float metres or 16-bit counts")
    if raw.ndim != 2:
        raise InputError(f"{path} has shape {raw.shape}; depth must be (height, width)")
    if raw.size > MAX_PIXELS:
        raise InputError(
            f"{path} has {raw.size / 1e6:.0f} million pixels; make it smaller than {MAX_PIXELS / 1e6:.0f} million"
        )
    return np.array(raw)


def _blend_on_white(image: Any) -> Any:
    """Converts any colour mode to RGB, transparent pixels over white."""
    from PIL import Image

    if "transparency" not in image.info and image.mode not in ("RGBA", "LA", "PA", "La", "RGBa"):
        return image.convert("RGB")
    layer = image.convert("RGBA")
    white = Image.new("RGBA", layer.size, (255, 255, 255, 255))
    return Image.alpha_composite(white, layer).convert("RGB")
