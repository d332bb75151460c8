"""A chunk that would unpack to more than its place in the array is refused before memory is taken."""

from pathlib import Path
from typing import Any

import google_crc32c
import numpy as np
import pytest
import zarr
from numcodecs import blosc, zstd
from zarr.codecs import BloscCodec, VLenUTF8Codec

from mmweaver.core.safe_files.bounded_codecs import BOUNDED, open_bounded
from mmweaver.datasets.zarr_arrays import put_array

BOMBS = {
    "zstd": zstd.compress(bytes(10_000_000), 1),
    "zstd without a size": b"\x28\xb5\x2f\xfd\x00\x58" + b"\x53\x00\x00" + b"\x00" * 4,
    "less": zstd.compress(bytes(16), 1),
    "empty": b"",
    "no frame": b"\xff" * 40,
}  # fmt: skip


def write(folder: Path, values: np.ndarray, packing: Any = None) -> Path:
    put_array(zarr.open_group(folder, mode="w"), "a", values, ("row",), packing=packing)
    return folder / "a" / "c" / "0"


def summed(data: bytes) -> bytes:
    return data + google_crc32c.value(data).to_bytes(4, "little")


@pytest.mark.parametrize("what", BOMBS)
def test_another_size_than_that_of_the_chunk_is_refused(tmp_path: Path, what: str):
    write(tmp_path, np.arange(4.0)).write_bytes(summed(BOMBS[what]))
    with pytest.raises(ValueError, match="not 32"):
        open_bounded(tmp_path / "a")[...]


def test_blosc_is_bounded_too(tmp_path: Path):
    chunk = write(tmp_path, np.arange(4.0), BloscCodec(cname="zstd"))
    assert np.array_equal(open_bounded(tmp_path / "a")[...], np.arange(4.0))
    chunk.write_bytes(summed(blosc.compress(bytes(10_000_000), b"zstd", 5, 1)))
    with pytest.raises(ValueError, match=r"10000000.*32"):
        open_bounded(tmp_path / "a")[...]


def test_texts_are_as_many_as_their_chunk_holds(tmp_path: Path):
    group = zarr.open_group(tmp_path, mode="w")
    group.create_array("a", shape=(2,), dtype="string", compressors=None)[...] = np.array(["one", "two"], dtype=object)
    assert open_bounded(tmp_path / "a")[...].tolist() == ["one", "two"]
    chunk = tmp_path / "a" / "c" / "0"
    chunk.write_bytes(b"\xff\xff\xff\x7f" + chunk.read_bytes()[4:])
    with pytest.raises(ValueError, match="number of texts"):
        open_bounded(tmp_path / "a")[...]


def test_zarr_itself_keeps_its_codecs(tmp_path: Path):
    write(tmp_path, np.arange(4.0))
    open_bounded(tmp_path / "a")
    used = {type(codec) for codec in zarr.open_array(tmp_path / "a", mode="r").metadata.codecs}
    assert not used & set(BOUNDED.values())
    assert VLenUTF8Codec not in BOUNDED.values()
