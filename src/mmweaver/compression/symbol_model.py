"""Adaptive distributions of integers, mixed from several contexts and coded many symbols at once.

Probabilities are ratios of counts: additions, products and divisions of IEEE doubles, identical on every machine.
"""

from collections.abc import Iterator

import numpy as np

from mmweaver.compression.entropy import BitStream

Integers = np.ndarray  # (n,) int64; called thousands of times per cube

MEMORY = 4000.0  # counts of a context are halved beyond
CONFIDENT = 150.0  # counts beyond which a context gains no more weight
PRIOR = 3.0  # symbols that the initial distribution counts for
HALF = 12  # signed numbers from -HALF to HALF have a symbol each; others escape
ESCAPE = 2 * HALF + 1
SIZE = ESCAPE + 1
MAX_BITS = 30
FIRST_BATCH = 16
ALWAYS = np.ones(1, bool)  # all numbers of a batch are as likely as their negatives


class Batches:
    """Batches of symbols after which models are updated: a batch is coded with what was learned before it.

    Version 3 had no batches, and a first phase of large levels cost eight bits too many each.
    """

    def __init__(self, stream: BitStream):
        self.is_endless, self.num_coded = stream.version == 3, 0

    def of(self, num: int) -> Iterator[slice]:
        """The batches of the next `num` symbols; each is as long as all previous ones together."""
        first = 0
        while first < num:
            last = num if self.is_endless else min(num, first + max(FIRST_BATCH, self.num_coded))
            yield slice(first, last)
            self.num_coded += last - first
            first = last


class MixedModel:
    """Distributions of symbols 0 ... size - 1, averaged over several tables of contexts.

    Contexts with many counts and narrow distributions have more weight. The tables are stored one after the other in
    one array, so that all are updated at once: batches are small, so the number of calls dominates the cost.
    """

    def __init__(self, priors: list[np.ndarray]):
        """Initialises the tables.

        Args:
            priors: Initial distributions (context, symbol) of each table; they need not be normalised.
        """
        self.size = priors[0].shape[1]
        self.counts = np.concatenate([PRIOR * prior / prior.sum(axis=1, keepdims=True) for prior in priors])
        self.totals = np.full(len(self.counts), PRIOR)
        self._first = np.cumsum([0] + [len(prior) for prior in priors[:-1]])[:, None]
        self._place = np.zeros(len(self.counts), np.int64)
        self._weighted = np.empty_like(self.counts)
        self._weigh(np.arange(len(self.counts)))

    def code(self, stream: BitStream, contexts: list[Integers], values: Integers, mirrored: np.ndarray | None = None):
        """Codes symbols, then updates the distributions.

        Args:
            stream: Encoder or decoder.
            contexts: One context (n,) per table.
            values: Symbols (n,).
            mirrored: Mask (n,) or ALWAYS: where set, a number and its negative are learned alike.

        Returns:
            The symbols.
        """
        places = np.concatenate(contexts).reshape(len(contexts), -1) + self._first
        rows = self._weighted.take(places[0], axis=0)
        for place in places[1:]:
            rows += self._weighted.take(place, axis=0)
        rows /= rows.sum(axis=1, keepdims=True)
        found = stream.rows(rows, values)
        self._learn(places, found, mirrored)
        return found

    def _learn(self, places: Integers, symbols: Integers, mirrored: np.ndarray | None) -> None:
        """Counts symbols (n,) at their places in every table (table, n)."""
        counts = np.bincount(places.ravel(), minlength=len(self.totals))
        seen = counts.nonzero()[0]
        self._place[seen] = np.arange(0, len(seen) * self.size, self.size)  # few contexts of large tables occur
        learned = self._place.take(places)
        learned += symbols
        some = self.counts.take(seen, axis=0)
        if mirrored is None:
            some += self._counted(learned, len(seen))
        else:
            # half for the symbol, half for its mirror image; symbols that are not mirrored count fully
            halves = 0.5 * self._counted(learned if mirrored is ALWAYS else learned[:, mirrored], len(seen))
            some += halves if mirrored is ALWAYS else self._counted(learned, len(seen)) - halves
            some[:, :ESCAPE] += halves[:, ESCAPE - 1 :: -1]
            some[:, ESCAPE:] += halves[:, ESCAPE:]
        self.counts[seen] = some
        self.totals += counts
        old = self.totals > MEMORY
        if old.any():
            self.counts[old] *= 0.5
            self.totals[old] *= 0.5
        self._weigh(seen)

    def _counted(self, places: Integers, num_contexts: int) -> np.ndarray:
        """Frequency of each symbol (context, symbol)."""
        size = num_contexts * self.size
        return np.bincount(places.ravel(), minlength=size).reshape(num_contexts, self.size)

    def _weigh(self, rows: Integers) -> None:
        """Distributions of some contexts multiplied by their weight in the average."""
        total = self.totals.take(rows)
        share = self.counts.take(rows, axis=0)
        share /= total[:, None]
        confidence = np.minimum(total, CONFIDENT) / (1.005 - (share * share).sum(axis=1))
        share *= confidence[:, None]
        self._weighted[rows] = share


class SignedModel:
    """Signed integers in contexts: high part by symbol, the lowest `shift` bits uniform, large ones by escape.

    In version 3 escapes hold the low bits too.
    """

    def __init__(self, scales: list[np.ndarray]):
        """`scales` (context,) of each table: the magnitude to expect."""
        self.symbols = MixedModel([prior_of(scale) for scale in scales])
        self.escapes = MixedModel([np.ones((1, MAX_BITS))])

    def code(
        self, stream: BitStream, contexts: list[Integers], shift: Integers | None, values: Integers, mirrored
    ) -> Integers:
        """Codes values (n,). `shift` (n,), None for none; `mirrored`: see `MixedModel.code`."""
        if shift is None:
            symbol = np.where(np.abs(values) <= HALF, values + HALF, ESCAPE)
            symbol = self.symbols.code(stream, contexts, symbol, mirrored)
            out, far = symbol - HALF, np.flatnonzero(symbol == ESCAPE)
            if len(far):
                out[far] = code_far(stream, self.escapes, values[far])
            return out
        if shift.max(initial=0) > MAX_BITS:
            raise ValueError("a number too large: the stream is damaged")
        half = (1 << shift) >> 1
        high = (values + half) >> shift
        low = values + half - (high << shift)
        symbol = np.where(np.abs(high) <= HALF, high + HALF, ESCAPE)
        symbol = self.symbols.code(stream, contexts, symbol, mirrored)
        out, far = symbol - HALF, np.flatnonzero(symbol == ESCAPE)
        if len(far) and stream.version > 3:
            out[far] = code_far(stream, self.escapes, high[far])
        has_low = (symbol < ESCAPE) | (stream.version > 3)
        low = stream.uniform(np.where(has_low, 1 << shift, 1), np.where(has_low, low, 0))
        out = (out << shift) - half + low
        if len(far) and stream.version == 3:
            out[far] = code_far(stream, self.escapes, values[far])
        return out


def code_far(stream: BitStream, escapes: MixedModel, values: Integers) -> Integers:
    """Codes integers of any size: the octave with a model, position within it and sign as uniform.

    Args:
        stream: Encoder or decoder.
        escapes: Model of the octave.
        values: Integers (n,).

    Returns:
        The integers.
    """
    size = np.abs(values) + 1
    bits = (np.frexp(size.astype(np.float64))[1] - 1).astype(np.int64)
    bits = escapes.code(stream, [np.zeros(len(values), np.int64)], np.minimum(bits, MAX_BITS - 1))
    top = np.int64(1) << bits
    size = top + stream.uniform(top, size - top)
    negative = stream.bits(np.full(len(values), 0.5), (values < 0).astype(np.int64))
    return (size - 1) * (1 - 2 * negative)


def prior_of(scale: np.ndarray) -> np.ndarray:
    """Initial distribution (context, symbol) for numbers of an expected magnitude (context,), not normalised."""
    distance = np.abs(np.arange(SIZE) - HALF)
    relative = 1 + distance / scale[:, None]
    prior = 1.0 / (relative * relative * relative)
    prior[:, ESCAPE] = 0.003
    return prior
