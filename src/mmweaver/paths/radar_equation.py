"""Echoes as one radar sees them: the radar equation, and the units of its cells. Differentiable."""

import math

import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.dsp.point_response import PointResponse, Points
from mmweaver.paths.antenna import (
    AZIMUTH_ROLL_OFF,
    ELEVATION_ROLL_OFF,
    FLOOR_DB,
    scatterer_gain,
)
from mmweaver.paths.mean_paths import Echoes


def points_of(echoes: Echoes, response: PointResponse) -> Points:
    """Scatterers in bins of the response, amplitudes real, in sqrt(mW). Reference: primer, equation 10."""
    config = response.config
    loss = pattern_db(echoes.direction, config)
    gain = scatterer_gain(config) * 10 ** (-loss / 10)  # out and back
    amplitude = gain * echoes.cross_section_m2.clamp(min=1e-30).sqrt() / echoes.range_m.clamp(min=0.1) ** 2
    doppler_bin = echoes.velocity_mps / response.velocity_a_bin_mps
    return Points(
        range_bin=echoes.range_m / response.range_a_bin_m + response.coupling * doppler_bin,
        doppler_bin=doppler_bin,
        direction=echoes.direction,
        amplitude=amplitude,
    )


def pattern_db(direction: Tensor, config: RadarConfig) -> Tensor:
    """Loss of one antenna towards direction cosines (..., 2) along x and z; `paths.antenna.pattern` in torch."""
    x, z = direction.unbind(-1)
    ahead = (1 - x.square() - z.square()).clamp(min=1e-4).sqrt()
    azimuth = torch.rad2deg(torch.atan2(x, ahead)).abs().clamp(min=1e-3)
    elevation = torch.rad2deg(torch.asin(z.clamp(-0.999, 0.999))).abs().clamp(min=1e-3)
    loss = 3 * (azimuth / (config.azimuth_beamwidth_deg / 2)) ** AZIMUTH_ROLL_OFF
    loss = loss + 3 * (elevation / (config.elevation_beamwidth_deg / 2)) ** ELEVATION_ROLL_OFF
    side = -FLOOR_DB - 10 * torch.log10((1 - z.square()).clamp(min=1e-3))
    return torch.minimum(loss, side)


def carrier(range_m: Tensor, config: RadarConfig) -> Tensor:
    """exp(j 4 pi R / wavelength), the phase of an echo from there; turns are wrapped in double precision."""
    turns = 2 * range_m.double() / config.wavelength_m
    angle = (2 * math.pi * (turns - turns.round())).to(torch.float32)
    return torch.polar(torch.ones_like(angle), angle)
