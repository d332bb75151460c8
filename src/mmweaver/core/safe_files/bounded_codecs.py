"""Codecs of Zarr that refuse a chunk which would unpack to more, or to less, than its place in the array holds.

Zarr's own take as much memory as the chunk itself asks for: 3 kB of Zstandard stand for 100 MB of zeros. Imported only
where arrays are read, because zarr is slow to import. Reference: RFC 8878, section 3.1.1.1 (frame header); c-blosc,
README_CHUNK_FORMAT.rst.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np
import zarr
from zarr import codecs
from zarr.registry import register_codec

MAX_TEXT_BYTES = 64 * 2**20


class BoundedZstd(codecs.ZstdCodec):
    """Zstandard whose frame has the size of its chunk."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        _check_size(_zstd_size(chunk_bytes.to_bytes()[:18]), chunk_spec)
        return super()._decode_sync(chunk_bytes, chunk_spec)


class BoundedBlosc(codecs.BloscCodec):
    """Blosc whose buffer has the size of its chunk."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        _check_size(int.from_bytes(chunk_bytes.to_bytes()[4:8], "little"), chunk_spec)
        return super()._decode_sync(chunk_bytes, chunk_spec)


class VLenUTF8Codec(codecs.VLenUTF8Codec):
    """Texts whose count is that of their chunk. Zarr insists on the name."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        if int.from_bytes(chunk_bytes.to_bytes()[:4], "little") != math.prod(chunk_spec.shape):
            raise ValueError("a chunk holds another number of texts")
        return super()._decode_sync(chunk_bytes, chunk_spec)


BOUNDED = {"zstd": BoundedZstd, "blosc": BoundedBlosc, "vlen-utf8": VLenUTF8Codec}
for _name, _codec in BOUNDED.items():
    register_codec(_name, _codec)


def open_bounded(place: Path) -> Any:
    """A Zarr array, read-only, whose chunks are unpacked by these codecs."""
    names = {f"codecs.{name}": f"{codec.__module__}.{codec.__qualname__}" for name, codec in BOUNDED.items()}
    with zarr.config.set(names):
        return zarr.open_array(place, mode="r", zarr_format=3)


def _check_size(size: int | None, chunk_spec: Any) -> None:
    dtype = chunk_spec.dtype.to_native_dtype()
    is_text = dtype.kind not in "biufc"
    expected = math.prod(chunk_spec.shape) * np.dtype(dtype).itemsize
    if size is None or (size > MAX_TEXT_BYTES if is_text else size != expected):
        raise ValueError(f"a chunk unpacks to {size} bytes, not {expected}")


def _zstd_size(head: bytes) -> int | None:
    """Bytes that a Zstandard frame unpacks to, by its header; None where it does not say."""
    if len(head) < 6 or head[:4] != b"\x28\xb5\x2f\xfd":
        return None
    single, flag = head[4] >> 5 & 1, head[4] >> 6
    width = (single, 2, 4, 8)[flag]
    at = 5 + (not single) + (0, 1, 2, 4)[head[4] & 3]
    return int.from_bytes(head[at : at + width], "little") + 256 * (flag == 1) if width else None
