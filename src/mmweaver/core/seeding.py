"""Named random streams: one independent stream per purpose, all derived from one seed.

Torch's default dtype during computation, independent of what the caller has set for the process.
"""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np


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


def stream(seed: int, *purpose: str | int) -> np.random.Generator:
    """Creates a random generator that depends only on seed and purpose.

    Purposes never share random numbers, so sampling more for one leaves the others unchanged.

    Args:
        seed: Seed of the run.
        *purpose: Words that name the purpose, and indices if there are several.

    Returns:
        The generator.

    >>> bool(stream(0, "noise").random() == stream(0, "noise").random())
    True
    >>> bool(stream(0, "noise").random() == stream(0, "motion").random())
    False
    """
    key = hashlib.sha256(repr((int(seed), *purpose)).encode()).digest()
    return np.random.Generator(np.random.SFC64(np.frombuffer(key, np.uint32).tolist()))
