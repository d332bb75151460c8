"""The paper's implicit neural representations of a radar sequence, and the fields made of them.

        proposed                                             base
   (r, d, a) in [-1, 1]                                (t, r, d, a) in [-1, 1]
        | positional encoding                                | positional encoding
       51                                                   68
        | 4 x [ Linear 32, gamma(t) . + beta(t), ReLU ]      | 4 x [ Linear 32, ReLU ]
        | Linear 2                                           | Linear 2
      I, Q                                                 I, Q

Reference: paper, "INR for RF representation"; 4,898 weights and 256 modulations a frame.
"""

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Complex, Float

from mmweaver.compression.signal_field import (
    CHUNK_POINTS,
    Coordinates,
    SignalField,
    centring_phasor,
    centring_phasor_at,
    coordinates_on,
)
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.core.shapes import CubeValues
from studies.paper.positional_encoding import (
    OCTAVES,
    Frequencies,
    encode_axis,
    normalised,
    positional_encoding,
)

HIDDEN_WIDTH = 32
NUM_HIDDEN = 4
NUM_OUTPUTS = 2  # I, Q
MODULATIONS_PER_FRAME = 2 * NUM_HIDDEN * HIDDEN_WIDTH

Weights = Float[torch.Tensor, " weight"]
Modulation = Float[torch.Tensor, "frame 4 32"]
Layer = tuple[torch.Tensor, torch.Tensor]  # weight (out, in), bias (out,)
IqPoints = Float[torch.Tensor, "point 2"]


GAUSS_WIDTH = 0.3  # fresh layers give z of this size; 1 learns several times slower


class _Gauss(torch.autograd.Function):
    """exp(-z^2 / 2 GAUSS_WIDTH^2), with one intermediate instead of three."""

    @staticmethod
    def forward(ctx, z: torch.Tensor) -> torch.Tensor:
        y = (z * z).mul_(-0.5 / GAUSS_WIDTH**2).exp_()
        ctx.save_for_backward(z, y)
        return y

    @staticmethod
    def backward(ctx, slope: torch.Tensor) -> torch.Tensor:  # type: ignore
        z, y = ctx.saved_tensors
        return (slope * z).mul_(y).mul_(-1 / GAUSS_WIDTH**2)


def _gauss(z: torch.Tensor) -> torch.Tensor:
    return _Gauss.apply(z)


SINE_TURNS = 30.0  # omega_0 of Sitzmann et al., "Implicit neural representations with periodic activation functions"


def _sine(z: torch.Tensor) -> torch.Tensor:
    return torch.sin(SINE_TURNS * z)


ACTIVATIONS: dict[str, Callable[[torch.Tensor], torch.Tensor]] = {"relu": torch.relu, "gauss": _gauss, "sine": _sine}


def _activate(activation: str, z: torch.Tensor) -> None:
    """In place. A negative bfloat16 is a negative int16, whose maximum takes a sixth of the time."""
    if activation == "relu" and z.dtype == torch.bfloat16:
        z.view(torch.int16).clamp_min_(0)
    elif activation == "relu":
        z.relu_()
    else:
        z.copy_(ACTIVATIONS[activation](z))


@dataclass(frozen=True, kw_only=True)
class InrShape:
    """An MLP on encoded coordinates; `num_axes` is 3 for the proposed INR (r, d, a) and 4 for the base one."""

    num_axes: int = 3
    activation: str = "relu"
    frequencies: tuple[Frequencies, ...] = (OCTAVES,) * 4  # of the last axes; the paper's

    @property
    def axis_frequencies(self) -> tuple[Frequencies, ...]:
        return self.frequencies[-self.num_axes :]

    @property
    def sizes(self) -> tuple[int, ...]:
        return (sum(self.axis_sizes), *[HIDDEN_WIDTH] * NUM_HIDDEN, NUM_OUTPUTS)

    @property
    def axis_sizes(self) -> tuple[int, ...]:
        """Encoded values of each axis; an axis without frequencies is its raw coordinate."""
        return tuple(1 + 2 * len(frequencies) for frequencies in self.axis_frequencies)

    @property
    def num_weights(self) -> int:
        """Length of theta.

        >>> InrShape().num_weights, InrShape(num_axes=4).num_weights
        (4898, 5442)
        """
        return sum((fan_in + 1) * fan_out for fan_in, fan_out in zip(self.sizes, self.sizes[1:], strict=False))

    def layers(self, theta: Weights) -> list[Layer]:
        """Theta as weights and biases, layer by layer: first all of a layer's rows, then its biases."""
        layers, at = [], 0
        for fan_in, fan_out in zip(self.sizes, self.sizes[1:], strict=False):
            end = at + fan_in * fan_out
            layers.append((theta[at:end].view(fan_out, fan_in), theta[end : end + fan_out]))
            at = end + fan_out
        return layers

    def fresh(self, generator: np.random.Generator) -> Weights:
        """Weights as torch's Linear initialises them: uniform in +-1 / sqrt(fan in), biases too; for sines as SIREN
        does."""
        parts = []
        for at, (fan_in, fan_out) in enumerate(zip(self.sizes, self.sizes[1:], strict=False)):
            reach = 1 / np.sqrt(fan_in)
            if self.activation == "sine":
                reach = 1 / fan_in if at == 0 else np.sqrt(6 / fan_in) / SINE_TURNS
            parts.append(generator.uniform(-1, 1, (fan_in + 1) * fan_out) * reach)
        return torch.from_numpy(np.concatenate(parts).astype(np.float32))


def fresh_modulation(num_frames: int) -> tuple[Modulation, Modulation]:
    """(gamma, beta) that change nothing: ones and zeros, (frame, layer, 32)."""
    shape = (num_frames, NUM_HIDDEN, HIDDEN_WIDTH)
    return torch.ones(shape), torch.zeros(shape)


def evaluate(
    shape: InrShape,
    theta: Weights,
    x_norm: Float[torch.Tensor, "point axis"],
    gamma: Float[torch.Tensor, "point 4 32"] | None = None,
    beta: Float[torch.Tensor, "point 4 32"] | None = None,
) -> IqPoints:
    """The INR at points, as the paper writes it; gamma and beta are those of each point's time, None = identity."""
    act = ACTIVATIONS[shape.activation]
    *hidden, (last_weight, last_bias) = shape.layers(theta)
    h = positional_encoding(x_norm, shape.axis_frequencies)
    for at, (weight, bias) in enumerate(hidden):
        z = torch.addmm(bias, h, weight.T)
        if gamma is not None:
            z = z * gamma[:, at]
        if beta is not None:
            z = z + beta[:, at]
        h = act(z)
    return torch.addmm(last_bias, h, last_weight.T)


def first_layer_terms(shape: InrShape, theta: Weights, axes_norm: list[torch.Tensor]) -> list[torch.Tensor]:
    """The first layer without its bias as one term an axis, each (cell, 32); their sum over a grid is the layer."""
    weight, _ = shape.layers(theta)[0]
    parts = weight.split(list(shape.axis_sizes), dim=1)
    each = zip(axes_norm, shape.axis_frequencies, parts, strict=True)
    return [encode_axis(axis, frequencies) @ part.T for axis, frequencies, part in each]


def evaluate_on_axes(
    shape: InrShape,
    theta: Weights,
    gamma: Modulation,
    beta: Modulation,
    axes_norm: list[torch.Tensor],
    *,
    turn: Complex[torch.Tensor, " cell"] | None = None,
    dtype: torch.dtype = torch.float32,
    threads: int = 1,
) -> Float[torch.Tensor, "frame cell 2"]:
    """The proposed INR on the grid of three axes for each frame, cells in row order (r, d, a). Keeps no gradients.

    The first layer is summed from one term an axis and gamma, beta are folded into weights and biases, so a cell
    costs three 32 x 32 products and one 32 x 2. Equals `evaluate` to rounding; bfloat16 errs by about 1 %. I + jQ is
    multiplied by `turn` where given. With several `threads` each takes some frames, which is faster than torch's own
    threads within such small products.
    """
    with torch.no_grad():
        terms = first_layer_terms(shape, theta, axes_norm)
        cells = math.prod(len(term) for term in terms)
        out = torch.empty(len(gamma), cells, NUM_OUTPUTS, dtype=torch.float32, device=theta.device)

    def fill(frames: np.ndarray) -> None:
        with torch.no_grad():  # counts for one thread alone
            decoder = _FrameDecoder(shape, theta, terms, dtype)
            for frame in frames.tolist():
                decoder.decode(gamma[frame], beta[frame], turn, out[frame])

    parts = np.array_split(np.arange(len(gamma)), threads)
    if threads == 1:
        fill(parts[0])
        return out
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(fill, parts))
    finally:
        torch.set_num_threads(before)
    return out


class _FrameDecoder:
    """Frames one after the other in the same two buffers: allocating memory costs as much as the arithmetic."""

    def __init__(self, shape: InrShape, theta: Weights, terms: list[torch.Tensor], dtype: torch.dtype):
        self.shape, self.theta, self.dtype = shape, theta, dtype
        a, b, c = terms
        self.first = a[:, None]
        self.rest = (b[:, None] + c[None]).flatten(0, 1)[None]
        cells = len(a) * self.rest.shape[1]
        self.buffers = [torch.empty(cells, HIDDEN_WIDTH, dtype=dtype, device=a.device) for _ in range(2)]

    def decode(
        self,
        gamma: Float[torch.Tensor, "4 32"],
        beta: Float[torch.Tensor, "4 32"],
        turn: torch.Tensor | None,
        out: IqPoints,
    ) -> None:
        """One frame into `out`."""
        act, dtype = self.shape.activation, self.dtype
        (_, first_bias), *inner, (last_weight, last_bias) = self.shape.layers(self.theta)
        h, free = self.buffers
        whole = h.view(len(self.first), -1, HIDDEN_WIDTH)
        torch.add(gamma[0] * self.first, gamma[0] * (self.rest + first_bias) + beta[0], out=whole)
        _activate(act, h)
        for at, (weight, bias) in enumerate(inner, start=1):
            folded = (gamma[at][:, None] * weight).T.to(dtype)
            torch.addmm((gamma[at] * bias + beta[at]).to(dtype), h, folded, out=free)
            _activate(act, free)
            h, free = free, h
        iq = torch.addmm(last_bias.to(dtype), h, last_weight.T.to(dtype)).float()
        if turn is None:
            out.copy_(iq)
        else:
            torch.mul(torch.view_as_complex(iq), turn, out=torch.view_as_complex(out))


class InrField(SignalField):
    """A sequence represented by the proposed INR: theta for all frames, gamma and beta for each.

    Between frames gamma and beta are interpolated. `amplitude` is the value of the network's 1.0 in the unit of the
    cube; `is_centred`: the network represents the phase-centred cube (see `phase_centring`).
    """

    def __init__(
        self,
        *,
        config: RadarConfig,
        grid: CubeGrid,
        scale: float,
        shape: InrShape,
        theta: Weights,
        gamma: Modulation,
        beta: Modulation,
        amplitude: float,
        is_centred: bool,
    ):
        self.config, self.grid, self.scale = config, grid, scale
        self.shape, self.amplitude, self.is_centred = shape, amplitude, is_centred
        self.theta, self.gamma, self.beta = (part.detach().cpu() for part in (theta, gamma, beta))
        self.decode_dtype = torch.float32  # torch.bfloat16 is faster, and about 1 % off
        self.decode_threads = 1

    @property
    def num_values(self) -> int:
        return self.theta.numel() + self.gamma.numel() + self.beta.numel()

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        out = np.empty(len(coordinates), np.complex64)
        for first in range(0, len(coordinates), CHUNK_POINTS // 16):
            part = coordinates[first : first + CHUNK_POINTS // 16]
            gamma, beta = self._modulation_at(part[:, 0])
            with torch.no_grad():
                iq = evaluate(self.shape, self.theta, torch.stack(self._norm(part[:, 1:].T), dim=1), gamma, beta)
            out[first : first + len(part)] = _complex(iq)
        out *= np.float32(self.amplitude)
        if self.is_centred:
            out *= centring_phasor_at(self.config, self.grid, coordinates).conj()
        return out

    def on_grid(self, grid: CubeGrid) -> CubeValues:
        axes = coordinates_on(self.grid, grid)
        gamma, beta = self._modulation_at(axes[0])
        turn = np.full(grid.shape[1:], self.amplitude, np.complex64)
        if self.is_centred:
            turn *= centring_phasor(self.config, grid).conj()[:, :, None]
        iq = evaluate_on_axes(
            self.shape, self.theta, gamma, beta, self._norm(axes[1:]), turn=torch.from_numpy(turn.ravel()),
            dtype=self.decode_dtype, threads=self.decode_threads,
        )  # fmt: skip
        return _complex(iq).reshape(grid.shape)

    def _norm(self, cells) -> list[torch.Tensor]:
        """Range, Doppler and antenna cells in [-1, 1]."""
        lengths = self.grid.shape[1:]
        return [
            torch.from_numpy(normalised(cell, num).astype(np.float32)) for cell, num in zip(cells, lengths, strict=True)
        ]

    def _modulation_at(self, frame: Float[np.ndarray, "_"]) -> tuple[Modulation, Modulation]:
        """gamma and beta at fractional frame numbers; constant before the first and after the last."""
        at = np.clip(frame, 0, len(self.gamma) - 1)
        low = np.minimum(at.astype(np.int64), max(len(self.gamma) - 2, 0))
        high = np.minimum(low + 1, len(self.gamma) - 1)
        share = torch.from_numpy((at - low).astype(np.float32))[:, None, None]
        return (
            torch.lerp(self.gamma[low], self.gamma[high], share),
            torch.lerp(self.beta[low], self.beta[high], share),
        )


class BaseInrField(SignalField):
    """A sequence represented by the base INR: time is a fourth coordinate."""

    def __init__(
        self,
        *,
        config: RadarConfig,
        grid: CubeGrid,
        scale: float,
        shape: InrShape,
        theta: Weights,
        amplitude: float,
        is_centred: bool,
    ):
        self.config, self.grid, self.scale = config, grid, scale
        self.shape, self.theta = shape, theta.detach().cpu()
        self.amplitude, self.is_centred = amplitude, is_centred

    @property
    def num_values(self) -> int:
        return self.theta.numel()

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        axes = [normalised(coordinates[:, axis], num).astype(np.float32) for axis, num in enumerate(self.grid.shape)]
        with torch.no_grad():
            iq = evaluate(self.shape, self.theta, torch.from_numpy(np.stack(axes, axis=1)))
        out = _complex(iq) * np.float32(self.amplitude)
        if self.is_centred:
            out *= centring_phasor_at(self.config, self.grid, coordinates).conj()
        return out


def _complex(iq: torch.Tensor) -> np.ndarray:
    """(..., 2) -> complex64 (...)."""
    return torch.view_as_complex(iq.contiguous()).numpy()
