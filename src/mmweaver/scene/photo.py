"""A photo with depth, from its files."""

from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.records import RgbdPhoto
from mmweaver.scene.camera_file import d455_intrinsics, intrinsics_for, read_camera_file
from mmweaver.scene.picture_files import read_depth, read_rgb


def read_photo(
    rgb: str | Path, depth: str | Path, camera: str | Path | None = None
) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Reads a colour picture, its depth and its camera; also gives, as sentences, what was assumed.

    Args:
        rgb: any picture Pillow reads; turned upright by its EXIF tag.
        depth: a 16-bit PNG in camera.json's `depth_unit_m` (0.001 if not stated, 0 = hole), or a .npy in metres
            (float) or in that unit (whole numbers); as many pixels as the colour picture, pixel upon pixel.
        camera: camera.json with fx, fy, cx, cy in pixels. None takes the field of view of a RealSense D455.

    Raises InputError, in one line, for whatever cannot be used.
    """
    rgb, depth = _existing(rgb, "--rgb"), _existing(depth, "--depth")
    camera = None if camera is None else _existing(camera, "--camera")
    numbers = {} if camera is None else read_camera_file(camera)
    pixels, stored_size, turned = read_rgb(rgb)
    depth_m = read_depth(depth, numbers.get("depth_unit_m"))
    height, width = depth_m.shape
    if pixels.shape[:2] != depth_m.shape:
        hint = "depth must be aligned to the colour picture, pixel upon pixel"
        if turned and stored_size == (width, height):
            hint = "the EXIF tag turns the colour picture but not the depth; turn both upright and save them so"
        raise InputError(
            f"{rgb} has {pixels.shape[1]} x {pixels.shape[0]} pixels but {depth} {width} x {height}; {hint}"
        )
    intrinsics = d455_intrinsics(width, height) if camera is None else intrinsics_for(camera, numbers, width, height)
    photo = RgbdPhoto(rgb=pixels, depth_m=depth_m, intrinsics=intrinsics)
    return photo, _assumptions(photo, has_camera=camera is not None, turned=turned)


def _assumptions(photo: RgbdPhoto, *, has_camera: bool, turned: bool) -> tuple[str, ...]:
    camera = photo.intrinsics
    sentences = []
    if not has_camera:
        sentences.append(
            f"No camera file: the field of view of a RealSense D455 was taken (focal length {camera.fx:.1f} pixels"
            f" on {camera.width} x {camera.height})."
        )
    if turned:
        sentences.append("The colour picture was turned upright by its EXIF tag; the depth was taken to be upright.")
    return tuple(sentences)


def _existing(path: str | Path, option: str) -> Path:
    path = Path(path)
    try:
        if path.is_file():
            return path
        problem = "is a folder" if path.is_dir() else "does not exist"
    except (OSError, ValueError) as error:
        raise InputError(f"{option} {str(path)[:80]!r} is no usable path: {error}") from error
    raise InputError(f"{option} {path} {problem}; give a file")
