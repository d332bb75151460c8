"""The paper's implicit neural representations of a radar sequence.

        proposed: ModulatedINR                               base: BaseINR
   X = (r, d, a) in [-1, 1]                            (t, r, d, a) in [-1, 1]
        | PE                                                 | PE
       51                                                   68
        | 4 x [ Linear 32, gamma(t) . + beta(t), ReLU ]      | 4 x [ Linear 32, ReLU ]
        | Linear 2                                           | Linear 2
      I, Q                                                 I, Q

Activation, encoding, width and depth are options; the defaults are the paper's. Reference: paper, "INR for RF
representation".
"""

import itertools
import math
from collections.abc import Callable, Sequence

import torch
from torch import Tensor, nn

NUM_FREQUENCIES = 8
Frequencies = tuple[float, ...]  # of one axis, in radians per unit of its coordinate
OCTAVES: Frequencies = tuple(2.0**i for i in range(NUM_FREQUENCIES))
GAUSS_WIDTH = 0.3  # fresh layers give z of this size; 1 learns several times slower
SINE_RATE = 30.0  # omega_0 of SIREN (Sitzmann et al., 2020)

ACTIVATIONS: dict[str, Callable[[Tensor], Tensor]] = {
    "relu": torch.relu,
    "gauss": lambda z: torch.exp(z * z * (-0.5 / GAUSS_WIDTH**2)),  # Ramasinghe and Lucey, 2022
    "sine": lambda z: torch.sin(SINE_RATE * z),
    "finer": lambda z: torch.sin(SINE_RATE * (z.abs() + 1) * z),  # Liu et al., 2024
    "wire": lambda z: torch.cos(10 * z) * torch.exp(-((5 * z) ** 2)),  # real Gabor wavelet, Saragadam et al., 2023
}


class PositionalEncoding(nn.Module):
    """PE(X) = [X, cos(2^i X), sin(2^i X)] for i = 0..7: 17 values per axis, axis after axis.

    The paper's formula counts i = 0..L and has no raw coordinate, which gives 54 values; its 51 = 3 (1 + 2 x 8) needs
    i = 0..7 and the raw coordinate. Reference: paper, "Proposed Architecture".

    >>> PositionalEncoding(3)(torch.zeros(7, 3)).shape
    torch.Size([7, 51])
    """

    def __init__(self, num_axes: int = 3, frequencies: Sequence[Frequencies] | None = None) -> None:
        """Keeps the frequencies.

        Args:
            num_axes: Number of coordinates.
            frequencies: Of each axis, in radians per unit; empty: the raw coordinate alone. Default: octaves.
        """
        super().__init__()
        self.frequencies = (OCTAVES,) * num_axes if frequencies is None else tuple(frequencies)

    @classmethod
    def limited(cls, num_cells: Sequence[int], share: float) -> "PositionalEncoding":
        """Evenly spaced frequencies up to a share of what the cells of each axis resolve.

        The octaves reach 128 radians on every axis; 12 antennas resolve 17, 32 Doppler bins 49, 64 range bins 99.
        Higher frequencies fit the cells as well, but ring between them.

        Args:
            num_cells: Number of cells of each axis.
            share: Highest frequency relative to half a turn per cell; 0 encodes nothing.
        """
        steps = [(i + 1) / NUM_FREQUENCIES for i in range(NUM_FREQUENCIES)] if share else []
        return cls(
            frequencies=[tuple(share * math.pi * max(num - 1, 1) / 2 * step for step in steps) for num in num_cells]
        )

    @property
    def sizes(self) -> list[int]:
        """Encoded values of each axis."""
        return [1 + 2 * len(own) for own in self.frequencies]

    def axis(self, x: Tensor, index: int) -> Tensor:
        """One coordinate (...) encoded as (..., size of the axis)."""
        turns = x[..., None] * x.new_tensor(self.frequencies[index])
        return torch.cat([x[..., None], turns.cos(), turns.sin()], dim=-1)

    def forward(self, x: Tensor) -> Tensor:
        """Encodes coordinates (..., axis) as (..., encoded)."""
        return torch.cat([self.axis(x[..., index], index) for index in range(len(self.frequencies))], dim=-1)


class BaseINR(nn.Module):
    """f_theta(t, r, d, a) -> I, Q: the paper's base INR, time as a fourth coordinate.

    The paper does not state its size; here it has the layers of the proposed one after 68 encoded values.

    >>> BaseINR().theta.numel()
    5442
    """

    def __init__(
        self, num_axes: int = 4, *, encoding: PositionalEncoding | None = None, activation: str = "relu",
        width: int = 32, depth: int = 4,
    ) -> None:  # fmt: skip
        """Initialises the weights.

        Args:
            num_axes: Number of coordinates.
            encoding: Of the coordinates; by default the paper's.
            activation: A name of `ACTIVATIONS`.
            width: Units of a hidden layer.
            depth: Number of hidden layers.
        """
        super().__init__()
        self.encoding, self.activation = encoding or PositionalEncoding(num_axes), activation
        self.sizes: tuple[int, ...] = (sum(self.encoding.sizes), *[width] * depth, 2)
        self.theta = nn.Parameter(torch.cat([self._fresh(at) for at in range(depth + 1)]))

    def _fresh(self, at: int) -> Tensor:
        """Weights and biases of a layer, as nn.Linear initialises them, or SIREN for sines."""
        fan_in, fan_out = self.sizes[at : at + 2]
        reach = 1 / math.sqrt(fan_in)
        if self.activation in ("sine", "finer"):
            reach = 1 / fan_in if at == 0 else math.sqrt(6 / fan_in) / SINE_RATE
        return reach * (2 * torch.rand((fan_in + 1) * fan_out) - 1)

    def layers(self, theta: Tensor) -> list[tuple[Tensor, Tensor]]:
        """Weight (..., out, in) and bias (..., 1, out) of each layer; all weights of a layer come before its biases."""
        layers, at = [], 0
        for fan_in, fan_out in itertools.pairwise(self.sizes):
            end = at + fan_in * fan_out
            weight = theta[..., at:end].unflatten(-1, (fan_out, fan_in))
            layers.append((weight, theta[..., None, end : end + fan_out]))
            at = end + fan_out
        return layers

    def forward(self, x: Tensor, *, theta: Tensor | None = None) -> Tensor:
        """I and Q at points.

        Args:
            x: Coordinates (..., point, axis) in [-1, 1].
            theta: Weights (..., weight) instead of the module's own.

        Returns:
            I and Q, (..., point, 2).
        """
        layers = self.layers(self.theta if theta is None else theta)
        return self._through(layers, self.encoding(x) @ layers[0][0].mT)

    def on_axes(self, axes: Sequence[Tensor]) -> Tensor:
        """I and Q at all combinations of coordinates (cell,) of each axis, the last one fastest; (cells, 2).

        The first layer is a sum of one term per axis, so few coordinates are encoded.
        """
        layers = self.layers(self.theta)
        return self._through(layers, self._first_layer(layers, axes))

    def _first_layer(self, layers: list[tuple[Tensor, Tensor]], axes: Sequence[Tensor]) -> Tensor:
        parts = layers[0][0].split(self.encoding.sizes, dim=-1)
        total = layers[0][0].new_zeros(1, len(parts[0]))
        for index, (axis, part) in enumerate(zip(axes, parts, strict=True)):
            total = (total[:, None] + self.encoding.axis(axis, index) @ part.mT).flatten(0, 1)
        return total

    def _through(
        self, layers: list[tuple[Tensor, Tensor]], z: Tensor, gamma: Tensor | None = None, beta: Tensor | None = None
    ) -> Tensor:
        """From the first layer's products on; gamma and beta (..., layer, unit)."""
        h, last = z, len(layers) - 1
        for at, (weight, bias) in enumerate(layers):
            z = (h if at == 0 else h @ weight.mT) + bias
            if at == last:
                return z
            if gamma is not None and beta is not None:
                z = z * gamma[..., at, None, :] + beta[..., at, None, :]
            h = ACTIVATIONS[self.activation](z)
        raise AssertionError("a network has an output layer")


class ModulatedINR(BaseINR):
    """f_theta(X; t) = sigma_L(gamma_L(t) . (W_L sigma_{L-1}(...) + b_L) + beta_L(t)), X = (r, d, a): the proposed INR.

    Weights theta are shared by all frames; gamma(t) and beta(t) scale and shift every hidden layer, 256 numbers per
    frame. They start at 1 and 0, the identity. Reference: paper, "Proposed Architecture" and "Microbenchmarks".

    >>> inr = ModulatedINR(num_frames=20)
    >>> inr.theta.numel(), inr.gamma.numel() + inr.beta.numel()
    (4898, 5120)
    >>> inr(torch.zeros(20, 7, 3)).shape
    torch.Size([20, 7, 2])
    """

    def __init__(self, num_frames: int = 20, *, width: int = 32, depth: int = 4, **options) -> None:
        """Initialises weights and modulations.

        Args:
            num_frames: Number of frames.
            width: Units of a hidden layer.
            depth: Number of hidden layers.
            **options: `encoding` and `activation`, see `BaseINR`.
        """
        super().__init__(3, width=width, depth=depth, **options)
        self.gamma = nn.Parameter(torch.ones(num_frames, depth, width))
        self.beta = nn.Parameter(torch.zeros(num_frames, depth, width))

    def forward(
        self, x: Tensor, *, theta: Tensor | None = None, gamma: Tensor | None = None, beta: Tensor | None = None
    ) -> Tensor:
        """I and Q at points of each frame.

        Args:
            x: Coordinates (..., frame, point, 3) in [-1, 1].
            theta: Weights (..., 1, weight) instead of the module's own, as a hypernetwork writes them.
            gamma: Scales (..., frame, layer, unit), likewise.
            beta: Shifts, likewise.

        Returns:
            I and Q, (..., frame, point, 2).
        """
        gamma, beta = self.gamma if gamma is None else gamma, self.beta if beta is None else beta
        layers = self.layers(self.theta if theta is None else theta)
        return self._through(layers, self.encoding(x) @ layers[0][0].mT, gamma, beta)

    def on_axes(self, axes: Sequence[Tensor], time: Tensor | None = None) -> Tensor:
        """I and Q at all combinations of coordinates of each axis, (frame, cells, 2).

        Args:
            axes: Coordinates (cell,) of r, d and a.
            time: Frames (frame,), fractions included: gamma and beta are interpolated. Default: all.
        """
        layers = self.layers(self.theta)
        first = self._first_layer(layers, axes)
        gamma, beta = (self.gamma, self.beta) if time is None else self.modulation(time)
        return torch.stack([self._through(layers, first, g, b) for g, b in zip(gamma, beta, strict=True)])

    def modulation(self, time: Tensor) -> tuple[Tensor, Tensor]:
        """gamma and beta (frame, layer, unit) at fractional frames, constant before the first and after the last."""
        last = len(self.gamma) - 1
        at = time.clamp(0, last)
        low = at.long().clamp(max=max(last - 1, 0))
        high, share = (low + 1).clamp(max=last), (at - low).to(self.gamma.dtype)[:, None, None]
        return torch.lerp(self.gamma[low], self.gamma[high], share), torch.lerp(self.beta[low], self.beta[high], share)
