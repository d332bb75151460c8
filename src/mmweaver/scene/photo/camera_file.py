"""camera.json: focal lengths, principal point and the unit of the depth picture."""

import json
import math
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.records import CameraIntrinsics

DEFAULT_DEPTH_UNIT_M = 0.001

# RealSense D455, colour: 1280 x 800 pixels, 90 degrees across (Intel's data sheet of the D400 series). Its smaller
# pictures are centred crops of that, scaled; 640 x 480 so has a focal length of 384 pixels.
_D455_WIDTH, _D455_HEIGHT, _D455_FOCAL = 1280, 800, 640.0


def d455_intrinsics(width: int, height: int) -> CameraIntrinsics:
    """The field of view of a RealSense D455 scaled to a picture.

    >>> d455_intrinsics(640, 480).fx
    384.0
    """
    focal = _D455_FOCAL * max(width / _D455_WIDTH, height / _D455_HEIGHT)
    return CameraIntrinsics(
        fx=focal, fy=focal, cx=(width - 1) / 2, cy=(height - 1) / 2, width=width, height=height
    )  # fmt: skip


def read_camera_file(path: Path) -> dict[str, float]:
    """The numbers of a camera.json: fx, fy, cx, cy, perhaps width, height (whole) and depth_unit_m.

    Raises InputError where a key is missing or a value is no sensible number. Other keys are ignored.
    """
    try:
        content: Any = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"cannot read the camera file {path}: {error.strerror or error}") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path} is not a JSON file: {error}; it needs fx, fy, cx, cy") from error
    if not isinstance(content, dict):
        raise InputError(f"{path} must be a JSON object with fx, fy, cx, cy")
    if missing := [key for key in ("fx", "fy", "cx", "cy") if key not in content]:
        raise InputError(f"{path}: missing {', '.join(missing)}; a camera file needs fx, fy, cx, cy in pixels")
    numbers = {key: _number(path, key, content[key]) for key in ("fx", "fy", "cx", "cy")}
    for key in ("width", "height", "depth_unit_m"):
        if content.get(key) is not None:
            numbers[key] = _number(path, key, content[key])
    for key in ("fx", "fy", "width", "height", "depth_unit_m"):
        if key in numbers and numbers[key] <= 0:
            raise InputError(f"{path}: {key} is {numbers[key]:g}; it must be positive")
    return numbers


def intrinsics_for(path: Path, numbers: dict[str, float], width: int, height: int) -> CameraIntrinsics:
    """The intrinsics in pixels of a picture of this size; scaled where the file states another width or height.

    Raises InputError where the two differ in shape, or no camera could have such numbers.
    """
    stated_width, stated_height = numbers.get("width", float(width)), numbers.get("height", float(height))
    across, down = width / stated_width, height / stated_height
    if abs(across / down - 1) > 0.01:
        raise InputError(
            f"{path} is for a picture of {stated_width:g} x {stated_height:g} pixels, this one has {width} x {height},"
            " which is another shape; give the camera file of this picture"
        )
    # Pixel centres lie at whole numbers, so pixel edges, at -0.5, are what scaling keeps.
    intrinsics = CameraIntrinsics(
        fx=numbers["fx"] * across,
        fy=numbers["fy"] * down,
        cx=(numbers["cx"] + 0.5) * across - 0.5,
        cy=(numbers["cy"] + 0.5) * down - 0.5,
        width=width,
        height=height,
    )
    _check(path, intrinsics)
    return intrinsics


def _check(path: Path, camera: CameraIntrinsics) -> None:
    across = math.degrees(2 * math.atan(camera.width / 2 / camera.fx))
    if not 10 <= across <= 150 or not 0.5 <= camera.fx / camera.fy <= 2:
        raise InputError(
            f"{path}: fx {camera.fx:g} and fy {camera.fy:g} on {camera.width} x {camera.height} pixels give a view of"
            f" {across:.0f} degrees; focal lengths must be in pixels of this picture"
        )
    if not (-0.25 <= camera.cx / camera.width <= 1.25 and -0.25 <= camera.cy / camera.height <= 1.25):
        raise InputError(
            f"{path}: the principal point ({camera.cx:g}, {camera.cy:g}) lies far outside the picture of"
            f" {camera.width} x {camera.height} pixels; cx and cy must be in pixels of this picture"
        )


def _number(path: Path, key: str, value: Any) -> float:
    if type(value) not in (int, float) or not abs(value) < 1e9:
        raise InputError(f"{path}: {key} is {value!r}; it must be a finite number")
    return float(value)
