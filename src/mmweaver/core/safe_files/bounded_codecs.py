"""Zarr codecs that refuse chunks that would not decompress to exactly their size in the array.

Zarr's own codecs allocate as much memory as the chunk claims: 3 kB of Zstandard can expand to 100 MB of zeros. Imported
only when arrays are read, since zarr is slow to import. Reference: RFC 8878, section 3.1.1.1 (frame header); c-blosc,
README_CHUNK_FORMAT.rst.
"""

import math
from typing import Any

import numpy as np
import zarr
from zarr import codecs
from zarr.core.buffer.cpu import Buffer
from zarr.registry import register_codec
from zarr.storage import MemoryStore

from mmweaver.core.safe_files.packed_folder import PackedPath
from mmweaver.core.safe_files.regular_files import Place

MAX_TEXT_BYTES = 64 * 2**20


class BoundedZstd(codecs.ZstdCodec):
    """Zstandard with a frame content size equal to the chunk size."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        _check_size(_zstd_size(chunk_bytes.to_bytes()[:18]), chunk_spec)
        return super()._decode_sync(chunk_bytes, chunk_spec)


class BoundedBlosc(codecs.BloscCodec):
    """Blosc with a buffer size equal to the chunk size."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        _check_size(int.from_bytes(chunk_bytes.to_bytes()[4:8], "little"), chunk_spec)
        return super()._decode_sync(chunk_bytes, chunk_spec)


class VLenUTF8Codec(codecs.VLenUTF8Codec):
    """Texts whose count equals that of the chunk. Zarr requires this class name."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        if int.from_bytes(chunk_bytes.to_bytes()[:4], "little") != math.prod(chunk_spec.shape):
            raise ValueError("a chunk holds another number of texts")
        return super()._decode_sync(chunk_bytes, chunk_spec)


BOUNDED = {"zstd": BoundedZstd, "blosc": BoundedBlosc, "vlen-utf8": VLenUTF8Codec}
for _name, _codec in BOUNDED.items():
    register_codec(_name, _codec)


def open_bounded(place: Place) -> Any:
    """Opens a Zarr array read-only with bounded codecs.

    Args:
        place: Folder of the array.

    Returns:
        The zarr.Array.
    """
    names = {f"codecs.{name}": f"{codec.__module__}.{codec.__qualname__}" for name, codec in BOUNDED.items()}
    store: Any = place if not isinstance(place, PackedPath) else _packed_store(place)
    with zarr.config.set(names):
        return zarr.open_array(store, mode="r", zarr_format=3)


def _packed_store(place: PackedPath) -> MemoryStore:
    """Store over the mapped bytes of a packed folder: nothing is read before its chunk is."""
    files = {one.relative_to(place).as_posix(): one.data() for one in place.files()}
    arrays: dict[str, Any] = {name: np.frombuffer(data, np.uint8) for name, data in files.items()}
    chunks: Any = {name: Buffer.from_array_like(array) for name, array in arrays.items()}
    return MemoryStore(chunks, read_only=True)


def _check_size(size: int | None, chunk_spec: Any) -> None:
    dtype = chunk_spec.dtype.to_native_dtype()
    is_text = dtype.kind not in "biufc"
    expected = math.prod(chunk_spec.shape) * np.dtype(dtype).itemsize
    if size is None or (size > MAX_TEXT_BYTES if is_text else size != expected):
        raise ValueError(f"a chunk unpacks to {size} bytes, not {expected}")


def _zstd_size(head: bytes) -> int | None:
    """Content size of a Zstandard frame according to its header; None if it is not stated."""
    if len(head) < 6 or head[:4] != b"\x28\xb5\x2f\xfd":
        return None
    single, flag = head[4] >> 5 & 1, head[4] >> 6
    width = (single, 2, 4, 8)[flag]
    at = 5 + (not single) + (0, 1, 2, 4)[head[4] & 3]
    return int.from_bytes(head[at : at + width], "little") + 256 * (flag == 1) if width else None
