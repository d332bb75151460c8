"""Parameters of a scatterer field: points per working frame over a static layer, with antenna calibration.

Receiver noise of a radar cube, sampled directly in its cells, without ADC samples or FFTs.

The transform of white noise is white, and the Hann window, whose spectrum is 1/2 and twice -1/4, mixes each bin with
its two neighbours. It is therefore sufficient to sample the stored bins and one more at either end.
"""

from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.signal.point_response import Axes, PointResponse, Points
from mmweaver.signal.windows import MIN_HANN_LOOPS, doppler_window

MIXED_POWER = 1.5  # sum of the squares of 1, -1/2, -1/2


def cell_noise(rng: np.random.Generator, config: RadarConfig, num_frames: int) -> np.ndarray:
    """Unit-power noise of frames that share no chirps.

    Args:
        rng: Random stream.
        config: The radar.
        num_frames: Number of frames.

    Returns:
        Noise (frame, range, doppler, antenna), complex64.
    """
    shape = (num_frames, config.num_range_bins, config.num_loops, config.num_antennas)
    out = np.empty(shape, np.complex64)
    samples = torch.empty(_num_sampled_bins(config), config.num_loops, 2 * config.num_antennas)
    generator = torch.Generator().manual_seed(int(rng.integers(1 << 62)))  # three times as fast as numpy's
    mixes_loops = config.num_loops >= MIN_HANN_LOOPS
    power = 2 * MIXED_POWER * (MIXED_POWER if mixes_loops else 1.0)
    for frame in out:  # one at a time stays in the cache
        lines = _range_bins(samples.normal_(generator=generator).numpy(), config)
        if mixes_loops:
            lines = lines - 0.5 * _neighbours(lines)
        np.multiply(lines, np.float32(power**-0.5), out=frame.view(np.float32))
    return out


def overlapping_noise(rng: np.random.Generator, config: RadarConfig, num_frames: int, hop: int) -> np.ndarray:
    """As `cell_noise`, of frames `hop` loops apart, which share the noise of their chirps."""
    loops = config.num_loops
    shape = (_num_sampled_bins(config), loops + hop * (num_frames - 1), 2 * config.num_antennas)
    lines = np.ascontiguousarray(_range_bins(rng.standard_normal(shape, dtype=np.float32), config)).view(np.complex64)
    window = doppler_window(loops)
    window = (window / np.sqrt(2 * MIXED_POWER * np.sum(window**2))).astype(np.float32)
    cut = np.stack([lines[:, hop * at :][:, :loops] for at in range(num_frames)])
    return np.fft.fft(cut * window[:, None], axis=2).astype(np.complex64)


def _neighbours(lines: np.ndarray) -> np.ndarray:
    """Sum of the two cyclic neighbours of each Doppler bin (range, doppler, value)."""
    out = np.empty_like(lines)
    np.add(lines[:, :-2], lines[:, 2:], out=out[:, 1:-1])
    np.add(lines[:, 1], lines[:, -1], out=out[:, 0])
    np.add(lines[:, -2], lines[:, 0], out=out[:, -1])
    return out


def _num_sampled_bins(config: RadarConfig) -> int:
    """Range bins that are sampled: those stored, and one more at either end where there is one."""
    return min(config.num_range_bins + 2, config.num_samples)


def _range_bins(white: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Mixes white bins as the range window does.

    Args:
        white: White noise (sampled, ...) of `_num_sampled_bins` bins.
        config: The radar.

    Returns:
        The stored bins (range, ...), with 3/2 of the power.
    """
    if len(white) < config.num_range_bins + 2:  # all bins, or all but one, are stored: neighbours are cyclic
        white = white[np.arange(-1, config.num_range_bins + 1) % config.num_samples]
    return white[1:-1] - 0.5 * (white[:-2] + white[2:])


VALUES_OF_POINT = 4  # range, velocity, complex amplitude; plus one per direction the array resolves

Array = np.ndarray
StaticResponse = tuple[Float[Array, "bins"], slice]  # of Doppler bins, and which these are

NO_RESPONSE = 1e-5  # relative to the peak
BITS_OF_VALUE = 32  # float32


@dataclass(frozen=True, kw_only=True)
class Layers:
    """Parameters of one fit window, in units of its response.

    `points` (frame, point) are padded with amplitude zero. `static` (range, antenna): static clutter, one complex
    amplitude per range cell and antenna; its Doppler response is known. `calibration` (antenna,): complex gains of the
    array. `noise_power`: per cell, not part of a rendered cube. `active_beams` (range, beam): beams of the static layer
    that are not zero; None = all.
    """

    points: Points
    static: Tensor
    calibration: Tensor
    noise_power: float
    active_beams: Array | None = None

    def counts(self) -> Tensor:
        """Number of scatterers (frame,)."""
        return (self.points.amplitude != 0).sum(dim=1)

    def num_values(self, response: PointResponse) -> int:
        """Number of real parameters: points, static layer, learned gains, and the noise power."""
        points = int(self.counts().sum()) * values_of_point(response)
        static = static_values(self.active_beams, self.static.numel()) if bool((self.static != 0).any()) else 0
        gains = 2 * self.calibration.numel() if bool((self.calibration != 1).any()) else 0
        return points + static + gains + 1


def values_of_point(response: PointResponse) -> int:
    """Number of real parameters of one scatterer."""
    return VALUES_OF_POINT + response.num_directions


def static_values(active_beams: Array | None, num_cells: int) -> int:
    """Real parameters of a static layer: two per active beam, and one per 32 bits of the mask (range, beam)."""
    if active_beams is None:
        return 2 * num_cells
    return min(2 * num_cells, 2 * int(active_beams.sum()) + -(-num_cells // BITS_OF_VALUE))


def rendered(layers: Layers, response: PointResponse, axes: Axes) -> Tensor:
    """Renders points and static layer in centred phase.

    Args:
        layers: Layers of one fit window.
        response: Point response of that window.
        axes: Cells to render.

    Returns:
        Values (frame, range, doppler, antenna), complex64.
    """
    cells = response.render(layers.points, axes, static_cells(layers.static, response, axes))
    return cells * layers.calibration if bool((layers.calibration != 1).any()) else cells


def static_cells(static: Tensor, response: PointResponse, axes: Axes) -> Tensor:
    """Cells of a static layer.

    Args:
        static: Static layer (range, antenna).
        response: Point response of the window.
        axes: Cells to render.

    Returns:
        Values (range, doppler, antenna).
    """
    return static[:, None, :] * response.doppler_kernel(axes.doppler_bin)[0][:, None]


def subtract_static(residual: Array, static: Array, response: StaticResponse) -> None:
    """Subtracts a static layer from a residual, in place.

    Args:
        residual: Residual (frame, range, doppler, antenna).
        static: Static layer (range, antenna).
        response: As given by `static_response`.
    """
    kernel, bins = response
    residual[:, :, bins] -= static[:, None, :] * kernel[:, None]


def fit_static(residual: Array, response: StaticResponse) -> Array:
    """Least-squares static layer of a residual.

    Args:
        residual: Residual (frame, range, doppler, antenna).
        response: As given by `static_response`.

    Returns:
        Static layer (range, antenna).
    """
    kernel, bins = response
    return np.einsum("trda,d->ra", residual[:, :, bins], kernel) / (len(residual) * np.square(kernel).sum())


def static_response(response: PointResponse, axes: Axes) -> StaticResponse:
    """Doppler response of zero velocity, where it is not zero.

    Args:
        response: Point response of the window.
        axes: Cells to render.

    Returns:
        The response, and the slice of its bins: three for a Hann window.
    """
    kernel = response.doppler_kernel(axes.doppler_bin)[0].numpy()
    found = np.flatnonzero(np.abs(kernel) > NO_RESPONSE)
    bins = slice(int(found[0]), int(found[-1]) + 1) if len(found) else slice(0, 0)
    return kernel[bins], bins


def no_points(num_frames: int) -> Points:
    """Scatterers (frame, 0) of frames without any."""
    return Points(
        range_bin=torch.zeros(num_frames, 0),
        doppler_bin=torch.zeros(num_frames, 0),
        direction=torch.zeros(num_frames, 0, 2),
        amplitude=torch.zeros(num_frames, 0, dtype=torch.complex64),
    )


def select_points(points: Points, order: Tensor) -> Points:
    """Points of each frame selected by index.

    Args:
        points: Points (frame, point).
        order: Indices (frame, selected).
    """
    return points[torch.arange(len(order))[:, None], order]


def compact(points: Points) -> Points:
    """Moves the padding to the end of each frame and trims it."""
    is_padding = points.amplitude == 0
    order = is_padding.to(torch.uint8).argsort(dim=1, stable=True)
    size = int((~is_padding).sum(dim=1).max()) if is_padding.numel() else 0
    return select_points(points, order[:, :size])


def strongest(points: Points, count: int) -> Points:
    """The strongest points over all frames.

    Args:
        points: Points (frame, point).
        count: Number of points to keep.

    Returns:
        Points (frame, point), padded with amplitude zero.
    """
    size = points.amplitude.abs().flatten()
    if count >= int((size > 0).sum()):
        return compact(points)
    least = size.sort(descending=True).values[count]
    silent = torch.zeros_like(points.amplitude)
    return compact(replace(points, amplitude=torch.where(points.amplitude.abs() > least, points.amplitude, silent)))
