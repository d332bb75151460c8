"""Cells without signal after a DCT along range and Doppler, where few coefficients hold most of their noise.

An FFT window correlates the noise of neighbouring cells: its spectrum along them is the squared window. Signals would
be spread by a DCT, so that cells with signal are filled with what continues their neighbourhood.
"""

import struct
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Complex
from scipy import fft

from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.residual_stream import (
    USUAL_PRICE,
    Price,
    QuantizedCells,
    code_plain_cells,
    estimated_cell_bits,
    quantized,
)
from mmweaver.compression.transforms import dct_matrix

Array = np.ndarray
MOST_HOLES = 0.25  # share of active cells up to which they are filled
FLOORS = (0.3, 0.06, 0.015, 0.004)  # of the smoothing, relative to the largest power
HEADER = struct.Struct("<IfBB")  # bytes of the stream, step, centroids


@dataclass(frozen=True, kw_only=True)
class NoiseLayer:
    """`packed`, and the `values` (frame, range, doppler, antenna) that a decoder has.

    Where only its size was asked for, `packed` is empty, and `num_bytes` within some percent of what it would be.
    """

    packed: bytes
    num_bytes: float
    values: Complex[Array, "frame range doppler antenna"]

    @classmethod
    def of(
        cls,
        coefficients: Complex[Array, "beam frame range doppler"],
        step: float,
        beams: Complex[Array, "beam antenna"],
        price: Price = USUAL_PRICE,
        *,
        only_size: bool = False,
    ) -> "NoiseLayer":
        """The layer of what `to_noise` makes of values without signal, see `without_signal`, or of all."""
        step = float(np.float32(step))
        cells = quantized(coefficients, step, 1, np.ones(coefficients.shape[1:], bool), price)
        stream, values = Encoder(), from_noise(cells.values(step, 1), beams)
        if only_size:
            near = np.zeros_like(cells.classes)
            bits = estimated_cell_bits(cells.levels, cells.classes, near, (False, False), 1)
            return cls(packed=b"", num_bytes=HEADER.size + bits / 8, values=values)
        code_plain_cells(stream, cells.levels, cells.classes)
        data = stream.to_bytes()
        packed = HEADER.pack(len(data), step, *cells.centroids) + data
        return cls(packed=packed, num_bytes=float(len(packed)), values=values)

    @classmethod
    def unpack(
        cls,
        data: bytes,
        shape: tuple[int, int, int, int],
        beams: Complex[Array, "beam antenna"],
        *,
        version: int = Encoder.version,
    ) -> "NoiseLayer":
        """The layer of bytes that begin with `packed`. Raises ValueError for what no encoder writes."""
        size, step, one, more = HEADER.unpack_from(data)
        last = HEADER.size + size
        if last > len(data) or not 0 < step < np.inf:
            raise ValueError("impossible noise")
        classes = np.zeros(shape[:3], np.int64)
        levels = code_plain_cells(Decoder(data[HEADER.size : last], version=version), None, classes, shape[3])
        cells = QuantizedCells(levels=levels, classes=classes, centroids=(one, more))
        return cls(packed=data[:last], num_bytes=float(last), values=from_noise(cells.values(step, 1), beams))


def without_signal(
    values: Complex[Array, "frame range doppler antenna"], is_active: Bool[Array, "frame range doppler"]
) -> Complex[Array, "frame range doppler antenna"]:
    """Values whose active cells continue the noise around them: alternately smoothed, and the other cells put back."""
    holes = is_active[..., None]
    quiet = np.where(holes, 0, values).astype(np.complex64)
    if is_active.mean() > MOST_HOLES:
        return quiet
    matrices = [dct_matrix(num).astype(np.float32) for num in values.shape[1:3]]
    profiles = [np.cos(np.pi * np.arange(num) / (2 * num)) ** 4 for num in values.shape[1:3]]
    power = (profiles[0][:, None, None] * profiles[1][:, None]).astype(np.float32)
    gains = [power / (power + np.float32(floor)) for floor in FLOORS]
    for frame, is_hole in zip(quiet, is_active, strict=True):  # one at a time stays in the cache
        for gain in gains if is_hole.any() else []:
            smooth = _product(matrices, frame)
            smooth *= gain
            frame[is_hole] = _product([matrix.T for matrix in matrices], smooth)[is_hole]
    return quiet


def _product(matrices: list[Array], values: Complex[Array, "range doppler antenna"]) -> Array:
    """Values times a matrix along range and one along Doppler."""
    flat = matrices[0] @ values.view(np.float32).reshape(len(values), -1)
    return (matrices[1] @ flat.reshape(*values.shape[:2], -1)).view(np.complex64)


def to_noise(
    values: Complex[Array, "frame range doppler antenna"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "beam frame range doppler"]:
    """Coefficients of a DCT along frames, range and Doppler of each beam."""
    return _along(np.tensordot(beams.astype(values.dtype), values, axes=(1, 3)), fft.dctn, (1, 2, 3))


def from_noise(
    coefficients: Complex[Array, "beam frame range doppler"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "frame range doppler antenna"]:
    """The inverse of `to_noise`."""
    values = _along(coefficients, fft.idctn, (1, 2, 3))
    return np.moveaxis(np.tensordot(beams.conj().astype(coefficients.dtype), values, axes=(0, 0)), 0, 3)


def _along(values: Array, transform, axes: tuple[int, ...]) -> Array:
    """A real transform of a complex array; complex64 stays complex64."""
    real, imaginary = (transform(part, axes=axes, norm="ortho") for part in (np.real(values), np.imag(values)))
    return real + values.dtype.type(1j) * imaginary
