"""Arrays: what a header says is held against the file before memory is taken; pickles are never loaded."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_arrays import is_sound_zip, read_npy, read_npz, read_words
from tests.fuzz.mutators import lying_npy, npy_bytes, npz_bytes

ARRAYS = [
    np.arange(12.0).reshape(3, 4), np.asfortranarray(np.arange(6).reshape(2, 3)), np.zeros((0, 3)), np.array(3.5),
    np.array(["a", "bcd"]), np.array([True, False]), np.arange(3, dtype=">i2"), np.ones(2, np.complex64),
]  # fmt: skip


@pytest.mark.parametrize("values", ARRAYS, ids=lambda values: f"{values.dtype}{values.shape}")
def test_what_numpy_writes_is_read(tmp_path: Path, values: np.ndarray):
    np.save(tmp_path / "a.npy", values)
    for mapped in (False, True):
        found = read_npy(tmp_path / "a.npy", mapped=mapped)
        assert found.dtype == values.dtype
        assert np.array_equal(found, values)
    np.savez_compressed(tmp_path / "a.npz", a=values, b=values)
    assert np.array_equal(read_npz(tmp_path / "a.npz")["a"], values)
    assert list(read_npz(tmp_path / "a.npz", only=("b",))) == ["b"]


def test_arrays_of_an_archive_are_left_on_the_disk(tmp_path: Path):
    np.savez(tmp_path / "a.npz", **{f"array_{index}": values for index, values in enumerate(ARRAYS)})
    found = read_npz(tmp_path / "a.npz", mapped=[f"array_{index}" for index in range(len(ARRAYS))])
    for index, values in enumerate(ARRAYS):
        assert np.array_equal(found[f"array_{index}"], values)
    assert isinstance(found["array_0"], np.memmap)
    data = bytearray((tmp_path / "a.npz").read_bytes())
    data[data.index(np.float64(7.0).tobytes())] ^= 1
    (tmp_path / "b.npz").write_bytes(data)
    with pytest.raises(InputError, match="CRC"):
        read_npz(tmp_path / "b.npz", mapped=["array_0"])


def header(shape: str = "(2,)", descr: str = "'<f8'", order: str = "False") -> str:
    return f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (lying_npy(header("(10**9,)")), "no plain .npy"),
        (lying_npy(header("(1000000000000,)"), bytes(16)), "it holds 16"),
        (lying_npy(header("(-1,)"), bytes(16)), "impossible shape"),
        (lying_npy(header("(2.0,)"), bytes(16)), "shape"),
        (lying_npy(header("(True, 2)"), bytes(16)), "impossible shape"),
        (lying_npy(header(order="1"), bytes(16)), "fortran_order"),
        (lying_npy(header(descr="'|O'"), bytes(16)), "pickled objects"),
        (lying_npy(header(descr="[('a','<f8')]"), bytes(16)), "of type"),
        (lying_npy(header(descr="'<M8[s]'"), bytes(16)), "values of type"),
        (lying_npy(header() + " " * 20_000, bytes(16)), "header is too large"),
        (lying_npy("{'descr': '<f8'", bytes(16)), "no plain .npy"),
        (lying_npy(header(), bytes(16), version=9), "no plain .npy"),
        (npz_bytes({"a": npy_bytes(np.zeros(2))}), "is an archive"),
        (npy_bytes(np.array(["ab"])).replace(b"a\0\0\0", b"a\0\0\x7f"), "text that is none"),
        (b"", "magic"), (b"\x93NUMPY\x01\x00\xff", "header"),
    ],
)  # fmt: skip
def test_headers_that_lie_are_refused(tmp_path: Path, data: bytes, message: str):
    (tmp_path / "a.npy").write_bytes(data)
    with pytest.raises(InputError, match=message):
        read_npy(tmp_path / "a.npy")


def test_archives_that_grow_out_of_proportion_are_refused(tmp_path: Path):
    file = tmp_path / "a.npz"
    file.write_bytes(npz_bytes({"a": npy_bytes(np.zeros(9_000_000))}, zipfile.ZIP_DEFLATED))
    with pytest.raises(InputError, match="100 times"):
        read_npz(file)
    assert len(read_npz(file, only=("none",))) == 0
    file.write_bytes(npz_bytes({"a": lying_npy(header("(9,)"), bytes(16))}))
    with pytest.raises(InputError, match="16 of 72"):
        read_npz(file)
    file.write_bytes(npz_bytes({"a": npy_bytes(np.zeros(2)) + b"more"}))
    with pytest.raises(InputError, match=r"a\.npy.*longer"):
        read_npz(file)


def test_arrays_of_objects_are_left_out_where_that_is_asked_for(tmp_path: Path):
    stream = io.BytesIO()
    np.savez(stream, a=np.zeros(2), b=np.array([{"x": 1}], dtype=object))
    (tmp_path / "a.npz").write_bytes(stream.getvalue())
    assert list(read_npz(tmp_path / "a.npz", skip_unreadable=True)) == ["a"]
    with pytest.raises(InputError, match="pickled objects"):
        read_npz(tmp_path / "a.npz")


def test_raw_numbers_and_sound_archives(tmp_path: Path):
    np.arange(5, dtype="<i2").tofile(tmp_path / "a.bin")
    assert read_words(tmp_path / "a.bin", "<i2", count=4).tolist() == [0, 1, 2, 3]
    with pytest.raises(InputError, match="12 bytes"):
        read_words(tmp_path / "a.bin", "<i2", count=6)
    data = bytearray(npz_bytes({"a": npy_bytes(np.zeros(9))}))
    (tmp_path / "a.zip").write_bytes(data)
    assert is_sound_zip(tmp_path / "a.zip")
    data[150] ^= 1
    (tmp_path / "a.zip").write_bytes(data)
    assert not is_sound_zip(tmp_path / "a.zip")
    assert not is_sound_zip(tmp_path / "a.bin")
