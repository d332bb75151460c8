"""Torch's default dtype during computation, independent of what the caller has set for the process."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def single_precision() -> Iterator[None]:
    """Context with float32 as torch's default dtype; restores the caller's default on exit."""
    import torch

    before = torch.get_default_dtype()
    torch.set_default_dtype(torch.float32)
    try:
        yield
    finally:
        torch.set_default_dtype(before)
