"""Response of a radar's cube to one point echo, as a product of three short factors.

In a cube whose phase refers to the middle of the chirp and of the frame (`PointResponse.phasor` removed), a
point of amplitude a at range bin b and Doppler bin f gives

    K_r(r - b) K_d(d - f) a S[antenna]                      (the point itself)
    - j M/(2 pi) m K_r'(r - b) K_d'(d - f) a S[antenna]     (its migration through range bins, m bins per loop)
    + q[antenna] K_r'(r - b) K_d(d - f) a S[antenna]        (an antenna off the centre is q bins closer to it)

with S = exp(-j 2 pi u.p / wavelength + j 2 pi f s + near field), s the delay of the antenna's transmitter relative to
the length of the frame: the TDM compensation of the cube assumes the velocity of a bin, so a point between bins keeps
exp(j 2 pi (f - d) s). The near field is the curvature of the wavefront at the range of the point, to second order.
K_r and K_d are the spectra of the windows. Reference: docs/radar_primer.md, equations 7 and 12.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.signal import windows
from mmweaver.signal.windows import WindowKernel

FLAT_WAVELENGTHS = 0.05  # an aperture below this cannot resolve direction


@dataclass(frozen=True, kw_only=True)
class Axes(TensorRecord):
    """Cells to render, in units of the response."""

    range_bin: Tensor  # (range,) bins of the range transform, zero at the radar
    doppler_bin: Tensor  # (doppler,) bins of the Doppler transform, zero at rest
    place: Tensor  # (antenna, 2) x and z in wavelengths
    delay: Tensor  # (antenna,) delay of the transmitter, in lengths of the frame
    parts: Tensor  # (2, antenna, 2) x and z of the transmitter and of the receiver, in wavelengths


@dataclass(frozen=True, kw_only=True)
class Points(TensorRecord):
    """Scatterers as float tensors (..., point), in the units of the response they are used with."""

    range_bin: Tensor
    doppler_bin: Tensor
    direction: Tensor  # (..., point, 2) direction cosines along x and z
    amplitude: Tensor  # complex


class PointResponse:
    """Response of one radar to point echoes, in bins of range and Doppler.

    Attributes:
        velocity_a_bin_mps: Velocity per Doppler bin in m/s.
        range_a_bin_m: Range per range bin in metres.
        migration: Range migration in bins per loop and Doppler bin.
        coupling: Range-Doppler coupling: shift in range bins per Doppler bin.
        num_directions: Number of direction cosines that the array resolves.
    """

    def __init__(self, config: RadarConfig, doppler_window: np.ndarray | None = None):
        """Tabulates the window spectra.

        Args:
            config: The radar.
            doppler_window: Window (loop,) over the loops, which also sets their number; by default that of the cube.
        """
        window = windows.doppler_window(config.num_loops) if doppler_window is None else doppler_window
        self.config = config
        self.num_loops = len(window)
        self.range_kernel = WindowKernel(windows.hann(config.num_samples))
        self.doppler_kernel = WindowKernel(window)
        self._doppler_middle = self.doppler_kernel.middle / self.num_loops  # 1/2 for a Hann window
        length_s = self.num_loops * config.loop_period_s
        self.velocity_a_bin_mps = config.wavelength_m / (2 * length_s)
        self.range_a_bin_m = config.range_resolution_m
        self.migration = self.velocity_a_bin_mps * config.loop_period_s / self.range_a_bin_m
        self.delay = config.antenna_delay_s / length_s
        # a Doppler shift changes the beat frequency, too
        self.coupling = config.num_samples / config.sample_rate_hz / length_s
        place = config.antenna_position_m[:, [0, 2]] / config.wavelength_m
        self.num_directions = 1 if np.ptp(place[:, 1]) < FLAT_WAVELENGTHS else 2
        if np.ptp(place[:, 0]) < FLAT_WAVELENGTHS and self.num_directions == 1:
            self.num_directions = 0

    def axes(self, grid: CubeGrid | None = None) -> Axes:
        """The cells of a grid of this radar; by default those of the radar's own cube."""
        config = self.config
        if grid is None:
            range_bin = config.first_range_bin + np.arange(config.num_range_bins)
            doppler_bin = np.arange(self.num_loops) - self.num_loops // 2
            place_m = config.antenna_position_m
        else:
            range_bin = grid.range_m / self.range_a_bin_m
            doppler_bin = grid.radial_velocity_mps / self.velocity_a_bin_mps
            place_m = grid.antenna_position_m
        delay, parts_m = self._nearest(place_m)
        return Axes(
            range_bin=_tensor(range_bin),
            doppler_bin=_tensor(doppler_bin),
            place=_tensor(place_m[:, [0, 2]] / config.wavelength_m),
            delay=_tensor(delay),
            parts=_tensor(parts_m[:, :, [0, 2]] / config.wavelength_m),
        )

    def phasor(self, axes: Axes, *, is_grid: bool = True) -> Tensor:
        """exp(-j pi (r + 2 m d) - j 2 pi d s) (range, doppler, antenna): centred, compensated phase -> the cube's.

        m is the middle of the Doppler window in lengths of the frame. If not `is_grid`, (cell,) as in `cells`.
        """
        late = self._doppler_middle + axes.delay.double()  # (antenna,)
        range_bin, doppler_bin = axes.range_bin.double(), axes.doppler_bin.double()
        if is_grid:
            range_bin, doppler_bin = range_bin[:, None, None], doppler_bin[:, None]
        turns = -0.5 * range_bin - doppler_bin * late
        angle = 2 * math.pi * (turns - turns.round())
        return torch.polar(torch.ones_like(angle), angle).to(torch.complex64)

    def factors(self, points: Points, axes: Axes) -> tuple[Tensor, Tensor, Tensor, Tensor, Tensor]:
        """Separable factors of points.

        Args:
            points: Points (..., point).
            axes: Cells to render.

        Returns:
            K_r and K_r' (..., point, range), K_d and K_d' (..., point, doppler), S (..., point, antenna).
        """
        at_range, range_slope = self.range_kernel(axes.range_bin - points.range_bin[..., None])
        at_doppler, doppler_slope = self.doppler_kernel(axes.doppler_bin - points.doppler_bin[..., None])
        turns = points.doppler_bin[..., None] * axes.delay - points.direction @ axes.place.T
        angle = 2 * math.pi * (turns + self._curvature(points, axes))
        return at_range, range_slope, at_doppler, doppler_slope, torch.complex(torch.cos(angle), torch.sin(angle))

    def render(self, points: Points, axes: Axes, base: Tensor | None = None) -> Tensor:
        """Sum of the responses of points, in centred phase.

        Args:
            points: Points (..., point).
            axes: Cells to render.
            base: Cube to add to; by default zero.

        Returns:
            Values (..., range, doppler, antenna), complex64.
        """
        at_range, range_slope, at_doppler, doppler_slope, steer = self.factors(points, axes)
        echo = points.amplitude[..., None] * steer
        along = self.num_loops / (2 * math.pi) * self.migration * points.doppler_bin[..., None]
        moved = torch.complex(echo.imag * along, -echo.real * along)  # -j along echo
        nearer = points.direction @ axes.place.T * (self.config.wavelength_m / (2 * self.range_a_bin_m))
        plain = at_doppler[..., None] * _parts(echo)
        sloped = torch.addcmul(doppler_slope[..., None] * _parts(moved), at_doppler[..., None], _parts(echo * nearer))
        shape = (*points.amplitude.shape[:-1], len(axes.range_bin), len(axes.doppler_bin), len(axes.place), 2)
        flat = at_range.new_zeros(1) if base is None else torch.view_as_real(base).flatten(-3)
        for left, right in ((at_range, plain), (range_slope, sloped)):
            flat = _add_product(flat, left.transpose(-1, -2), right.flatten(-2))
        return torch.view_as_complex(flat.reshape(shape))

    def cells(self, points: Points, axes: Axes) -> Tensor:
        """Sum of the points at cells (..., cell), where the axes give one range, Doppler and antenna per cell."""
        at_range, range_slope, at_doppler, doppler_slope, steer = self.factors(points, axes)
        along = self.num_loops / (2 * math.pi) * self.migration * points.doppler_bin[..., None]
        nearer = points.direction @ axes.place.T * (self.config.wavelength_m / (2 * self.range_a_bin_m))
        real = at_range * at_doppler + nearer * range_slope * at_doppler
        echo = points.amplitude[..., None] * steer * torch.complex(real, -along * range_slope * doppler_slope)
        return echo.sum(dim=-2)

    def _curvature(self, points: Points, axes: Axes) -> Tensor:
        """Near-field phase in cycles (..., point, antenna) relative to a plane wave: (|x|^2 - (u.x)^2) / (2 R)."""
        range_wavelengths = points.range_bin.clamp(min=1.0) * (self.range_a_bin_m / self.config.wavelength_m)
        square = (axes.parts**2).sum(dim=(0, 2))
        along = sum((points.direction @ part.T) ** 2 for part in axes.parts)
        return (square - along) / (2 * range_wavelengths[..., None])

    def _nearest(self, place_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Delay (antenna,) and positions (2, antenna, 3) of transmitter and receiver of the nearest own antenna.

        The offset of a place from its antenna is split evenly between both.
        """
        config = self.config
        gap = np.linalg.norm(place_m[:, None] - config.antenna_position_m[None], axis=-1)
        own = gap.argmin(axis=1)
        ends = np.stack(
            [
                config.virtual_tx_position_m[own // config.num_rx],
                np.asarray(config.rx_position_m)[own % config.num_rx],
            ]
        )
        return self.delay[own], ends + (place_m - ends.sum(axis=0)) / 2


def _parts(echo: Tensor) -> Tensor:
    """Complex (..., point, antenna) -> real (..., point, 1, 2 antenna)."""
    return torch.view_as_real(echo).flatten(-2)[..., None, :]


def _add_product(total: Tensor, left: Tensor, right: Tensor) -> Tensor:
    """total + left @ right, in one pass where there is one axis of frames."""
    return torch.baddbmm(total, left, right) if left.dim() == 3 else total + left @ right


def _tensor(values: np.ndarray) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(values)).to(torch.float32)
