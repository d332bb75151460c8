"""The arrays of a photo in a Zarr group: colours, depth, classes; its camera is an attribute."""

from dataclasses import asdict
from typing import Any

import numpy as np

from mmweaver.core.records import CameraIntrinsics, ClassMask, RgbdPhoto
from mmweaver.core.safe_files.safe_zarr import ZarrFolder
from mmweaver.datasets.zarr_arrays import put_array
from mmweaver.scene.photo.camera_file import camera_numbers

FARTHEST_M = 1000.0  # of depths; what is beyond is damage


def put_photo(group: Any, photo: RgbdPhoto, depth_type: str = "float32") -> None:
    """Writes a photo with its camera; `depth_type`: that of the stored depth in metres."""
    put_array(group, "photo_rgb", photo.rgb, ("row", "column", "colour"))
    put_array(group, "photo_depth_m", photo.depth_m.astype(depth_type), ("row", "column"))
    if photo.classes is not None:
        put_array(group, "photo_class", photo.classes.index, ("row", "column"))
    group.attrs.update(
        {"camera": asdict(photo.intrinsics), "class_names": list(photo.classes.names) if photo.classes else []}
    )


def stored_photo(group: ZarrFolder) -> RgbdPhoto:
    """The photo of a group. Raises InputError where it is damaged."""
    rgb = group.numbers("photo_rgb", ("row", "column", 3), kinds="u", high=255).astype(np.uint8)
    depth_m = group.numbers("photo_depth_m", ("row", "column"), kinds="f", low=0, high=FARTHEST_M, nan=True)
    names, classes = group.words("class_names"), None
    if names:
        index = group.numbers("photo_class", ("row", "column"), kinds="u", high=len(names) - 1)
        classes = ClassMask(index=index.astype(np.uint8), names=names)
    height, width = depth_m.shape
    numbers = camera_numbers(group.attr("camera", dict), group.path)
    camera = CameraIntrinsics(
        fx=numbers["fx"], fy=numbers["fy"], cx=numbers["cx"], cy=numbers["cy"],
        width=round(numbers.get("width", width)), height=round(numbers.get("height", height)),
    )  # fmt: skip
    return RgbdPhoto(rgb=rgb, depth_m=depth_m.astype(np.float64), intrinsics=camera, classes=classes)
