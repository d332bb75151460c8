"""camera.json: focal lengths, principal point and the unit of the depth picture."""

import math
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import resized
from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.safe_files.regular_files import Place
from mmweaver.core.safe_files.safe_text import read_json

# RealSense D455, colour: 1280 x 800 pixels, 90 degrees horizontally (Intel's data sheet of the D400 series). Its
# smaller pictures are centred crops of that, scaled: 640 x 480 has a focal length of 384 pixels.
_D455_WIDTH, _D455_HEIGHT, _D455_FOCAL = 1280, 800, 640.0


LIMITS = {
    "fx": (1e-3, 1e6),
    "fy": (1e-3, 1e6),
    "width": (8, 1e5),
    "height": (8, 1e5),
    "depth_unit_m": (1e-6, 1.0),
}


def centred_intrinsics(width: int, height: int, focal_px: float) -> CameraIntrinsics:
    """Intrinsics with square pixels and the principal point in the middle of the picture.

    Args:
        width: Columns of the picture.
        height: Rows of the picture.
        focal_px: Focal length in pixels.
    """
    return CameraIntrinsics(
        fx=focal_px, fy=focal_px, cx=(width - 1) / 2, cy=(height - 1) / 2, width=width, height=height
    )


def d455_intrinsics(width: int, height: int) -> CameraIntrinsics:
    """The intrinsics of a RealSense D455's colour camera.

    Args:
        width: Columns of the picture.
        height: Rows of the picture.

    >>> d455_intrinsics(640, 480).fx
    384.0
    """
    return centred_intrinsics(width, height, _D455_FOCAL * max(width / _D455_WIDTH, height / _D455_HEIGHT))


def lens_intrinsics(width: int, height: int, focal_35mm: float) -> CameraIntrinsics:
    """The intrinsics of an uncropped picture from its 35 mm equivalent focal length.

    The equivalent focal length compares diagonals (CIPA DCG-001).

    Args:
        width: Columns of the picture.
        height: Rows of the picture.
        focal_35mm: Focal length in millimetres on 35 mm film.

    >>> round(lens_intrinsics(4000, 3000, 26.0).fx)
    3005
    """
    return centred_intrinsics(width, height, focal_35mm * math.hypot(width, height) / math.hypot(36.0, 24.0))


def read_camera_file(path: Path) -> dict[str, float]:
    """Reads a camera.json; other keys are ignored.

    Args:
        path: The file.

    Returns:
        fx, fy, cx, cy in pixels; width, height in pixels and depth_unit_m in metres if present.

    Raises:
        InputError: If a key is missing or a value is not a plausible number.
    """
    return camera_numbers(read_json(path), path)


def camera_numbers(content: Any, path: Place) -> dict[str, float]:
    """Validates the content of a camera.json, see `read_camera_file`.

    Args:
        content: Parsed JSON.
        path: File it comes from, for error messages.
    """
    if not isinstance(content, dict):
        raise InputError(f"{path} must be a JSON object with fx, fy, cx, cy")
    if missing := [key for key in ("fx", "fy", "cx", "cy") if key not in content]:
        raise InputError(f"{path}: missing {', '.join(missing)}; a camera file needs fx, fy, cx, cy in pixels")
    numbers = {key: _number(path, key, content[key]) for key in ("fx", "fy", "cx", "cy")}
    for key in ("width", "height", "depth_unit_m"):
        if content.get(key) is not None:
            numbers[key] = _number(path, key, content[key])
    for key, (low, high) in LIMITS.items():
        if key in numbers and not low <= numbers[key] <= high:
            raise InputError(f"{path}: {key} is {numbers[key]:g}; it must be positive, {low:g} to {high:g}")
    return numbers


def intrinsics_for(path: Path, numbers: dict[str, float], width: int, height: int) -> CameraIntrinsics:
    """Intrinsics of a picture from the numbers of a camera.json, rescaled if the file is for another size.

    Args:
        path: The camera file, for error messages.
        numbers: Result of `read_camera_file`.
        width: Columns of the picture.
        height: Rows of the picture.

    Returns:
        Intrinsics in pixels of this picture.

    Raises:
        InputError: If the aspect ratios differ, or the numbers are implausible for a camera.
    """
    stated = CameraIntrinsics(
        fx=numbers["fx"],
        fy=numbers["fy"],
        cx=numbers["cx"],
        cy=numbers["cy"],
        width=round(numbers.get("width", width)),
        height=round(numbers.get("height", height)),
    )
    if abs(width / stated.width / (height / stated.height) - 1) > 0.01:
        raise InputError(
            f"{path} is for a picture of {stated.width} x {stated.height} pixels, this one has {width} x {height},"
            " another aspect ratio; give the camera file of this picture"
        )
    intrinsics = resized(stated, width, height)
    _check(path, intrinsics)
    return intrinsics


def _check(path: Path, camera: CameraIntrinsics) -> None:
    field_of_view_deg = math.degrees(2 * math.atan(camera.width / 2 / camera.fx))
    if not 10 <= field_of_view_deg <= 150 or not 0.5 <= camera.fx / camera.fy <= 2:
        raise InputError(
            f"{path}: fx {camera.fx:g} and fy {camera.fy:g} on {camera.width} x {camera.height} pixels give a field of"
            f" view of {field_of_view_deg:.0f} degrees; focal lengths must be in pixels of this picture"
        )
    if not (-0.25 <= camera.cx / camera.width <= 1.25 and -0.25 <= camera.cy / camera.height <= 1.25):
        raise InputError(
            f"{path}: the principal point ({camera.cx:g}, {camera.cy:g}) is far outside the picture of"
            f" {camera.width} x {camera.height} pixels; cx and cy must be in pixels of this picture"
        )


def _number(path: Place, key: str, value: Any) -> float:
    if type(value) not in (int, float) or not abs(value) < 1e300:
        raise InputError(f"{path}: {key} is {value!r}; it must be a finite number")
    return float(value)
