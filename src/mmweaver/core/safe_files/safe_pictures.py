"""Pictures in a few common formats; all other decoders of Pillow stay unreachable.

Pillow would pass an EPS to Ghostscript whatever the file name, and decoders of rare formats are poorly tested.
"""

import contextlib
import logging
import os
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.regular_files import foreign_errors, open_regular

if TYPE_CHECKING:
    from PIL import Image

MAX_PIXELS = 50_000_000
FORMATS = ("PNG", "JPEG", "TIFF", "WEBP", "BMP", "PPM")  # JPEG includes MPO, which many phones write
_MIN_SIDE = 32
ORIENTATION = 0x0112
_EXIF, _FOCAL_35MM = 0x8769, 0xA405
_HEIF_BRANDS = (b"heic", b"heix", b"heim", b"heis", b"mif1", b"msf1")
# EXIF orientation: operation that turns the stored picture upright, as numbered in Pillow's Image.Transpose
_TURN = {2: 0, 3: 3, 4: 1, 5: 5, 6: 4, 7: 6, 8: 2}


@dataclass(frozen=True, kw_only=True)
class Picture:
    """A decoded picture, upright."""

    image: "Image.Image"
    stored_size: tuple[int, int]  # (width, height) in the file
    orientation: int  # EXIF orientation, 1 to 8; 1 = as stored
    focal_35mm: float | None = None  # 35 mm equivalent focal length from EXIF, in millimetres


def open_picture(path: Path) -> Picture:
    """Opens and decodes a picture, and turns it upright according to its EXIF orientation.

    Args:
        path: The file.

    Returns:
        The picture.

    Raises:
        InputError: If it cannot be decoded, is too small or too large.
    """
    from PIL import Image, UnidentifiedImageError

    with (
        _quiet_pillow(),
        open_regular(path) as file,
        foreign_errors(path, "damaged ({reason}); give a whole picture file"),
    ):
        try:
            image = Image.open(file, formats=(*FORMATS, *_heif(path, file)))
        except UnidentifiedImageError:
            raise InputError(_unknown(path)) from None
        except Image.DecompressionBombError:
            raise InputError(_too_large(path)) from None
        size = image.size
        if size[0] * size[1] > MAX_PIXELS:
            raise InputError(_too_large(path))
        if min(size) < _MIN_SIDE:
            raise InputError(f"{path} has only {size[0]} x {size[1]} pixels; give a larger picture")
        if image.format == "TIFF":  # Pillow turns these upright itself and drops the tag
            orientation = image.getexif().get(ORIENTATION, 1)
            with _no_messages():
                image.load()
        else:
            image.load()
            orientation = image.getexif().get(ORIENTATION, 1)
            if orientation in range(2, 9):
                image = image.transpose(Image.Transpose(_TURN[orientation]))
            elif image.format == "HEIF":  # already upright after decoding, with a reset tag
                orientation = image.info.get("original_orientation") or 1
                size = size[::-1] if orientation in range(5, 9) else size
        focal_35mm = _focal_35mm(image.getexif())
    orientation = orientation if orientation in range(2, 9) else 1
    return Picture(image=image, stored_size=size, orientation=orientation, focal_35mm=focal_35mm)


def turned_upright(stored: np.ndarray, orientation: int) -> np.ndarray:
    """Turns stored pixels upright.

    Args:
        stored: Pixels as stored, (row, column, ...).
        orientation: EXIF orientation, 1 to 8.

    Returns:
        Upright pixels.

    >>> turned_upright(np.array([[1, 2, 3]]), 6).tolist()
    [[1], [2], [3]]
    """
    quarters = {3: 2, 4: 2, 5: -1, 6: -1, 7: 1, 8: 1}.get(orientation, 0)  # counterclockwise
    upright = np.rot90(stored, quarters)
    return upright[:, ::-1] if orientation in (2, 4, 5, 7) else upright


def _heif(path: Path, file: BufferedReader) -> tuple[str, ...]:
    """Name of the HEIC decoder if the file is HEIC. Raises InputError if it is not installed."""
    start = file.read(12)
    file.seek(0)
    if start[4:8] != b"ftyp" or start[8:12] not in _HEIF_BRANDS:
        return ()
    need("phone", f"{path} is a HEIC, which", "pillow_heif")
    import pillow_heif

    pillow_heif.register_heif_opener()
    return ("HEIF",)


def _focal_35mm(exif: "Image.Exif") -> float | None:
    """35 mm equivalent focal length, if present and plausible."""
    value: Any = exif.get_ifd(_EXIF).get(_FOCAL_35MM)
    try:
        focal_mm = float(value)
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    return focal_mm if 8 <= focal_mm <= 300 else None


def read_animation(path: Path) -> list[np.ndarray]:
    """Reads a .gif.

    Args:
        path: The file.

    Returns:
        One picture per frame, (height, width, 3) uint8.

    Raises:
        InputError: If it is not a .gif, is damaged or too large.
    """
    from PIL import Image, ImageSequence

    with open_regular(path) as file, foreign_errors(path, "damaged or no .gif ({reason}); make it again"):
        image, pictures = Image.open(file, formats=("GIF",)), []
        for picture in ImageSequence.Iterator(image):
            if (len(pictures) + 1) * image.width * image.height > MAX_PIXELS:
                raise InputError(_too_large(path))
            pictures.append(np.asarray(picture.convert("RGB")))
    return pictures


def _unknown(path: Path) -> str:
    if path.suffix.lower() == ".exr":
        return f"{path} is OpenEXR, which is not supported; save it as a float TIFF or a .npy"
    return f"{path} is not a picture that can be read; give a PNG or JPEG (TIFF, WebP, BMP and PPM are read too)"


def _too_large(path: Path) -> str:
    return f"{path} is too large; make it smaller than {MAX_PIXELS / 1e6:.0f} million pixels"


@contextlib.contextmanager
def safe_decoders() -> Iterator[None]:
    """Context in which pictures that a library opens, such as textures of a mesh, have the limits of `read_picture`."""
    from PIL import Image

    opened = Image.open

    def open_safely(file: Any, mode: Any = "r", formats: Any = None) -> Any:
        image = opened(file, mode, FORMATS if formats is None else formats)
        if image.width * image.height > MAX_PIXELS:
            raise ValueError("a picture in it is too large")
        return image

    Image.open = cast("Any", open_safely)
    try:
        yield
    finally:
        Image.open = opened


@contextlib.contextmanager
def _quiet_pillow() -> Iterator[None]:
    """Silences Pillow's log about damaged files: without handlers, logging writes errors to stderr."""
    log = logging.getLogger("PIL")
    kept = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        log.setLevel(kept)


@contextlib.contextmanager
def _no_messages() -> Iterator[None]:
    """Silences messages of libtiff about damaged files, which go to stderr directly."""
    try:
        kept = os.dup(2)
    except OSError:  # there is no stderr
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
