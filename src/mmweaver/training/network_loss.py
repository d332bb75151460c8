"""Loss of the learned method, on mean power maps and never on phase.

The power of a radar cell with several echoes of unknown phase is exponentially distributed about its mean (speckle).
The negative log-likelihood of that mean is the Itakura-Saito divergence, p/m - log(p/m) - 1, which weights decibels
equally in weak and strong cells. But where the network cannot know whether a cell is bright, this estimates the mean of
the bright case and blurs the maps; the absolute difference of logarithms estimates the median instead. Both are used.

Reference: Fevotte et al. 2009.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.propagation.mean_power import MeanEchoes, MeanPower, PowerMaps
from mmweaver.propagation.radar_equation import points_of

STEEPEST = 8.0
LIKELIHOOD = 0.2  # weight of the divergence relative to the difference of logarithms
FLOOR = 1e-5  # relative to the peak: levels below a 50 dB display have no weight
OF_PERSON = 2.0  # weight of the maps of the person only, where the network has most to learn
FLOOR_OF_PERSON = 1e-4  # as FLOOR, relative to the peak of the person
# Six sevenths of a range-Doppler map are empty; two antenna rows resolve elevation poorly.
WEIGHT = {"range_doppler": 4.0, "range_azimuth": 1.0, "range_elevation": 0.4}
POOLS = (
    (1, 1),
    (4, 2),
    (8, 8),
)  # average pooling, so that a slightly displaced echo is not counted twice


@dataclass(frozen=True, kw_only=True)
class Targets:
    """Maps of recorded, simulated or expected power in mW, of sampled frames and of the static room."""

    maps: PowerMaps  # (sequence, frame, range, other)
    static: PowerMaps  # (sequence, range, other), the room without a person
    person: PowerMaps | None = None  # like `maps`, of the person only, if known


def itakura_saito(mean: Tensor, power: Tensor, least: Tensor) -> Tensor:
    """Itakura-Saito divergence, averaged over cells.

    Args:
        mean: Predicted mean power.
        power: Observed power.
        least: Floor added to both (broadcast).

    Returns:
        Scalar.
    """
    return speckle_divergence((power + least).log() - (mean + least).log()).mean()


def speckle_divergence(log_ratio: Tensor) -> Tensor:
    """p/m - log(p/m) - 1 per cell.

    Beyond p = STEEPEST m it continues linearly in decibels, so that a single unpredicted specular lobe does not
    dominate the loss.

    Args:
        log_ratio: log(p/m).

    Returns:
        Divergence of the same shape.
    """
    bounded = log_ratio.clamp(max=math.log(STEEPEST))
    return bounded.exp() - bounded - 1 + (STEEPEST - 1) * (log_ratio - bounded)


def difference(mean: Tensor, power: Tensor, least: Tensor) -> Tensor:
    """Mean absolute difference of logarithms plus weighted divergence.

    Args:
        mean: Predicted maps, (sequence, ..., range, other).
        power: Observed maps.
        least: Floor added to both (broadcast).

    Returns:
        Scalar.
    """
    logs = ((power + least).log() - (mean + least).log()).abs().mean()
    return logs + LIKELIHOOD * itakura_saito(mean, power, least)


def weaver_loss(radar: MeanPower, static: MeanEchoes, moving: MeanEchoes, targets: Targets) -> dict[str, Tensor]:
    """Computes the loss of the learned method.

    Args:
        radar: The radar.
        static: Echoes of the room.
        moving: Echoes of people in the sampled frames.
        targets: Target maps.

    Returns:
        Terms by name, whose sum is minimised.
    """
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
