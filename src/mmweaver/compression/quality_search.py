"""Searches the smallest file of a quality (encoder side): over steps, and where quality jumps, over prices of a bit."""

import math

import numpy as np

from mmweaver.compression.cell_choice import active_cells
from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.coded_chunk import CodedChunk
from mmweaver.compression.rate_search import Progress, error_db
from mmweaver.compression.residual_stream import PRICE, USUAL_PRICE, Price
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.compression.step_search import step_of_error, sum_at
from mmweaver.core.errors import InputError

TRIALS = 24
USUAL_TRIALS, FEW_TRIALS = 4, 8  # after which the range is halved; from which on a little better is good enough
CLOSEST = 1e-5  # logarithms of steps that make no difference
WITHIN_DB, AIM_DB = 0.2, 0.08  # better than the quality asked for
MOST_OVER_DB = 0.3  # the same after some trials; what is better than that is said
MOST_PRICE, PRICES, SHARES = 1000.0, 10, 8  # squared steps a bit; how many prices, and shares of cells, are tried
# coarser steps are tried one by one, down to a share of the dB asked for: of few levels they may have less error
COARSER_STEPS, MUCH_WORSE = np.geomspace(1.05, 8, 14), 0.7


def within_error(segment: SegmentEncoder, quality_db: float, progress: Progress) -> list[bytes]:
    """The fewest bytes found whose error-to-signal ratio in active cells is at most -quality_db.

    They have no more than that quality, but where no smaller file is found: a few levels, the offsets of which hold
    eight bits of each, cannot be as bad as asked for.
    """
    if not np.any(segment.cube.values):
        return segment.exact()
    search = _Search(segment, quality_db, progress)
    for more in (search.over_steps, search.over_prices, search.over_coarser_steps):
        if search.is_too_good:
            more()
    if search.best is None:
        raise InputError(f"a quality of {quality_db:g} dB cannot be reached; ask for less")
    size, *_, chunks = search.best
    if (search.is_too_good or segment.repeats()) and sum(map(len, exact := segment.exact())) <= size:
        return exact
    return chunks


class _Search:
    """Keeps the smallest file that is good enough: bytes, quality, logarithm of the step, chunks."""

    def __init__(self, segment: SegmentEncoder, quality_db: float, progress: Progress):
        self.segment, self.quality_db, self.progress = segment, quality_db, progress
        self.is_active = active_cells(segment.cube.values)
        self.best: tuple[int, float, float, list[bytes]] | None = None
        self._trials = 0

    @property
    def is_too_good(self) -> bool:
        """Whether no file is good enough, or the smallest one is better than asked for."""
        return self.best is None or not self._is_met(self.best[1])

    def over_steps(self) -> None:
        """Narrows the step down by estimates, then by halves."""
        segment = self.segment
        low, high = math.log(segment.finest_step), math.log(segment.coarsest_step)
        guess = math.log(self._first_step())
        segment.decide(math.exp(guess))
        for trial in range(TRIALS):
            coded, found_db = self._try(guess)
            if self._is_met(found_db) or high - low < CLOSEST:
                break
            low, high = (guess, high) if found_db >= self.quality_db else (low, guess)
            too_good_db = found_db - self.quality_db - AIM_DB
            guess = _next_step(coded, guess, too_good_db, low, high, is_late=trial > USUAL_TRIALS)

    def over_prices(self) -> None:
        """Lowers levels at the best step: in all cells, then by one more notch in a share of them."""
        if self.best is None:
            return
        log_step, cheap, dear = self.best[2], math.log(PRICE), math.log(MOST_PRICE)
        if self._try(log_step, Price(MOST_PRICE, MOST_PRICE, 1.0))[1] >= self.quality_db:  # it has no part in the error
            return
        for _ in range(PRICES):
            middle = (cheap + dear) / 2
            found_db = self._try(log_step, Price(math.exp(middle), math.exp(middle), 1.0))[1]
            if self._is_met(found_db):
                return
            cheap, dear = (middle, dear) if found_db >= self.quality_db else (cheap, middle)
        few, many = 0.0, 1.0
        for _ in range(SHARES):
            share = (few + many) / 2
            found_db = self._try(log_step, Price(math.exp(cheap), math.exp(dear), share))[1]
            if self._is_met(found_db):
                return
            few, many = (share, many) if found_db >= self.quality_db else (few, share)

    def over_coarser_steps(self) -> None:
        """Tries some coarser steps one by one."""
        if self.best is not None:
            for log_step in self.best[2] + np.log(COARSER_STEPS):
                found_db = self._try(min(float(log_step), math.log(self.segment.coarsest_step)))[1]
                if self._is_met(found_db) or found_db < MUCH_WORSE * self.quality_db:
                    return

    def _is_met(self, found_db: float) -> bool:
        within_db = WITHIN_DB if self._trials < FEW_TRIALS else MOST_OVER_DB
        return self.quality_db <= found_db <= self.quality_db + within_db

    def _try(self, log_step: float, price: Price = USUAL_PRICE) -> tuple[list[CodedChunk], float]:
        """Encodes; keeps the smallest that is good enough."""
        self._trials += 1
        self.progress(f"trial {self._trials}")
        segment, cube = self.segment, self.segment.cube
        coded = segment.encode(math.exp(log_step), segment.coarser, price=price)
        values = np.concatenate([decode_chunk(chunk.data, cube.config).cube_values() for chunk in coded])
        found_db = -error_db(cube.values, values, self.is_active)
        size = sum(len(chunk.data) for chunk in coded)
        if found_db >= self.quality_db and (self.best is None or (size, found_db) < self.best[:2]):
            self.best = size, found_db, log_step, [chunk.data for chunk in coded]
        return coded, found_db

    def _first_step(self) -> float:
        segment = self.segment
        relative = np.abs(segment.cube.values[self.is_active]) / np.float32(segment.scale.peak)
        error = float(np.sum(np.square(relative))) * 10 ** (-self.quality_db / 10)
        return step_of_error(segment.samples(), error, segment.coarser, segment.bounds, lambda one: one.active_error)


def _next_step(
    coded: list[CodedChunk], guess: float, too_good_db: float, low: float, high: float, *, is_late: bool
) -> float:
    """The logarithm of the step to try after one that was so much too good, between two that were tried."""
    samples = [chunk.sample for chunk in coded]
    # coarse cells have no part in it
    error = sum_at(samples, math.exp(guess), 1).active_error * 10 ** (too_good_db / 10)
    bounds = math.exp(max(low, guess - 2)), math.exp(min(high, guess + 2))
    found = math.log(step_of_error(samples, error, 1, bounds, lambda one: one.active_error))
    edge = 0.02 * (high - low)
    inside = low + edge < found < high - edge
    return found if inside and not is_late else (max(low, guess - 4) + min(high, guess + 4)) / 2
