"""What the weaver is trained on: mean power, never phase.

The power of a radar cell in which several echoes of unknown phase meet is exponentially distributed about its mean.
The likelihood of that mean is the Itakura-Saito divergence, p/m - log(p/m) - 1: it asks for the right decibels
everywhere, faint cells as much as strong ones. But where the network cannot know whether a cell is bright, the mean is
that of the bright case, and its pictures glow all over; the absolute difference of logarithms asks for the median
instead. Both are used. Reference: Fevotte et al. 2009; decision 91.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.paths.mean_paths import Echoes
from mmweaver.paths.mean_power import MeanPower, PowerMaps
from mmweaver.paths.radar_equation import points_of

STEEPEST = 8.0
LIKELIHOOD = 0.2  # share of the divergence beside the difference of logarithms
FLOOR = 1e-5  # of the peak: what a 50 dB picture no longer shows counts for nothing
OF_PERSON = 2.0  # weight of the person's own maps: what the network has most to learn about
FLOOR_OF_PERSON = 1e-4  # the same, of the person's own peak
# The range-Doppler picture is empty but for a seventh, and two rows of antennas tell elevation poorly.
WEIGHT = {"range_doppler": 4.0, "range_azimuth": 1.0, "range_elevation": 0.4}
POOLS = ((1, 1), (4, 2), (8, 8))  # cells of a map taken together: small steps of an echo shall not cost twice


@dataclass(frozen=True, kw_only=True)
class Targets:
    """Maps of recorded, simulated or expected power: of some frames, and of the room without a person."""

    maps: PowerMaps  # (sequence, frame, range, other)
    empty: PowerMaps  # (sequence, range, other)
    person: PowerMaps | None = None  # as maps, of the person alone, where that is known


def itakura_saito(mean: Tensor, power: Tensor, least: Tensor) -> Tensor:
    """Mean over cells of p/m - log(p/m) - 1, both raised by `least` (broadcast).

    From p = STEEPEST m on it goes on as a straight line in decibels: one glint that was not foreseen shall not weigh
    as much as all the rest.
    """
    log_ratio = (power + least).log() - (mean + least).log()
    bounded = log_ratio.clamp(max=math.log(STEEPEST))
    return (bounded.exp() - bounded - 1 + (STEEPEST - 1) * (log_ratio - bounded)).mean()


def difference(mean: Tensor, power: Tensor, least: Tensor) -> Tensor:
    """Absolute difference of logarithms, and a share of the divergence."""
    logs = ((power + least).log() - (mean + least).log()).abs().mean()
    return logs + LIKELIHOOD * itakura_saito(mean, power, least)


def weaver_loss(radar: MeanPower, resting: Echoes, moving: Echoes, targets: Targets) -> dict[str, Tensor]:
    """Terms of the loss by name; their sum is what is minimised."""
    still = radar.maps(points_of(resting, radar.response))
    person = radar.maps(points_of(moving, radar.response))
    terms: dict[str, Tensor] = {}
    for name, noise in zip(("range_doppler", "range_azimuth", "range_elevation"), radar.noise_maps(), strict=True):
        truth, empty = getattr(targets.maps, name), getattr(targets.empty, name)
        if truth.shape[-1] == 0:
            continue
        mean = getattr(person, name) + getattr(still, name)[:, None] + noise
        peak = truth.amax(dim=(1, 2, 3), keepdim=True)
        for rows, columns in POOLS:
            pooled = _pooled(mean, rows, columns), _pooled(truth, rows, columns)
            terms[f"{name}_{rows}x{columns}"] = WEIGHT[name] * difference(*pooled, FLOOR * peak) / len(POOLS)
        least = 0.1 * noise + FLOOR * empty.amax(dim=(1, 2), keepdim=True)
        terms[f"{name}_empty"] = 0.5 * WEIGHT[name] * difference(getattr(still, name), empty, least)
        if targets.person is not None:
            alone = getattr(targets.person, name)
            least = noise + FLOOR_OF_PERSON * alone.amax(dim=(1, 2, 3), keepdim=True)
            terms[f"{name}_person"] = OF_PERSON * WEIGHT[name] * difference(getattr(person, name), alone, least)
    return terms


def _pooled(maps: Tensor, rows: int, columns: int) -> Tensor:
    if (rows, columns) == (1, 1):
        return maps
    return torch.nn.functional.avg_pool2d(maps, (rows, columns), ceil_mode=True)
