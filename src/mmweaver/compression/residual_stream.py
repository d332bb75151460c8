"""Coefficients of a chunk as bits: which cells are open, how finely each is quantised, and their levels."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float, Int

from mmweaver.compression.class_map import CLOSED, COARSE, FINE, ClassMapCoder
from mmweaver.compression.entropy import BitStream, Encoder
from mmweaver.compression.level_coder import LevelCoder
from mmweaver.compression.level_size import estimated_bits

Array = np.ndarray
ROUNDING = 0.36  # values are rounded up from 1 - ROUNDING: small levels cost more bits than they save distortion
PRICE = 0.11  # Lagrange multiplier: squared steps per bit
GOLDEN = 0.6180339887498949  # multiples of it, modulo 1, are spread evenly
SLIGHTLY_LESS = 0.999  # for roundings of float32
LOWERED = (0.5, 0.75, 0.9, 0.0)  # shares of levels that are tried in turn
ZERO_BITS, SIGN_AND_SIZE_BITS, OPEN_BITS = 0.35, 3.0, 3.0
FIRST_OCTAVES, FIRST_OCTAVE_BITS, OCTAVE_BITS = 2, 1.6, 1.25


@dataclass(frozen=True)
class Price:
    """Squared steps that a bit must save: `dear` in a `share` of the cells, evenly spread, and `usual` in the others.

    At 0 all cells are coded in which any level is not zero, above PRICE levels are lowered too.
    """

    usual: float = PRICE
    dear: float = PRICE
    share: float = 0.0

    def of_cells(self, cells: Int[Array, "cell"]) -> Array:
        """The price (cell, 1) in each of some cells, given by their indices; (1, 1) where it is the same in all."""
        usual, dear = np.float32(self.usual), np.float32(self.dear)
        return np.where(cells * GOLDEN % 1 < self.share, dear, usual)[:, None] if self.share else np.full((1, 1), usual)


USUAL_PRICE = Price()


@dataclass(frozen=True, kw_only=True)
class QuantizedCells:
    """Levels (part, beam, cell) of the open cells, the classes of all, and the centroids of the levels."""

    levels: Int[Array, "2 beam cell"]
    classes: Int[Array, "time range index"]
    centroids: tuple[int, int]  # mean offset of values from level 1, and from higher ones, in 1/256, plus 128

    def open_values(self, step: float, coarser: int) -> Complex[Array, "beam cell"]:
        """The coefficients of the open cells that a decoder has."""
        size = np.abs(self.levels)
        one, more = ((offset - 128) / 256 for offset in self.centroids)
        magnitude = size + np.where(size == 1, one, more)
        classes = self.classes[self.classes > CLOSED]
        out = np.sign(self.levels) * magnitude * (step * np.where(classes == COARSE, coarser, 1))
        return out[0] + 1j * out[1]

    def values(self, step: float, coarser: int) -> Complex[Array, "beam time range index"]:
        """The coefficients that a decoder has, complex64."""
        out = np.zeros((self.levels.shape[1], *self.classes.shape), np.complex64)
        out[:, self.classes > CLOSED] = self.open_values(step, coarser)
        return out


def cell_energy(values: Complex[Array, "beam *cells"]) -> Float[Array, "*cells"]:
    """Energy of each cell in all beams."""
    return sum(np.square(beam.real) + np.square(beam.imag) for beam in values)


def quantized(
    coefficients: Complex[Array, "beam time range index"],
    step: float,
    coarser: int,
    is_active: Array,
    price: Price = USUAL_PRICE,
    energy: Array | None = None,
) -> QuantizedCells:
    """Rate-distortion choice of the cells that are coded. Cells that are not active have `coarser` times the step.

    `coarser` 0: cells that are not active stay closed.

    `energy`: that of the cells, if known.
    """
    energy = cell_energy(coefficients) if energy is None else energy
    own_step = np.where(is_active, step, step * (coarser or 1))
    # most cells have less energy than their least level
    is_open = (energy >= SLIGHTLY_LESS * ((1 - ROUNDING) * own_step) ** 2) & (is_active | (coarser > 0))
    cells = np.flatnonzero(is_open)
    # (beam, cell, part), as in memory
    parts = coefficients.reshape(len(coefficients), -1).take(cells, axis=1)
    parts = parts.view(parts.real.dtype).reshape(*parts.shape, 2)
    parts /= own_step.ravel()[cells, None].astype(parts.dtype)
    magnitude = np.abs(parts)
    levels = magnitude + magnitude.dtype.type(ROUNDING)
    np.floor(levels, out=levels)
    prices = price.of_cells(cells)
    if price.dear > PRICE:
        levels = _lowered(magnitude, levels, prices)
    worth = np.flatnonzero(_is_worthwhile(magnitude, levels, prices[:, 0]))
    if len(worth) < len(cells):
        parts, magnitude, levels = (values.take(worth, axis=1) for values in (parts, magnitude, levels))
    is_open = np.zeros(is_active.shape, bool)
    is_open.flat[cells[worth]] = True
    centroids = _centroids(magnitude, levels)
    return QuantizedCells(
        levels=np.moveaxis(np.copysign(levels, parts, out=parts), 2, 0).astype(np.int64, order="C"),
        classes=np.where(is_open, np.where(is_active | (coarser <= 1), FINE, COARSE), CLOSED),
        centroids=centroids,
    )


def code_cells(
    stream: BitStream,
    levels: Array | None,
    classes: Array,
    near: Array,
    correlated: tuple[bool, bool],
    coarser: int,
    num_beams: int = 0,
) -> Array:
    """Encodes levels and classes; with None for levels, fills in the classes and returns the levels of so many beams.

    `near`: strength of the nearest scatterer. `correlated`: see `LevelCoder`.
    """
    ClassMapCoder(classes.shape[2]).code(stream, classes, near)
    if levels is None:
        levels = np.zeros((2, num_beams, np.count_nonzero(classes)), np.int64)
    factor = np.where(classes == FINE, 1, coarser) * (classes > CLOSED)
    LevelCoder((levels.shape[1], *classes.shape), correlated).code(stream, levels, factor)
    return levels


def estimated_cell_bits(
    levels: Array, classes: Array, near: Array, correlated: tuple[bool, bool], coarser: int
) -> float:
    """About the bits of what `code_cells` would code; only the classes are."""
    stream = Encoder()
    ClassMapCoder(classes.shape[2]).code(stream, classes, near)
    factor = np.where(classes == FINE, 1, coarser) * (classes > CLOSED)
    coder = LevelCoder((levels.shape[1], *classes.shape), correlated)
    weights = approximate_bits(np.abs(levels)).sum(axis=(0, 2))
    return 8 * len(stream.to_bytes()) + estimated_bits(coder, levels, factor, weights)


def code_plain_cells(stream: BitStream, levels: Array | None, classes: Array, num_beams: int = 0) -> Array:
    """The same of cells without scatterers near, without correlation, and with one step."""
    return code_cells(stream, levels, classes, np.zeros_like(classes), (False, False), 1, num_beams)


def _lowered(magnitude: Array, levels: Array, price: Array) -> Array:
    """Levels lowered as far as each bit that this saves costs less error than `price`."""
    for share in LOWERED:
        lower = np.floor(levels * share)
        error = np.square(magnitude - lower) - np.square(magnitude - levels)
        levels = np.where(error < price * (approximate_bits(levels) - approximate_bits(lower)), lower, levels)
    return levels


def _is_worthwhile(magnitude: Array, levels: Array, price: Array) -> Array:
    """Whether cells (cell,) of levels (beam, cell, part) save as much error as their bits are worth; not empty ones."""
    saved = magnitude + magnitude
    saved -= levels
    saved *= levels
    saved, bits = (values.sum(axis=0).sum(axis=1) for values in (saved, approximate_bits(levels)))
    return (saved > price * (bits + OPEN_BITS)) & (saved > 0)


def approximate_bits(levels: Array) -> Array:
    """Approximate bits of magnitudes in open cells."""
    most = len(BITS_OF_LEVEL) - 1
    if levels.max(initial=0) < most:
        return BITS_OF_LEVEL.take(levels.astype(np.intp), mode="clip")  # without a check of each
    bits = BITS_OF_LEVEL.take(np.minimum(levels, most).astype(np.intp))
    is_large = levels >= most
    bits[is_large] = _bits_of(levels[is_large])
    return bits


def _bits_of(levels: Array) -> Array:
    octaves = np.log2(np.maximum(levels, 1))
    more = FIRST_OCTAVE_BITS * np.minimum(octaves, FIRST_OCTAVES) + OCTAVE_BITS * np.maximum(octaves - FIRST_OCTAVES, 0)
    return np.where(levels > 0, SIGN_AND_SIZE_BITS + more, ZERO_BITS)


BITS_OF_LEVEL = _bits_of(np.arange(256)).astype(np.float32)


def _centroids(magnitude: Array, levels: Array) -> tuple[int, int]:
    """Mean offset of values from level 1, and from higher ones, in 1/256, plus 128."""
    offset = magnitude - levels
    is_one, is_more = levels == 1, levels > 1
    found = []
    for chosen in (is_one, is_more):
        num = np.count_nonzero(chosen)
        mean = float(np.vdot(offset, chosen.astype(offset.dtype))) / num if num else 0.0
        found.append(int(np.clip(round(mean * 256) + 128, 0, 255)))
    return found[0], found[1]
