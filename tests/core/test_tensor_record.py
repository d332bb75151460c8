"""Records of tensors: what is done to the record is done to every tensor, nested ones included."""

from dataclasses import dataclass

import pytest
import torch
from torch import Tensor

from mmweaver.core.tensor_files import TensorRecord


@dataclass(frozen=True, kw_only=True)
class Inner(TensorRecord):
    phase: Tensor  # (frame, path)


@dataclass(frozen=True, kw_only=True)
class Outer(TensorRecord):
    range_m: Tensor  # (frame, path)
    place_m: Tensor  # (frame, path, 3)
    inner: Inner
    noise: float
    extra: Tensor | None = None


def record(frames: int, value: float) -> Outer:
    shape = (frames, 4)
    inner = Inner(phase=torch.full(shape, value))
    return Outer(range_m=torch.full(shape, value), place_m=torch.full((*shape, 3), value), inner=inner, noise=value)


def test_indexing_reaches_every_tensor():
    chosen = record(3, 1.0)[1:, torch.tensor([0, 2])]
    assert chosen.range_m.shape == chosen.inner.phase.shape == (2, 2)
    assert chosen.place_m.shape == (2, 2, 3)
    assert (chosen.noise, chosen.extra) == (1.0, None)


def test_stack_and_cat():
    parts = [record(2, 1.0), record(2, 2.0)]
    assert Outer.stack(parts).place_m.shape == (2, 2, 4, 3)
    joined = Outer.cat(parts, 1)
    assert joined.inner.phase.shape == (2, 8)
    assert joined.range_m[0].tolist() == [1.0] * 4 + [2.0] * 4
    assert joined.noise == 1.0
    with pytest.raises(RuntimeError):
        Outer.stack([record(2, 1.0), record(3, 1.0)])


def test_to_changes_the_type_of_all():
    assert record(2, 1.0).to(torch.float64).inner.phase.dtype == torch.float64
