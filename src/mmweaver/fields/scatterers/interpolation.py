"""Interpolation between cells."""

import numpy as np
import torch
from torch import Tensor


def interpolate(values: Tensor, cell: np.ndarray, *, is_signal: bool = False) -> Tensor:
    """Values (cell, ...) at fractional cells: linear, or band-limited (sinc) for a centred signal along range."""
    at = torch.from_numpy(np.asarray(cell, np.float64))
    index = torch.arange(len(values))
    distance = at[:, None] - index
    weight = torch.sinc(distance) if is_signal else (1 - distance.abs()).clamp(min=0)
    return (weight.to(values.dtype) @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:])


def interpolate_rows(values: Tensor, cell: np.ndarray) -> Tensor:
    """Each row of values (row, cell) at its own fractional cell, (row,)."""
    at = torch.from_numpy(np.asarray(cell, np.float64))
    weight = (1 - (at[:, None] - torch.arange(values.shape[1])).abs()).clamp(min=0)
    return (values * weight.to(values.dtype)).sum(1)
