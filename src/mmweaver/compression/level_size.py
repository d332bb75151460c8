"""How many bits `LevelCoder` needs for levels, without coding them (encoder side).

The length of an adaptive code depends on the counts of its symbols alone, not on their order, so that a context's bits
follow from one histogram. Only the first of the coder's tables is counted, that of the size expected, whose bits are
within two percent of those of the mixture of all; and of many beams only some.
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float, Int

from mmweaver.compression.level_coder import (
    DIGITS,
    FAR,
    NUM_SIZES,
    NUM_TRENDS,
    OTHER,
    OWN,
    REAL,
    SIZE_BOUNDS,
    TREND_BOUNDS,
    WIDE,
    CellPlaces,
    LevelCoder,
    PhaseGroup,
    lattices_of,
    neighbour_axes,
    trend_of,
)
from mmweaver.compression.symbol_model import ESCAPE, HALF, SIZE, adaptive_bits, prior_of

Array = np.ndarray
ENOUGH_LEVELS = 30_000  # of which the bits of all are estimated
MIXED = 0.994  # bits of all tables mixed in those of one
EMPTY = 0.5  # of the levels of a beam in the mean: with fewer in those chosen, these do not tell those of all
ESCAPE_BITS = 2.5  # of an escaped level, besides those of its binary digits


def estimated_bits(
    coder: LevelCoder,
    levels: Int[Array, "2 beam cell"],
    factor: Int[Array, "time range doppler"],
    weights: Float[Array, "beam"],
) -> float:
    """Bits of the levels that `coder` would code with these factors.

    `weights`: about the bits of each beam, so that some beams tell those of all.
    """
    beams, num = levels.shape[1:]
    if not num:
        return 0.0
    chosen = np.arange(0, beams, max(1, min(beams, 2 * beams * num // ENOUGH_LEVELS)))
    filled = np.count_nonzero(levels, axis=(0, 2))
    if filled[chosen].mean() < EMPTY * filled.mean():  # levels are in a few other beams
        chosen = np.arange(beams)
    counts = np.zeros((NUM_SIZES * NUM_TRENDS, SIZE))
    low_bits = 0.0
    for contexts, symbols, low in _symbols(coder, levels, factor, chosen):
        counts += np.bincount(contexts * SIZE + symbols, minlength=counts.size).reshape(counts.shape)
        low_bits += low
    mirrored = counts[::NUM_TRENDS, :ESCAPE]  # where no trend is known, a number and its negative are learned alike
    mirrored[...] = (mirrored + mirrored[:, ::-1]) / 2
    more = beams / len(chosen)
    some = MIXED * adaptive_bits(counts * more, prior_of(coder.scales[0])) / more + low_bits
    return some * float(weights.sum() / max(weights[chosen].sum(), 1e-30))


def _symbols(coder: LevelCoder, levels: Array, factor: Array, chosen: Array) -> Iterator[tuple[Array, Array, float]]:
    """Contexts in the first table, symbols and uniform bits of the levels of some beams, phase by phase."""
    beams, num = levels.shape[1:]
    lattices = lattices_of(num, beams)
    margins = [lattices[0] if size > 1 else 0 for size in coder.shape[1:]]
    places = CellPlaces(factor, margins)
    factors = factor[factor > 0][:, None]
    size = np.zeros((num + 1, beams), np.int64)
    size[:-1] = np.abs(levels).sum(axis=0).T * factors
    before = _before(size, chosen)
    neighbours = [places.of(places.at, offset) for offset in neighbour_axes(margins)]
    wide = sum((before[cells] for cells in neighbours), np.zeros((num, len(chosen)), np.int64)) // 6
    planes = np.zeros((2, num + 1, len(chosen)), np.int64)
    planes[:, :-1] = levels[:, chosen].swapaxes(1, 2) * factors
    size = size[:, chosen]
    known_size, has_before = np.zeros_like(size), chosen > 0
    for group in coder.groups(places, lattices, has_all=False):
        total, weight = _known(group, known_size, before, wide, has_before)
        cells, own_factor = group.cells, group.factor[:, None]
        known_size[cells] = size[cells]
        real: Array | None = None
        for plane in planes:
            expected = (total + (8 * REAL * real if real is not None else 0)) // np.maximum(
                weight + REAL * (real is not None), 1
            )
            if real is None:
                expected = np.where(weight > 0, expected, 5)
            value = plane[cells] // own_factor
            trend = trend_of(plane, group)
            yield _counted(value, expected, None if trend is None else trend // own_factor)
            real = np.abs(value)


def _before(size: Array, chosen: Array) -> Array:
    """Magnitudes (cell, chosen beam) of the beams that are known before each, as `LevelCoder` averages them."""
    out, mean = np.zeros((len(size), len(chosen)), np.int64), np.zeros(len(size), np.int64)
    passes, first = LevelCoder.passes(size.shape[1], len(size) - 1), 0
    for last in passes:
        out[:, (chosen >= first) & (chosen < last)] = mean[:, None]
        for beam in range(first, last):
            mean = (size[:, beam] + mean) // 2 if beam else size[:, beam]
        first = last
    return out


def _known(group: PhaseGroup, size: Array, before: Array, wide: Array, has_before: Array) -> tuple[Array, Array]:
    """Weighted sum (cell, beam) of what is known about the size in eighths of a level, and its weights."""
    cells, factor = group.cells, group.factor[:, None]
    total = np.where(has_before, OTHER * (4 * before[cells] // factor) + WIDE * (4 * wide[cells] // factor), 0)
    weight = np.where(has_before, OTHER + WIDE, 0)
    if group.around:
        around = sum(share * size[places] for share, places in group.around)
        total += OWN * (4 * around // (sum(share for share, _ in group.around) * factor))
        weight = weight + OWN
    return total, weight


def _counted(value: Array, expected: Array, trend: Array | None) -> tuple[Array, Array, float]:
    low_bits, by_trend = 0.0, 0
    if trend is not None:
        towards = np.abs(trend)
        is_far = towards >= FAR
        by_trend = np.where(is_far, NUM_TRENDS - 1, TREND_BOUNDS.searchsorted(towards, "right"))
        value = value * np.where(trend < 0, -1, 1) - np.where(is_far, (towards + 4) // 8, 0)
    if int(expected.max()) >> 3 >= 1 << DIGITS:
        digits = np.frexp(np.maximum(expected >> 3, 1).astype(np.float64))[1].astype(np.int64)
        shift = np.maximum(digits - DIGITS, 0)
        value, expected, low_bits = (value + ((1 << shift) >> 1)) >> shift, expected >> shift, float(shift.sum())
    far = np.abs(value) > HALF
    if far.any():
        low_bits += float(np.sum(np.log2(np.abs(value[far]) + 1.0) + ESCAPE_BITS))
    symbols = np.where(far, ESCAPE, value + HALF)
    contexts = SIZE_BOUNDS.searchsorted(expected, "right") * NUM_TRENDS + by_trend
    return contexts.ravel(), symbols.ravel(), low_bits
