"""Torch's default type while mmWeaver computes, whatever a caller has set for the process."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def single_precision() -> Iterator[None]:
    """float32 as torch's default type inside; `torch.set_default_dtype` of the caller holds again afterwards."""
    import torch

    before = torch.get_default_dtype()
    torch.set_default_dtype(torch.float32)
    try:
        yield
    finally:
        torch.set_default_dtype(before)
