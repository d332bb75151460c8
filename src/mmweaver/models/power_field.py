"""An implicit neural representation of log power, written by a hypernetwork as modulations of a shared network.

    coordinates -> sines and cosines -> 4 wide layers, each x (1 + gamma) + shift -> logarithm of a cross section

The wide layers are the same for all rooms and motions and are trained; 256 numbers a field (or a frame) move them, as
many as the paper's gamma and beta, and 16 compose the second layer out of matrices of rank one. Predicting all weights
instead, as the paper does, starts with outputs seven times too large.
Reference: Perez et al., 2018; docs/decisions/paper-network.md.
"""

import math

import torch
from torch import Tensor, nn

WIDTH, LAYERS = 128, 4
CODE, RANK = 64, 16  # numbers that modulate a layer, and that compose the second one
NUM_WRITTEN = LAYERS * CODE + RANK  # by the hypernetwork for each field
FAINTEST_LOG = -9.0  # of a natural logarithm of square metres: where an untrained field stands

MIN_SPREAD = 1e-3  # of the largest: directions that differ less are left out


def octaves(values: Tensor, count: int) -> Tensor:
    """Coordinates (...) in [-1, 1] as themselves and sines and cosines of `count` octaves from half a turn on."""
    turns = values[..., None] * (0.5 * math.pi * 2.0 ** torch.arange(count, device=values.device))
    return torch.cat([values[..., None], turns.sin(), turns.cos()], dim=-1)


def octave_size(counts: tuple[int, ...]) -> int:
    """How many values `octaves` gives for axes of so many octaves."""
    return sum(1 + 2 * count for count in counts)


class PowerField(nn.Module):
    """Encoded coordinates (field, point, size), what was written (field, NUM_WRITTEN) -> logarithms (field, point)."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self.layers = nn.ModuleList(nn.Linear(size if index == 0 else WIDTH, WIDTH) for index in range(LAYERS))
        self.expand = nn.ModuleList(nn.Linear(CODE, 2 * WIDTH, bias=False) for _ in range(LAYERS))
        self.narrow, self.widen = nn.Linear(WIDTH, RANK, bias=False), nn.Linear(RANK, WIDTH, bias=False)
        self.norm, self.out = nn.LayerNorm(WIDTH), nn.Linear(WIDTH, 1)
        self.straight = nn.Linear(size, 1, bias=False)
        nn.init.constant_(self.out.bias, FAINTEST_LOG)
        nn.init.zeros_(self.straight.weight)

    def begin_with(self, level: float, slopes: dict[int, float], count: int) -> None:
        """Before training: a level, and slopes over some of the last `count` encoded values."""
        nn.init.constant_(self.out.bias, level)
        with torch.no_grad():
            for index, slope in slopes.items():
                self.straight.weight[0, index - count] = slope

    def forward(self, encoded: Tensor, written: Tensor) -> Tensor:
        *codes, composed = written.split([CODE] * LAYERS + [RANK], dim=-1)
        h = encoded
        for index, (layer, expand, code) in enumerate(zip(self.layers, self.expand, codes, strict=True)):
            z = layer(h)
            if index == 1:
                z = z + self.widen(self.narrow(h) * composed[:, None])
            gamma, shift = expand(code)[:, None].chunk(2, dim=-1)
            h = nn.functional.gelu(z * (1 + gamma) + shift)
        return (self.out(self.norm(h)) + self.straight(encoded))[..., 0]


class FieldWriter(nn.Module):
    """The hypernetwork: whitened codes (..., size) -> the numbers of a field (..., NUM_WRITTEN).

    They are small before training. What all fields have in common comes from a constant of the same size as what
    differs, so that it is learned as fast as without codes.
    """

    def __init__(self, size: int, width: int = 512) -> None:
        super().__init__()
        norm = nn.LayerNorm(width)
        nn.init.ones_(norm.bias)
        self.trunk = nn.Sequential(nn.Linear(size, width), nn.GELU(), nn.Linear(width, width), nn.GELU(), norm)
        self.head = nn.Linear(width, NUM_WRITTEN)
        nn.init.normal_(self.head.weight, std=0.1 / math.sqrt(width))
        nn.init.zeros_(self.head.bias)

    def forward(self, code: Tensor) -> Tensor:
        return self.head(self.trunk(code))


class PcaWhitening(nn.Module):
    """Codes (..., size) -> their first `count` principal components (..., count), of unit spread over samples.

    An encoder's codes differ little from each other next to their mean, and nearly all of that in one or two
    directions: a network that reads them as they are writes the same for all. Mean and directions are measured once,
    by `measure`, and not trained; until then the first values are passed on.
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
        count = min(self.directions.shape[1], int((spread > MIN_SPREAD * spread[0]).sum()))
        self.mean.copy_(mean)
        self.directions.zero_()
        self.directions[:, :count] = (axes[:count].T / spread[:count]).to(self.directions.dtype)

    def forward(self, codes: Tensor) -> Tensor:
        return (codes - self.mean) @ self.directions
