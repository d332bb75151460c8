"""Input maps of networks: range-Doppler and range-azimuth power in decibels above the receiver's noise.

Everything is scaled by constants of the radar, not of the sequence, so the absolute strength of a signal is
preserved. Differentiable with respect to the cube.
"""

import math

import torch
from torch import Tensor, nn

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.signal.windows import noise_share

NUM_AZIMUTHS, WIDEST_DEG = 32, 60.0
NUM_ANGLE_MAPS = 2  # all echoes, and the moving ones
MIDDLE_DB, SPREAD_DB = 20.0, 15.0  # offset and scale that normalise decibels above the noise
STATIC_BINS = 1  # on either side of zero Doppler, to which a Hann window spreads static clutter


class LogMaps(nn.Module):
    """Normalised log power maps of cubes, in units of 15 dB about 20 dB above the noise."""

    def __init__(self, config: RadarConfig):
        super().__init__()
        place = config.antenna_position_m
        row = azimuth_row(place, config.wavelength_m)
        sine = torch.linspace(-WIDEST_DEG, WIDEST_DEG, NUM_AZIMUTHS).deg2rad().sin()
        x = torch.tensor(2 * math.pi / config.wavelength_m * place[row, 0], dtype=torch.float32)
        moving = (torch.arange(config.num_loops) - config.num_loops // 2).abs() > STATIC_BINS
        self.noise_mw = config.noise_power_mw * noise_share(config.num_samples, config.num_loops)
        self.row: Tensor
        self.steering: Tensor
        self.is_moving: Tensor
        self.register_buffer("row", torch.from_numpy(row.astype("int64")), persistent=False)
        self.register_buffer("steering", torch.polar(torch.ones(()), x[:, None] * sine) / len(row), persistent=False)
        self.register_buffer("is_moving", moving.float(), persistent=False)

    def forward(self, values: Tensor) -> tuple[Tensor, Tensor]:
        """Computes the maps.

        Args:
            values: Cubes (..., range, doppler, antenna), complex, in sqrt(mW).

        Returns:
            Range-Doppler maps (..., 1, range, doppler), and range-azimuth maps (..., 2, range, azimuth) of all echoes
            and of moving ones.
        """
        power = values.abs().square().mean(dim=-1)
        beams = (values[..., self.row] @ self.steering).abs().square()
        count = float(len(self.is_moving))
        everything, moving = beams.sum(dim=-2), (beams * self.is_moving[:, None]).sum(dim=-2)
        noise = self.noise_mw * count / len(self.row)
        angle = torch.stack([everything, moving], dim=-3)
        return _numbers(power / self.noise_mw)[..., None, :, :], _numbers(angle / noise)


def _numbers(ratio: Tensor) -> Tensor:
    return (10 * torch.log10(ratio + 1) - MIDDLE_DB) / SPREAD_DB
