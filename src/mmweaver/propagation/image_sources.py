"""Paths as points in the cells of a radar: where each appears, and how strong it is."""

import numpy as np
import torch
from torch import Tensor

from mmweaver.propagation.paths import Paths, StaticPaths
from mmweaver.signal.point_response import PointResponse, Points


def apparent_direction(departure: Tensor, arrival: Tensor) -> Tensor:
    """Unit directions (..., 3) in which paths appear, of vectors (..., 3) towards their departure and arrival.

    An array of transmitter and receiver pairs sees such a path between its two ends.
    """
    towards = (_unit(departure) + _unit(arrival)) / 2
    ahead = (1 - towards[..., 0].square() - towards[..., 2].square()).clamp(0, 1).sqrt()
    return torch.stack([towards[..., 0], ahead, towards[..., 2]], dim=-1)


def static_points(paths: StaticPaths, response: PointResponse) -> Points:
    """Static paths (path,) as points of real amplitude, in sqrt(mW)."""
    towards = apparent_direction(paths.departure_vertex_m, paths.arrival_vertex_m)
    range_m = paths.length_m.mean(dim=(-2, -1)) / 2
    return _points(range_m, torch.zeros_like(range_m), towards, paths.amplitude.abs(), response)


def moving_points(paths: Paths, response: PointResponse) -> Points:
    """Moving paths (..., path) as points of real amplitude at the middle of their segment, in sqrt(mW).

    Both orders of a reciprocal path add up as far as the array cannot tell its ends apart.
    """
    towards = apparent_direction(paths.departure.position_m, paths.arrival.position_m)
    both = 2 + 2 * _agreement(paths, response)
    power = paths.amplitude.abs().square() * torch.where(paths.is_reciprocal, both, torch.ones_like(both))
    return _points(paths.length_m / 2, paths.rate_mps / 2, towards, power.sqrt(), response)


def _agreement(paths: Paths, response: PointResponse) -> Tensor:
    """Mean cosine (..., path) between both orders of a path over the array's pairs."""
    tx_m, rx_m = (
        torch.from_numpy(np.asarray(place)) for place in (response.config.tx_position_m, response.config.rx_position_m)
    )
    apart_m = (tx_m[:, None] - rx_m).reshape(-1, 3)
    cycles = (paths.departure.direction - paths.arrival.direction) @ apart_m.T / response.config.wavelength_m
    return torch.cos(2 * torch.pi * cycles).mean(dim=-1)


def _points(
    range_m: Tensor, velocity_mps: Tensor, towards: Tensor, amplitude: Tensor, response: PointResponse
) -> Points:
    doppler_bin = (velocity_mps / response.velocity_a_bin_mps).float()
    return Points(
        range_bin=(range_m / response.range_a_bin_m).float() + response.coupling * doppler_bin,
        doppler_bin=doppler_bin,
        direction=towards[..., [0, 2]].float(),
        amplitude=amplitude.float(),
    )


def _unit(vectors: Tensor) -> Tensor:
    return vectors / vectors.norm(dim=-1, keepdim=True).clamp(min=1e-9)
