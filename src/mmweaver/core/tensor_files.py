"""Tensors as safetensors files: byte-for-byte reproducible, with damage detection.

The header contains the SHA-256 of the tensors and metadata of the caller.
"""

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files import safe_tensors
from mmweaver.core.safe_files.safe_text import parse_json

if TYPE_CHECKING:
    from torch import Tensor

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
