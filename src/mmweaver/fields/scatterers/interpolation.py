"""Values between cells."""

import numpy as np
import torch
from torch import Tensor


def between(values: Tensor, cell: np.ndarray, *, is_signal: bool = False) -> Tensor:
    """Values (cell, ...) at fractional cells: straight lines, or band-limited for a centred signal along range."""
    at = torch.from_numpy(np.asarray(cell, np.float64))
    index = torch.arange(len(values))
    away = at[:, None] - index
    weight = torch.sinc(away) if is_signal else (1 - away.abs()).clamp(min=0)
    return (weight.to(values.dtype) @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:])


def between_rows(values: Tensor, cell: np.ndarray) -> Tensor:
    """One entry of each row (row, cell), at fractional cells."""
    at = torch.from_numpy(np.asarray(cell, np.float64))
    weight = (1 - (at[:, None] - torch.arange(values.shape[1])).abs()).clamp(min=0)
    return (values * weight.to(values.dtype)).sum(1)
