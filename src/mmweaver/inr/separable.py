"""A modulated INR that is separable: sums of products of one-dimensional functions, shifted by the modulations.

    f(r, d, a; t) = sum_k gamma_k(t) phi_r(r - beta_kr(t)) phi_d(d - beta_kd(t)) exp(j turn(a; beta_ka(t))) + static

phi_r and phi_d are one-layer networks of Gaussians that learn the response of the radar's windows; direction enters as
the phase of a plane wave over the antennas' places. gamma(t), complex, and beta(t) belong to a frame. Kernels and a
static part, the same sum without t and at rest, are theta, shared by all frames. What the modulations shift is the
input rather than a hidden layer, as in Functa (Dupont et al., 2022); products of Gaussians and waves are those of a
multiplicative filter network (Fathony et al., 2021).
"""

import math

import torch
from torch import Tensor, nn

from mmweaver.signal.point_response import Axes

KERNEL_UNITS = 6
RATES = {"amplitude": 10.0, "direction": 0.3, "kernel": 0.1}  # learning rates relative to shifts in range and Doppler


class Kernel(nn.Module):
    """phi(x) = sum_m w_m (g((x - c_m) / s_m) + g((x + c_m) / s_m)) / 2 with Gaussian g: even, near 1 at 0.

    Begins as one Gaussian about as wide as the main lobe of a Hann window.
    """

    def __init__(self) -> None:
        super().__init__()
        self.kernel_weight = nn.Parameter(torch.eye(KERNEL_UNITS)[0])
        self.kernel_width = nn.Parameter(torch.linspace(0.85, 1.6, KERNEL_UNITS))
        self.kernel_centre = nn.Parameter(torch.linspace(0, 2.5, KERNEL_UNITS))

    def forward(self, x: Tensor) -> Tensor:
        """phi at offsets (...) in bins."""
        x, rate = x[..., None], -0.5 / self.kernel_width.square()
        both = (rate * (x - self.kernel_centre).square()).exp() + (rate * (x + self.kernel_centre).square()).exp()
        return both @ self.kernel_weight / 2


class SeparableINR(nn.Module):
    """f(X; t) as a sum of separable terms: `rank` per frame, and `num_shared` that are the same in all frames.

    Coordinates are bins of range and Doppler and places of antennas in wavelengths (`PointResponse.axes`).

    >>> inr = SeparableINR(20, rank=78, num_shared=100, num_directions=2)
    >>> sum(parameter.numel() for parameter in inr.parameters())
    9896
    """

    def __init__(self, num_frames: int, *, rank: int, num_shared: int, num_directions: int) -> None:
        """Initialises all terms as zero; `grow` adds terms where a signal has energy.

        Args:
            num_frames: Number of frames.
            rank: Terms per frame.
            num_shared: Terms of the static part.
            num_directions: Direction cosines that the array resolves: 0, 1 or 2.
        """
        super().__init__()
        self.range_kernel, self.doppler_kernel = Kernel(), Kernel()
        self.range_shift = nn.Parameter(torch.zeros(num_frames, rank))
        self.doppler_shift = nn.Parameter(torch.zeros(num_frames, rank))
        self.direction = nn.Parameter(torch.zeros(num_frames, rank, num_directions))
        self.amplitude = nn.Parameter(torch.zeros(num_frames, rank, 2))
        self.static_range_shift = nn.Parameter(torch.zeros(num_shared))
        self.static_direction = nn.Parameter(torch.zeros(num_shared, num_directions))
        self.static_amplitude = nn.Parameter(torch.zeros(num_shared, 2))

    def forward(self, axes: Axes, time: Tensor | None = None, *, is_grid: bool = True) -> Tensor:
        """I and Q in centred phase.

        Args:
            axes: Coordinates of cells.
            time: Frames (frame,); those in between are the nearest one's. Default: all.
            is_grid: Whether all combinations of coordinates are wanted; otherwise axes have one entry per cell.

        Returns:
            (frame, range, doppler, antenna, 2), or (frame, cell, 2).
        """
        nearest = slice(None) if time is None else time.round().long().clamp(0, len(self.range_shift) - 1)
        bins, speed = self.range_shift[nearest], self.doppler_shift[nearest]
        at_range = self.range_kernel(axes.range_bin - bins[..., None])  # (frame, term, range)
        at_doppler = self.doppler_kernel(axes.doppler_bin - speed[..., None])
        echo = _turned(self.amplitude[nearest], self.direction[nearest], speed, axes)  # (frame, term, antenna, 2)
        still = _turned(self.static_amplitude, self.static_direction, 0 * self.static_range_shift, axes)
        static = self.range_kernel(axes.range_bin - self.static_range_shift[:, None])
        rest = self.doppler_kernel(axes.doppler_bin)
        if not is_grid:
            moving = ((at_range * at_doppler)[..., None] * echo).sum(1)
            return moving + (static[..., None] * still).sum(0) * rest[:, None]
        cells = (at_range[..., None] * at_doppler[..., None, :]).flatten(-2).mT @ echo.flatten(-2)
        layer = (static.mT @ still.flatten(-2))[:, None] * rest[:, None]
        whole = cells.unflatten(-2, layer.shape[:2]) + layer
        return whole.unflatten(-1, (-1, 2))

    @torch.no_grad()
    def grow(self, rest: Tensor, axes: Axes, rank: int, num_shared: int) -> None:
        """Adds terms at the strongest cells of a residual.

        Args:
            rest: Residual (frame, range, doppler, antenna), complex, in centred phase.
            axes: Its cells.
            rank: Terms per frame from now on.
            num_shared: Terms of the static part from now on, at most one more per range bin.
        """
        beams = _beams(axes)
        place = axes.place[:, : beams.shape[1]]
        steer = torch.polar(torch.ones(()), 2 * math.pi * beams @ place.T) / len(place)
        count, num_bins = rank - self.range_shift.shape[1], rest.shape[2]
        energy = rest.abs().square().sum(-1)
        is_peak = energy >= nn.functional.max_pool2d(energy, 3, 1, 1)
        cell = (energy * (is_peak + 1e-3)).flatten(1).topk(min(count, energy[0].numel())).indices
        at, speed = cell // num_bins, axes.doppler_bin[cell % num_bins]
        value = rest.flatten(1, 2).gather(1, cell[..., None].expand(-1, -1, rest.shape[3]))
        untwisted = value * torch.polar(torch.ones(()), -2 * math.pi * speed[..., None] * axes.delay)
        amplitude, direction = _strongest(untwisted @ steer.T, beams)
        self._add("", 1, axes.range_bin[at], direction, amplitude)
        self.doppler_shift = nn.Parameter(torch.cat([self.doppler_shift, speed], 1))
        still = rest[:, :, int(axes.doppler_bin.abs().argmin())].mean(0)
        at = still.abs().square().sum(-1).topk(min(num_shared - len(self.static_range_shift), len(still))).indices
        amplitude, direction = _strongest(still[at] @ steer.T, beams)
        self._add("static_", 0, axes.range_bin[at], direction, amplitude)

    def _add(self, prefix: str, dim: int, *new: Tensor) -> None:
        for name, own in zip(("range_shift", "direction", "amplitude"), new, strict=True):
            setattr(self, prefix + name, nn.Parameter(torch.cat([getattr(self, prefix + name), own], dim)))


def ranks(num_frames: int, num_directions: int, num_values: int, static_share: float = 0.1) -> tuple[int, int]:
    """Terms per frame and of the static part, which gets `static_share`, for a network of at most so many values."""
    num_shared = int(static_share * num_values) // (3 + num_directions) if num_frames > 1 else 0
    rest = num_values - 6 * KERNEL_UNITS - num_shared * (3 + num_directions)
    return rest // (num_frames * (4 + num_directions)), num_shared


def _turned(amplitude: Tensor, direction: Tensor, doppler_bin: Tensor, axes: Axes) -> Tensor:
    """Amplitudes (..., term, 2) times the phase of a plane wave at the antennas, (..., term, antenna, 2).

    Transmitters fire one after the other: what moves turns by a phase in between.
    """
    turns = doppler_bin[..., None] * axes.delay - direction @ axes.place[:, : direction.shape[-1]].T
    cos, sin = (2 * math.pi * turns).cos(), (2 * math.pi * turns).sin()
    i, q = amplitude[..., :1], amplitude[..., 1:]
    return torch.stack([i * cos - q * sin, i * sin + q * cos], dim=-1)


def _beams(axes: Axes) -> Tensor:
    """Direction cosines (beam, direction) that `grow` tries: as fine as twice the resolution of the array."""
    grid = torch.linspace(-1, 1, 33)
    span = axes.place.amax(0) - axes.place.amin(0)
    if span[1] > 0.05:
        beams = torch.cartesian_prod(grid, grid)
        return beams[beams.square().sum(1) < 1]
    return grid[:, None] if span[0] > 0.05 else torch.zeros(1, 0)


def _strongest(found: Tensor, beams: Tensor) -> tuple[Tensor, Tensor]:
    """Of values (..., term, beam) those of the strongest beam: amplitudes (..., term, 2) and their directions."""
    which = found.abs().argmax(-1)
    return torch.view_as_real(found.gather(-1, which[..., None])[..., 0]), beams[which]
