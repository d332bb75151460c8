"""Tensors from safetensors files and PyTorch checkpoints; no pickle is executed."""

import math
import struct
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import check_regular, foreign_errors, open_regular
from mmweaver.core.safe_files.safe_text import parse_json

if TYPE_CHECKING:
    import torch

MAX_HEADER_BYTES = 16 * 2**20
PICKLE = (b"\x80", b"PK")  # first bytes of a pickle and of a torch.save checkpoint
NO_TENSORS = "damaged or no safetensors file ({reason}); fetch or write it again"


def read_tensors(
    path: Path | str, *, only: Iterable[str] | None = None
) -> tuple[dict[str, "torch.Tensor"], dict[str, str]]:
    """Reads a safetensors file.

    Args:
        path: The file.
        only: Names of the tensors to read. Default: all.

    Returns:
        Tensors by name, and the metadata.

    Raises:
        InputError: If the file is damaged, lacks one of `only`, or contains nan or infinity.
    """
    from safetensors import safe_open

    check_header(path)
    with foreign_errors(path, NO_TENSORS), safe_open(path, framework="pt") as file:
        metadata = dict(file.metadata() or {})
        names = list(file.keys() if only is None else only)
        if missing := [name for name in names if name not in set(file.keys())]:
            raise InputError(f"{path} holds no {missing[0]}; is it the right file?")
        tensors = {name: file.get_tensor(name) for name in names}
    check_finite(path, tensors)
    return tensors, metadata


def read_tensor_metadata(path: Path | str) -> dict[str, str]:
    """Reads the metadata of a safetensors file without its tensors.

    Args:
        path: The file.

    Returns:
        Metadata by key.

    Raises:
        InputError: If it is not a safetensors file.
    """
    header = check_header(path)
    metadata = header.get("__metadata__", {})
    if not isinstance(metadata, dict) or not all(isinstance(value, str) for value in metadata.values()):
        raise InputError(f"{path} is damaged or no safetensors file (its metadata); fetch or write it again")
    return metadata


def check_header(path: Path | str) -> dict[str, Any]:
    """Reads the header of a safetensors file and checks it against the file size.

    Args:
        path: The file.

    Returns:
        Decoded JSON header.

    Raises:
        InputError: If it is not a safetensors file; the message points out pickles.
    """
    size = check_regular(path)
    with open_regular(path) as file, foreign_errors(path, NO_TENSORS):
        start = file.read(8)
        length = struct.unpack("<Q", start)[0] if len(start) == 8 else 0
        if not 2 <= length <= min(size - 8, MAX_HEADER_BYTES):
            # only checked now, since one valid header length in 32 begins like a pickle
            if start.startswith(PICKLE):
                raise InputError(
                    f"{path} holds pickled objects, which can run any program; mmweaver reads only safetensors"
                )
            raise ValueError("its header does not fit")
        text = file.read(length)
    header = parse_json(text, f"the header of {path}")
    if not isinstance(header, dict):
        raise InputError(f"{path} is damaged or no safetensors file (its header); fetch or write it again")
    return header


def check_finite(path: Path | str, tensors: dict[str, "torch.Tensor"]) -> None:
    """Checks that all tensors are finite, which they are not after a diverged training.

    Args:
        path: The file, for error messages.
        tensors: Tensors by name.

    Raises:
        InputError: If one contains nan or infinity.
    """
    import torch

    for name, tensor in tensors.items():
        if tensor.is_floating_point() and not bool(torch.isfinite(tensor).all()):
            raise InputError(f"{path}: {name} holds values that are not finite; train or fetch the weights again")


def read_checkpoint(path: Path | str, *, what: str) -> Any:
    """Loads a torch.save checkpoint on the CPU; refuses code in it.

    Args:
        path: The file.
        what: What is wrong and the remedy, as in `foreign_errors`.

    Returns:
        Tensors and plain values.

    Raises:
        InputError: If the file contains anything else or is damaged.
    """
    import torch

    size = check_regular(path)
    with open_regular(path) as file, foreign_errors(path, what):
        content = torch.load(file, map_location="cpu", weights_only=True)
        _check_size(content, size)
    return content


def _check_size(content: Any, size: int) -> None:
    """Raises ValueError if shared storages let a small file expand to far more numbers."""
    import torch

    total, level = 0, [content]
    while level:
        value = level.pop()
        if isinstance(value, dict):
            level += value.values()
        elif isinstance(value, list | tuple):
            level += value
        elif isinstance(value, torch.Tensor):
            total += math.prod(value.shape) * value.element_size()
    if total > 100 * size + 2**26:
        raise ValueError("its tensors are larger than the file")
