"""Rate and distortion of quantised cells at any step, estimated from a sample of cells without coding."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mmweaver.compression.quantised_cells import OPEN_BITS, PRICE, ROUNDING, approximate_bits

Array = np.ndarray
NUM_STRONG, NUM_WEAK = 1536, 2560  # sampled cells: the strongest, and some of the others
NODES_PER_OCTAVE = 4  # steps per octave for which estimates are computed; others are interpolated
CONTEXT_GAIN = 0.8  # coded bits relative to `approximate_bits`, thanks to context modelling
TINY = 1e-30
COARSEST = 2.0**60  # step at which nothing is coded


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Bytes, and error energies in active cells and in all cells, in squared units of the coefficients."""

    num_bytes: float
    active_error: float
    all_error: float

    def cost(self, step: float, coarser: int) -> float:
        """Lagrangian cost of a coding.

        Args:
            step: Quantisation step.
            coarser: Step of cells without signal relative to that; their distortion is weighted by 1 / coarser².

        Returns:
            Weighted distortion plus the price of the rate.
        """
        weighted = self.active_error + (self.all_error - self.active_error) / max(coarser, 1) ** 2
        return weighted + PRICE * step**2 * 8 * self.num_bytes


@dataclass(frozen=True, kw_only=True)
class CellSample:
    """Coefficients of some cells, and the bytes of everything else that is coded.

    `front_bytes` hold at `front_step`; halving the step costs one more bit for each of `front_values`.
    """

    coefficients: Array  # (beam, cell)
    is_active: Array  # (cell,)
    weight: Array  # (cell,): number of cells that each represents
    front_bytes: int | float = 0
    front_values: int = 0
    front_step: float = 1.0
    magnitude: Array = field(init=False)  # (cell, number): real and imaginary parts of all beams
    _known: dict[tuple[int, bool], Array] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        parts = np.concatenate([self.coefficients.real, self.coefficients.imag])
        object.__setattr__(self, "magnitude", np.abs(parts).T.copy())

    @classmethod
    def of(cls, coefficients: Array, is_active: Array, **front: Any) -> "CellSample":
        """Samples cells: the strongest, and a regular choice of the others.

        Args:
            coefficients: Coefficients (beam, time, range, index).
            is_active: Mask (time, range, index).
            **front: The remaining fields.
        """
        flat, active = coefficients.reshape(len(coefficients), -1), is_active.reshape(-1)
        chosen, weight = np.arange(flat.shape[1]), np.ones(flat.shape[1])
        if len(chosen) > NUM_STRONG + NUM_WEAK:
            power = np.square(flat.real).sum(axis=0) + np.square(flat.imag).sum(axis=0)
            order = np.argpartition(-power, NUM_STRONG)
            strong, rest = order[:NUM_STRONG], np.sort(order[NUM_STRONG:])
            stride = max(1, len(rest) // NUM_WEAK)
            # shifted by one from stride to stride, so that the choice is not aligned with an axis
            places = np.arange(0, len(rest), stride) + np.arange(-(-len(rest) // stride)) % stride
            weak = rest[places[places < len(rest)]]
            chosen = np.concatenate([strong, weak])
            weight = np.concatenate([np.ones(len(strong)), np.full(len(weak), len(rest) / len(weak))])
        some = flat.take(chosen, axis=1)
        return cls(coefficients=some, is_active=active[chosen], weight=weight, **front)

    def rotated(self, matrix: Array, front_bytes: int | float) -> "CellSample":
        """The same cells after a unitary transform.

        Args:
            matrix: Transform (beam, beam).
            front_bytes: Bytes of everything else that is coded with it.
        """
        some = matrix.astype(self.coefficients.dtype) @ self.coefficients
        return replace(self, coefficients=some, front_bytes=front_bytes, _known={})

    def estimate(self, step: float, coarser: int) -> Estimate:
        """Bytes and errors at a step.

        Args:
            step: Step of active cells, in units of the coefficients.
            coarser: Step of the other cells relative to that; 0 leaves them uncoded.
        """
        active_bytes, active_error = self._part(step, is_active=True)
        other_bytes, other_error = self._part(step * coarser or math.inf, is_active=False)
        front = self.front_bytes + self.front_values / 8 * math.log2(self.front_step / step)
        return Estimate(
            num_bytes=max(front + active_bytes + other_bytes, 1.0),
            active_error=active_error,
            all_error=active_error + other_error,
        )

    def _part(self, step: float, *, is_active: bool) -> tuple[float, float]:
        """Bytes and error of the active cells, or of the others, interpolated between steps of a grid."""
        place = math.log2(min(step, COARSEST)) * NODES_PER_OCTAVE
        below = math.floor(place)
        share = place - below
        logs = self._node(below, is_active) * (1 - share)
        if share:
            logs = logs + self._node(below + 1, is_active) * share
        num_bytes, error = np.exp(logs).tolist()
        return num_bytes, error

    def _node(self, node: int, is_active: bool) -> Array:
        if (node, is_active) not in self._known:
            chosen = self.is_active == is_active
            found = _estimated(self.magnitude[chosen], self.weight[chosen], 2.0 ** (node / NODES_PER_OCTAVE))
            self._known[node, is_active] = np.log(np.maximum(found, TINY))
        return self._known[node, is_active]


def _estimated(magnitude: Array, weight: Array, step: float) -> tuple[float, float]:
    """Bytes and error of cells of magnitudes (cell, number), quantised as in `quantised_cells.quantise`."""
    error = np.square(magnitude).sum(axis=1, dtype=np.float64) * weight
    cells = np.flatnonzero(magnitude.max(axis=1, initial=0) >= (1 - ROUNDING) * step)
    magnitude, weight = magnitude[cells] / np.float32(step), weight[cells]
    levels = np.floor(magnitude + np.float32(ROUNDING))
    rest = magnitude - levels
    bits = approximate_bits(levels).sum(axis=1) + OPEN_BITS
    is_open = np.sum(levels * (magnitude + rest), axis=1) > PRICE * bits
    error[cells] = np.where(is_open, np.square(rest).sum(axis=1) * step**2 * weight, error[cells])
    return CONTEXT_GAIN / 8 * float(np.sum(bits * is_open * weight)), float(error.sum())
