"""Tensors in, the same bytes out, and no damage goes unnoticed."""

from pathlib import Path

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.tensor_files import read_tensors, write_tensors

TENSORS = {"b": torch.arange(12.0).reshape(3, 4), "a": torch.ones(2, dtype=torch.float16), "n": torch.tensor([3, 4])}


def test_written_then_read_is_the_same(tmp_path: Path):
    write_tensors(tmp_path / "a.safetensors", TENSORS, {"mark": 'quote " and ü'})
    tensors, header = read_tensors(tmp_path / "a.safetensors")
    assert header["mark"] == 'quote " and ü'
    assert all(torch.equal(tensors[name], TENSORS[name]) for name in TENSORS)


def test_any_flipped_bit_of_the_values_is_noticed(tmp_path: Path):
    file = tmp_path / "a.safetensors"
    write_tensors(file, TENSORS)
    whole = file.read_bytes()
    first = 8 + int.from_bytes(whole[:8], "little")
    for at in range(first, len(whole)):
        file.write_bytes(whole[:at] + bytes([whole[at] ^ 4]) + whole[at + 1 :])
        with pytest.raises(InputError, match="damaged"):
            read_tensors(file)
