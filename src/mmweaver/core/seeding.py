"""Named random streams, one per purpose, and counters for plans of millions of sequences, all derived from one seed.

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


def hashed_words(*purpose: str | int) -> np.ndarray:
    """Four words of 64 bits that depend only on a purpose.

    Args:
        *purpose: Words and indices that name the purpose, the seed of the run among them.

    Returns:
        uint64 (4,): SHA-256 of the purpose.
    """
    return np.frombuffer(hashlib.sha256(repr(purpose).encode()).digest(), "<u8").astype(np.uint64)


def counter_bits(keys: np.ndarray, counters: np.ndarray) -> np.ndarray:
    """Random words that can be computed at any place, without those before them: SplitMix64.

    For one key, different counters give different words, as each step is a bijection.

    Args:
        keys: Keys, uint64, for example from `hashed_words`.
        counters: Counters, uint64; broadcast against the keys.

    Returns:
        Uniform words of 64 bits, uint64.
    """
    words = keys + (counters + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        words = (words ^ (words >> np.uint64(shift))) * np.uint64(factor)
    return words ^ (words >> np.uint64(31))
