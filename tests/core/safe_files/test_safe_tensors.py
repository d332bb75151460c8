"""Tensors: safetensors and checkpoints without code in them, finite, no larger than their file."""

import json
import os
import struct
from pathlib import Path
from typing import Any

import pytest
import torch
from safetensors.torch import save_file

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_tensors import read_checkpoint, read_tensor_metadata, read_tensors

TENSORS = {"a": torch.arange(6.0).reshape(2, 3), "b": torch.tensor([1, 2])}
WHAT = "no checkpoint ({reason}); train anew"


class Attack:
    """A pickle that makes a folder when it is loaded."""

    def __init__(self, place: Path):
        self.place = place

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return os.mkdir, (str(self.place),)


def test_a_header_whose_length_begins_as_a_pickle_does_is_read(tmp_path: Path):
    """A length of 128 modulo 256 is stored as a first byte of 0x80, with which pickles begin, too."""
    lengths = set()
    for size in range(0, 256, 8):
        save_file(TENSORS, tmp_path / "t.safetensors", {"note": "x" * size})
        lengths.add((tmp_path / "t.safetensors").read_bytes()[0])
        assert read_tensors(tmp_path / "t.safetensors")[1] == {"note": "x" * size}
    assert 0x80 in lengths


def test_tensors_and_metadata_come_back(tmp_path: Path):
    file = tmp_path / "a.safetensors"
    save_file(TENSORS, file, {"card": "{}"})
    tensors, metadata = read_tensors(file)
    assert torch.equal(tensors["a"], TENSORS["a"])
    assert metadata == {"card": "{}"} == read_tensor_metadata(file)
    assert list(read_tensors(file, only=("b",))[0]) == ["b"]
    with pytest.raises(InputError, match="holds no c"):
        read_tensors(file, only=("c",))


def with_header(content: Any, body: bytes = b"") -> bytes:
    text = json.dumps(content).encode() if not isinstance(content, bytes) else content
    return struct.pack("<Q", len(text)) + text + body


@pytest.mark.parametrize(
    "data",
    [
        b"", b"\x80\x04pickle", b"PK\x03\x04", struct.pack("<Q", 2**60) + b"{}", with_header([1]), with_header(b"{"),
        with_header({"a": {"dtype": "F32", "shape": [2**40], "data_offsets": [0, 2**42]}}),
        with_header({"a": {"dtype": "F32", "shape": [2], "data_offsets": [0, 8]}}, bytes(4)),
        with_header({"__metadata__": {"card": 3}}),
    ],
)  # fmt: skip
def test_what_is_no_sound_file_is_refused(tmp_path: Path, data: bytes):
    (tmp_path / "a.safetensors").write_bytes(data)
    with pytest.raises(InputError):
        read_tensors(tmp_path / "a.safetensors")


def test_values_that_are_not_finite_are_refused_unless_asked_for(tmp_path: Path):
    file = tmp_path / "a.safetensors"
    save_file({"a": torch.tensor([1.0, float("nan")])}, file)
    with pytest.raises(InputError, match="a holds values that are not finite"):
        read_tensors(file)


def test_a_checkpoint_is_read_without_running_its_code(tmp_path: Path):
    file = tmp_path / "a.pt"
    torch.save({"state": TENSORS, "step": 3}, file)
    assert read_checkpoint(file, what=WHAT)["step"] == 3
    torch.save({"state": Attack(tmp_path / "attacked")}, file)
    with pytest.raises(InputError, match="could run code"):
        read_checkpoint(file, what=WHAT)
    assert not (tmp_path / "attacked").exists()
    torch.save({"a": torch.zeros(1).expand(10**9)}, file)  # four gigabytes of one number
    with pytest.raises(InputError, match="larger than the file"):
        read_checkpoint(file, what=WHAT)
