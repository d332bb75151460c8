"""Mean echoes as received by one radar: the radar equation, in units of its cells. Differentiable."""

import math

import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.propagation.antenna import pattern_db, scatterer_gain
from mmweaver.propagation.mean_power import MeanEchoes
from mmweaver.signal.point_response import PointResponse, Points


def points_of(echoes: MeanEchoes, response: PointResponse) -> Points:
    """Applies the radar equation to mean echoes. Reference: docs/radar_primer.md, equation 10.

    Args:
        echoes: Mean echoes, (..., echo).
        response: Point response of the radar, which defines the bins.

    Returns:
        Points (..., echo) of real amplitude in sqrt(mW).
    """
    config = response.config
    loss = direction_loss_db(echoes.direction, config)
    gain = scatterer_gain(config) * 10 ** (-loss / 10)  # out and back
    amplitude = gain * echoes.cross_section_m2.clamp(min=1e-30).sqrt() / echoes.range_m.clamp(min=0.1) ** 2
    doppler_bin = echoes.velocity_mps / response.velocity_a_bin_mps
    return Points(
        range_bin=echoes.range_m / response.range_a_bin_m + response.coupling * doppler_bin,
        doppler_bin=doppler_bin,
        direction=echoes.direction,
        amplitude=amplitude,
    )


def direction_loss_db(direction: Tensor, config: RadarConfig) -> Tensor:
    """One-way antenna loss towards directions in front of the radar.

    Args:
        direction: Direction cosines (..., 2) along x and z.
        config: The radar, for its beamwidths.

    Returns:
        Loss (...) in dB.
    """
    x, z = direction.unbind(-1)
    ahead = (1 - x.square() - z.square()).clamp(min=1e-4).sqrt()
    return pattern_db(torch.stack([x, ahead, z], dim=-1), config)


def carrier(range_m: Tensor, config: RadarConfig) -> Tensor:
    """Two-way carrier phasor exp(j 4 pi R / wavelength); cycles are wrapped in double precision.

    Args:
        range_m: Ranges R (...) in metres.
        config: The radar, for its wavelength.

    Returns:
        Phasors (...), complex64.
    """
    cycles = 2 * range_m.double() / config.wavelength_m
    angle = (2 * math.pi * (cycles - cycles.round())).to(torch.float32)
    return torch.polar(torch.ones_like(angle), angle)
