"""Precision of products, and batches of all shapes on a device."""

from dataclasses import dataclass

import pytest
import torch
from torch import Tensor

from mmweaver.training.device import ComputeDevice, moved


@dataclass(frozen=True, kw_only=True)
class Nested:
    values: Tensor
    inner: tuple[Tensor, ...]
    name: str


@pytest.mark.parametrize(("precision", "dtype"), [("float32", torch.float32), ("bf16", torch.bfloat16)])
def test_products_are_in_the_chosen_precision(precision: str, dtype: torch.dtype):
    with ComputeDevice(precision=precision).arithmetic():
        assert (torch.ones(2, 2) @ torch.ones(2, 2)).dtype == dtype


def test_nested_batches_move():
    batch = [Nested(values=torch.ones(1), inner=(torch.ones(2),), name="a"), {"b": torch.ones(3)}]
    there = moved(batch, torch.device("meta"))
    assert (there[0].values.device.type, there[0].inner[0].device.type, there[1]["b"].device.type) == ("meta",) * 3
    assert there[0].name == "a"
