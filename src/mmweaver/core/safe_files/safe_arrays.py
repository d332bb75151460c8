"""Arrays from .npy, .npz and raw files; sizes in headers are checked against the file before memory is allocated.

Pickled objects are never loaded. Reference: numpy.lib.format; PKWARE APPNOTE.TXT for zip.
"""

import math
import struct
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.regular_files import MEGABYTE, check_regular, foreign_errors, open_regular

MAX_HEADER_BYTES = 10_000
UNICODE_END = 0x110000
KINDS = "biufcUS"  # dtype kinds that are read: no objects, dates or records
# A compressed archive may expand to this size, or to this multiple of its own size, whichever is larger.
INFLATED_BYTES, INFLATED_RATIO = 64 * MEGABYTE, 100
NO_NPY = "no plain .npy array of numbers ({reason}); save it with numpy.save"
NO_NPZ = "no plain .npz archive, or it is damaged ({reason}); write it again with numpy.savez"
ZIP_LOCAL, ZIP_LENGTHS = 30, 26  # bytes of a local header before its name, and before the lengths of name and extra
_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


def read_npy(path: Path | str, *, mapped: bool = False) -> np.ndarray:
    """Reads a .npy file.

    Args:
        path: The file.
        mapped: Whether the array is memory-mapped, read-only. Default: False.

    Returns:
        Array of numbers, booleans or texts.

    Raises:
        InputError: If the file is anything else, including pickled objects and records.
    """
    with open_regular(path) as file, foreign_errors(path, NO_NPY):
        if zipfile.is_zipfile(file):
            raise InputError(f"{path} is an archive, not a .npy array; save the array alone with numpy.save")
        file.seek(0)
        dtype, shape, order = _header(file)
        start = file.tell()
        needed, held = math.prod(shape) * dtype.itemsize, check_regular(path) - start
        if needed > held:
            raise ValueError(f"its header says {shape} {dtype}, {needed} bytes, but it holds {max(held, 0)}")
        if mapped and needed:
            return np.memmap(file, dtype=dtype, mode="r", offset=start, shape=shape, order=order)
        return _filled(file, dtype, shape, order)


class NpzArrays(Mapping[str, np.ndarray]):
    """Arrays of an .npz archive by name, with checks (`array_checks`)."""

    def __init__(self, path: Path | str, arrays: dict[str, np.ndarray]):
        self.path, self._arrays, self._checks = path, arrays, ArrayChecks(path)

    def __getitem__(self, name: str) -> np.ndarray:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def take(self, name: str) -> np.ndarray:
        """Returns an array unchecked.

        Args:
            name: Name of the array.

        Raises:
            InputError: If there is none of that name.
        """
        if name not in self._arrays:
            raise InputError(f"{self.path} holds no {name!r}; it has {', '.join(self._arrays) or 'nothing'}")
        return self._arrays[name]

    def numbers(self, name: str, shape: tuple[int | str, ...] | None = None, **limits: Any) -> np.ndarray:
        """Returns a checked array of numbers.

        Args:
            name: Name of the array.
            shape: Expected shape. Default: any.
            **limits: Further limits of `ArrayChecks.numbers`.

        Raises:
            InputError: If the array is missing or fails the checks.
        """
        return self._checks.numbers(name, self.take(name), shape, **limits)

    def texts(self, name: str) -> tuple[str, ...]:
        """Returns a list of texts.

        Args:
            name: Name of the array.

        Raises:
            InputError: If the array is missing or contains anything else.
        """
        values = self.take(name)
        if values.dtype.kind != "U" or values.ndim != 1:
            raise InputError(f"{self.path}: {name} is {values.dtype} of shape {values.shape}; texts are needed")
        with foreign_errors(self.path, "damaged ({reason}); write it again"):
            return tuple(values.tolist())


def read_npz(
    path: Path | str, only: Iterable[str] | None = None, *, skip_unreadable: bool = False, mapped: Iterable[str] = ()
) -> NpzArrays:
    """Reads an .npz archive.

    Args:
        path: The file.
        only: Names of the arrays to read. Default: all.
        skip_unreadable: Whether arrays of unsupported dtypes, such as Python objects, are skipped instead of refusing
            the archive. Default: False.
        mapped: Names of arrays to memory-map read-only if they are uncompressed, after a check of their CRC-32.

    Returns:
        Arrays by name.

    Raises:
        InputError: If the file is not such an archive, is damaged, or would expand out of proportion.
    """
    held = check_regular(path)
    found: dict[str, np.ndarray] = {}
    with open_regular(path) as file, foreign_errors(path, NO_NPZ):
        if not zipfile.is_zipfile(file):
            raise ValueError("it is no zip file")
        with zipfile.ZipFile(file) as archive:
            left = max(INFLATED_BYTES, INFLATED_RATIO * held)
            for entry in archive.infolist():
                name = entry.filename.removesuffix(".npy")
                if only is not None and name not in only:
                    continue
                left -= entry.file_size
                if left < 0 or (entry.compress_type == zipfile.ZIP_STORED and entry.file_size > held):
                    raise ValueError(f"{held} bytes would grow to more than {INFLATED_RATIO} times as many")
                if name in mapped and entry.compress_type == zipfile.ZIP_STORED:
                    array = _mapped_entry(archive, entry, file)
                else:
                    array = _entry(archive, entry, skip_unreadable)
                if array is not None:
                    found[name] = array
    return NpzArrays(path, found)


def is_sound_zip(path: Path | str) -> bool:
    """Whether a file is a zip archive, such as a torch checkpoint, all of whose entries match their CRC-32."""
    try:
        with open_regular(path) as file, foreign_errors(path, NO_NPZ), zipfile.ZipFile(file) as archive:
            return archive.testzip() is None
    except InputError:
        return False


def read_words(path: Path | str, dtype: str, *, count: int, first: int = 0) -> np.ndarray:
    """Reads numbers from a headerless file.

    Args:
        path: The file.
        dtype: Type of a number, such as "<i2".
        count: Number of values.
        first: Index of the first value. Default: 0.

    Returns:
        The numbers, (count,).

    Raises:
        InputError: If the file is too short.
    """
    size = np.dtype(dtype).itemsize
    needed = (first + count) * size
    if check_regular(path) < needed:
        raise InputError(f"{path} has fewer than {needed} bytes; is it truncated?")
    with open_regular(path) as file, foreign_errors(path, "unreadable ({reason})"):
        file.seek(first * size)
        return _filled(file, np.dtype(dtype), (count,), "C")


def _mapped_entry(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, file: Any) -> np.ndarray:
    with archive.open(entry) as stream:
        dtype, shape, order = _header(stream)
        header_bytes = stream.tell()
        while stream.read(MEGABYTE):  # checks the CRC-32 at the end
            pass
    needed = math.prod(shape) * dtype.itemsize
    if header_bytes + needed != entry.file_size:
        raise ValueError(f"{entry.filename} says {shape} {dtype}, but has {entry.file_size} bytes")
    if not needed:
        return np.empty(shape, dtype)
    file.seek(entry.header_offset + ZIP_LENGTHS)
    front = ZIP_LOCAL + sum(struct.unpack("<HH", file.read(4)))  # may differ from the central directory
    start = entry.header_offset + front + header_bytes
    return np.memmap(file, dtype=dtype, mode="r", offset=start, shape=shape, order=order)


def _entry(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, skip_unreadable: bool) -> np.ndarray | None:
    with archive.open(entry) as stream:
        try:
            dtype, shape, order = _header(stream)
        except _UnreadTypeError:
            if skip_unreadable:
                return None
            raise
        if math.prod(shape) * dtype.itemsize > entry.file_size:
            raise ValueError(f"{entry.filename} says {shape} {dtype}, but has {entry.file_size} bytes")
        array = _filled(stream, dtype, shape, order)
        if stream.read(1):
            raise ValueError(f"{entry.filename} is longer than its header says")
        return array


class _UnreadTypeError(ValueError):
    """An array of an unsupported dtype."""


def _header(file: Any) -> tuple[np.dtype, tuple[int, ...], Any]:
    """Dtype, shape and order ("C" or "F") of a .npy stream. Raises ValueError if it is malformed or unsupported."""
    version = np.lib.format.read_magic(file)
    if version not in _HEADERS:
        raise _UnreadTypeError("it holds records, not plain numbers")  # the only ones written as version 3
    shape, is_fortran, dtype = _HEADERS[version](file, MAX_HEADER_BYTES)
    if len(shape) > 16 or not all(type(length) is int and 0 <= length < 2**48 for length in shape):
        raise ValueError("its header has an impossible shape")
    if dtype.kind == "O":
        raise _UnreadTypeError("it holds pickled objects")
    if dtype.kind not in KINDS or dtype.itemsize == 0:
        raise _UnreadTypeError(f"it holds values of type {dtype}")
    return dtype, shape, "F" if is_fortran else "C"


def _filled(file: Any, dtype: np.dtype, shape: tuple[int, ...], order: Any) -> np.ndarray:
    """Reads an array from a stream in bounded pieces."""
    array = np.empty(math.prod(shape), dtype)
    raw: Any = array.view(np.uint8) if array.size else b""
    view = memoryview(raw)
    at = 0
    while at < len(view):
        piece = file.read(min(len(view) - at, MEGABYTE))
        if not piece:
            raise ValueError(f"it ends after {at} of {len(view)} bytes")
        view[at : at + len(piece)] = piece
        at += len(piece)
    letters = np.dtype(np.uint32).newbyteorder(dtype.byteorder)
    if dtype.kind == "U" and array.size and array.view(letters).max() >= UNICODE_END:  # Python raises SystemError
        raise ValueError("it holds text that is none")
    return array.reshape(shape, order=order)
