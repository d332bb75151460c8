"""Zarr (v3) groups and arrays on the disk: metadata is checked before zarr takes memory for what it promises."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.regular_files import MEGABYTE, check_regular, foreign_errors
from mmweaver.core.safe_files.safe_text import read_json

METADATA = "zarr.json"
CODECS = frozenset({"bytes", "zstd", "gzip", "blosc", "crc32c", "sharding_indexed", "transpose"})
INFLATED_BYTES, INFLATED_RATIO = 64 * MEGABYTE, 1000  # zstd makes much less of zeros
DAMAGED = "damaged ({reason}); make it again"


class ZarrFolder:
    """A group: its attributes, its arrays and the groups inside it. Every array is checked as it is read."""

    def __init__(self, path: Path):
        metadata = _metadata(path)
        if metadata.get("node_type") != "group" or not isinstance(metadata.get("attributes", {}), dict):
            raise InputError(f"{path} is no Zarr group (version 3); is it the right folder?")
        self.path = path
        self.attrs: dict[str, Any] = metadata.get("attributes", {})
        self._checks = ArrayChecks(path)

    def __contains__(self, name: str) -> bool:
        return (self.path / name / METADATA).is_file()

    def group(self, name: str) -> "ZarrFolder":
        """A group inside this one."""
        return ZarrFolder(self.path / name)

    def array_names(self) -> list[str]:
        """The names of the arrays directly inside."""
        names = sorted(path.parent.name for path in self.path.glob(f"*/{METADATA}"))
        return [name for name in names if _metadata(self.path / name).get("node_type") == "array"]

    def attr(self, name: str, kind: type) -> Any:
        """An attribute of a JSON type. Raises InputError where it is missing or of another type."""
        value = self.attrs.get(name)
        if type(value) is not kind:
            raise InputError(f"{self.path} is damaged: its {name} is {value!r}; make it again")
        return value

    def shape(self, name: str) -> tuple[int, ...]:
        """The shape of an array, which is not read."""
        return _checked_shape(self.path / name)[0]

    def numbers(
        self, name: str, shape: tuple[int | str, ...] | None = None, *, rows: Any = ..., **limits: Any
    ) -> np.ndarray:
        """An array, or `rows` of it, checked by `ArrayChecks.numbers`. Raises InputError where it is damaged."""
        place = self.path / name
        _checked_shape(place)
        import zarr

        with foreign_errors(place, DAMAGED):
            values = np.asarray(zarr.open_array(place, mode="r", zarr_format=3)[rows])
        return self._checks.numbers(name, values, shape, **limits)


def open_zarr(folder: Path | str) -> ZarrFolder:
    """A Zarr group. Raises InputError where the folder is none, is damaged, or Zarr is not installed."""
    try:
        import zarr  # noqa: F401
    except ImportError as error:
        raise InputError("data sets need Zarr; install it with: pip install 'mmweaver[dataset]'") from error
    return ZarrFolder(Path(folder))


def _metadata(folder: Path) -> dict[str, Any]:
    content = read_json(folder / METADATA)
    if not isinstance(content, dict) or content.get("zarr_format") != 3:
        raise InputError(f"{folder / METADATA} is no metadata of Zarr (version 3); make the folder again")
    return content


def _checked_shape(place: Path) -> tuple[tuple[int, ...], np.dtype]:
    """Shape and type of an array, once its chunks are regular files and it does not promise far more than they hold."""
    metadata = _metadata(place)
    try:
        shape = tuple(metadata["shape"])
        chunk = tuple(metadata["chunk_grid"]["configuration"]["chunk_shape"])
        dtype = np.dtype(metadata["data_type"])
        codecs = {codec["name"] for codec in _all_codecs(metadata["codecs"])}
        is_plain = all(type(length) is int and 0 <= length < 2**48 for length in (*shape, *chunk))
    except (KeyError, TypeError, ValueError, AttributeError):
        raise InputError(f"{place} is no array of Zarr, or it is damaged; make it again") from None
    largest = tuple(max(1, length) for length in shape)
    if metadata.get("node_type") != "array" or not is_plain or len(chunk) != len(shape) or dtype.kind not in "biufc":
        raise InputError(f"{place} is no array of numbers of Zarr, or it is damaged; make it again")
    if any(length > most or length == 0 for length, most in zip(chunk, largest, strict=True)) or codecs - CODECS:
        raise InputError(f"{place} has impossible chunks or codecs; make it again")
    held = sum(check_regular(file) for file in place.rglob("*") if not file.is_dir())
    if math.prod(shape) * dtype.itemsize > max(INFLATED_BYTES, INFLATED_RATIO * held):
        raise InputError(f"{place} says {shape} {dtype}, but its files hold {held} bytes; make it again")
    return shape, dtype


def _all_codecs(codecs: list[Any]) -> list[Any]:
    found = list(codecs)
    for codec in codecs:
        inner = codec.get("configuration", {})
        found += _all_codecs(inner.get("codecs", [])) + _all_codecs(inner.get("index_codecs", []))
    return found
