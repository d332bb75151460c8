"""Coordinates in [-1, 1] as raw value, cosines and sines: the paper's PE, 17 values an axis, 51 for three.

The paper's formula has no raw coordinate and counts i = 0..L inclusive, which would make 54; its 51 = 3 (1 + 2 x 8)
needs the raw coordinate and i = 0..7.

Reference: paper, "Proposed Architecture".
"""

import numpy as np
import torch
from jaxtyping import Float

NUM_FREQUENCIES = 8
Frequencies = tuple[float, ...]  # of one axis, in radians a unit of its coordinate
OCTAVES: Frequencies = tuple(2.0**i for i in range(NUM_FREQUENCIES))  # the paper's


def harmonics(num_cells: int, highest: float = 1.0) -> Frequencies:
    """`num` evenly spaced frequencies, the last at `highest` of what an axis of so many cells can resolve.

    The octaves go to 128 radians for every axis: 12 antennas resolve 17, 32 Doppler bins 49, 64 range bins 99. Higher
    frequencies fit the cells as well, but ring between them.
    """
    nyquist = np.pi * max(num_cells - 1, 1) / 2
    return tuple(float(highest * nyquist * (i + 1) / NUM_FREQUENCIES) for i in range(NUM_FREQUENCIES))


def encoded_size(num_axes: int) -> int:
    """Values that `positional_encoding` gives for so many axes.

    >>> encoded_size(3)
    51
    """
    return num_axes * (1 + 2 * NUM_FREQUENCIES)


def encode_axis(
    x_norm: Float[torch.Tensor, " point"], frequencies: Frequencies = OCTAVES
) -> Float[torch.Tensor, "point 17"]:
    """One coordinate: [x, cos(w x) for each frequency w, sin(w x) for each]."""
    turns = x_norm[:, None] * torch.tensor(frequencies, dtype=x_norm.dtype, device=x_norm.device)
    return torch.cat([x_norm[:, None], torch.cos(turns), torch.sin(turns)], dim=1)


def positional_encoding(
    x_norm: Float[torch.Tensor, "point axis"], frequencies: tuple[Frequencies, ...] | None = None
) -> Float[torch.Tensor, "point encoded"]:
    """All coordinates, axis after axis, so that a linear layer on it is a sum of one term per axis."""
    frequencies = frequencies or (OCTAVES,) * x_norm.shape[1]
    return torch.cat([encode_axis(x_norm[:, axis], each) for axis, each in enumerate(frequencies)], dim=1)


def normalised(cell: Float[np.ndarray, "_"], num_cells: int) -> Float[np.ndarray, "_"]:
    """Cell indices 0..num-1 mapped to [-1, 1]; the one cell of an axis of length 1 to 0."""
    return 2 * cell / (num_cells - 1) - 1 if num_cells > 1 else np.zeros(len(cell))
