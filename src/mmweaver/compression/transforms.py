"""Unitary transforms of a residual: antennas -> beams, and frames -> their cosine transform where nothing moves."""

import numpy as np
from jaxtyping import Complex, Float

from mmweaver.fields.beams import beams_of as beams_of

Array = np.ndarray
STILL = 1  # Doppler bins on either side of zero that a resting scene fills


def cosines(num: int) -> Float[Array, "num num"]:
    """The orthonormal DCT-II.

    >>> bool(np.allclose(cosines(5) @ cosines(5).T, np.eye(5)))
    True
    """
    index = np.arange(num)
    matrix = np.cos(np.pi * (index[None] + 0.5) * index[:, None] / num) * np.sqrt(2 / num)
    matrix[0] /= np.sqrt(2)
    return matrix


def to_coefficients(
    residual: Complex[Array, "frame range doppler antenna"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "beam frame range doppler"]:
    """Beams, and for Doppler bins at rest the cosine transform over frames."""
    values = np.tensordot(beams, residual, axes=(1, 3))
    return _still_turned(values, cosines(values.shape[1]))


def from_coefficients(
    values: Complex[Array, "beam frame range doppler"], beams: Complex[Array, "beam antenna"]
) -> Complex[Array, "frame range doppler antenna"]:
    """The inverse of `to_coefficients`."""
    values = _still_turned(values.copy(), cosines(values.shape[1]).T)
    return np.moveaxis(np.tensordot(beams.conj(), values, axes=(0, 0)), 0, 3)


def still_bins(num_doppler: int) -> slice:
    """Doppler cells that a resting scene fills."""
    middle = num_doppler // 2
    return slice(max(0, middle - STILL), middle + STILL + 1)


def _still_turned(values: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    still = still_bins(values.shape[3])
    values[..., still] = np.einsum("ts,bsrd->btrd", matrix, values[..., still], optimize=True)
    return values
