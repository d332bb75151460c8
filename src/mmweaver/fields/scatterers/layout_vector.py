"""Scatterers as one flat vector of values of order 1, suitable as a network's output."""

from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.dsp.point_response import Axes, PointResponse, Points

PER_POINT = 6  # range, velocity, two direction cosines, real and imaginary amplitude


@dataclass(frozen=True, kw_only=True)
class ScattererLayout:
    """Layout of a vector (..., num_points * 6): for each scatterer range, velocity, x, z, re, im.

    Range and velocity run from -1 to 1 over the radar's cells, direction cosines are unscaled, amplitudes are in units
    of `peak`. Both directions are differentiable; `packed` is the inverse of `points`.
    """

    num_points: int
    first_bin: tuple[float, float]  # range, Doppler: the middle of the axis
    half_bins: tuple[float, float]  # from the middle to the last cell

    @classmethod
    def of(cls, response: PointResponse, num_points: int) -> "ScattererLayout":
        return cls.over(response.axes(), num_points)

    @classmethod
    def over(cls, axes: Axes, num_points: int) -> "ScattererLayout":
        """The layout of scatterers within these axes."""
        ends = [(float(axis[0]), float(axis[-1])) for axis in (axes.range_bin, axes.doppler_bin)]
        middle = tuple((first + last) / 2 for first, last in ends)
        half = tuple(max((last - first) / 2, 0.5) for first, last in ends)
        return cls(num_points=num_points, first_bin=(middle[0], middle[1]), half_bins=(half[0], half[1]))

    @property
    def num_values(self) -> int:
        return PER_POINT * self.num_points

    def points(self, values: Tensor) -> Points:
        """Vector (..., num_values) -> scatterers (..., point)."""
        parts = values.unflatten(-1, (self.num_points, PER_POINT))
        return Points(
            range_bin=self.first_bin[0] + self.half_bins[0] * parts[..., 0],
            doppler_bin=self.first_bin[1] + self.half_bins[1] * parts[..., 1],
            direction=parts[..., 2:4],
            amplitude=torch.complex(parts[..., 4], parts[..., 5]),
        )

    def packed(self, points: Points) -> Tensor:
        """Scatterers (..., point) -> vector, padded to `num_points` with amplitude zero."""
        missing = self.num_points - points.amplitude.shape[-1]
        if missing < 0:
            raise ValueError(f"{points.amplitude.shape[-1]} scatterers do not fit into {self.num_points} places")
        columns = [
            (points.range_bin - self.first_bin[0]) / self.half_bins[0],
            (points.doppler_bin - self.first_bin[1]) / self.half_bins[1],
            points.direction[..., 0],
            points.direction[..., 1],
            points.amplitude.real,
            points.amplitude.imag,
        ]
        rows = torch.stack(columns, dim=-1)
        return torch.nn.functional.pad(rows, (0, 0, 0, missing)).flatten(-2)
