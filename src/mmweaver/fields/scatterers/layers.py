"""What a scatterer field is made of: points in each working frame over a static layer, seen by a calibrated array."""

from dataclasses import dataclass, replace

import torch
from torch import Tensor

from mmweaver.dsp.point_response import Axes, PointResponse, Points

VALUES_OF_POINT = 4  # range, velocity, complex amplitude; and one for each direction the array can tell

BITS_OF_VALUE = 32  # float32


@dataclass(frozen=True, kw_only=True)
class Layers:
    """Parameters of one stretch, in units of its response.

    `points` (frame, point) are padded with amplitude zero. `static` (range, antenna): what stands still, one complex
    number for each range cell and antenna; its Doppler response is known. `kept_beams` (range, beam): the beams of it
    that are not zero, None = all. `calibration` (antenna,) multiplies all of it. `noise_power` is that of one cell,
    what a rendered cube lacks.
    """

    points: Points
    static: Tensor
    calibration: Tensor
    noise_power: float
    kept_beams: Tensor | None = None

    def counts(self) -> Tensor:
        """Scatterers in each frame."""
        return (self.points.amplitude != 0).sum(dim=1)

    def num_values(self, response: PointResponse) -> int:
        """Real numbers that say all of this: the points, the static layer, the gains where learned, the noise."""
        points = int(self.counts().sum()) * values_of_point(response)
        has_static = bool((self.static != 0).any())
        static = static_values(self.kept_beams, self.static.numel()) if has_static else 0
        gains = 2 * self.calibration.numel() if bool((self.calibration != 1).any()) else 0
        return points + static + gains + 1


def values_of_point(response: PointResponse) -> int:
    """Real numbers of one scatterer."""
    return VALUES_OF_POINT + response.num_directions


def static_values(kept_beams: Tensor | None, num_cells: int) -> int:
    """Real numbers of a static layer: two a beam that is kept, and one for every 32 marks of which are."""
    if kept_beams is None:
        return 2 * num_cells
    return min(2 * num_cells, 2 * int(kept_beams.sum()) + -(-num_cells // BITS_OF_VALUE))


def rendered(layers: Layers, response: PointResponse, axes: Axes) -> Tensor:
    """Points and static layer on the response's own range and antenna cells, centred phase."""
    cells = response.render(layers.points, axes, static_cells(layers.static, response, axes))
    return cells * layers.calibration if bool((layers.calibration != 1).any()) else cells


def static_cells(static: Tensor, response: PointResponse, axes: Axes) -> Tensor:
    """(range, antenna) at rest -> (range, doppler, antenna)."""
    return static[:, None, :] * response.doppler_kernel(axes.doppler_bin)[0][:, None]


def at_rest(residual: Tensor, response: PointResponse, axes: Axes) -> Tensor:
    """The least-squares static layer (range, antenna) of a residual."""
    kernel = response.doppler_kernel(axes.doppler_bin)[0]
    still = torch.einsum("trda,d->ra", residual, kernel.to(residual.dtype))
    return still / (len(residual) * kernel.square().sum())


def no_points(num_frames: int) -> Points:
    return Points(
        range_bin=torch.zeros(num_frames, 0),
        doppler_bin=torch.zeros(num_frames, 0),
        direction=torch.zeros(num_frames, 0, 2),
        amplitude=torch.zeros(num_frames, 0, dtype=torch.complex64),
    )


def picked(points: Points, order: Tensor) -> Points:
    """Points of each frame in another order, or some of them: `order` (frame, wanted)."""
    return Points(
        range_bin=points.range_bin.gather(1, order),
        doppler_bin=points.doppler_bin.gather(1, order),
        direction=points.direction.gather(1, order[..., None].expand(-1, -1, 2)),
        amplitude=points.amplitude.gather(1, order),
    )


def joined(first: Points, second: Points) -> Points:
    """Both, without the padding between them."""
    return compact(
        Points(
            range_bin=torch.cat([first.range_bin, second.range_bin], 1),
            doppler_bin=torch.cat([first.doppler_bin, second.doppler_bin], 1),
            direction=torch.cat([first.direction, second.direction], 1),
            amplitude=torch.cat([first.amplitude, second.amplitude], 1),
        )
    )


def compact(points: Points) -> Points:
    """Padding at the end of each frame, and no more of it than needed."""
    is_padding = points.amplitude == 0
    order = is_padding.to(torch.uint8).argsort(dim=1, stable=True)
    size = int((~is_padding).sum(dim=1).max()) if is_padding.numel() else 0
    return picked(points, order[:, :size])


def strongest(points: Points, count: int) -> Points:
    """The `count` strongest of all frames."""
    size = points.amplitude.abs().flatten()
    if count >= int((size > 0).sum()):
        return compact(points)
    least = size.sort(descending=True).values[count]
    silent = torch.zeros_like(points.amplitude)
    return compact(replace(points, amplitude=torch.where(points.amplitude.abs() > least, points.amplitude, silent)))
