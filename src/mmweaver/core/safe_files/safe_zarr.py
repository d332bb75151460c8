"""Zarr (v3) groups and arrays on disk, checked against their chunk files before memory is allocated.

Chunks that would expand beyond their size in the array are refused (`bounded_codecs`). Supported are arrays as mmWeaver
writes them: numbers or texts, Zstandard or Blosc, CRC-32C, shards. Reference: Zarr v3 core specification.
"""

import itertools
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.packed_folder import PackedPath
from mmweaver.core.safe_files.regular_files import MEGABYTE, Place, check_regular, foreign_errors
from mmweaver.core.safe_files.safe_text import read_json

METADATA = "zarr.json"
DAMAGED = "damaged ({reason}); make it again"
# The arrays of a group may expand to this size, or to this multiple of their files, whichever is larger.
INFLATED_BYTES, INFLATED_RATIO = 64 * MEGABYTE, 100
MAX_CHUNKS = 1_000_000
ABSENT_CHUNKS = 1000  # Zarr may omit chunks of zeros
BYTES_OF_INDEX = 16  # per chunk of a shard
MAX_AXES = 16
KEYS = {"name": "default", "configuration": {"separator": "/"}}
TEXT = np.dtype("O")
_PACKED = [[], ["zstd"], ["blosc"], ["crc32c"], ["zstd", "crc32c"], ["blosc", "crc32c"]]


@dataclass(frozen=True, kw_only=True)
class ArrayPromise:
    """Shape and dtype (`TEXT` for texts) according to the metadata, and the size of the array's files in bytes."""

    shape: tuple[int, ...]
    dtype: np.dtype
    held: int

    @property
    def promised(self) -> int:
        """Size of all elements in memory, bytes."""
        return math.prod(self.shape) * max(self.dtype.itemsize, 1)


class ZarrFolder:
    """A Zarr group; its arrays are checked when it is opened and again as they are read.

    Raises:
        InputError: If it is not a group, or an array is damaged or claims far more than its files contain.
    """

    def __init__(self, path: Place):
        metadata = _metadata(path)
        if metadata.get("node_type") != "group" or not isinstance(metadata.get("attributes", {}), dict):
            raise InputError(f"{path} is no Zarr group (version 3); is it the right folder?")
        self.path = path
        self.attrs: dict[str, Any] = metadata.get("attributes", {})
        self._checks = ArrayChecks(path)
        self._opened: dict[str, Any] = {}
        self._promises = {
            place.name: _promise(place, inner)
            for place in _inner_folders(path)
            if (inner := _metadata(place)).get("node_type") == "array"
        }
        promised = sum(one.promised for one in self._promises.values())
        held = sum(one.held for one in self._promises.values())
        if promised > max(INFLATED_BYTES, INFLATED_RATIO * held):
            raise InputError(f"{path}: its arrays say {promised} bytes, but their files hold {held}; make it again")

    def __contains__(self, name: str) -> bool:
        return name in self._promises

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_opened": {}}

    def has_group(self, name: str) -> bool:
        """Whether the group contains a subgroup of that name."""
        return name not in self and (self.path / name / METADATA).is_file()

    def group(self, name: str) -> "ZarrFolder":
        """Opens a subgroup."""
        return ZarrFolder(self.path / name)

    def attr(self, name: str, kind: type) -> Any:
        """Returns an attribute.

        Args:
            name: Name of the attribute.
            kind: Expected Python type, such as int or list.

        Raises:
            InputError: If it is missing or of another type.
        """
        value = self.attrs.get(name)
        if type(value) is not kind:
            raise InputError(f"{self.path} is damaged: its {name} is {value!r}; make it again")
        return value

    def words(self, name: str) -> tuple[str, ...]:
        """Returns an attribute that is a list of texts.

        Args:
            name: Name of the attribute.

        Raises:
            InputError: If it is anything else.
        """
        values = self.attr(name, list)
        if not all(isinstance(value, str) for value in values):
            raise InputError(f"{self.path} is damaged: its {name} is no list of texts; make it again")
        return tuple(values)

    def promise(self, name: str) -> ArrayPromise:
        """Returns shape and dtype of an array without reading it.

        Args:
            name: Name of the array.

        Raises:
            InputError: If there is none of that name.
        """
        if name not in self._promises:
            raise InputError(f"{self.path} is damaged: it has no {name}; make it again")
        return self._promises[name]

    def check_shape(self, name: str, found: tuple[int, ...], wanted: tuple[int | str, ...]) -> None:
        """Checks the shape of related data against the named axes of the arrays; see `ArrayChecks.shape`."""
        self._checks.shape(name, found, wanted)

    def rows_a_file(self, name: str) -> int:
        """Number of rows along the first axis that one chunk file contains.

        Args:
            name: Name of the array.

        Raises:
            InputError: If there is none of that name.
        """
        self.promise(name)
        array = self._array(name)
        return int((array.shards or array.chunks)[0])

    def numbers(self, name: str, shape: tuple[int | str, ...], **limits: Any) -> np.ndarray:
        """Reads an array of numbers.

        Args:
            name: Name of the array.
            shape: Expected shape, as in `ArrayChecks.numbers`.
            **limits: Further limits of `ArrayChecks.numbers`.

        Raises:
            InputError: If the array is missing, damaged or fails the checks.
        """
        found = self.promise(name)
        self._checks.shape(name, found.shape, shape)
        return self._checks.numbers(name, self._read(name, ...), shape, **limits)

    def row(self, name: str, index: int, shape: tuple[int | str, ...], **limits: Any) -> np.ndarray:
        """Reads one element along the first axis of an array.

        Args:
            name: Name of the array.
            index: Index of the element.
            shape: Expected shape of the element.
            **limits: Further limits of `ArrayChecks.numbers`.

        Raises:
            InputError: If the element is missing, damaged or fails the checks.
        """
        found = self.promise(name)
        if not 0 <= index < (found.shape or (0,))[0]:
            raise InputError(f"{self.path}: {name} has no element {index}; make it again")
        self._checks.shape(name, found.shape[1:], shape)
        return self._checks.numbers(name, self._read(name, index), shape, **limits)

    def texts(self, name: str, axis: str) -> np.ndarray:
        """Reads a list of texts.

        Args:
            name: Name of the array.
            axis: Name of its axis, which must match the length in the other arrays.

        Raises:
            InputError: If the array is missing, damaged or contains anything else.
        """
        found = self.promise(name)
        self._checks.shape(name, found.shape, (axis,))
        if found.dtype != TEXT:
            raise InputError(f"{self.path}: {name} holds {found.dtype}; texts are needed")
        return self._read(name, ...)

    def _read(self, name: str, rows: Any) -> np.ndarray:
        array = self._array(name)
        with foreign_errors(self.path / name, DAMAGED):
            return np.asarray(array[rows])

    def _array(self, name: str) -> Any:
        """The array, opened once so that what was checked is what is read."""
        if name not in self._opened:
            from mmweaver.core.safe_files.bounded_codecs import open_bounded

            with foreign_errors(self.path / name, DAMAGED):
                array = open_bounded(self.path / name)
                if array.shape != self.promise(name).shape:
                    raise ValueError("it was changed while it was read")
            self._opened[name] = array
        return self._opened[name]


def open_zarr(folder: Place | str) -> ZarrFolder:
    """Opens a Zarr group.

    Args:
        folder: The folder.

    Returns:
        The group.

    Raises:
        InputError: If the folder is not a Zarr group, is damaged, or zarr is not installed.
    """
    need("dataset", "a data set", "zarr")
    return ZarrFolder(Path(folder) if isinstance(folder, str) else folder)


def _inner_folders(path: Place) -> list[Any]:
    """Folders of the arrays and groups directly below a group."""
    if isinstance(path, PackedPath):
        return sorted(one.parent for one in path.rglob(METADATA) if one.parent.parent == path)
    return sorted(file.parent for file in path.glob(f"*/{METADATA}"))


def _metadata(folder: Place) -> dict[str, Any]:
    content = read_json(folder / METADATA)
    if not isinstance(content, dict) or content.get("zarr_format") != 3:
        raise InputError(f"{folder / METADATA} is no metadata of Zarr (version 3); make the folder again")
    return content


def _promise(place: Place, metadata: dict[str, Any]) -> ArrayPromise:
    """Checks that the chunk layout is possible and that existing chunk files are regular files."""
    try:
        shape, chunk = _lengths(metadata["shape"]), _lengths(metadata["chunk_grid"]["configuration"]["chunk_shape"])
        is_text = metadata["data_type"] == "string"
        dtype = TEXT if is_text else np.dtype(metadata["data_type"])
        inner = _inner_chunk(metadata["codecs"], chunk, is_text)
        if dtype.kind not in "biufcO" or (dtype.kind == "O") != is_text or len(shape) > MAX_AXES:
            raise ValueError("its type or shape")
        if metadata["chunk_grid"].get("name") != "regular" or metadata.get("chunk_key_encoding", KEYS) != KEYS:
            raise ValueError("its chunks are laid out in another way")
        _check_chunks(shape, chunk)
        _check_chunks(chunk, inner)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(f"{place} is no array that is read here, or it is damaged ({error}); make it again") from None
    counts = [-(-length // step) for length, step in zip(shape, chunk, strict=True)]
    held, in_shards = _held(place, counts), math.prod(counts)
    if inner != chunk:
        in_shards *= math.prod(-(-length // step) for length, step in zip(chunk, inner, strict=True))
        if in_shards > ABSENT_CHUNKS + held // BYTES_OF_INDEX:
            raise InputError(f"{place} says {in_shards} chunks, but its files hold {held} bytes; make it again")
    return ArrayPromise(shape=shape, dtype=dtype, held=held)


def _held(place: Place, counts: list[int]) -> int:
    """Total size of the chunk files in bytes. Raises InputError if many are missing."""
    if math.prod(counts) > MAX_CHUNKS:
        raise InputError(f"{place} says {math.prod(counts)} chunks, more than {MAX_CHUNKS}; make it again")
    held = absent = 0
    for key in itertools.product(*map(range, counts)):
        inner = "/".join(("c", *map(str, key)))
        file = place / inner if isinstance(place, PackedPath) else f"{place}/{inner}"
        if file.is_file() if isinstance(file, PackedPath) else os.path.lexists(file):
            held += check_regular(file)
        else:
            absent += 1
        if absent > ABSENT_CHUNKS:
            raise InputError(f"{place} says {math.prod(counts)} chunks, of which few are there; make it again")
    return held


def _lengths(values: Any) -> tuple[int, ...]:
    if not isinstance(values, list) or not all(type(length) is int and 0 <= length < 2**48 for length in values):
        raise ValueError("its shape")
    return tuple(values)


def _inner_chunk(codecs: list[dict[str, Any]], chunk: tuple[int, ...], is_text: bool) -> tuple[int, ...]:
    """Shape of the unit of compression. Raises ValueError for codecs that mmWeaver does not write."""
    first, *packing = (codec["name"] for codec in codecs)
    if first == "sharding_indexed" and not packing:
        shards = codecs[0]["configuration"]
        inner = _lengths(shards["chunk_shape"])
        if [codec["name"] for codec in shards["index_codecs"]] != ["bytes", "crc32c"]:
            raise ValueError("the index of its shards")
        if _inner_chunk(shards["codecs"], inner, is_text) != inner:
            raise ValueError("shards in shards")
        return inner
    if first != ("vlen-utf8" if is_text else "bytes") or packing not in _PACKED:
        raise ValueError("its codecs")
    return chunk


def _check_chunks(whole: tuple[int, ...], chunk: tuple[int, ...]) -> None:
    """Raises ValueError for chunks that are empty or larger than the array or shard."""
    if len(whole) != len(chunk) or any(
        not 1 <= step <= max(length, 1) for length, step in zip(whole, chunk, strict=True)
    ):
        raise ValueError("its chunks")
