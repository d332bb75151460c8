"""Alone, one of several, and batches of all shapes on a device."""

from dataclasses import dataclass

import pytest
import torch
from torch import Tensor, nn

from mmweaver.training.device import ComputeDevice, moved


@dataclass(frozen=True, kw_only=True)
class Nested:
    values: Tensor
    inner: tuple[Tensor, ...]
    name: str


def test_a_single_process_averages_nothing():
    place, module = ComputeDevice(), nn.Linear(2, 2)
    assert place.is_first
    assert place.joined(module) is module
    assert torch.equal(place.mean(torch.tensor([3.0])), torch.tensor([3.0]))
    place.wait()


def test_only_the_first_writes():
    assert not ComputeDevice(share=(1, 2)).is_first


@pytest.mark.parametrize(("precision", "dtype"), [("float32", torch.float32), ("bf16", torch.bfloat16)])
def test_products_are_in_the_chosen_precision(precision: str, dtype: torch.dtype):
    with ComputeDevice(precision=precision).arithmetic():
        assert (torch.ones(2, 2) @ torch.ones(2, 2)).dtype == dtype


def test_nested_batches_move():
    batch = [Nested(values=torch.ones(1), inner=(torch.ones(2),), name="a"), {"b": torch.ones(3)}]
    there = moved(batch, torch.device("meta"))
    assert (there[0].values.device.type, there[0].inner[0].device.type, there[1]["b"].device.type) == ("meta",) * 3
    assert there[0].name == "a"
