"""Reads a photo with depth from its files."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import resized
from mmweaver.core.records import CameraIntrinsics, ClassMask, RgbdPhoto
from mmweaver.core.safe_files.safe_pictures import turned_upright
from mmweaver.core.shapes import DepthPixels, RgbPixels
from mmweaver.scene.depth_scale import DepthReading
from mmweaver.scene.photo.camera_file import d455_intrinsics, intrinsics_for, lens_intrinsics, read_camera_file
from mmweaver.scene.photo.depth_grid import fill_scattered_holes
from mmweaver.scene.photo.estimated_depth import EXAMPLE, estimate_depth
from mmweaver.scene.photo.picture_files import Turned, read_depth_values, read_rgb
from mmweaver.scene.segmentation.builtin_segmenter import segment_builtin
from mmweaver.scene.segmentation.class_file import read_class_file
from mmweaver.scene.segmentation.pretrained_segmenter import refined_by_sam, segment

BUILTIN = "builtin"  # the name of the built-in segmenter
SAME_ASPECT = 0.01  # relative difference of two aspect ratios that count as equal
MIN_WIDTH = 640  # a coarser depth picture is enlarged to about this many columns


def read_photo(
    rgb: str | Path,
    depth: str | Path | None = None,
    camera: str | Path | None = None,
    *,
    depth_model: str | None = None,
    depth_unit: str | None = None,
    depth_kind: str | None = None,
    classes: str | Path | None = None,
    segmenter: str | None = None,
    sam: str | None = None,
) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Reads a colour picture with its depth and camera.

    Args:
        rgb: Any picture that Pillow reads; rotated upright by its EXIF tag.
        depth: A 16-bit PNG (0 = hole), a .npy in metres (float) or of integers, or a TIFF of either; the same view as
            the colour picture. Where one has more pixels than the other, both are resampled to one size.
        camera: camera.json with fx, fy, cx, cy in pixels of the colour picture. None takes the focal length of the
            picture's EXIF, else the estimate of the depth model, else the field of view of a RealSense D455.
        depth_model: Folder or Hub name of a metric depth model, or "auto", used if there is no `depth`; a Prompt Depth
            Anything refines a coarse `depth`.
        depth_unit: Unit of integers: a name in `depth_scale.UNITS`, "sunrgbd", or metres per count. Default:
            camera.json's `depth_unit_m`, else estimated from the room and reported.
        depth_kind: "z" (along the optical axis), "ray" (along each pixel's ray) or "disparity" (of a Kinect). Default:
            z, or ray where only that makes surfaces flat.
        classes: Picture of COCO-Stuff class numbers, see `class_file`; excludes `segmenter` and `sam`.
        segmenter: Folder or Hub name of a segmentation model, or "builtin" for the built-in one.
        sam: Folder or Hub name of a SAM model that refines the segmenter's edges.

    Returns:
        The photo, and the assumptions made, as sentences.

    Raises:
        InputError: If a file or model cannot be used, in one line.
    """
    rgb = _existing(rgb, "--rgb")
    camera = None if camera is None else _existing(camera, "--camera")
    numbers = {} if camera is None else read_camera_file(camera)
    pixels, turned = read_rgb(rgb)
    rgb_size = (pixels.shape[1], pixels.shape[0])
    notes: list[str] = []
    if depth is not None:
        depth = _existing(depth, "--depth")
        raw, depth_turned = read_depth_values(depth)
        if depth_lies := _lies_as_stored(rgb_size, raw, turned, depth_turned):
            raw = turned_upright(raw, turned.orientation)
        seen_by = _camera_of_depth(raw.shape, camera, numbers, turned, rgb_size)
        known = DepthReading(unit=depth_unit, kind=depth_kind, stated_unit_m=numbers.get("depth_unit_m"))
        depth_m, depth_notes = known.depth(depth, raw, seen_by)
        notes += depth_notes
        _check_same_view(rgb, depth, rgb_size, depth_m)
        _check_turned(rgb, depth, turned, depth_turned)
    else:
        depth_m, depth_lies = None, False
    estimated = None
    if depth_model is not None:
        estimated = estimate_depth(pixels, depth_model, measured_m=depth_m)
        notes.append(
            f"The depth was estimated from the colours by {estimated.model}; it may err by tens of per cent."
            if depth_m is None
            else f"The measured depth was refined from the colours by {estimated.model}."
        )
        depth_m = estimated.depth_m
    if depth_m is None:
        raise InputError(
            f"{rgb} has no depth: give --depth, or a model that estimates it: --depth auto ({EXAMPLE}, downloaded"
            " once), a folder or another Hub name"
        )
    depth_m, fill_notes = fill_scattered_holes(depth_m)
    pixels, depth_m, size_notes = to_common_size(pixels, depth_m)
    height, width = depth_m.shape
    numbers = {"width": float(rgb_size[0]), "height": float(rgb_size[1]), **numbers}
    intrinsics, lens_note = (
        _default_intrinsics(rgb_size, (width, height), turned, None if estimated is None else estimated.focal_px)
        if camera is None
        else (intrinsics_for(camera, numbers, width, height), None)
    )
    photo = RgbdPhoto(rgb=pixels, depth_m=depth_m, intrinsics=intrinsics)
    photo = replace(photo, classes=classes_of(photo, classes=classes, segmenter=segmenter, sam=sam))
    assumptions = _assumptions(lens_note, turned if depth is not None else None, depth_lies=depth_lies)
    return photo, (*assumptions, *fill_notes, *size_notes, *notes)


def _camera_of_depth(
    shape: tuple[int, ...], camera: Path | None, numbers: dict[str, float], turned: Turned, rgb_size: tuple[int, int]
) -> CameraIntrinsics:
    """Intrinsics in pixels of a depth picture, as far as they are known before it is read."""
    height, width = shape[0], shape[1]
    numbers = {"width": float(rgb_size[0]), "height": float(rgb_size[1]), **numbers}
    same = abs(numbers["width"] / numbers["height"] / (width / height) - 1) <= SAME_ASPECT
    return (
        _default_intrinsics(rgb_size, (width, height), turned, None)[0]
        if camera is None or not same
        else intrinsics_for(camera, numbers, width, height)
    )


def classes_of(
    photo: RgbdPhoto, *, classes: str | Path | None = None, segmenter: str | None = None, sam: str | None = None
) -> ClassMask | None:
    """The class mask of a photo, from a file or by a model.

    Args:
        photo: The photo.
        classes: Picture of class numbers, see `class_file`.
        segmenter: Folder or Hub name of a segmentation model, or "builtin".
        sam: Folder or Hub name of a SAM model that refines the segmenter's edges.

    Returns:
        The mask; None if neither `classes` nor `segmenter` is given.

    Raises:
        InputError: If `classes` is combined with a model, `sam` lacks a segmenter, or a file or model cannot be used.
    """
    if classes is not None and (segmenter or sam):
        raise InputError("classes already gives the classes; leave out segmenter and sam")
    if sam is not None and segmenter is None:
        raise InputError("sam finds edges, not classes; give segmenter too")
    if classes is not None:
        return read_class_file(_existing(classes, "--classes"), photo.intrinsics.width, photo.intrinsics.height)
    if segmenter == BUILTIN:
        mask = segment_builtin(photo)
        return mask if sam is None else refined_by_sam(mask, photo.rgb, sam)
    return None if segmenter is None else segment(photo.rgb, segmenter, sam)


def _has_aspect(size: tuple[int, int], picture: np.ndarray) -> bool:
    height, width = picture.shape
    return abs(size[0] / size[1] / (width / height) - 1) <= SAME_ASPECT


def _lies_as_stored(rgb_size: tuple[int, int], depth: np.ndarray, colours: Turned, depths: Turned) -> bool:
    """Whether the depth is rotated as the colours are stored: its shape shows it, and it has no EXIF tag."""
    is_quarter = colours.orientation >= 5 and depths.orientation == 1
    return is_quarter and not _has_aspect(rgb_size, depth) and _has_aspect(colours.stored_size, depth)


def _check_same_view(rgb: Path, depth: Path, rgb_size: tuple[int, int], depth_m: DepthPixels) -> None:
    if not _has_aspect(rgb_size, depth_m):
        height, width = depth_m.shape
        raise InputError(
            f"{rgb} has {rgb_size[0]} x {rgb_size[1]} pixels but {depth} {width} x {height};"
            " depth must be aligned to the colour picture: the same view with the same aspect ratio"
        )


def _check_turned(rgb: Path, depth: Path, colours: Turned, depths: Turned) -> None:
    """Rejects depth of ambiguous orientation: the colours have an EXIF rotation that the depth's shape cannot confirm.

    A quarter turn is visible in the depth's shape; a half turn and a mirror image are not.
    """
    width, height = colours.stored_size
    is_visible = colours.orientation >= 5 and abs(width / height - 1) > SAME_ASPECT
    if colours.orientation != 1 and depths.orientation == 1 and not is_visible:
        raise InputError(
            f"the EXIF tag turns {rgb} (orientation {colours.orientation}), but nothing says whether {depth} is upright"
            " too; save both upright and without the tag"
        )


def to_common_size(pixels: np.ndarray, depth_m: np.ndarray) -> tuple[RgbPixels, DepthPixels, tuple[str, ...]]:
    """Resamples colours and depth to one size: the depth's, or an integer multiple of a small one.

    Args:
        pixels: Colour picture, uint8, (rows, columns, 3).
        depth_m: Depth in metres, (height, width); pixels are repeated, never interpolated.

    Returns:
        Colours and depth at one size, and a sentence that reports the resampling if there was any.
    """
    from PIL import Image

    (rows, columns), (height, width) = pixels.shape[:2], depth_m.shape
    if (rows, columns) == (height, width):
        return pixels, depth_m, ()
    factor = max(1, min(-(-MIN_WIDTH // width), columns // width))
    size = (factor * width, factor * height)
    colours = np.array(Image.fromarray(pixels).resize(size, Image.Resampling.BOX))
    note = (
        f"The colour picture has {columns} x {rows} pixels, the depth {width} x {height}: both were resampled to"
        f" {size[0]} x {size[1]}, assuming that they show the same view."
    )
    return colours, np.repeat(np.repeat(depth_m, factor, axis=0), factor, axis=1), (note,)


def _default_intrinsics(
    rgb_size: tuple[int, int], size: tuple[int, int], turned: Turned, focal_px: float | None
) -> tuple[CameraIntrinsics, str]:
    """Intrinsics of a picture resampled from `rgb_size` to `size`, and the sentence that reports their source.

    `focal_px` is the depth model's estimate in pixels of the original picture.
    """
    if turned.focal_35mm is not None:
        camera = resized(lens_intrinsics(*rgb_size, turned.focal_35mm), *size)
        said = f"the focal length of the picture's EXIF tag was taken ({turned.focal_35mm:g} mm on 35 mm film;"
    elif focal_px is not None:
        camera = resized(replace(d455_intrinsics(*rgb_size), fx=focal_px, fy=focal_px), *size)
        said = "the focal length that the depth model estimated was taken ("
    else:
        camera = d455_intrinsics(*size)
        said = "the field of view of a RealSense D455 was assumed (focal length"
    pixels = f"{camera.fx:.1f} pixels on {camera.width} x {camera.height})."
    return camera, f"No camera file: {said}{'' if said.endswith('(') else ' '}{pixels}"


def _assumptions(lens_note: str | None, turned: Turned | None, *, depth_lies: bool) -> tuple[str, ...]:
    """Sentences on the lens and the orientation; `turned` is that of the colours of a photo with a depth file."""
    notes = [] if lens_note is None else [lens_note]
    if turned is not None and turned.orientation != 1:
        said = "was turned with it" if depth_lies else "was taken as upright"
        notes.append(f"The colour picture was rotated upright by its EXIF tag; the depth {said}.")
    return tuple(notes)


def _existing(path: str | Path, option: str) -> Path:
    path = Path(path)
    try:
        if path.is_file():
            return path
        problem = "is a folder" if path.is_dir() else "does not exist"
    except (OSError, ValueError) as error:
        raise InputError(f"{option} {str(path)[:80]!r} is not a usable path: {error}") from error
    raise InputError(f"{option} {path} {problem}; give a file")
