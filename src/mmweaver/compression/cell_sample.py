"""What cells would cost at any step, estimated from some of them and without coding (encoder side)."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mmweaver.compression.residual_stream import OPEN_BITS, PRICE, ROUNDING, approximate_bits

Array = np.ndarray
NUM_STRONG, NUM_WEAK = 1536, 2560  # sampled cells: the strongest, and some of the others
STEPS_AN_OCTAVE = 4  # for which estimates are made
ON_GRID = 1e-6
LEAST = 1e-30
SHORTER = 0.8  # coded bits in estimated ones


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Bytes, and energies of the error in active cells and in all, in the units of the coefficients."""

    num_bytes: float
    active_error: float
    all_error: float

    def cost(self, step: float, coarser: int) -> float:
        """As `CodedChunk.cost`."""
        weighted = self.active_error + (self.all_error - self.active_error) / max(coarser, 1) ** 2
        return weighted + PRICE * step**2 * 8 * self.num_bytes


def _magnitude(coefficients: Array) -> Array:
    """(beam, cell) -> (cell, number)."""
    return np.abs(np.concatenate([coefficients.real, coefficients.imag])).T.copy()


@dataclass(frozen=True, kw_only=True)
class CellSample:
    """Coefficients of some cells, and what is coded besides cells.

    That is `front_bytes` at `front_step`, with so many values of which each costs a bit more where the step is halved.
    """

    magnitude: Array  # (cell, number) float32: of real and imaginary parts of all beams
    is_active: Array  # (cell,)
    weight: Array  # (cell,): how many cells each stands for
    front_bytes: int | float = 0
    front_values: int = 0
    front_step: float = 1.0
    coefficients: Array | None = None  # (beam, cell)
    largest: Array = field(init=False)  # (cell,) magnitude
    energy: Array = field(init=False)  # (cell,)
    _known: dict[tuple[int, int], tuple[float, float, float]] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "largest", self.magnitude.max(axis=1, initial=0))
        object.__setattr__(self, "energy", np.square(self.magnitude).sum(axis=1))

    @classmethod
    def of(cls, coefficients: Array, is_active: Array, front_bytes: int | float = 0, **front: Any) -> "CellSample":
        """A sample of coefficients (beam, time, range, index); all of the strongest cells are in it."""
        flat, active = coefficients.reshape(len(coefficients), -1), is_active.reshape(-1)
        chosen, weight = np.arange(flat.shape[1]), np.ones(flat.shape[1])
        if len(chosen) > NUM_STRONG + NUM_WEAK:
            power = np.square(flat.real).sum(axis=0) + np.square(flat.imag).sum(axis=0)
            order = np.argpartition(-power, NUM_STRONG)
            strong, rest = order[:NUM_STRONG], np.sort(order[NUM_STRONG:])
            # a stride without common factors with the axes
            stride = max(1, len(rest) // NUM_WEAK)
            places = np.arange(0, len(rest), stride) + np.arange(-(-len(rest) // stride)) % stride
            weak = rest[places[places < len(rest)]]
            chosen = np.concatenate([strong, weak])
            weight = np.concatenate([np.ones(len(strong)), np.full(len(weak), len(rest) / len(weak))])
        some = flat.take(chosen, axis=1)
        return cls(
            magnitude=_magnitude(some), is_active=active[chosen], weight=weight, front_bytes=front_bytes,
            coefficients=some, **front,
        )  # fmt: skip

    def turned(self, matrix: Array, front_bytes: int | float) -> "CellSample":
        """The same cells after a unitary transform (beam, beam) of their coefficients."""
        assert self.coefficients is not None
        some = matrix.astype(self.coefficients.dtype) @ self.coefficients
        return replace(self, magnitude=_magnitude(some), coefficients=some, front_bytes=front_bytes, _known={})

    def front_at(self, step: float) -> float:
        """Bytes of what is coded besides cells."""
        return self.front_bytes + self.front_values / 8 * math.log2(self.front_step / step)

    def at(self, step: float, coarser: int) -> Estimate:
        """The estimate for a step; cells that are not active have `coarser` times that.

        Searches ask for many steps near each other, so it is interpolated between steps of a fixed grid.
        """
        place = math.log2(step) * STEPS_AN_OCTAVE
        below = math.floor(place + ON_GRID)
        share = max(place - below, 0.0)
        first = self._at_node(below, coarser)
        second = first if share < ON_GRID else self._at_node(below + 1, coarser)
        cells, active_error, all_error = (
            one ** (1 - share) * two**share for one, two in zip(first, second, strict=True)
        )
        return Estimate(num_bytes=max(self.front_at(step) + cells, 1.0), active_error=active_error, all_error=all_error)

    def nodes(self, coarser: int) -> set[int]:
        """Where on the grid there are estimates already."""
        return {node for node, other in self._known if other == coarser}

    def _at_node(self, node: int, coarser: int) -> tuple[float, float, float]:
        if (node, coarser) not in self._known:
            self._known[node, coarser] = self._estimated(2.0 ** (node / STEPS_AN_OCTAVE), coarser)
        return self._known[node, coarser]

    def _estimated(self, step: float, coarser: int) -> tuple[float, float, float]:
        """Bytes of the cells, and the errors in active cells and in all; all above zero."""
        own_step = np.where(self.is_active, step, step * (coarser or 1)).astype(self.magnitude.dtype)
        may_open = (self.largest >= (1 - ROUNDING) * own_step) & (self.is_active | (coarser > 0))
        cells = np.flatnonzero(may_open)  # at most steps few of all
        own, weight = own_step[cells, None], self.weight[cells]
        magnitude = self.magnitude[cells] / own
        levels = np.floor(magnitude + np.float32(ROUNDING))
        bits = approximate_bits(levels).sum(axis=1) + OPEN_BITS
        rest = magnitude - levels
        is_open = np.sum(levels * (magnitude + rest), axis=1) > PRICE * bits
        error = self.energy * self.weight
        rest = np.square(rest).sum(axis=1) * own[:, 0].astype(np.float64) ** 2
        error[cells] = np.where(is_open, rest * weight, error[cells])
        num_bytes = SHORTER / 8 * float(np.sum(bits * is_open * weight))
        return num_bytes + LEAST, float(error[self.is_active].sum()) + LEAST, float(error.sum()) + LEAST
