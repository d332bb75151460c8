"""Reads colour pictures as 8-bit RGB and depth pictures in metres; anything else is refused in one line."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import DepthPixels, RgbPixels

MAX_PIXELS = 50_000_000
_MIN_SIDE = 32
_PLAUSIBLE_MEDIAN_M = (0.2, 20.0)
_MAX_HOLES = 0.9
# Units in use: metres, centimetres, millimetres, TUM's 1/5000 m, 1/4000 m, 0.1 mm.
_KNOWN_UNITS_M = (1.0, 0.01, 0.001, 0.0002, 0.00025, 0.0001)
_UINT16_SATURATED = 65535


def read_rgb(path: Path) -> tuple[RgbPixels, tuple[int, int], bool]:
    """The upright picture, uint8 (height, width, 3), the (width, height) of the file, and whether EXIF rotated it."""
    from PIL import ImageOps

    image = open_picture(path)
    stored_size = image.size
    rotated = image.getexif().get(0x0112, 1) in range(2, 9)
    if rotated:
        image = ImageOps.exif_transpose(image)
    if image.mode.startswith("I;16") or image.mode == "I":
        grey = np.clip(np.asarray(image).astype(np.int64) // 256, 0, 255).astype(np.uint8)
        return np.repeat(grey[:, :, None], 3, axis=2), stored_size, rotated
    if image.mode == "F":
        raise InputError(f"{path} holds floating-point values, not colours; --rgb needs a photo (PNG or JPEG)")
    return np.array(_on_white(image)), stored_size, rotated


def read_depth(path: Path, unit_m: float | None) -> DepthPixels:
    """Depth in metres, (height, width), nan where there is no measurement.

    Integers are in units of `unit_m` metres (millimetres if None). Raises InputError for what cannot be depth: 8-bit or
    colour pictures, pictures without measurements, a wrong unit.
    """
    raw = _raw_npy(path) if path.suffix.lower() == ".npy" else _raw_picture(path)
    if raw.size > MAX_PIXELS or min(raw.shape) < _MIN_SIDE:
        raise InputError(f"{path} has {raw.shape[1]} x {raw.shape[0]} pixels; make it {_MIN_SIDE} to 8000 on a side")
    counts = raw.dtype.kind in "ui"
    used_unit_m = (0.001 if unit_m is None else unit_m) if counts else 1.0
    depth = raw.astype(np.float64) * used_unit_m
    measured = np.isfinite(depth) & (depth > 0)
    if raw.dtype == np.uint16:
        measured &= raw < _UINT16_SATURATED
    _check_measured(path, raw, measured)
    _check_unit(path, float(np.median(depth[measured])), used_unit_m, counts)
    return np.where(measured, depth, np.nan)


def _check_measured(path: Path, raw: np.ndarray, measured: np.ndarray) -> None:
    share = measured.mean()
    if share == 0:
        kinds = (
            ("zero", raw == 0),
            ("nan", np.isnan(raw)),
            ("infinite", np.isinf(raw)),
            ("negative", raw < 0),
        )
        kind = next((name for name, mask in kinds if mask.all()), "zero, negative or not finite")
        raise InputError(f"{path}: every depth value is {kind}; give a depth picture with measurements")
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


def _raw_picture(path: Path) -> np.ndarray:
    image = open_picture(path)
    if image.mode in ("1", "L", "P"):
        raise InputError(f"{path} has 8 bits a pixel; depth must be a 16-bit PNG or a .npy in metres")
    if not (image.mode.startswith("I;16") or image.mode in ("I", "F")):
        raise InputError(f"{path} is a colour picture ({image.mode}), not depth; give a 16-bit PNG or a .npy in metres")
    raw = np.array(image)
    return raw.astype(np.uint16) if image.mode.startswith("I;16") else raw


def _raw_npy(path: Path) -> np.ndarray:
    try:
        raw: Any = np.load(path, allow_pickle=False, mmap_mode="r")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, EOFError) as error:
        raise InputError(f"{path} is not a plain .npy array ({_first_line(error)}); save it with numpy.save") from error
    if not isinstance(raw, np.ndarray):
        raise InputError(f"{path} is an archive, not a .npy array; save the depth alone with numpy.save")
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


def open_picture(path: Path) -> Any:
    """Opens and decodes a picture. Raises InputError where it cannot be read, is too small or too large."""
    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(path)
        if image.width * image.height > MAX_PIXELS:
            raise Image.DecompressionBombError
        if min(image.size) < _MIN_SIDE:
            raise InputError(f"{path} has only {image.width} x {image.height} pixels; give a larger picture")
        image.load()
    except UnidentifiedImageError as error:
        if path.suffix.lower() == ".exr":
            raise InputError(f"{path} is OpenEXR, which is not supported; save it as a float TIFF or a .npy") from error
        raise InputError(f"{path} is not a picture that can be read; give a PNG or JPEG") from error
    except Image.DecompressionBombError as error:
        raise InputError(f"{path} is too large; make it smaller than {MAX_PIXELS / 1e6:.0f} million pixels") from error
    except InputError:
        raise
    except OSError as error:
        reason = error.strerror or _first_line(error)
        raise InputError(f"cannot read {path}: {reason}; give a whole picture file") from error
    except (ValueError, SyntaxError, EOFError) as error:
        raise InputError(f"{path} is damaged ({_first_line(error)}); give a whole picture file") from error
    return image


def _on_white(image: Any) -> Any:
    """Converts any colour mode to RGB, transparent pixels over white."""
    from PIL import Image

    if "transparency" not in image.info and image.mode not in ("RGBA", "LA", "PA", "La", "RGBa"):
        return image.convert("RGB")
    layer = image.convert("RGBA")
    white = Image.new("RGBA", layer.size, (255, 255, 255, 255))
    return Image.alpha_composite(white, layer).convert("RGB")


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
