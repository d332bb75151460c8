"""The photo of a capture folder as mmwave-capture-std writes it: a RealSense's colour.avi and depth.zst.

The two are not aligned, and their extrinsics are not recorded. The photo is the depth camera's; each pixel takes its
colour from the colour camera, which a D455 has 59 mm to the side.

Reference: mmwave-capture-std, capture/realsense (facts of the format only).

A further photo of a room and its camera's pose.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.pinhole import project, rotated_clockwise, unproject
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.core.safe_files.regular_files import open_regular
from mmweaver.core.safe_files.safe_text import read_json, read_toml
from mmweaver.core.shapes import Array, DepthPixels, PerFrame, RgbPixels
from mmweaver.scene.photo.picture_files import read_rgb, read_video_frame

Pose = Float[Array, "4 4"]


@dataclass(frozen=True, kw_only=True)
class PosedPhoto:
    """A photo with its camera's pose relative to that of the room's first photo.

    `pose` transforms points of this camera (x right, y down, z forward) into the first camera's, metres. A `RadarPose`
    is a rough position and yaw in the first camera's level frame, which the photos' own floors and walls refine.
    """

    photo: RgbdPhoto
    pose: Pose | RadarPose

    @property
    def is_rough(self) -> bool:
        """Whether only position and yaw are known, and those roughly."""
        return isinstance(self.pose, RadarPose)


DEPTH, COLOUR = "depth.zst", "color.avi"
D455_BASELINE_M = 0.059  # a point at x in the depth camera is at x - baseline in the colour camera
MAX_BYTES = 8_000_000_000


@dataclass(frozen=True, kw_only=True)
class CapturedPhoto:
    """One photo of a capture, or several of one room, their folder, and the assumptions made in reading them."""

    photo: RgbdPhoto
    folder: Path
    files: dict[str, Path]  # by what they hold: rgb, depth, camera
    assumptions: tuple[str, ...]
    others: tuple[PosedPhoto, ...] = ()  # further photos of the room


def photo_folder(path: Path | str) -> Path | None:
    """Finds the RealSense folder of a capture, in it or next to the given radar folder.

    Args:
        path: Capture folder, camera folder, or the folder of the capture's radar.

    Returns:
        The folder that holds depth.zst; None if there is none.

    Raises:
        InputError: If there are several.
    """
    path = Path(path)
    for parent in (path, path.parent):
        found = [parent] if (parent / DEPTH).is_file() else _camera_folders(parent)
        if len(found) > 1:
            raise InputError(f"{parent} holds several cameras; give the folder of one: {', '.join(map(str, found))}")
        if found:
            return found[0]
    return None


def photo_times_s(folder: Path) -> PerFrame:
    """Arrival time of each photo in a RealSense folder.

    Args:
        folder: Folder of the camera.

    Returns:
        Seconds on the recorder's clock, (photo,).

    Raises:
        InputError: If depth_metadata.json is missing or has no times.
    """
    entries = read_json(folder / "depth_metadata.json")
    if not isinstance(entries, list) or not entries:
        raise InputError(f"{folder / 'depth_metadata.json'} lists no photos")
    for key in ("time_of_arrival", "timestamp"):
        try:
            times_s = np.array([float(entry[key]) for entry in entries]) / 1e3
        except (KeyError, TypeError, ValueError):
            continue
        if np.isfinite(times_s).all() and (times_s > 0).all():
            return times_s
    raise InputError(f"{folder / 'depth_metadata.json'} holds no time_of_arrival or timestamp for every photo")


def read_capture_photo(path: Path | str, index: int = 0, rgb: Path | None = None) -> CapturedPhoto:
    """Reads one photo of a capture with its depth.

    Args:
        path: Capture folder, or as in `photo_folder`.
        index: Number of the photo, from 0.
        rgb: Colour picture that replaces the frame of color.avi.

    Returns:
        The photo in the depth camera's view, with the assumptions made.

    Raises:
        InputError: If the folder has no RealSense or no such photo, or a file is missing or damaged.
    """
    folder = photo_folder(path)
    if folder is None and not Path(path).exists():
        raise InputError(f"{path} does not exist; give a capture folder")
    if folder is None:
        raise InputError(f"{path} holds no RealSense ({DEPTH}); give --rgb and --depth instead")
    depth_config, colour_config = (read_json(folder / f"{name}_config.json") for name in ("depth", "color"))
    intrinsics, colour_intrinsics = (
        _intrinsics(folder / f"{name}_config.json", content)
        for name, content in (("depth", depth_config), ("color", colour_config))
    )
    unit_m = depth_config.get("depth_units")
    if not (isinstance(unit_m, int | float) and 1e-6 < unit_m < 0.1):
        raise InputError(
            f"{folder / 'depth_config.json'}: depth_units is {unit_m!r}; it must be the metres of one count"
        )
    rotated = _is_rotated(folder)
    raw = _depth_frame(folder / DEPTH, index, intrinsics)
    pixels = read_video_frame(folder / COLOUR, index) if rgb is None else read_rgb(rgb)[0]
    if rotated:  # both pictures were rotated by 90 degrees clockwise when saved, their intrinsics were not
        raw = np.rot90(raw.reshape(intrinsics.width, intrinsics.height))
        pixels = np.rot90(pixels)
    if pixels.shape[:2] != (colour_intrinsics.height, colour_intrinsics.width):
        raise InputError(
            f"{rgb or folder / COLOUR} has {pixels.shape[1]} x {pixels.shape[0]} pixels, color_config.json says"
            f" {colour_intrinsics.width} x {colour_intrinsics.height}"
        )
    depth_m = np.where(raw > 0, raw * float(unit_m), np.nan)
    if not np.isfinite(depth_m).any():
        raise InputError(f"{folder / DEPTH}: photo {index} has no depth at all; choose another (--photo)")
    colours = coloured(depth_m, intrinsics, pixels, colour_intrinsics)
    if rotated:
        depth_m, colours = np.rot90(depth_m, -1).copy(), np.rot90(colours, -1).copy()
        intrinsics = rotated_clockwise(intrinsics)
    photo = RgbdPhoto(rgb=colours, depth_m=depth_m, intrinsics=intrinsics)
    files = {"depth": folder / DEPTH, "rgb": rgb or folder / COLOUR}
    return CapturedPhoto(photo=photo, folder=folder, files=files, assumptions=_assumptions(index))


def _assumptions(index: int) -> tuple[str, ...]:
    return (
        f"Photo {index} of the capture was used, in the depth camera's view; the colour camera's position, which is not"
        f" recorded, was assumed to be that of a RealSense D455, {1e3 * D455_BASELINE_M:.0f} mm to the side.",
        "The recorder stamps a frame number into the colour picture; that patch stays white.",
    )


def coloured(
    depth_m: DepthPixels,
    intrinsics: CameraIntrinsics,
    rgb: UInt8[Array, "rows columns 3"],
    colour_intrinsics: CameraIntrinsics,
) -> RgbPixels:
    """Colours each depth pixel by reprojection into the colour camera, 59 mm to the side.

    Args:
        depth_m: Depth in metres, (height, width), nan where missing; such pixels are reprojected at the median depth.
        intrinsics: Intrinsics of the depth camera.
        rgb: Colour picture, uint8, (rows, columns, 3).
        colour_intrinsics: Intrinsics of the colour camera.

    Returns:
        Colour of each depth pixel, uint8, (height, width, 3).
    """
    filled = np.where(np.isfinite(depth_m), depth_m, np.nanmedian(depth_m))
    points_m = unproject(filled, intrinsics) - np.array([D455_BASELINE_M, 0.0, 0.0])
    with np.errstate(all="ignore"):  # implausible intrinsics may project points anywhere
        pixels = np.nan_to_num(project(points_m, colour_intrinsics)[0])
    column = np.clip(np.rint(pixels[..., 0]), 0, colour_intrinsics.width - 1).astype(int)
    row = np.clip(np.rint(pixels[..., 1]), 0, colour_intrinsics.height - 1).astype(int)
    return rgb[row, column]


def _depth_frame(path: Path, index: int, intrinsics: CameraIntrinsics) -> np.ndarray:
    """Depth counts (height, width), uint16, of one frame of the zstd stream."""
    need("capture", f"{path} is compressed, which", "zstandard")
    import zstandard

    size = 2 * intrinsics.width * intrinsics.height
    if index < 0 or (index + 1) * size > MAX_BYTES:
        raise InputError(f"{path} cannot hold a photo {index}; choose one from 0")
    try:
        with open_regular(path) as file, zstandard.ZstdDecompressor().stream_reader(file) as stream:
            for number in range(index + 1):
                content = _read_fully(stream, size)
                if len(content) < size:
                    pixels = f"{intrinsics.width} x {intrinsics.height} pixels"
                    raise InputError(
                        f"{path} holds {number} photos of {pixels}; choose one from 0 to {number - 1}"
                        if number
                        else f"{path} holds no whole photo of {pixels}; it is truncated"
                    )
    except (zstandard.ZstdError, OSError) as error:
        raise InputError(f"cannot read {path}: {error}; is it the capture's {DEPTH}?") from None
    return np.frombuffer(content, "<u2").reshape(intrinsics.height, intrinsics.width)


def _read_fully(stream: Any, size: int) -> bytes:
    parts, missing = [], size
    while missing and (part := stream.read(missing)):
        parts.append(part)
        missing -= len(part)
    return b"".join(parts)


def _intrinsics(path: Path, content: Any) -> CameraIntrinsics:
    try:
        own = content["intrinsics"]
        width, height = int(own["width"]), int(own["height"])
        fx, fy, ppx, ppy = (float(own[key]) for key in ("fx", "fy", "ppx", "ppy"))
    except (KeyError, TypeError, ValueError, OverflowError):
        raise InputError(f"{path} lacks intrinsics with width, height, fx, fy, ppx, ppy") from None
    if not (
        32 <= width <= 8000 and 32 <= height <= 8000 and 1 < fx < 1e6 and 1 < fy < 1e6 and max(abs(ppx), abs(ppy)) < 1e5
    ):
        raise InputError(f"{path}: no camera has {width} x {height} pixels with fx {fx:g}, fy {fy:g}")
    return CameraIntrinsics(fx=fx, fy=fy, cx=ppx, cy=ppy, width=width, height=height)


def _is_rotated(folder: Path) -> bool:
    """Whether the camera's pictures were rotated, according to config.toml."""
    try:
        content = read_toml(folder.parent / "config.toml")
        return bool(content["hardware"][folder.name].get("rotate", False))
    except (InputError, KeyError, TypeError, AttributeError):
        return False


def _camera_folders(parent: Path) -> list[Path]:
    return sorted(folder for folder in parent.iterdir() if (folder / DEPTH).is_file()) if parent.is_dir() else []
