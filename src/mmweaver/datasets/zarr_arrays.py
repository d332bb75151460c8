"""Arrays in the Zarr groups of a data set: every chunk is written, with a CRC-32C."""

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
SHARD_BYTES = 32 << 20  # maximum size of a signal file unless a sequence is larger: about 30 files per 500 sequences

_PEAK = 16384.0  # largest float16 value of a sequence


def zarr_module() -> Any:
    """The zarr module, imported lazily. Raises InputError if it is not installed."""
    need("dataset", "a data set", "zarr")
    import zarr

    return zarr


def put_array(group: Any, name: str, values: np.ndarray, dimensions: tuple[str, ...], *, packing: Any = None) -> None:
    """Writes an array as one chunk.

    Chunks of zeros are written too, so that a missing file is detected as damage; Zarr itself would read zeros.

    Args:
        group: Zarr group.
        name: Name of the array.
        values: The array.
        dimensions: Names of its dimensions.
        packing: Codec of its bytes. Default: Zstandard.
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


class SequenceWriter:
    """Writes an array one sequence after another; each is a chunk, in shards of at most SHARD_BYTES.

    Holds one shard in memory. The number of sequences may turn out smaller than announced.

    Args:
        group: Zarr group.
        name: Name of the array.
        kind: Dtype.
        shape: (sequence, ...), with the largest number of sequences.
        dimensions: Names of the dimensions.
        packing: Codecs of the chunks. Default: none.
    """

    def __init__(
        self,
        group: Any,
        name: str,
        kind: str,
        shape: tuple[int, ...],
        dimensions: tuple[str, ...],
        *,
        packing: Sequence[Any] = (),
    ):
        self.group, self.name, self.kind, self.shape = group, name, kind, shape
        self.dimensions, self.packing = dimensions, packing
        self.count = 0
        self._in_shard = min(max(1, SHARD_BYTES // (int(np.prod(shape[1:])) * np.dtype(kind).itemsize)), shape[0])
        self._kept: list[np.ndarray] = []
        self._array: Any = None

    def add(self, values: np.ndarray) -> None:
        """Adds one sequence."""
        if len(self._kept) == self._in_shard:
            self._flush(self.shape[0])
        self._kept.append(values)

    def close(self) -> None:
        """Writes the last shard, and the number of sequences that were added."""
        total = self.count + len(self._kept)
        if self._kept:
            self._flush(total)
        if self._array is not None and total != self._array.shape[0]:
            self._array.resize((total, *self.shape[1:]))

    def _flush(self, total: int) -> None:
        if self._array is None:
            self._array = self._create(total)
        first, self.count = self.count, self.count + len(self._kept)
        self._array[first : self.count] = np.stack(self._kept)
        self._kept = []

    def _create(self, total: int) -> Any:
        from zarr.codecs import Crc32cCodec

        array = self.group.create_array(
            self.name,
            shape=(total, *self.shape[1:]),
            chunks=(1, *self.shape[1:]),
            shards=(min(self._in_shard, total), *self.shape[1:]),
            dtype=self.kind,
            overwrite=True,
            dimension_names=self.dimensions,
            compressors=[*self.packing, Crc32cCodec()],
            config={"write_empty_chunks": True},
        )
        _put_unit(array, self.name)
        return array


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
    """Writes an array from the values of each sequence; see `SequenceWriter`."""
    writer = SequenceWriter(group, name, kind, shape, dimensions, packing=packing)
    for values in sequences:
        writer.add(values)
    writer.close()


def write_iq(group: Any, kind: str, shape: tuple[int, ...], sequences: Iterable[np.ndarray]) -> None:
    """Writes signals without compression, so that the size of a sequence carries no information on its content.

    Args:
        group: Zarr group.
        kind: "float16" or "float32".
        shape: (sequence, frame, range, doppler, antenna, part).
        sequences: Values of each sequence.
    """
    put_sequences(group, "iq", kind, shape, IQ_DIMENSIONS, sequences)
    name_parts(group)


def name_parts(group: Any) -> None:
    """Names the real parts of stored signals."""
    group["iq"].attrs["part_names"] = ["in-phase", "quadrature"]


def packed_iq(cube: RadarCube, kind: str = "float16") -> tuple[np.ndarray, float]:
    """Packs a cube for storage.

    The largest float16 is 16384: the error is below 5e-4 of a value down to 1e-9 of the peak power.

    Args:
        cube: The cube.
        kind: "float16" or "float32". Default: "float16".

    Returns:
        Values (frame, range, doppler, antenna, part), and the factor to sqrt(mW).
    """
    scale = cube.scale if np.isfinite(cube.scale) else 1.0
    pairs = np.ascontiguousarray(cube.values).view(np.float32).reshape(*cube.values.shape, 2)
    if kind == "float32":
        return pairs, float(scale)
    peak = float(np.abs(pairs).max(initial=0.0)) or 1.0
    return (pairs * (_PEAK / peak)).astype(np.float16), scale * peak / _PEAK


def consolidate(store: Path) -> None:
    """Collects the metadata of all arrays in that of the group, so that xarray opens it without search or warning."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # not yet part of the Zarr 3 specification; other readers ignore it
        zarr_module().consolidate_metadata(store)


def put_texts(group: Any, name: str, texts: Sequence[str]) -> None:
    """Writes one text per sequence."""
    array = group.create_array(name, shape=(len(texts),), dtype="string", dimension_names=("sequence",))
    array[...] = np.asarray(texts, dtype=object)


FARTHEST_M = 1000.0  # largest depth; anything beyond indicates damage


def put_photo(group: Any, photo: RgbdPhoto, depth_type: str = "float32") -> None:
    """Writes a photo with its camera.

    Args:
        group: Zarr group.
        photo: The photo.
        depth_type: Dtype of the stored depth in metres. Default: float32.
    """
    put_array(group, "photo_rgb", photo.rgb, ("row", "column", "colour"))
    put_array(group, "photo_depth_m", photo.depth_m.astype(depth_type), ("row", "column"))
    if photo.classes is not None:
        put_array(group, "photo_class", photo.classes.index, ("row", "column"))
    group.attrs.update(
        {"camera": asdict(photo.intrinsics), "class_names": list(photo.classes.names) if photo.classes else []}
    )


def stored_photo(group: ZarrFolder) -> RgbdPhoto:
    """Reads the photo of a group.

    Args:
        group: The group.

    Returns:
        The photo.

    Raises:
        InputError: If it is damaged.
    """
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
