"""Named random streams: one independent stream per purpose, all derived from one seed."""

import hashlib

import numpy as np


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
