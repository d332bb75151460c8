"""Coefficients of a chunk as bits: which cells are open, how finely each is quantised, and their levels."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Int

from mmweaver.compression.class_map import CLOSED, COARSE, FINE, ClassMapCoder
from mmweaver.compression.entropy import BitStream
from mmweaver.compression.level_coder import LevelCoder

Array = np.ndarray
ROUNDING = 0.36  # values are rounded up from 1 - ROUNDING: small levels cost more bits than they save distortion
PRICE = 0.11  # Lagrange multiplier: squared steps per bit
LOWERED = (0.5, 0.75, 0.9, 0.0)  # shares of levels that are tried in turn
ZERO_BITS, SIGN_AND_SIZE_BITS, OPEN_BITS = 0.35, 3.0, 3.0
FIRST_OCTAVES, FIRST_OCTAVE_BITS, OCTAVE_BITS = 2, 1.6, 1.25


@dataclass(frozen=True, kw_only=True)
class QuantizedCells:
    """Levels (part, beam, time, range, index), the classes of the cells, and the centroids of the levels."""

    levels: Int[Array, "2 beam time range index"]
    classes: Int[Array, "time range index"]
    centroids: tuple[int, int]  # mean offset of values from level 1, and from higher ones, in 1/256, plus 128

    def values(self, step: float, coarser: int) -> Complex[Array, "beam time range index"]:
        """The coefficients that a decoder has."""
        size = np.abs(self.levels)
        one, more = ((offset - 128) / 256 for offset in self.centroids)
        magnitude = size + np.where(size == 1, one, more)
        out = np.sign(self.levels) * magnitude * (step * np.where(self.classes == COARSE, coarser, 1))
        return out[0] + 1j * out[1]


def quantized(
    coefficients: Complex[Array, "beam time range index"],
    step: float,
    coarser: int,
    is_active: Array,
    price: float = PRICE,
) -> QuantizedCells:
    """Rate-distortion choice of the cells that are coded. Cells that are not active have `coarser` times the step.

    `coarser` 0: cells that are not active stay closed.

    `price`: squared steps that a bit must save; at 0 all cells are coded in which any level is not zero, above PRICE
    levels are lowered too.
    """
    own_step = np.where(is_active, step, step * (coarser or 1))
    parts = np.stack([np.real(coefficients), np.imag(coefficients)])
    parts /= own_step.astype(parts.dtype)
    magnitude = np.abs(parts)
    levels = np.floor(magnitude + magnitude.dtype.type(ROUNDING))
    if price > PRICE:
        levels = _lowered(magnitude, levels, price)
    is_open = _is_worthwhile(magnitude, levels, price) & levels.any(axis=(0, 1)) & (is_active | (coarser > 0))
    levels *= is_open
    centroids = _centroids(magnitude[:, :, is_open], levels[:, :, is_open])
    classes = np.where(is_open, np.where(is_active | (coarser <= 1), FINE, COARSE), CLOSED)
    return QuantizedCells(
        levels=np.where(parts < 0, -levels, levels).astype(np.int64), classes=classes.astype(np.int64),
        centroids=centroids,
    )  # fmt: skip


def code_cells(
    stream: BitStream, levels: Array, classes: Array, near: Array, correlated: tuple[bool, bool], coarser: int
) -> None:
    """Encodes levels and classes, or fills them in when decoding.

    `near`: strength of the nearest scatterer. `correlated`: see `LevelCoder`.
    """
    ClassMapCoder(classes.shape[2]).code(stream, classes, near)
    factor = np.where(classes == FINE, 1, coarser) * (classes > CLOSED)
    LevelCoder(levels.shape[1:], correlated).code(stream, levels, factor)


def _lowered(magnitude: Array, levels: Array, price: float) -> Array:
    """Levels lowered as far as each bit that this saves costs less error than `price`."""
    for share in LOWERED:
        lower = np.floor(levels * share)
        error = np.square(magnitude - lower) - np.square(magnitude - levels)
        levels = np.where(error < price * (approximate_bits(levels) - approximate_bits(lower)), lower, levels)
    return levels


def _is_worthwhile(magnitude: Array, levels: Array, price: float) -> Array:
    gain = np.sum(levels * (2 * magnitude - levels), axis=(0, 1))
    return gain > price * (np.sum(approximate_bits(levels), axis=(0, 1)) + OPEN_BITS)


def approximate_bits(levels: Array) -> Array:
    """Approximate bits of magnitudes in open cells."""
    octaves = np.log2(np.maximum(levels, 1))
    more = FIRST_OCTAVE_BITS * np.minimum(octaves, FIRST_OCTAVES) + OCTAVE_BITS * np.maximum(octaves - FIRST_OCTAVES, 0)
    return np.where(levels > 0, SIGN_AND_SIZE_BITS + more, ZERO_BITS)


def _centroids(magnitude: Array, levels: Array) -> tuple[int, int]:
    found = []
    for chosen in (levels == 1, levels > 1):
        mean = float((magnitude[chosen] - levels[chosen]).mean()) if chosen.any() else 0.0
        found.append(int(np.clip(round(mean * 256) + 128, 0, 255)))
    return found[0], found[1]
