"""Mean echoes -> paths of one realization: unknown phases are sampled, the rest follows from geometry.

A moving echo stands for several spots of skin that ride on one part of the body; their sum scintillates as the part
turns, as real skin does. Spots belong to the person, static phases to the room, so that the same seed, person and room
give the same signal, and a person's frames belong together.
Reference: docs/decisions/speckle-phases.md, docs/decisions/loss-on-mean-power.md.
"""

import math
from functools import lru_cache

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.propagation.mean_scatterers import MeanEchoes
from mmweaver.propagation.paths import ApparentPoint, Interaction, Paths, StaticPaths
from mmweaver.propagation.radar_equation import carrier, points_of
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.signal.point_response import PointResponse

SPOTS = 6  # of skin, for each echo
SPOT_SPREAD_M = 0.04
MIN_SHARE = 1e-4  # of the strongest static path's amplitude: fainter ones are left out


def sample_static(static: MeanEchoes, config: RadarConfig, room_seed: int) -> StaticPaths:
    """Static echoes with sampled phases.

    Args:
        static: mean echoes (echo,).
        config: the radar.
        room_seed: of the phases.
    """
    rng = stream(room_seed, "weaver", "room")
    amplitude = points_of(static, _response(config)).amplitude
    cycles = rng.random(len(amplitude))
    place_m = place_of(static).numpy()
    delay_s = 2 * np.linalg.norm(place_m, axis=1) / SPEED_OF_LIGHT_MPS
    # sampled is the phase at the receiver: the amplitude lacks what the renderers add along the path
    along = config.centre_frequency_hz * delay_s - config.chirp_slope_hz_per_s * delay_s**2 / 2
    sampled = amplitude.numpy() * np.exp(2j * np.pi * (cycles - along))
    return scattered_paths(place_m, sampled, Interaction.DIFFUSE, config)


def strongest_first(paths: StaticPaths) -> StaticPaths:
    """Static paths in the order of their strength; those too faint to matter are left out."""
    size = paths.amplitude.abs()
    return paths[size.argsort(descending=True)[: int((size > MIN_SHARE * size.max()).sum())]]


def sample_moving(moving: MeanEchoes, aspect: Tensor, config: RadarConfig, subject: int) -> Paths:
    """Moving echoes with sampled phases.

    Args:
        moving: mean echoes (frame, echo).
        aspect: (frame, 3), twice the line of sight that the body sees.
        config: the radar.
        subject: whose spots of skin scintillate.

    Returns:
        Paths (frame, echo).
    """
    offset_m, level = _spots(moving.range_m.shape[-1], subject)
    along_m = torch.einsum("fc,esc->fes", aspect, offset_m)
    scintillation = (carrier(along_m, config) * level).sum(dim=-1)
    amplitude = points_of(moving, _response(config)).amplitude * scintillation
    return Paths.direct(amplitude, radial_scatterers(moving, moving.range_m, moving.velocity_mps, 0 * moving.range_m))


def sample_moving_segments(
    moving: MeanEchoes, aspect: Tensor, time_s: Tensor, config: RadarConfig, subject: int
) -> Paths:
    """Moving echoes of frames with long chirps, a path for each spot of skin.

    Spots are paths of their own, whose phases follow the turning body: a sum of them, constant within a segment, would
    jump from one to the next. All are at their echo's range.

    Args:
        moving: mean echoes (frame, segment, echo).
        aspect: (frame, segment, 3), twice the line of sight that the body sees.
        time_s: (segment,), the middles of the segments.
        config: the radar.
        subject: whose spots of skin scintillate.

    Returns:
        Paths (frame * segment, echo * spot).
    """
    offset_m, level = _spots(moving.range_m.shape[-1], subject)
    along_m = torch.einsum("gtc,esc->gtes", aspect, offset_m)
    turning_mps = torch.gradient(along_m, spacing=(time_s.float(),), dim=1)[0]
    velocity_mps = moving.velocity_mps[..., None] + turning_mps
    acceleration = torch.gradient(velocity_mps, spacing=(time_s.float(),), dim=1)[0]
    range_m = moving.range_m[..., None].expand_as(along_m)
    amplitude = points_of(moving, _response(config)).amplitude[..., None] * level * carrier(along_m, config)
    spots = moving.map(lambda tensor: tensor[:, :, :, None].expand(-1, -1, -1, SPOTS, *tensor.shape[3:]))
    return Paths.direct(amplitude, radial_scatterers(spots, range_m, velocity_mps, acceleration)).map(
        lambda tensor: tensor.flatten(0, 1).flatten(1, 2)
    )


@lru_cache(maxsize=4)
def _response(config: RadarConfig) -> PointResponse:
    return PointResponse(config)


def place_of(echoes: MeanEchoes) -> Tensor:
    """Where echoes lie, (..., echo, 3) in metres, float64."""
    return echoes.range_m.double()[..., None] * _unit(echoes.direction)


def radial_scatterers(
    echoes: MeanEchoes, range_m: Tensor, velocity_mps: Tensor, acceleration_mps2: Tensor
) -> ApparentPoint:
    """Points in the echoes' directions with radial motion (..., echo)."""
    unit = _unit(echoes.direction)
    return ApparentPoint(
        position_m=range_m.double()[..., None] * unit,
        velocity_mps=velocity_mps.double()[..., None] * unit,
        acceleration_mps2=acceleration_mps2.double()[..., None] * unit,
    )


def _unit(direction: Tensor) -> Tensor:
    """Unit vectors (..., 3) of direction cosines (..., 2) along x and z, ahead of the radar; float64."""
    x, z = direction.double().unbind(-1)
    ahead = (1 - x.square() - z.square()).clamp(min=0).sqrt()
    return torch.nn.functional.normalize(torch.stack([x, ahead, z], dim=-1), dim=-1)


def _spots(count: int, subject: int) -> tuple[Tensor, Tensor]:
    """Of each echo's spots of skin: place on the body (echo, spot, 3) in metres, and complex amplitude (echo, spot)."""
    rng = stream(subject, "weaver", "skin")
    offset_m = torch.from_numpy(rng.standard_normal((count, SPOTS, 3)) * SPOT_SPREAD_M).to(torch.float32)
    level = torch.from_numpy(rng.standard_normal((count, SPOTS, 2)) / math.sqrt(2 * SPOTS)).to(torch.float32)
    return offset_m, torch.view_as_complex(level)
