"""Resolution cells of a field of radar cross section: range, radial velocity and two direction cosines.

A field says how many square metres echo from a reference cell around a place. Cells of any other size hold that times
the ratio of the volumes, so one field is read at any resolution, by any radar.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.signal.point_response import PointResponse

REFERENCE = (0.05, 0.275, 0.125, 0.25)  # of a cell: m, m/s, cosine along x, cosine along z
NEAREST_M, FARTHEST_M = 0.3, 4.2
WIDEST = 0.97  # of the squared direction cosines: nothing is heard from the side
REACH = (0.9, 4.4, 0.6)  # of a person about the pelvis: m, m/s, cosine along x


@dataclass(frozen=True, kw_only=True)
class CellSizes:
    """How finely a field is read: sizes as in `REFERENCE`, and the ranges (m) that the radar keeps."""

    range_m: float = REFERENCE[0]
    velocity_mps: float = REFERENCE[1]
    cosine_x: float = REFERENCE[2]
    cosine_z: float = REFERENCE[3]
    nearest_m: float = NEAREST_M
    farthest_m: float = FARTHEST_M

    @classmethod
    def of(cls, config: RadarConfig) -> "CellSizes":
        """A cell in each bin of range and velocity, and two in each beam, or finer."""
        response = PointResponse(config)
        place = config.antenna_position_m[:, [0, 2]] / config.wavelength_m
        wide, high = (float(axis.max() - axis.min()) for axis in place.T)
        around = 2 * config.range_resolution_m
        return cls(
            range_m=response.range_a_bin_m,
            velocity_mps=response.velocity_a_bin_mps,
            cosine_x=min(REFERENCE[2], 1 / (2 * max(wide, 0.5))),
            cosine_z=min(REFERENCE[3], 1 / (2 * max(high, 0.5))),
            nearest_m=max(0.1, float(config.range_m[0]) - around),
            farthest_m=float(config.range_m[-1]) + around,
        )

    @property
    def spacing(self) -> tuple[float, float, float, float]:
        """Range, velocity, cosines along x and z."""
        return self.range_m, self.velocity_mps, self.cosine_x, self.cosine_z

    @property
    def room_share(self) -> float:
        """Volume of a cell at rest over that of a reference cell."""
        return self.moving_share * REFERENCE[1] / self.velocity_mps

    @property
    def moving_share(self) -> float:
        """Volume of a moving cell over that of a reference cell."""
        return math.prod(own / known for own, known in zip(self.spacing, REFERENCE, strict=True))

    def room_cells(self) -> Tensor:
        """Centres (cell, 3) of all cells at rest: range and direction cosines."""
        first, last = round(self.nearest_m / self.range_m), round(self.farthest_m / self.range_m)
        axes = [self.range_m * torch.arange(first, last + 1)]
        axes += [_cosines(step) for step in (self.cosine_x, self.cosine_z)]
        cells = torch.cartesian_prod(*axes)
        return cells[cells[:, 1:].square().sum(-1) < WIDEST]

    def boxes(self, pelvis: Tensor, shape: tuple[int, int, int, int]) -> tuple[Tensor, Tensor]:
        """Blocks of `shape` cells that fill the box around a pelvis (..., 4): range, velocity, direction cosines.

        Returns centres (..., block, 4) of the blocks and where their cells lie from there (cell, 4).
        """
        steps = torch.tensor(self.spacing)
        block = steps * torch.tensor(shape)
        counts = torch.ceil(2 * torch.tensor([*REACH, 1.0]) / block).int().tolist()
        grid = torch.cartesian_prod(*[torch.arange(count) - (count - 1) / 2 for count in counts])
        # blocks lie on the cells' own raster, so that a cell stays the same while a person passes
        middle = torch.cat([pelvis[..., :3], torch.zeros_like(pelvis[..., 3:])], -1)
        corner = torch.floor((middle[..., None, :] + (grid - 0.5) * block) / steps)
        inside = torch.cartesian_prod(*[torch.arange(count) - (count - 1) / 2 for count in shape])
        half = torch.tensor([(count - 1) / 2 for count in shape])
        return (corner + half) * steps, inside * steps

    def numbers(self, cells: Tensor) -> Tensor:
        """Numbers (...,) int64 of cells with centres (..., 4): the same for the same place."""
        index = torch.round(cells / torch.tensor(self.spacing)).long() + 512
        return ((index[..., 0] * 1024 + index[..., 1]) * 1024 + index[..., 2]) * 1024 + index[..., 3]


def _cosines(step: float) -> Tensor:
    count = int(1 / step)
    return step * torch.arange(-count, count + 1)
