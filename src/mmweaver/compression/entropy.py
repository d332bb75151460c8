"""Adaptive entropy coding; encoder and decoder share one code path.

Probabilities are ratios of counts: additions and divisions of IEEE doubles, identical on every machine, so a file
written on one machine decodes on every other.
"""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

# called tens of thousands of times per cube, so shapes are documented but not checked
Integers = np.ndarray  # (n,) int64
Probability = np.ndarray  # (n,) float64

VERSION = 5  # of the .mmw format that is written
MIN_PROBABILITY = 2.0**-14
MAX_OCTAVES = 30
MAX_UNIFORM = 2**23


class BitStream(ABC):
    """Common interface of encoder and decoder: encodes given values, or returns decoded ones.

    A decoder uses only the length of the values. `version` is the .mmw version whose models of levels and classes are
    used (`cell_coder`, `symbol_model`).
    """

    def __init__(self, version: int = VERSION) -> None:
        import constriction  # its submodules cannot be imported by name

        self.version = version
        stream: Any = constriction.stream  # type: ignore
        self._queue, self._one = stream.queue, stream.model.Categorical
        self._bernoulli, self._uniform = stream.model.Bernoulli(perfect=False), stream.model.Uniform()
        self._categorical = stream.model.Categorical(perfect=False)

    @abstractmethod
    def _code(self, values: Integers, model: Any, *parameters: np.ndarray) -> Integers:
        """Codes values with one model, or with a family of models with parameters per value."""

    def bits(self, probability: Probability, values: Integers) -> Integers:
        """Codes bits.

        Args:
            probability: Probability (n,) of a 1.
            values: Bits (n,), int64; ignored when decoding.

        Returns:
            The bits.
        """
        return self._code(values, self._bernoulli, probability)

    def symbols(self, probability: Probability, values: Integers) -> Integers:
        """Codes symbols of one distribution.

        Args:
            probability: Distribution (symbol,).
            values: Symbols (n,), int64; ignored when decoding.

        Returns:
            The symbols.
        """
        return self._code(values, self._one(probability, perfect=False))

    def rows(self, probability: Probability, values: Integers) -> Integers:
        """Codes symbols, each with its own distribution.

        Args:
            probability: Distributions (n, symbol).
            values: Symbols (n,), int64; ignored when decoding.

        Returns:
            The symbols.
        """
        return self._code(values, self._categorical, probability)

    def uniform(self, sizes: Integers, values: Integers) -> Integers:
        """Codes integers that are uniform on 0 ... size - 1.

        Beyond 2^23, the limit of the coder's precision, sizes are truncated to multiples of 2^16; larger values cannot
        be coded.

        Args:
            sizes: Number of values (n,) of each integer.
            values: Integers (n,); ignored when decoding.

        Returns:
            The integers.
        """
        huge = sizes > MAX_UNIFORM
        if not huge.any():
            return self._small(sizes, values)
        out = self._small(np.where(huge, sizes >> 16, sizes), np.where(huge, values >> 16, values))
        low = self._small(np.where(huge, 1 << 16, 1), values & 0xFFFF)
        return np.where(huge, (out << 16) + low, out)

    def _small(self, sizes: Integers, values: Integers) -> Integers:
        wide, out = sizes > 1, np.zeros(len(sizes), np.int64)
        if wide.any():
            out[wide] = self._code(values[wide], self._uniform, sizes[wide].astype(np.int32))
        return out


class Encoder(BitStream):
    """A BitStream that encodes; `to_bytes` returns the result."""

    def __init__(self) -> None:
        super().__init__()
        self._coder = self._queue.RangeEncoder()

    def _code(self, values: Integers, model: Any, *parameters: np.ndarray) -> Integers:
        if len(values):
            self._coder.encode(values.astype(np.int32), model, *parameters)
        return values

    def to_bytes(self) -> bytes:
        """Everything encoded so far."""
        return self._coder.get_compressed().astype("<u4").tobytes()


class Decoder(BitStream):
    """A BitStream that decodes the bytes of an Encoder."""

    def __init__(self, data: bytes, *, version: int = VERSION) -> None:
        super().__init__(version)
        # streams are whole words; some files had other bytes after the last one
        self._coder = self._queue.RangeDecoder(np.frombuffer(data, "<u4", len(data) // 4).astype(np.uint32))

    def _code(self, values: Integers, model: Any, *parameters: np.ndarray) -> Integers:
        if not len(values):
            return values
        return np.asarray(self._coder.decode(model, *(parameters or (len(values),)))).astype(np.int64)


class BitModel:
    """Adaptive probability of a 1 in each of several contexts."""

    def __init__(self, num_contexts: int, probability: float = 0.5, weight: float = 1.0, memory: float = 400.0):
        """Initialises all contexts alike.

        Args:
            num_contexts: Number of contexts.
            probability: Initial probability of a 1.
            weight: Number of bits that the initial probability counts for.
            memory: Number of bits beyond which counts are halved.
        """
        self.ones = np.full(num_contexts, probability * weight)
        self.total = np.full(num_contexts, weight)
        self.memory = memory

    def probability(self, context: Integers) -> tuple[Probability, Probability]:
        """Probability of a 1 in each context (n,), and the number of bits it is estimated from."""
        total = self.total[context]
        return self.ones[context] / total, total

    def learn(self, context: Integers, bits: Integers) -> None:
        """Counts bits.

        Args:
            context: Context (n,) of each bit.
            bits: Bits (n,).
        """
        num = len(self.total)
        self.ones += np.bincount(context, weights=bits, minlength=num)
        self.total += np.bincount(context, minlength=num)
        old = self.total > self.memory
        self.ones[old] *= 0.5
        self.total[old] *= 0.5


class Mixture:
    """Mixes BitModels with different contexts; the more confident model has more weight."""

    def __init__(self, models: list[BitModel]):
        self.models = models

    def code(self, stream: BitStream, contexts: list[Integers], values: Integers) -> Integers:
        """Codes bits, then updates the models.

        Args:
            stream: Encoder or decoder.
            contexts: One context (n,) per model.
            values: Bits (n,).

        Returns:
            The bits.
        """
        above = np.zeros(len(values))
        below = np.full(len(values), 1e-9)
        for model, context in zip(self.models, contexts, strict=True):
            probability, seen = model.probability(context)
            # confidence grows with the count up to a limit, and towards probabilities of 0 and 1
            weight = np.minimum(seen, 60.0) / (probability * (1 - probability) + 0.002)
            above += weight * probability
            below += weight
        probability = np.clip(above / below, MIN_PROBABILITY, 1 - MIN_PROBABILITY)
        bits = stream.bits(probability, values)
        for model, context in zip(self.models, contexts, strict=True):
            model.learn(context, bits)
        return bits


class NumberModel:
    """Non-negative integers: adaptive unary steps, then adaptive octaves of the remainder, then uniform bits."""

    def __init__(self, num_contexts: int, steps: int, probability: float = 0.4):
        self.steps = steps
        self.models = [Mixture([BitModel(num_contexts, probability, 2.0)]) for _ in range(steps)]
        self.octaves = [Mixture([BitModel(num_contexts, 0.5, 2.0)]) for _ in range(MAX_OCTAVES)]

    def code(self, stream: BitStream, context: Integers, values: Integers) -> Integers:
        """Codes integers.

        Args:
            stream: Encoder or decoder.
            context: Context (n,) of each integer.
            values: Integers (n,); ignored when decoding.

        Returns:
            The integers.
        """
        out = _unary(stream, self.models, context, values)
        rest = np.flatnonzero(out == self.steps)
        if len(rest):
            more = values[rest] - self.steps + 1
            wanted = np.frexp(np.maximum(more, 1).astype(np.float64))[1].astype(np.int64) - 1
            octave = _unary(stream, self.octaves, context[rest], wanted)
            if octave.max() >= MAX_OCTAVES:
                raise ValueError("a number too large: the stream is damaged")
            size = 2**octave
            out[rest] += size - 1 + stream.uniform(size, more - size)
        return out


def _unary(stream: BitStream, models: list[Mixture], context: Integers, values: Integers) -> Integers:
    """Unary code: the number of models in turn whose bit is 1, at most all of them."""
    out = np.zeros(len(values), np.int64)
    active = np.arange(len(values))
    for step, model in enumerate(models):
        if not len(active):
            break
        more = model.code(stream, [context[active]], (values[active] > step).astype(np.int64))
        active = active[more > 0]
        out[active] = step + 1
    return out
