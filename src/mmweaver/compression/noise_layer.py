"""Cells without signal, coded after a DCT along frames, range and Doppler, which concentrates their noise.

An FFT window correlates the noise of neighbouring cells: its spectrum along them is the squared window. A DCT would
spread signals, so cells with signal are filled with a continuation of their neighbourhood.
"""

import struct
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Complex
from scipy import fft

from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.quantised_cells import QuantisedCells, code_cells, quantise
from mmweaver.compression.transforms import dct_matrix

Array = np.ndarray
MAX_FILLED = 0.25  # share of active cells up to which they are filled
FLOORS = (0.3, 0.06, 0.015, 0.004)  # regularisation of each smoothing, relative to the largest power
HEADER = struct.Struct("<IfBB")  # bytes of the stream, step, centroids


@dataclass(frozen=True, kw_only=True)
class NoiseLayer:
    """`packed` bytes, and the `values` (frame, range, doppler, antenna) that they decode to."""

    packed: bytes
    values: Complex[Array, "frame range doppler antenna"]

    @classmethod
    def of(
        cls,
        coefficients: Complex[Array, "beam frame range doppler"],
        step: float,
        beams: Complex[Array, "beam antenna"],
    ) -> "NoiseLayer":
        """Encodes coefficients.

        Args:
            coefficients: As given by `to_noise`, (beam, frame, range, doppler).
            step: Quantisation step.
            beams: Unitary matrix (beam, antenna).
        """
        step = float(np.float32(step))
        cells = quantise(coefficients, step, 1, np.ones(coefficients.shape[1:], bool))
        stream = Encoder()
        code_cells(stream, cells.levels, cells.classes)
        data = stream.to_bytes()
        packed = HEADER.pack(len(data), step, *cells.centroids) + data
        return cls(packed=packed, values=from_noise(cells.values(step, 1), beams))

    @classmethod
    def unpack(
        cls, data: bytes, shape: tuple[int, ...], beams: Complex[Array, "beam antenna"], version: int
    ) -> "NoiseLayer":
        """Decodes bytes that begin with `packed`.

        Args:
            data: The bytes.
            shape: Shape (frame, range, doppler, antenna).
            beams: Unitary matrix (beam, antenna).
            version: Version of the .mmw format.

        Raises:
            ValueError: For bytes that no encoder writes.
        """
        size, step, one, more = HEADER.unpack_from(data)
        last = HEADER.size + size
        if last > len(data) or not 0 < step < np.inf:
            raise ValueError("impossible noise")
        classes = np.zeros(shape[:3], np.int64)
        stream = Decoder(data[HEADER.size : last], version=version)
        levels = code_cells(stream, None, classes, num_beams=shape[3])
        cells = QuantisedCells(levels=levels, classes=classes, centroids=(one, more))
        return cls(packed=data[:last], values=from_noise(cells.values(step, 1), beams))


def signal_filled(
    values: Complex[Array, "frame range doppler antenna"], is_active: Bool[Array, "frame range doppler"]
) -> Complex[Array, "frame range doppler antenna"]:
    """Replaces active cells by a continuation of the noise around them.

    Alternates between smoothing in the DCT domain and restoring the other cells.

    Args:
        values: Working frames (frame, range, doppler, antenna).
        is_active: Mask (frame, range, doppler) of the cells to replace; above MAX_FILLED they are set to zero.
    """
    quiet = np.where(is_active[..., None], 0, values).astype(np.complex64)
    if is_active.mean() > MAX_FILLED:
        return quiet
    by_range, by_doppler = (dct_matrix(num).astype(np.float32) for num in values.shape[1:3])
    profiles = [np.cos(np.pi * np.arange(num) / (2 * num)) ** 4 for num in values.shape[1:3]]
    power = (profiles[0][:, None, None] * profiles[1][:, None]).astype(np.float32)
    for frame, is_hole in zip(quiet, is_active, strict=True):  # one at a time fits into the cache
        for floor in FLOORS if is_hole.any() else ():
            smooth = _product(by_range, by_doppler, frame) * (power / (power + np.float32(floor)))
            frame[is_hole] = _product(by_range.T, by_doppler.T, smooth)[is_hole]
    return quiet


def _product(by_range: Array, by_doppler: Array, values: Complex[Array, "range doppler antenna"]) -> Array:
    """Values multiplied by a matrix along range and one along Doppler."""
    flat = by_range @ values.view(np.float32).reshape(len(values), -1)
    return (by_doppler @ flat.reshape(*values.shape[:2], -1)).view(np.complex64)


def to_noise(
    values: Complex[Array, "frame range doppler antenna"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "beam frame range doppler"]:
    """DCT coefficients along frames, range and Doppler of each beam.

    Args:
        values: Working frames (frame, range, doppler, antenna).
        beams: Unitary matrix (beam, antenna).

    Returns:
        Coefficients (beam, frame, range, doppler).
    """
    return _transformed(np.tensordot(beams.astype(values.dtype), values, axes=(1, 3)), fft.dctn)


def from_noise(
    coefficients: Complex[Array, "beam frame range doppler"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "frame range doppler antenna"]:
    """The inverse of `to_noise`.

    Args:
        coefficients: Coefficients (beam, frame, range, doppler).
        beams: Unitary matrix (beam, antenna).

    Returns:
        Working frames (frame, range, doppler, antenna).
    """
    values = _transformed(coefficients, fft.idctn)
    return np.moveaxis(np.tensordot(beams.conj().astype(coefficients.dtype), values, axes=(0, 0)), 0, 3)


def _transformed(values: Array, transform) -> Array:
    """A real transform of a complex array; complex64 stays complex64."""
    real, imaginary = (transform(part, axes=(1, 2, 3), norm="ortho") for part in (np.real(values), np.imag(values)))
    return real + values.dtype.type(1j) * imaginary
