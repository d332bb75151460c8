"""Codes of an encoder as a few numbers that differ between samples as much in one direction as in any other.

An encoder's codes differ little from each other next to their mean, and nearly all of that in one or two directions:
what reads them as they are writes the same for all. Reference: docs/decisions/paper-network.md.
"""

import torch
from torch import Tensor, nn

LEAST_SPREAD = 1e-3  # of the largest: directions that differ less are left out


class PcaWhitening(nn.Module):
    """Codes (..., size) -> their first `count` principal components (..., count), of unit spread over samples.

    Mean and directions are measured once, by `measure`, and not trained; until then the first values are passed on.
    """

    mean: Tensor
    directions: Tensor

    def __init__(self, size: int, count: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(size))
        self.register_buffer("directions", torch.eye(size, count))

    def measure(self, codes: Tensor) -> None:
        """Takes mean and directions from sample codes (sample, size); directions that they do not show become zero."""
        mean = codes.double().mean(0)
        _, length, axes = torch.linalg.svd(codes.double() - mean, full_matrices=False)
        spread = length / max(len(codes) - 1, 1) ** 0.5
        count = min(self.directions.shape[1], int((spread > LEAST_SPREAD * spread[0]).sum()))
        self.mean.copy_(mean)
        self.directions.zero_()
        self.directions[:, :count] = (axes[:count].T / spread[:count]).to(self.directions.dtype)

    def forward(self, codes: Tensor) -> Tensor:
        return (codes - self.mean) @ self.directions
