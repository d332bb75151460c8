"""A photo with depth, from its files."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import ClassMask, RgbdPhoto
from mmweaver.core.shapes import DepthPixels, RgbPixels
from mmweaver.scene.photo.camera_file import d455_intrinsics, intrinsics_for, read_camera_file
from mmweaver.scene.photo.estimated_depth import EXAMPLE, estimate_depth
from mmweaver.scene.photo.picture_files import read_depth, read_rgb
from mmweaver.scene.photo.sparse_depth import fill_scattered_holes
from mmweaver.scene.segmentation.builtin_segmenter import segment_builtin
from mmweaver.scene.segmentation.class_file import read_class_file
from mmweaver.scene.segmentation.pretrained_segmenter import segment, sharpened

BUILTIN = "builtin"  # the name of our own segmenter
SAME_SHAPE = 0.01  # two pictures in the same proportions
WIDE_ENOUGH = 640  # a coarser depth picture is enlarged to about so many columns


def read_photo(
    rgb: str | Path,
    depth: str | Path | None = None,
    camera: str | Path | None = None,
    *,
    depth_model: str | None = None,
    classes: str | Path | None = None,
    segmenter: str | None = None,
    sam: str | None = None,
) -> tuple[RgbdPhoto, tuple[str, ...]]:
    """Reads a colour picture, its depth and its camera; also gives, as sentences, what was assumed.

    Args:
        rgb: any picture Pillow reads; turned upright by its EXIF tag.
        depth: a 16-bit PNG in camera.json's `depth_unit_m` (0.001 if not stated, 0 = hole), a .npy in metres (float)
            or in that unit (whole numbers), or a TIFF of either; the same view as the colour picture. Where one has
            more pixels than the other both are brought to one size.
        camera: camera.json with fx, fy, cx, cy in pixels of the colour picture. None takes the field of view of a
            RealSense D455.
        depth_model: folder or Hub name of a metric depth model, where there is no `depth`.
        classes: a picture of COCO-Stuff's class numbers (see `class_file`), or
        segmenter: folder or Hub name of a model that finds them, or "builtin" for the small one that comes with the
            project; `sam`, a model whose masks sharpen their edges.

    Raises InputError, in one line, for whatever cannot be used.
    """
    rgb = _existing(rgb, "--rgb")
    camera = None if camera is None else _existing(camera, "--camera")
    numbers = {} if camera is None else read_camera_file(camera)
    pixels, stored_size, turned = read_rgb(rgb)
    seen = (pixels.shape[1], pixels.shape[0])
    sentences: list[str] = []
    if depth is not None:
        depth = _existing(depth, "--depth")
        depth_m = read_depth(depth, numbers.get("depth_unit_m"))
        _check_same_view(rgb, depth, seen, depth_m, turned_from=stored_size if turned else None)
    elif depth_model is not None:
        depth_m = estimate_depth(pixels, depth_model)
        sentences.append(f"The depth was estimated from the colours by {depth_model}; it may err by tens of per cent.")
    else:
        raise InputError(
            f"{rgb} has no depth: give --depth, or a model that estimates it: --depth-model DIR or Hub name, for"
            f" example {EXAMPLE}"
        )
    depth_m, patched = fill_scattered_holes(depth_m)
    pixels, depth_m, resized = _of_one_size(pixels, depth_m)
    height, width = depth_m.shape
    own = {"width": float(seen[0]), "height": float(seen[1]), **numbers}
    intrinsics = d455_intrinsics(width, height) if camera is None else intrinsics_for(camera, own, width, height)
    photo = RgbdPhoto(rgb=pixels, depth_m=depth_m, intrinsics=intrinsics)
    mask = classes_of(photo, classes=classes, segmenter=segmenter, sam=sam)
    photo = replace(photo, classes=mask)
    stated = _assumptions(photo, has_camera=camera is not None, turned=turned and depth is not None)
    return photo, (*stated, *patched, *resized, *sentences)


def classes_of(
    photo: RgbdPhoto, *, classes: str | Path | None = None, segmenter: str | None = None, sam: str | None = None
) -> ClassMask | None:
    """What each pixel of a photo shows, from a file or by a model; None where neither is given."""
    if classes is not None and (segmenter or sam):
        raise InputError("--classes says what is what; leave out --segmenter and --sam")
    if sam is not None and segmenter is None:
        raise InputError("--sam finds edges and no classes; give --segmenter too")
    if classes is not None:
        return read_class_file(_existing(classes, "--classes"), photo.intrinsics.width, photo.intrinsics.height)
    if segmenter == BUILTIN:
        mask = segment_builtin(photo)
        return mask if sam is None else sharpened(mask, photo.rgb, sam)
    return None if segmenter is None else segment(photo.rgb, segmenter, sam)


def _check_same_view(
    rgb: Path, depth: Path, seen: tuple[int, int], depth_m: DepthPixels, *, turned_from: tuple[int, int] | None
) -> None:
    height, width = depth_m.shape
    if abs(seen[0] / seen[1] / (width / height) - 1) <= SAME_SHAPE:
        return
    hint = "depth must be aligned to the colour picture: the same view in the same proportions"
    if turned_from is not None and abs(turned_from[0] / turned_from[1] / (width / height) - 1) <= SAME_SHAPE:
        hint = "the EXIF tag turns the colour picture but not the depth; turn both upright and save them so"
    raise InputError(f"{rgb} has {seen[0]} x {seen[1]} pixels but {depth} {width} x {height}; {hint}")


def _of_one_size(pixels: np.ndarray, depth_m: np.ndarray) -> tuple[RgbPixels, DepthPixels, tuple[str, ...]]:
    """Both at the depth's size, or a whole multiple of a small one; depth by its nearest pixels, never in between."""
    from PIL import Image

    (rows, columns), (height, width) = pixels.shape[:2], depth_m.shape
    if (rows, columns) == (height, width):
        return pixels, depth_m, ()
    times = max(1, min(-(-WIDE_ENOUGH // width), columns // width))
    size = (times * width, times * height)
    colours = np.array(Image.fromarray(pixels).resize(size, Image.Resampling.BOX))
    sentence = (
        f"The colour picture has {columns} x {rows} pixels, the depth {width} x {height}: both were brought to"
        f" {size[0]} x {size[1]}, taken to show the same view."
    )
    return colours, np.repeat(np.repeat(depth_m, times, axis=0), times, axis=1), (sentence,)


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
