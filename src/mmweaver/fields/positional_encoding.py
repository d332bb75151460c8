"""Coordinates in [-1, 1] as raw value, cosines and sines: the paper's PE, 17 values an axis, 51 for three.

The paper's formula has no raw coordinate and counts i = 0..L inclusive, which would make 54; its 51 = 3 (1 + 2 x 8)
needs the raw coordinate and i = 0..7.

Reference: paper, "Proposed Architecture".
"""

import numpy as np
import torch
from jaxtyping import Float

NUM_FREQUENCIES = 8


def encoded_size(num_axes: int) -> int:
    """Values that `positional_encoding` gives for so many axes.

    >>> encoded_size(3)
    51
    """
    return num_axes * (1 + 2 * NUM_FREQUENCIES)


def encode_axis(x_norm: Float[torch.Tensor, " point"]) -> Float[torch.Tensor, "point 17"]:
    """One coordinate: [x, cos(2^i x) for i = 0..7, sin(2^i x) for i = 0..7]."""
    turns = x_norm[:, None] * 2.0 ** torch.arange(NUM_FREQUENCIES, dtype=x_norm.dtype, device=x_norm.device)
    return torch.cat([x_norm[:, None], torch.cos(turns), torch.sin(turns)], dim=1)


def positional_encoding(x_norm: Float[torch.Tensor, "point axis"]) -> Float[torch.Tensor, "point encoded"]:
    """All coordinates, axis after axis, so that a linear layer upon it is a sum of one term an axis."""
    return torch.cat([encode_axis(x_norm[:, axis]) for axis in range(x_norm.shape[1])], dim=1)


def normalised(cell: Float[np.ndarray, "_"], num_cells: int) -> Float[np.ndarray, "_"]:
    """Cell numbers 0..num-1 to [-1, 1]; the one cell of an axis of length 1 is 0."""
    return 2 * cell / (num_cells - 1) - 1 if num_cells > 1 else np.zeros(len(cell))
