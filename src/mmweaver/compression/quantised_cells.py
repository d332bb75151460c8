"""Quantisation of a chunk's coefficients: which cells are open, how finely each is quantised, and their levels.

Cells that contain signal (encoder side).

Unitary transform of the array's antennas to beams.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float, Int

from mmweaver.compression.cell_coder import CLOSED, COARSE, FINE, ClassMapCoder, LevelCoder
from mmweaver.compression.entropy import BitStream
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.shapes import CubeValues, RangeDopplerMask
from mmweaver.core.virtual_array import SAME_PLACE_WAVELENGTHS


def beams_of(config: RadarConfig) -> Complex[np.ndarray, "beam antenna"]:
    """Unitary beamforming matrix: a DFT per row of the array, boresight in the middle, rows from low to high.

    Args:
        config: The radar, for its antenna positions.

    Returns:
        Matrix (beam, antenna), complex128.
    """
    position_m = config.antenna_position_m
    height = np.round(position_m[:, 2] / (SAME_PLACE_WAVELENGTHS * config.wavelength_m))
    beams = np.zeros((config.num_antennas, config.num_antennas), complex)
    first = 0
    for level in np.unique(height):
        row = np.flatnonzero(height == level)
        row = row[np.argsort(position_m[row, 0], kind="stable")]
        num = len(row)
        cycles = np.outer(np.arange(num) - num // 2, np.arange(num)) / num
        beams[first : first + num, row] = np.exp(-2j * np.pi * cycles) / np.sqrt(num)
        first += num
    return beams


ACTIVE_DB = 12.0  # above the noise floor, as in metrics.cells


def active_mask(values: CubeValues, min_power: float | None = None) -> RangeDopplerMask:
    """Marks the cells that contain signal.

    Args:
        values: Cube (frame, range, doppler, antenna).
        min_power: Threshold on the power averaged over the antennas; by default 12 dB above its median.

    Returns:
        Mask (frame, range, doppler); all cells where none exceeds the threshold.
    """
    power = cell_power(values)
    is_active = power > (active_power(power) if min_power is None else min_power)
    return is_active if is_active.any() else np.ones_like(is_active)


def cell_power(values: CubeValues) -> np.ndarray:
    """Antenna-averaged power (frame, range, doppler), float64, since squares of 1e-30 underflow in float32."""
    return np.mean(np.square(values.real, dtype=np.float64) + np.square(values.imag, dtype=np.float64), axis=-1)


def active_power(power: np.ndarray) -> float:
    """Threshold 12 dB above the median of cell powers.

    Cells that are exactly zero, such as Doppler bins missing from a file, are excluded from the median.
    """
    some = power[power > 0]
    return float(np.median(some) if len(some) else 0.0) * 10 ** (ACTIVE_DB / 10)


Array = np.ndarray
ROUNDING = 0.36  # values are rounded up from 1 - ROUNDING: small levels cost more bits than they save distortion
# Lagrange multiplier: squared steps of distortion that a bit must save. A uniform quantiser has D = step² / 12, and D
# falls by a factor of four per bit, so -dD/dR = 2 ln 2 / 12.
PRICE = 0.11
FLOAT32_MARGIN = 0.999
ZERO_BITS, SIGN_AND_SIZE_BITS, OPEN_BITS = 0.35, 3.0, 3.0
FIRST_OCTAVES, FIRST_OCTAVE_BITS, OCTAVE_BITS = 2, 1.6, 1.25


@dataclass(frozen=True, kw_only=True)
class QuantisedCells:
    """Levels (part, beam, cell) of the open cells, the classes of all, and the centroids of the levels."""

    levels: Int[Array, "2 beam cell"]
    classes: Int[Array, "time range index"]
    centroids: tuple[int, int]  # mean offset of values from level 1, and from higher ones, in 1/256, plus 128

    def values(self, step: float, coarser: int) -> Complex[Array, "beam time range index"]:
        """The coefficients that these levels decode to.

        Args:
            step: Quantisation step of fine cells.
            coarser: Step of coarse cells relative to that.

        Returns:
            Coefficients (beam, time, range, index), complex64.
        """
        size = np.abs(self.levels)
        one, more = ((offset - 128) / 256 for offset in self.centroids)
        magnitude = size + np.where(size == 1, one, more)
        is_open = self.classes > CLOSED
        parts = np.sign(self.levels) * magnitude * (step * np.where(self.classes[is_open] == COARSE, coarser, 1))
        out = np.zeros((self.levels.shape[1], *self.classes.shape), np.complex64)
        out[:, is_open] = parts[0] + 1j * parts[1]
        return out


def quantise(
    coefficients: Complex[Array, "beam time range index"], step: float, coarser: int, is_active: Array
) -> QuantisedCells:
    """Quantises coefficients, and opens the cells that are worth their bits.

    Args:
        coefficients: Coefficients (beam, time, range, index).
        step: Step of the active cells.
        coarser: Step of the other cells relative to that; 0 leaves them closed.
        is_active: Mask (time, range, index).
    """
    energy = cell_energy(coefficients)
    own_step = np.where(is_active, step, step * (coarser or 1))
    # most cells have less energy than their lowest level
    is_open = (energy >= FLOAT32_MARGIN * ((1 - ROUNDING) * own_step) ** 2) & (is_active | (coarser > 0))
    cells = np.flatnonzero(is_open)
    # (beam, cell, part), as in memory
    parts = coefficients.reshape(len(coefficients), -1).take(cells, axis=1)
    parts = parts.view(parts.real.dtype).reshape(*parts.shape, 2)
    parts /= own_step.ravel()[cells, None].astype(parts.dtype)
    magnitude = np.abs(parts)
    levels = magnitude + magnitude.dtype.type(ROUNDING)
    np.floor(levels, out=levels)
    worth = np.flatnonzero(_is_worthwhile(magnitude, levels))
    if len(worth) < len(cells):
        parts, magnitude, levels = (values.take(worth, axis=1) for values in (parts, magnitude, levels))
    is_open = np.zeros(is_active.shape, bool)
    is_open.flat[cells[worth]] = True
    centroids = _centroids(magnitude, levels)
    return QuantisedCells(
        levels=np.moveaxis(np.copysign(levels, parts, out=parts), 2, 0).astype(np.int64, order="C"),
        classes=np.where(is_open, np.where(is_active | (coarser <= 1), FINE, COARSE), CLOSED),
        centroids=centroids,
    )


def code_cells(
    stream: BitStream,
    levels: Array | None,
    classes: Array,
    near: Array | None = None,
    correlated: tuple[bool, bool] = (False, False),
    coarser: int = 1,
    num_beams: int = 0,
) -> Array:
    """Encodes classes and levels, or decodes them.

    Args:
        stream: Encoder or decoder.
        levels: Levels (part, beam, cell) of the open cells; None when decoding.
        classes: Classes (time, range, index), filled in when decoding.
        near: Strength of the nearest scatterer (time, range, index); None without scatterers.
        correlated: Whether neighbours along range and along Doppler predict each other's sign.
        coarser: Step of coarse cells in fine steps.
        num_beams: Number of beams of the levels, when decoding.

    Returns:
        The levels.
    """
    near = np.zeros_like(classes) if near is None else near
    ClassMapCoder(classes.shape[2]).code(stream, classes, near)
    if levels is None:
        levels = np.zeros((2, num_beams, np.count_nonzero(classes)), np.int64)
    factor = np.where(classes == FINE, 1, coarser) * (classes > CLOSED)
    LevelCoder((levels.shape[1], *classes.shape), correlated).code(stream, levels, factor)
    return levels


def cell_energy(values: Complex[Array, "beam *cells"]) -> Float[Array, "*cells"]:
    """Energy of each cell, summed over all beams."""
    return sum(np.square(beam.real) + np.square(beam.imag) for beam in values)


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


def _is_worthwhile(magnitude: Array, levels: Array) -> Array:
    """Whether cells (cell,) of levels (beam, cell, part) reduce the error enough for their bits; empty ones do not."""
    saved = levels * (2 * magnitude - levels)
    saved, bits = (values.sum(axis=0).sum(axis=1) for values in (saved, approximate_bits(levels)))
    return (saved > PRICE * (bits + OPEN_BITS)) & (saved > 0)


def _centroids(magnitude: Array, levels: Array) -> tuple[int, int]:
    """Mean offset of values from level 1, and from higher ones, in 1/256, plus 128."""
    offset = magnitude - levels
    found = []
    for chosen in (levels == 1, levels > 1):
        num = np.count_nonzero(chosen)
        mean = float(np.vdot(offset, chosen.astype(offset.dtype))) / num if num else 0.0
        found.append(int(np.clip(round(mean * 256) + 128, 0, 255)))
    return found[0], found[1]
