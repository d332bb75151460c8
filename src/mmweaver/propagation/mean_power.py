"""Mean power maps of echoes of unknown phase: the predictable part of a radar signal.

Echoes of independent phase add in power. Reference: speckle statistics (Goodman).

Output of the networks: mean echoes, independent of the radar, before phases are sampled (`speckle`).
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.core.virtual_array import azimuth_row, elevation_columns
from mmweaver.signal.point_response import Axes, PointResponse, Points
from mmweaver.signal.spectra import azimuth_axis_rad, elevation_axis_rad
from mmweaver.signal.windows import noise_share


@dataclass(frozen=True, kw_only=True)
class MeanEchoes(TensorRecord):
    """Echoes of scatterers, averaged over their unknown phases."""

    range_m: Tensor  # (..., echo)
    velocity_mps: Tensor  # (..., echo) radial, positive away from the radar
    direction: Tensor  # (..., echo, 2) direction cosines along x and z
    cross_section_m2: Tensor  # (..., echo) mean


@dataclass(frozen=True, kw_only=True)
class PowerMaps(TensorRecord):
    """Power in mW, scaled as by `signal.spectra`: (frame, range, doppler), (frame, range, azimuth), and so on."""

    range_doppler: Tensor
    range_azimuth: Tensor
    range_elevation: Tensor  # without elevation cells where the array has no vertical aperture


class MeanPower:
    """Mean power maps of points for one radar; differentiable with respect to all properties of the points."""

    def __init__(self, config: RadarConfig):
        """Prepares the cells and beams of a radar.

        Args:
            config: The radar.
        """
        self.config = config
        self.response = PointResponse(config)
        self.axes: Axes = self.response.axes()
        place = config.antenna_position_m
        row = azimuth_row(place, config.wavelength_m)
        wave = 2 * math.pi / config.wavelength_m
        self._row_x = torch.tensor(wave * place[row, 0], dtype=torch.float32)
        self._sin_azimuth = torch.tensor(azimuth_axis_rad(), dtype=torch.float32).sin()
        columns = elevation_columns(place, config.wavelength_m)
        self._column_z = torch.tensor(wave * place[columns[0], 2] if columns else [], dtype=torch.float32)
        self._sin_elevation = torch.tensor(elevation_axis_rad(), dtype=torch.float32).sin()
        self.noise = config.noise_power_mw * noise_share(config.num_samples, config.num_loops)
        self.noise *= float(config.tx_noise_gain.mean())

    def to(self, device: torch.device) -> "MeanPower":
        """Moves the tensors to a device, in place, and returns itself."""
        self.axes = self.axes.to(device)
        for name in ("_row_x", "_column_z", "_sin_azimuth", "_sin_elevation"):
            setattr(self, name, getattr(self, name).to(device))
        return self

    def maps(self, points: Points) -> PowerMaps:
        """Mean power maps of points of independent phase.

        Args:
            points: Points (..., point) in bins of the response; their squared magnitude is the mean power.

        Returns:
            Power in mW: (..., range, doppler), (..., range, azimuth), (..., range, elevation).
        """
        power = points.amplitude.abs().square()
        at_range = self.response.range_kernel(self.axes.range_bin - points.range_bin[..., None])[0].square()
        weighted = (at_range * power[..., None]).transpose(-1, -2)
        at_doppler = self.response.doppler_kernel(self.axes.doppler_bin - points.doppler_bin[..., None])[0].square()
        along_doppler = at_doppler.sum(dim=-1, keepdim=True)
        return PowerMaps(
            range_doppler=weighted @ at_doppler,
            range_azimuth=weighted @ (along_doppler * _beam(points.direction[..., 0], self._row_x, self._sin_azimuth)),
            range_elevation=weighted @ (along_doppler * self._elevation_beam(points.direction[..., 1])),
        )

    def noise_maps(self) -> tuple[float, float, float]:
        """Mean receiver noise in mW per cell of each map."""
        beam = self.noise * len(self.axes.doppler_bin)
        return self.noise, beam / len(self._row_x), beam / max(len(self._column_z), 1)

    def _elevation_beam(self, cosine_z: Tensor) -> Tensor:
        if not len(self._column_z):
            return cosine_z.new_zeros((*cosine_z.shape, 0))
        return _beam(cosine_z, self._column_z, self._sin_elevation)


def _beam(cosine: Tensor, place: Tensor, sine: Tensor) -> Tensor:
    """Power pattern (..., point, angle) of a line of antennas at `place` (phase in rad), steered to each angle."""
    own = cosine[..., None] * place
    steered = place[:, None] * sine
    # sum over the line of exp(j steered - j own), as two matrix products
    both = torch.cat([own.cos(), own.sin()], dim=-1)
    real = both @ torch.cat([steered.cos(), steered.sin()])
    imaginary = both @ torch.cat([steered.sin(), -steered.cos()])
    return (real.square() + imaginary.square()) / len(place) ** 2
