"""Read-only: the low-rank layer that files of versions 3 to 5 may contain. Encoders no longer write it."""

import numpy as np
from jaxtyping import Complex

from mmweaver.compression.cell_coder import LevelCoder
from mmweaver.compression.entropy import BitStream

CORRELATED = True, False  # neighbouring rows of a factor predict each other's sign


def decode_low_rank(
    stream: BitStream, rank: int, shape: tuple[int, ...], step: float
) -> Complex[np.ndarray, "frame range doppler antenna"]:
    """Decodes a low-rank matrix (frame and range, Doppler and antenna) as values of a chunk.

    Columns of the left factor have the strength of their component and the step of the chunk; rows of the right one
    have unit norm, and that step divided by the strength of the decoded column.

    Args:
        stream: The decoder.
        rank: Number of components.
        shape: Shape (frame, range, doppler, antenna) of the chunk.
        step: Quantisation step.

    Returns:
        Values of that shape, complex64.

    Raises:
        ValueError: For an impossible rank.
    """
    frames, num_range, doppler, antennas = shape
    if rank > min(frames * num_range, doppler * antennas):
        raise ValueError("impossible rank")
    left, right = (_factor(stream, (rank, *axes)) for axes in ((frames * num_range, 1), (doppler, antennas)))
    strength = np.maximum(np.sqrt(np.sum(np.square(np.abs(left)), axis=1)), 1.0)
    return ((left * step).T @ (right / strength[:, None])).reshape(shape).astype(np.complex64)


def _factor(stream: BitStream, shape: tuple[int, int, int]) -> np.ndarray:
    """Levels of a factor, complex (rank, place)."""
    levels = np.zeros((2, 1, int(np.prod(shape))), np.int64)
    LevelCoder((1, *shape), CORRELATED).code(stream, levels, np.ones(shape, np.int64))
    real, imaginary = levels.reshape(2, shape[0], -1)
    return real + 1j * imaginary
