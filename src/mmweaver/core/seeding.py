"""Random streams: one seed, one independent stream for each named purpose."""

import hashlib

import numpy as np


def stream(seed: int, *purpose: str | int) -> np.random.Generator:
    """A random generator that depends only on the seed and the purpose.

    Purposes never share random numbers, so sampling more for one leaves the others unchanged.

    Args:
        seed: The seed of a run.
        *purpose: What the numbers are for: words, and indices where there are several.

    Returns:
        The generator.

    >>> bool(stream(0, "noise").random() == stream(0, "noise").random())
    True
    >>> bool(stream(0, "noise").random() == stream(0, "motion").random())
    False
    """
    key = hashlib.sha256(repr((int(seed), *purpose)).encode()).digest()
    return np.random.Generator(np.random.SFC64(np.frombuffer(key, np.uint32).tolist()))
