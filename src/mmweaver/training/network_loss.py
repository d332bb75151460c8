"""Loss of the learned method: on mean power maps, never on phase.

The power of a radar cell in which several echoes of unknown phase meet is exponentially distributed about its mean.
The likelihood of that mean is the Itakura-Saito divergence, p/m - log(p/m) - 1: it weighs decibels equally in weak and
strong cells. But where the network cannot know whether a cell is bright, it estimates the mean of the bright case, and
the maps glow all over; the absolute difference of logarithms estimates the median instead. Both are used.

Reference: Fevotte et al. 2009.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.propagation.mean_power import MeanPower, PowerMaps
from mmweaver.propagation.mean_scatterers import MeanEchoes
from mmweaver.propagation.radar_equation import points_of

STEEPEST = 8.0
LIKELIHOOD = 0.2  # weight of the divergence relative to the difference of logarithms
FLOOR = 1e-5  # of the peak: levels below a 50 dB display have no weight
OF_PERSON = 2.0  # weight of the maps of the person alone, where the network has most to learn
FLOOR_OF_PERSON = 1e-4  # as FLOOR, relative to the peak of the person
# Range-Doppler maps are empty except for a seventh; two antenna rows resolve elevation poorly.
WEIGHT = {"range_doppler": 4.0, "range_azimuth": 1.0, "range_elevation": 0.4}
POOLS = (
    (1, 1),
    (4, 2),
    (8, 8),
)  # average pooling of the maps, so that small displacements of an echo do not count twice


@dataclass(frozen=True, kw_only=True)
class Targets:
    """Maps of recorded, simulated or expected power (mW): of some frames, and of the static room."""

    maps: PowerMaps  # (sequence, frame, range, other)
    static: PowerMaps  # (sequence, range, other), the room without a person
    person: PowerMaps | None = None  # as maps, of the person alone, where known


def itakura_saito(mean: Tensor, power: Tensor, least: Tensor) -> Tensor:
    """Mean over cells of p/m - log(p/m) - 1, both raised by `least` (broadcast)."""
    return speckle_divergence((power + least).log() - (mean + least).log()).mean()


def speckle_divergence(log_ratio: Tensor) -> Tensor:
    """p/m - log(p/m) - 1 of each cell, of log(p/m).

    Beyond p = STEEPEST m it continues linearly in decibels, so that a single unpredicted specular lobe does not
    dominate the loss.
    """
    bounded = log_ratio.clamp(max=math.log(STEEPEST))
    return bounded.exp() - bounded - 1 + (STEEPEST - 1) * (log_ratio - bounded)


def difference(mean: Tensor, power: Tensor, least: Tensor) -> Tensor:
    """Mean absolute difference of logarithms plus the weighted divergence, of maps (sequence, ..., range, other)."""
    logs = ((power + least).log() - (mean + least).log()).abs().mean()
    return logs + LIKELIHOOD * itakura_saito(mean, power, least)


def weaver_loss(radar: MeanPower, static: MeanEchoes, moving: MeanEchoes, targets: Targets) -> dict[str, Tensor]:
    """Terms of the loss by name; their sum is what is minimised."""
    static_maps = radar.maps(points_of(static, radar.response))
    person = radar.maps(points_of(moving, radar.response))
    terms: dict[str, Tensor] = {}
    for name, noise in zip(("range_doppler", "range_azimuth", "range_elevation"), radar.noise_maps(), strict=True):
        truth, room = getattr(targets.maps, name), getattr(targets.static, name)
        if truth.shape[-1] == 0:
            continue
        mean = getattr(person, name) + getattr(static_maps, name)[:, None] + noise
        peak = truth.amax(dim=(1, 2, 3), keepdim=True)
        for rows, columns in POOLS:
            pooled = _pooled(mean, rows, columns), _pooled(truth, rows, columns)
            terms[f"{name}_{rows}x{columns}"] = WEIGHT[name] * difference(*pooled, FLOOR * peak) / len(POOLS)
        least = 0.1 * noise + FLOOR * room.amax(dim=(1, 2), keepdim=True)
        terms[f"{name}_empty"] = 0.5 * WEIGHT[name] * difference(getattr(static_maps, name), room, least)
        if targets.person is not None:
            alone = getattr(targets.person, name)
            least = noise + FLOOR_OF_PERSON * alone.amax(dim=(1, 2, 3), keepdim=True)
            terms[f"{name}_person"] = OF_PERSON * WEIGHT[name] * difference(getattr(person, name), alone, least)
    return terms


def _pooled(maps: Tensor, rows: int, columns: int) -> Tensor:
    if (rows, columns) == (1, 1):
        return maps
    return torch.nn.functional.avg_pool2d(maps, (rows, columns), ceil_mode=True)
