"""Tensors as safetensors files: byte-for-byte reproducible, with damage detection.

The header contains the SHA-256 of the tensors and metadata of the caller.

Frozen dataclasses of tensors or arrays that are moved, stacked, joined and indexed as one.
"""

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files import safe_tensors
from mmweaver.core.safe_files.safe_text import parse_json

if TYPE_CHECKING:
    from torch import Tensor


RecordT = TypeVar("RecordT", bound="TensorRecord")


@dataclass(frozen=True, kw_only=True)
class TensorRecord:
    """Base of records whose fields are tensors, or numpy arrays, that share their leading axes.

    Operations apply to every one and to nested records; None and other values stay as they are, taken from the first
    record where several are combined.

    >>> import torch
    >>> @dataclass(frozen=True, kw_only=True)
    ... class Track(TensorRecord):
    ...     range_m: torch.Tensor  # (frame,)
    >>> both = Track.cat([Track(range_m=torch.ones(2)), Track(range_m=torch.zeros(3))])
    >>> both.range_m.shape, both[1:].range_m.shape
    (torch.Size([5]), torch.Size([4]))
    """

    def map(self: RecordT, function: Callable[["Tensor"], "Tensor"]) -> RecordT:
        """Applies a function to each tensor.

        Args:
            function: Maps a tensor to a tensor.

        Returns:
            The record of results.
        """
        values = {name: _mapped(getattr(self, name), function) for name in self.__dataclass_fields__}
        return type(self)(**values)  # `replace` takes twice as long

    def to(self: RecordT, *target: Any, **options: Any) -> RecordT:
        """Moves or converts each tensor; arguments are those of `Tensor.to`."""
        return self.map(lambda tensor: tensor.to(*target, **options))

    def __getitem__(self: RecordT, index: Any) -> RecordT:
        """Indexes each tensor along the shared leading axes."""
        return self.map(lambda tensor: tensor[index])

    @classmethod
    def stack(cls: type[RecordT], records: Sequence[RecordT]) -> RecordT:
        """Records of tensors of equal shapes along a new leading axis."""
        import torch

        return _combined(records, torch.stack)

    @classmethod
    def cat(cls: type[RecordT], records: Sequence[RecordT], dim: int = 0) -> RecordT:
        """Concatenates records along a shared axis.

        Args:
            records: Records of one type.
            dim: Axis, counted from the front. Default: 0.

        Returns:
            The combined record.
        """
        import torch

        return _combined(
            records, lambda parts: (np.concatenate if isinstance(parts[0], np.ndarray) else torch.cat)(parts, dim)
        )


def _mapped(value: Any, function: Callable[["Tensor"], "Tensor"]) -> Any:
    import torch

    if isinstance(value, TensorRecord):
        return value.map(function)
    return function(value) if isinstance(value, (torch.Tensor, np.ndarray)) else value


def _combined(records: Sequence[RecordT], join: Callable[[list[Any]], Any]) -> RecordT:
    import torch

    first = records[0]
    values = {}
    for name in first.__dataclass_fields__:
        each = [getattr(record, name) for record in records]
        if isinstance(each[0], TensorRecord):
            values[name] = _combined(each, join)
        else:
            values[name] = join(each) if isinstance(each[0], (torch.Tensor, np.ndarray)) else each[0]
    return type(first)(**values)


SHA256 = "sha256"  # in the header


def write_tensors(file: Path, tensors: "dict[str, Tensor]", header: dict[str, str] | None = None) -> None:
    """Writes tensors and their SHA-256 atomically.

    Args:
        file: The safetensors file.
        tensors: Tensors by name.
        header: Further metadata. Default: none.

    Raises:
        InputError: If the file cannot be written.
    """
    from safetensors.torch import save

    own = {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}
    data = _sort_metadata(save(own, metadata={**(header or {}), SHA256: sha256_of(own)}))
    with atomic_file(file) as temporary:
        temporary.write_bytes(data)


def read_tensors(file: Path) -> "tuple[dict[str, Tensor], dict[str, str]]":
    """Reads the output of `write_tensors`.

    Args:
        file: The safetensors file.

    Returns:
        Tensors by name, and the metadata.

    Raises:
        InputError: If the file is missing or damaged, or a value is not finite.
    """
    tensors, header = safe_tensors.read_tensors(file)
    if header.get(SHA256, "") not in ("", sha256_of(tensors)):
        raise InputError(f"{file} is damaged: its values are not those that were written; write it again")
    return tensors, header


def sha256_of(tensors: "dict[str, Tensor]") -> str:
    """Hashes tensors including their names, dtypes and shapes.

    Args:
        tensors: Tensors by name.

    Returns:
        SHA-256, hexadecimal; independent of the order of names.
    """
    import torch

    digest = hashlib.sha256()
    for name in sorted(tensors):
        tensor = tensors[name].detach().cpu().contiguous()
        digest.update(f"{name} {tensor.dtype} {tuple(tensor.shape)}\n".encode())
        if tensor.dtype == torch.bfloat16:
            tensor = tensor.view(torch.int16)  # which numpy knows
        digest.update(tensor.numpy().tobytes())
    return digest.hexdigest()


def _sort_metadata(data: bytes) -> bytes:
    """Sorts the entries of `__metadata__`, whose order safetensors varies from run to run.

    Reference: safetensors format: 8 bytes of length, a JSON header padded with spaces, the data.
    """
    size = int.from_bytes(data[:8], "little")
    header = parse_json(data[8 : 8 + size], "the header")
    metadata = dict(sorted(header.pop("__metadata__").items()))
    text = json.dumps({"__metadata__": metadata, **header}, ensure_ascii=False, separators=(",", ":"))
    packed = text.encode().ljust(size)
    assert len(packed) == size, "the header is as long as before"
    return data[:8] + packed + data[8 + size :]
