"""Files of a step, coded or counted, and the step at which they would have a size or an error (encoder side)."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

from mmweaver.compression.cell_sample import STEPS_AN_OCTAVE, CellSample, Estimate
from mmweaver.compression.coded_chunk import CodedChunk

COUNT_AIM, AIM = 0.992, 0.996  # of the bytes allowed, for chunks that were counted, and for coded ones
FURTHEST = 8  # ratio of steps up to which an estimate is believed
LEAST_ERROR = 1e-30  # relative to the squared peak
USUAL_SLOPE, HALVED_EVERY = 0.12, 4  # of log(bytes) over the grid of estimates; trials of which one halves the range

Bounds = tuple[float, float]  # the finest and the coarsest step


@dataclass(frozen=True, kw_only=True)
class Found:
    """Chunks of a step, coded or counted."""

    coded: list[CodedChunk]
    step: float
    coarser: int
    noise_step: float = 0.0

    @cached_property
    def num_bytes(self) -> float:
        """Of all chunks."""
        return sum(chunk.num_bytes for chunk in self.coded)

    @property
    def active_error(self) -> float:
        """Energy of the error in active cells."""
        return sum(chunk.active_error for chunk in self.coded)

    @property
    def all_error(self) -> float:
        """Energy of the error in all cells."""
        return sum(chunk.all_error for chunk in self.coded)

    @property
    def badness(self) -> float:
        """Product of the errors in active and in all cells."""
        return self.active_error * self.all_error

    @cached_property
    def samples(self) -> list[CellSample]:
        """Of the chunks."""
        return [chunk.sample for chunk in self.coded]

    @property
    def bytes_factor(self) -> float:
        """Bytes in estimated ones."""
        return self.num_bytes / sum_at(self.samples, self.step, self.coarser).num_bytes

    def step_of_size(self, num_bytes: int | float, bounds: Bounds) -> float:
        """Where the estimate, calibrated by these chunks, has the size."""
        near = max(bounds[0], self.step / FURTHEST), min(bounds[1], self.step * FURTHEST)
        return step_of_size(self.samples, num_bytes / self.bytes_factor, self.coarser, near)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A file as it would be with the bytes allowed, by an estimate that counted chunks have calibrated."""

    found: Found
    step: float
    noise_step: float
    active_error: float
    all_error: float

    @classmethod
    def of(cls, found: Found, num_bytes: int | float, bounds: Bounds) -> "Plan":
        """Chunks like these, with so many bytes; their errors are infinite where they are larger at any step."""
        if found.num_bytes > num_bytes and found.step >= bounds[1]:
            return cls(found=found, step=found.step, noise_step=found.noise_step, active_error=math.inf,
                       all_error=math.inf)  # fmt: skip
        return cls.at(found, found.step_of_size(COUNT_AIM * num_bytes, bounds))

    @classmethod
    def at(cls, found: Found, step: float, noise_step: float | None = None, noise_error: float = 1.0) -> "Plan":
        """Chunks like these at other steps; `noise_error`: what the noise leaves, over what it leaves in these."""
        here, there = (sum_at(found.samples, one, found.coarser) for one in (found.step, step))
        active, every = there.active_error / here.active_error, noise_error * there.all_error / here.all_error
        if any(chunk.mode.with_rank for chunk in found.coded):  # what is left is the error of the factors
            active = every = (step / found.step) ** 2
        return cls(
            found=found, step=step, noise_step=found.noise_step if noise_step is None else noise_step,
            active_error=found.active_error * active, all_error=found.all_error * every,
        )  # fmt: skip

    @property
    def badness(self) -> float:
        """Product of the errors in active and in all cells."""
        return self.active_error * self.all_error

    def is_behind(self, other: "Plan", share: float) -> bool:
        """Whether `share` of the errors in active cells and of their product with those in all exceed another's."""
        return self.active_error * share > other.active_error and self.badness * share > other.badness


def sum_at(samples: list[CellSample], step: float, coarser: int) -> Estimate:
    """The estimate of several chunks together."""
    each = [sample.at(step, coarser) for sample in samples]
    return Estimate(
        num_bytes=sum(one.num_bytes for one in each), active_error=sum(one.active_error for one in each),
        all_error=sum(one.all_error for one in each),
    )  # fmt: skip


def step_of_size(samples: list[CellSample], num_bytes: int | float, coarser: int, bounds: Bounds) -> float:
    """The step at which chunks have so many bytes by the estimate."""

    def excess(step: float) -> float:
        return math.log(sum_at(samples, step, coarser).num_bytes / max(num_bytes, LEAST_ERROR))

    return _step_where(excess, *bounds, _known(samples, coarser))


def step_of_error(
    samples: list[CellSample], error: float, coarser: int, bounds: Bounds, error_of: Callable[[Estimate], float]
) -> float:
    """The step at which chunks have an error by the estimate."""

    def room(step: float) -> float:
        found = error_of(sum_at(samples, step, coarser))
        return math.log(max(error, LEAST_ERROR)) - math.log(max(found, LEAST_ERROR))  # an error may be infinite

    return _step_where(room, *bounds, _known(samples, coarser))


def _known(samples: list[CellSample], coarser: int) -> set[int]:
    """Where on the grid all samples have been estimated."""
    return set.intersection(*(sample.nodes(coarser) for sample in samples)) if samples else set()


def _step_where(excess: Callable[[float], float], finest: float, coarsest: float, known: Iterable[int]) -> float:
    """The step at which a falling function of it is zero: false position on the grid of estimates, then between two.

    `known`: where on the grid the function costs nothing.
    """
    low, high = (math.log2(bound) * STEPS_AN_OCTAVE for bound in (finest, coarsest))
    above, below = math.inf, -math.inf

    def probe(node: int) -> None:
        nonlocal low, above, high, below
        if low < node < high:
            here = excess(2 ** (node / STEPS_AN_OCTAVE))
            low, above, high, below = (node, here, high, below) if here > 0 else (low, above, node, here)

    for node in known:
        probe(node)
    trial = 0
    while (first := math.floor(low) + 1) <= (last := math.ceil(high) - 1):
        trial += 1
        if math.isinf(above - below) and not math.isinf(min(above, -below)):  # one side is known
            guess = low + above / USUAL_SLOPE + 1 if math.isinf(below) else high + below / USUAL_SLOPE - 1
        elif math.isinf(above) or trial % HALVED_EVERY == 0:
            guess = (low + high) / 2
        else:
            guess = low + (high - low) * above / (above - below)
        probe(min(max(round(guess), first), last))
    above = excess(2 ** (low / STEPS_AN_OCTAVE)) if above == math.inf else above
    below = excess(2 ** (high / STEPS_AN_OCTAVE)) if below == -math.inf else below
    if above <= 0 or below >= 0:
        return finest if above <= 0 else coarsest
    return 2 ** ((low + (high - low) * above / (above - below)) / STEPS_AN_OCTAVE)
