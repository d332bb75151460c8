"""Entropy coding with models that learn while they code; the same code path writes and reads.

Probabilities are ratios of counts: additions and divisions of IEEE doubles, the same on every machine, so what one
machine writes every other reads.
"""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

# called tens of thousands of times a cube: shapes are said, not checked, here
Whole = np.ndarray  # (n,) int64
Chance = np.ndarray  # (n,) float64

LEAST_CHANCE = 2.0**-14


class BitStream(ABC):
    """Writes what it is given, or gives what was written."""

    @abstractmethod
    def bits(self, chance: Chance, values: Whole) -> Whole:
        """Bits of which each is 1 with its chance. A reader ignores `values` (but for their number)."""

    @abstractmethod
    def even(self, sizes: Whole, values: Whole) -> Whole:
        """Numbers of which each is any of 0 ... size - 1."""


def _constriction() -> tuple[Any, Any]:
    """Its models and coders; the package keeps them in a module that has no name to import from."""
    import constriction

    stream: Any = constriction.stream  # pyright: ignore[reportAttributeAccessIssue]
    return stream.model, stream.queue


class Writer(BitStream):
    """A BitStream that writes; `finished` gives the bytes."""

    def __init__(self) -> None:
        model, queue = _constriction()

        self._coder = queue.RangeEncoder()
        self._bit, self._even = model.Bernoulli(perfect=False), model.Uniform()

    def bits(self, chance: Chance, values: Whole) -> Whole:
        if len(values):
            self._coder.encode(values.astype(np.int32), self._bit, chance)
        return values

    def even(self, sizes: Whole, values: Whole) -> Whole:
        wide = sizes > 1
        if wide.any():
            self._coder.encode(values[wide].astype(np.int32), self._even, sizes[wide].astype(np.int32))
        return values

    def finished(self) -> bytes:
        return self._coder.get_compressed().astype("<u4").tobytes()


class Reader(BitStream):
    """A BitStream that reads what a Writer wrote."""

    def __init__(self, data: bytes) -> None:
        model, queue = _constriction()

        self._coder = queue.RangeDecoder(np.frombuffer(data, "<u4").astype(np.uint32))
        self._bit, self._even = model.Bernoulli(perfect=False), model.Uniform()

    def bits(self, chance: Chance, values: Whole) -> Whole:
        if not len(values):
            return values
        return np.asarray(self._coder.decode(self._bit, chance)).astype(np.int64)

    def even(self, sizes: Whole, values: Whole) -> Whole:
        out = np.zeros(len(sizes), np.int64)
        wide = sizes > 1
        if wide.any():
            out[wide] = self._coder.decode(self._even, sizes[wide].astype(np.int32))
        return out


class BitModel:
    """Chance of a 1 in each of several contexts, learned from what was coded in it."""

    def __init__(self, num_contexts: int, chance: float = 0.5, weight: float = 1.0, memory: float = 400.0):
        self.ones = np.full(num_contexts, chance * weight)
        self.total = np.full(num_contexts, weight)
        self.memory = memory

    def chance(self, context: Whole) -> tuple[Chance, Chance]:
        """Chance of a 1, and how many bits of experience stand behind it."""
        total = self.total[context]
        return self.ones[context] / total, total

    def learn(self, context: Whole, bits: Whole) -> None:
        num = len(self.total)
        self.ones += np.bincount(context, weights=bits, minlength=num)
        self.total += np.bincount(context, minlength=num)
        old = self.total > self.memory
        self.ones[old] *= 0.5
        self.total[old] *= 0.5


class Mixture:
    """Several BitModels that look at the same bit from several sides; the surer one has more say."""

    def __init__(self, models: list[BitModel]):
        self.models = models

    def code(self, stream: BitStream, contexts: list[Whole], values: Whole) -> Whole:
        """Codes bits, one context of each model a bit, then learns."""
        above = np.zeros(len(values))
        below = np.full(len(values), 1e-9)
        for model, context in zip(self.models, contexts, strict=True):
            chance, seen = model.chance(context)
            # experience counts up to a point; a chance near 0 or 1 says more than one near a half
            say = np.minimum(seen, 60.0) / (chance * (1 - chance) + 0.002)
            above += say * chance
            below += say
        chance = np.clip(above / below, LEAST_CHANCE, 1 - LEAST_CHANCE)
        bits = stream.bits(chance, values)
        for model, context in zip(self.models, contexts, strict=True):
            model.learn(context, bits)
        return bits


class NumberModel:
    """Whole numbers from 0: a learned chance for each step up, then an Elias-gamma tail."""

    def __init__(self, num_contexts: int, steps: int, chance: float = 0.4):
        self.steps = steps
        self.models = [Mixture([BitModel(num_contexts, chance, 2.0)]) for _ in range(steps)]

    def code(self, stream: BitStream, context: Whole, values: Whole) -> Whole:
        out = np.zeros(len(values), np.int64)
        open_ = np.arange(len(values))
        for step in range(self.steps):
            if not len(open_):
                return out
            more = self.models[step].code(stream, [context[open_]], (values[open_] > step).astype(np.int64))
            open_ = open_[more > 0]
            out[open_] = step + 1
        if len(open_):
            out[open_] = self.steps + _gamma(stream, values[open_] - self.steps)
        return out


def _gamma(stream: BitStream, values: Whole) -> Whole:
    """Elias gamma of numbers from 0."""
    length = np.zeros(len(values), np.int64)
    wanted = np.floor(np.log2(np.maximum(values, 0) + 1)).astype(np.int64)
    open_ = np.arange(len(values))
    while len(open_):
        half = np.full(len(open_), 0.5)
        more = stream.bits(half, (wanted[open_] > length[open_]).astype(np.int64))
        open_ = open_[more > 0]
        length[open_] += 1
        if length.max(initial=0) > 30:
            raise ValueError("a number too large: the stream is damaged")
    size = 2**length
    return size + stream.even(size, values + 1 - size) - 1
