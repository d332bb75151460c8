"""Tensors from safetensors files and from PyTorch checkpoints; no pickle is run, and every value is finite."""

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
PICKLE = (b"\x80", b"PK")  # how a pickle and a checkpoint of torch.save begin
NO_TENSORS = "damaged or no safetensors file ({reason}); fetch or write it again"


def read_tensors(
    path: Path | str, *, only: Iterable[str] | None = None
) -> tuple[dict[str, "torch.Tensor"], dict[str, str]]:
    """The tensors of a safetensors file.

    Args:
        path: The file.
        only: Names of tensors that are read. Default: all.

    Returns:
        The tensors by name, and the metadata.

    Raises:
        InputError: where it is another file or damaged, lacks one of `only`, or has NaN or infinity.
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
    """The metadata of a safetensors file, without its tensors. Raises InputError where it is no such file."""
    header = check_header(path)
    metadata = header.get("__metadata__", {})
    if not isinstance(metadata, dict) or not all(isinstance(value, str) for value in metadata.values()):
        raise InputError(f"{path} is damaged or no safetensors file (its metadata); fetch or write it again")
    return metadata


def check_header(path: Path | str) -> dict[str, Any]:
    """The header of a safetensors file, after it was checked against the size of the file."""
    size = check_regular(path)
    with open_regular(path) as file, foreign_errors(path, NO_TENSORS):
        start = file.read(8)
        length = struct.unpack("<Q", start)[0] if len(start) == 8 else 0
        if not 2 <= length <= min(size - 8, MAX_HEADER_BYTES):
            # only now: the length of one header in 32 begins as a pickle does
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
    """Raises InputError where a tensor holds NaN or infinity, as after a diverged training."""
    import torch

    for name, tensor in tensors.items():
        if tensor.is_floating_point() and not bool(torch.isfinite(tensor).all()):
            raise InputError(f"{path}: {name} holds values that are not finite; train or fetch the weights again")


def read_checkpoint(path: Path | str, *, what: str) -> Any:
    """The content of a checkpoint of torch.save, on the CPU; code in it is refused.

    Args:
        path: The file.
        what: What is wrong with it and the remedy, as in `foreign_errors`.

    Returns:
        Tensors and plain values.

    Raises:
        InputError: for anything else.
    """
    import torch

    size = check_regular(path)
    with open_regular(path) as file, foreign_errors(path, what):
        content = torch.load(file, map_location="cpu", weights_only=True)
        _check_size(content, size)
    return content


def _check_size(content: Any, size: int) -> None:
    """Raises ValueError where storages are shared so that a small file stands for far more numbers."""
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
