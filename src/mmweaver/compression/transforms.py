"""Unitary transforms of a residual: antennas to beams, and a DCT over frames at zero Doppler."""

import numpy as np
from jaxtyping import Complex, Float

from mmweaver.fields.beams import beams_of as beams_of

Array = np.ndarray
STATIC_BINS = 1  # Doppler bins on either side of zero that static clutter fills


def dct_matrix(num: int) -> Float[Array, "num num"]:
    """The orthonormal DCT-II.

    >>> bool(np.allclose(dct_matrix(5) @ dct_matrix(5).T, np.eye(5)))
    True
    """
    index = np.arange(num)
    matrix = np.cos(np.pi * (index[None] + 0.5) * index[:, None] / num) * np.sqrt(2 / num)
    matrix[0] /= np.sqrt(2)
    return matrix


def to_coefficients(
    residual: Complex[Array, "frame range doppler antenna"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "beam frame range doppler"]:
    """Transforms antennas to beams and, in the static Doppler bins, frames to DCT coefficients."""
    values = np.tensordot(beams, residual, axes=(1, 3))
    return _transform_static(values, dct_matrix(values.shape[1]))


def from_coefficients(
    values: Complex[Array, "beam frame range doppler"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "frame range doppler antenna"]:
    """The inverse of `to_coefficients`."""
    values = _transform_static(values.copy(), dct_matrix(values.shape[1]).T)
    return np.moveaxis(np.tensordot(beams.conj(), values, axes=(0, 0)), 0, 3)


def static_bins(num_doppler: int) -> slice:
    """Doppler cells that static clutter fills."""
    middle = num_doppler // 2
    return slice(max(0, middle - STATIC_BINS), middle + STATIC_BINS + 1)


def _transform_static(values: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    static = static_bins(values.shape[3])
    values[..., static] = np.einsum("ts,bsrd->btrd", matrix, values[..., static], optimize=True)
    return values
