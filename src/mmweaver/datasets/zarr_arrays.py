"""Arrays of a data set's Zarr groups: every chunk is written, with a CRC-32C."""

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.optional_packages import need
from mmweaver.core.records import CameraIntrinsics, ClassMask, RadarCube, RgbdPhoto
from mmweaver.core.safe_files.safe_zarr import ZarrFolder
from mmweaver.scene.photo.camera_file import camera_numbers

UNITS = {
    "iq": "1 (times iq_scale: sqrt(mW))",
    "iq_scale": "sqrt(mW)",
    "joint_velocity_mps": "m/s",
    "range": "m",
    "radial_velocity": "m/s",
    "frame_time": "s",
    "empty_iq": "sqrt(mW)",
    "heading": "rad",
    "height": "m",
}
IQ_DIMENSIONS = ("sequence", "frame_time", "range", "radial_velocity", "antenna", "part")
SHARD_BYTES = 32 << 20  # of signals in one file, if a sequence is not larger: 500 sequences are some 30 files

_PEAK = 16384.0  # of the largest float16 of a sequence


def zarr_module() -> Any:
    """The zarr module, imported lazily. Raises InputError where it is not installed."""
    need("dataset", "a data set", "zarr")
    import zarr

    return zarr


def put_array(group: Any, name: str, values: np.ndarray, dimensions: tuple[str, ...], *, packing: Any = None) -> None:
    """Writes one array as one chunk.

    `packing`: the codec of its bytes (default Zstandard). Chunks of nothing but zeros are written too, so that a file
    that is missing is damage, which Zarr itself takes for zeros.
    """
    from zarr.codecs import Crc32cCodec, ZstdCodec

    values = np.ascontiguousarray(values)
    array = group.create_array(
        name,
        shape=values.shape,
        dtype=values.dtype,
        dimension_names=dimensions,
        overwrite=True,
        compressors=[packing or ZstdCodec(), Crc32cCodec()],
        config={"write_empty_chunks": True},
        chunks=values.shape if values.size else (1,) * values.ndim,
    )
    array[...] = values
    _put_unit(array, name)


def _put_unit(array: Any, name: str) -> None:
    unit = UNITS.get(name, "m" if name.endswith("_m") else "")
    if unit:
        array.attrs["units"] = unit


def put_sequences(
    group: Any,
    name: str,
    kind: str,
    shape: tuple[int, ...],
    dimensions: tuple[str, ...],
    sequences: Iterable[np.ndarray],
    *,
    packing: Sequence[Any] = (),
) -> None:
    """Writes an array of `shape` (sequence, ...) and number type `kind`, one sequence after another.

    A sequence is a chunk, packed by the codecs `packing`; chunks are in shards of at most SHARD_BYTES.
    """
    from zarr.codecs import Crc32cCodec

    bytes_each = int(np.prod(shape[1:])) * np.dtype(kind).itemsize
    in_shard = min(max(1, SHARD_BYTES // bytes_each), shape[0])
    array = group.create_array(
        name,
        shape=shape,
        chunks=(1, *shape[1:]),
        shards=(in_shard, *shape[1:]),
        dtype=kind,
        overwrite=True,
        dimension_names=dimensions,
        compressors=[*packing, Crc32cCodec()],
        config={"write_empty_chunks": True},
    )
    _put_unit(array, name)
    kept: list[np.ndarray] = []
    for number, values in enumerate(sequences, start=1):
        kept.append(values)
        if len(kept) == in_shard or number == shape[0]:
            array[number - len(kept) : number] = np.stack(kept)
            kept = []


def write_iq(group: Any, kind: str, shape: tuple[int, ...], sequences: Iterable[np.ndarray]) -> None:
    """Writes the signals of `shape` (sequence, frame, range, doppler, antenna, part) as float16 or float32.

    Without compression, so that the size of a sequence says nothing of its content.
    """
    put_sequences(group, "iq", kind, shape, IQ_DIMENSIONS, sequences)
    group["iq"].attrs["part_names"] = ["in-phase", "quadrature"]


def packed_iq(cube: RadarCube, kind: str = "float16") -> tuple[np.ndarray, float]:
    """(frame, range, doppler, antenna, part) in float16 or float32, and the factor to sqrt(mW).

    The largest float16 is 16384: the error is below 5e-4 of a value down to 1e-9 of the peak's power.
    """
    scale = cube.scale if np.isfinite(cube.scale) else 1.0
    pairs = np.ascontiguousarray(cube.values).view(np.float32).reshape(*cube.values.shape, 2)
    if kind == "float32":
        return pairs, float(scale)
    peak = float(np.abs(pairs).max(initial=0.0)) or 1.0
    return (pairs * (_PEAK / peak)).astype(np.float16), scale * peak / _PEAK


def consolidate(store: Path) -> None:
    """Collects the metadata of all arrays in the group's own, so that xarray opens it without a word or a search."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # version 3 of Zarr has no chapter on it yet; readers without it ignore it
        zarr_module().consolidate_metadata(store)


def put_texts(group: Any, name: str, texts: Sequence[str]) -> None:
    """Writes one text for each sequence."""
    array = group.create_array(name, shape=(len(texts),), dtype="string", dimension_names=("sequence",))
    array[...] = np.asarray(texts, dtype=object)


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
        fx=numbers["fx"],
        fy=numbers["fy"],
        cx=numbers["cx"],
        cy=numbers["cy"],
        width=round(numbers.get("width", width)),
        height=round(numbers.get("height", height)),
    )
    return RgbdPhoto(rgb=rgb, depth_m=depth_m.astype(np.float64), intrinsics=camera, classes=classes)
