"""Greedy choice of new scatterers: matched-filter peaks of the residual."""

from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn.functional import max_pool2d

from mmweaver.dsp.point_response import Axes, PointResponse, Points

BEAMS_A_WAVELENGTH = 2.2  # slightly denser than the array's resolution
CELLS_A_POINT, CELLS_AT_ONCE = 16, 8192
LEAST_BEND = 0.5  # of a parabola, relative to its peak
ROUNDED = 1e-4
PEAK_SHARE = 0.9  # of the peak that a new scatterer gets, for neighbours share its energy


@dataclass(frozen=True, kw_only=True)
class Beams:
    """Grid of direction cosines (beam, 2) and unit-norm steering vectors (antenna, beam)."""

    direction: Tensor
    steer: Tensor

    @classmethod
    def over(cls, axes: Axes, num_directions: int) -> "Beams":
        """As dense as the aperture requires; a single zero cosine along a side the array cannot resolve."""
        sides = []
        for side in range(2):
            if side >= num_directions:
                sides.append(torch.zeros(1))
                continue
            aperture = float(axes.place[:, side].max() - axes.place[:, side].min())
            sides.append(torch.linspace(-0.95, 0.95, max(3, round(2 * BEAMS_A_WAVELENGTH * (aperture + 0.5)))))
        x, z = torch.meshgrid(*sides, indexing="ij")
        direction = torch.stack([x.flatten(), z.flatten()], dim=1)
        direction = direction[(direction**2).sum(1) <= 1]
        angle = 2 * torch.pi * (axes.place @ direction.T)
        return cls(direction=direction, steer=torch.polar(torch.ones_like(angle), angle) / len(axes.place) ** 0.5)


def matched_power(
    residual: Tensor, response: PointResponse, beams: Beams, *, count: int, least: float
) -> tuple[Tensor, Tensor]:
    """Energy (frame, range, doppler) that one scatterer per cell would explain, and the index of its beam.

    Where it is at most `least`, or less than that of `count` local maxima, it may be 0. A cell cannot explain more than
    the energy of its antennas, so that beams are formed in the strongest cells alone, in ever more of them.
    """
    smoothed = _along(_along(residual, response.range_kernel, 1), response.doppler_kernel, 2)
    bound = torch.view_as_real(smoothed).square().sum((-2, -1)) * (1 + ROUNDED)
    shape, flat = bound.shape, bound.flatten()
    power, beam = torch.zeros_like(flat), torch.zeros(flat.shape, dtype=torch.long)
    order = torch.topk(flat, min(len(flat), CELLS_A_POINT * count)).indices
    done = 0
    while True:
        some = order[done:]
        for part in some.split(CELLS_AT_ONCE):
            best = torch.view_as_real(smoothed.flatten(0, 2)[part] @ beams.steer).square().sum(-1).max(dim=-1)
            power[part], beam[part] = best.values, best.indices
        done = len(order)
        reached = float(flat[order[-1]])
        found = peaks(power.view(shape)) > max(reached, least)
        if done == len(flat) or reached <= least or int(found.sum()) >= count:
            return power.view(shape), beam.view(shape)
        order = torch.topk(flat, min(len(flat), 4 * done)).indices


def peaks(power: Tensor) -> Tensor:
    """Powers (frame, range, doppler) of local maxima over range and Doppler, 0 elsewhere."""
    return power * (power >= max_pool2d(power, 3, stride=1, padding=1))


def _along(values: Tensor, kernel, dim: int) -> Tensor:
    """Matched filter along one axis with the main lobe of the kernel."""
    taps = kernel(torch.tensor([0.0, 1.0]))[0]
    taps = taps / (taps[0] ** 2 + 2 * taps[1] ** 2) ** 0.5
    out = taps[0] * values
    size = values.shape[dim] - 1
    out.narrow(dim, 0, size).add_(taps[1] * values.narrow(dim, 1, size))
    out.narrow(dim, 1, size).add_(taps[1] * values.narrow(dim, 0, size))
    return out


def next_points(
    residual: Tensor, response: PointResponse, axes: Axes, beams: Beams, *, count: int, least: float
) -> Points:
    """The `count` best new scatterers over all frames, (frame, point), padded with amplitude zero.

    Candidates are local maxima over range and Doppler that explain more energy than `least`.
    """
    power, beam = matched_power(residual, response, beams, count=count, least=max(least, 0.0))
    frames, num_range, num_doppler = power.shape
    flat = peaks(power).flatten()
    best = torch.topk(flat, min(count, flat.numel()))
    chosen = best.indices[best.values > max(least, 0.0)]
    frame = chosen // (num_range * num_doppler)
    order = torch.argsort(frame, stable=True)
    chosen, frame = chosen[order], frame[order]
    counts = torch.bincount(frame, minlength=frames)
    slot = torch.arange(len(frame)) - torch.repeat_interleave(counts.cumsum(0) - counts, counts)
    size = int(counts.max()) if len(frame) else 0
    place = chosen % (num_range * num_doppler)
    points = Points(
        range_bin=torch.full((frames, size), float(axes.range_bin[0])),
        doppler_bin=torch.zeros(frames, size),
        direction=torch.zeros(frames, size, 2),
        amplitude=torch.zeros(frames, size, dtype=torch.complex64),
    )
    steer = beams.steer.T[beam.flatten()[chosen]] / len(axes.place) ** 0.5
    row, column = place // num_doppler, place % num_doppler
    received = _Received(residual.flatten(0, 2), chosen, steer)
    range_offset, by_range = received.offset(row, num_range, num_doppler, response.range_kernel)
    doppler_offset, by_doppler = received.offset(column, num_doppler, 1, response.doppler_kernel)
    points.range_bin[frame, slot] = axes.range_bin[row] + range_offset
    points.doppler_bin[frame, slot] = axes.doppler_bin[column] + doppler_offset
    points.direction[frame, slot] = beams.direction[beam.flatten()[chosen]]
    points.amplitude[frame, slot] = PEAK_SHARE * received.peak / (by_range * by_doppler)
    return points


class _Received:
    """Complex amplitudes in a beam each at peaks of the residual (cell, antenna) and at the cells next to them."""

    def __init__(self, residual: Tensor, cell: Tensor, steer: Tensor):
        self.residual, self.cell, self.steer = residual, cell, steer
        self.peak = (residual[cell] * steer).sum(-1)

    def offset(self, index: Tensor, size: int, stride: int, kernel) -> tuple[Tensor, Tensor]:
        """Offset in bins of a parabola through each peak and its neighbours along an axis, and the kernel there.

        `index`: of the peaks along the axis of `size` cells, `stride` apart.
        """
        before, after = (
            (self.residual[self.cell + side * stride * inside] * self.steer).sum(-1).div(self.peak).real * inside
            for side, inside in ((-1, index > 0), (1, index < size - 1))
        )
        offset = ((after - before) / (2 * (2 - after - before)).clamp(min=LEAST_BEND)).clamp(-0.5, 0.5)
        offset = offset.nan_to_num(0.0)  # a peak of nothing has no neighbours to lie between
        return offset, kernel(offset)[0]
