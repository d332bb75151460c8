"""One realization of mean echoes: unknown phases are sampled, everything else follows from geometry.

A moving echo represents several spots of skin that move with one part of the body; their sum scintillates as the part
turns, as real skin does. Spots belong to the person and static phases to the room, so the same seed, person and room
give the same signal, and a person's frames are coherent.
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
from mmweaver.propagation.mean_power import MeanEchoes
from mmweaver.propagation.paths import ApparentPoint, Interaction, Paths, StaticPaths
from mmweaver.propagation.radar_equation import carrier, points_of
from mmweaver.propagation.static_paths import scattered_paths
from mmweaver.signal.point_response import PointResponse

SPOTS = 6  # of skin, per echo
SPOT_SPREAD_M = 0.04
MIN_SHARE = 1e-4  # amplitude relative to the strongest static path below which paths are omitted


def sample_static(static: MeanEchoes, config: RadarConfig, room_seed: int) -> StaticPaths:
    """Samples the phases of static echoes.

    Args:
        static: Mean echoes, (echo,).
        config: The radar.
        room_seed: Seed of the phases.

    Returns:
        Static paths of kind DIFFUSE, (echo,), amplitudes in sqrt(mW).
    """
    rng = stream(room_seed, "weaver", "room")
    amplitude = points_of(static, _response(config)).amplitude
    cycles = rng.random(len(amplitude))
    place_m = place_of(static).numpy()
    delay_s = 2 * np.linalg.norm(place_m, axis=1) / SPEED_OF_LIGHT_MPS
    # the phase at the receiver is sampled, so the phase that the renderers add along the path is removed here
    along = config.centre_frequency_hz * delay_s - config.chirp_slope_hz_per_s * delay_s**2 / 2
    sampled = amplitude.numpy() * np.exp(2j * np.pi * (cycles - along))
    return scattered_paths(place_m, sampled, Interaction.DIFFUSE, config)


def strongest_first(paths: StaticPaths) -> StaticPaths:
    """Static paths sorted by amplitude, without negligible ones."""
    size = paths.amplitude.abs()
    return paths[size.argsort(descending=True)[: int((size > MIN_SHARE * size.max()).sum())]]


def sample_moving(moving: MeanEchoes, aspect: Tensor, config: RadarConfig, subject: int) -> Paths:
    """Samples the phases of moving echoes.

    Args:
        moving: Mean echoes, (frame, echo).
        aspect: Twice the line of sight in the body's frame of reference, (frame, 3).
        config: The radar.
        subject: Person whose spots of skin scintillate.

    Returns:
        Direct paths (frame, echo), amplitudes in sqrt(mW).
    """
    offset_m, level = _spots(moving.range_m.shape[-1], subject)
    along_m = torch.einsum("fc,esc->fes", aspect, offset_m)
    scintillation = (carrier(along_m, config) * level).sum(dim=-1)
    amplitude = points_of(moving, _response(config)).amplitude * scintillation
    return Paths.direct(amplitude, radial_scatterers(moving, moving.range_m, moving.velocity_mps, 0 * moving.range_m))


def sample_moving_segments(
    moving: MeanEchoes, aspect: Tensor, time_s: Tensor, config: RadarConfig, subject: int
) -> Paths:
    """Samples the phases of moving echoes of frames with long chirp sequences, one path per spot of skin.

    Each spot is a path of its own, whose phase follows the turning body: a sum over spots that is constant within a
    segment would jump at its end. All spots are at the range of their echo.

    Args:
        moving: Mean echoes, (frame, segment, echo).
        aspect: Twice the line of sight in the body's frame of reference, (frame, segment, 3).
        time_s: Middles of the segments, (segment,), in seconds.
        config: The radar.
        subject: Person whose spots of skin scintillate.

    Returns:
        Direct paths (frame * segment, echo * spot), amplitudes in sqrt(mW).
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
    """Positions of echoes, (..., echo, 3) in metres, float64."""
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
    """Each echo's spots of skin: offset on the body (echo, spot, 3) in metres, and complex amplitude (echo, spot)."""
    rng = stream(subject, "weaver", "skin")
    offset_m = torch.from_numpy(rng.standard_normal((count, SPOTS, 3)) * SPOT_SPREAD_M).to(torch.float32)
    level = torch.from_numpy(rng.standard_normal((count, SPOTS, 2)) / math.sqrt(2 * SPOTS)).to(torch.float32)
    return offset_m, torch.view_as_complex(level)
