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
MOST_OCTAVES = 30
MOST_EVEN = 2**23
LAST_SINGLE = 3
RUNGS = np.array([0, 1, 2, 3, *(2**octave * half // 2 for octave in range(2, 30) for half in (2, 3))])
MOST_RUNGS = len(RUNGS) - 2


class BitStream(ABC):
    """Writes what it is given, or gives what was written."""

    @abstractmethod
    def bits(self, chance: Chance, values: Whole) -> Whole:
        """Bits of which each is 1 with its chance. A reader ignores `values` (but for their number)."""

    def even(self, sizes: Whole, values: Whole) -> Whole:
        """Numbers of which each is any of 0 ... size - 1. Sizes beyond 2^23 must be multiples of 2^16."""
        huge = sizes > MOST_EVEN
        if not huge.any():
            return self._even_small(sizes, values)
        out = self._even_small(np.where(huge, sizes >> 16, sizes), np.where(huge, values >> 16, values))
        low = self._even_small(np.where(huge, 1 << 16, 1), values & 0xFFFF)
        return np.where(huge, (out << 16) + low, out)

    @abstractmethod
    def _even_small(self, sizes: Whole, values: Whole) -> Whole:
        """The same for sizes of at most 2^23, which is what the coder's precision allows."""


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

    def _even_small(self, sizes: Whole, values: Whole) -> Whole:
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

    def _even_small(self, sizes: Whole, values: Whole) -> Whole:
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
    """Whole numbers from 0: a learned chance for each step up, then for each octave of the rest, then even bits."""

    def __init__(self, num_contexts: int, steps: int, chance: float = 0.4):
        self.steps = steps
        self.models = [Mixture([BitModel(num_contexts, chance, 2.0)]) for _ in range(steps)]
        self.octaves = [Mixture([BitModel(num_contexts, 0.5, 2.0)]) for _ in range(MOST_OCTAVES)]

    def code(self, stream: BitStream, context: Whole, values: Whole) -> Whole:
        out = _climbed(stream, self.models, context, values)
        rest = np.flatnonzero(out == self.steps)
        if len(rest):
            more = values[rest] - self.steps + 1
            wanted = np.frexp(np.maximum(more, 1).astype(np.float64))[1].astype(np.int64) - 1
            octave = _climbed(stream, self.octaves, context[rest], wanted)
            if octave.max() >= MOST_OCTAVES:
                raise ValueError("a number too large: the stream is damaged")
            size = 2**octave
            out[rest] += size - 1 + stream.even(size, more - size)
        return out


def _climbed(stream: BitStream, models: list[Mixture], context: Whole, values: Whole) -> Whole:
    """How many models in turn say "further", at most all of them."""
    out = np.zeros(len(values), np.int64)
    open_ = np.arange(len(values))
    for step, model in enumerate(models):
        if not len(open_):
            break
        more = model.code(stream, [context[open_]], (values[open_] > step).astype(np.int64))
        open_ = open_[more > 0]
        out[open_] = step + 1
    return out


class LadderModel:
    """Whole numbers from 0, seen from several sides: a learned chance for each rung of a ladder, then even bits.

    Rungs are 0, 1, 2, 3, then two to an octave: 4-5, 6-7, 8-11, 12-15, 16-23, ...
    """

    def __init__(self, num_contexts: list[int], chance: float = 0.4):
        self.rungs = [Mixture([BitModel(num, chance, 2.0) for num in num_contexts]) for _ in range(MOST_RUNGS)]

    def code(self, stream: BitStream, contexts: list[Whole], values: Whole) -> Whole:
        """One context of each side a number."""
        wanted = np.searchsorted(RUNGS, values, side="right") - 1
        rung = np.zeros(len(values), np.int64)
        open_ = np.arange(len(values))
        for step, model in enumerate(self.rungs):
            if not len(open_):
                break
            more = model.code(stream, [context[open_] for context in contexts], (wanted[open_] > step).astype(np.int64))
            open_ = open_[more > 0]
            rung[open_] = step + 1
        if len(open_):
            raise ValueError("a number too large: the stream is damaged")
        out = RUNGS[rung]
        wide = np.flatnonzero(rung > LAST_SINGLE)
        if len(wide):
            out[wide] += stream.even(RUNGS[rung[wide] + 1] - out[wide], values[wide] - out[wide])
        return out
