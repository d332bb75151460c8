"""Paths as points in a radar's cells: apparent position and strength."""

import numpy as np
import torch
from torch import Tensor

from mmweaver.propagation.paths import Paths, StaticPaths
from mmweaver.signal.point_response import PointResponse, Points


def apparent_direction(departure: Tensor, arrival: Tensor) -> Tensor:
    """Apparent direction of paths whose departure and arrival differ.

    An array of transmitter-receiver pairs sees such a path half way between its two ends.

    Args:
        departure: Vectors (..., 3) towards the departure point.
        arrival: Vectors (..., 3) towards the arrival point.

    Returns:
        Unit vectors (..., 3).
    """
    towards = (_unit(departure) + _unit(arrival)) / 2
    ahead = (1 - towards[..., 0].square() - towards[..., 2].square()).clamp(0, 1).sqrt()
    return torch.stack([towards[..., 0], ahead, towards[..., 2]], dim=-1)


def static_points(paths: StaticPaths, response: PointResponse) -> Points:
    """Static paths as points.

    Args:
        paths: Static paths, (path,).
        response: Point response of the radar, which defines the bins.

    Returns:
        Points (path,) of real amplitude in sqrt(mW).
    """
    towards = apparent_direction(paths.departure_vertex_m, paths.arrival_vertex_m)
    range_m = paths.length_m.mean(dim=(-2, -1)) / 2
    return _points(range_m, torch.zeros_like(range_m), towards, paths.amplitude.abs(), response)


def moving_points(paths: Paths, response: PointResponse) -> Points:
    """Moving paths as points at the middle of their segment.

    Both directions of a reciprocal path add coherently as far as the array cannot resolve its two ends.

    Args:
        paths: Moving paths, (..., path).
        response: Point response of the radar, which defines the bins.

    Returns:
        Points (..., path) of real amplitude in sqrt(mW).
    """
    towards = apparent_direction(paths.departure.position_m, paths.arrival.position_m)
    both = 2 + 2 * _agreement(paths, response)
    power = paths.amplitude.abs().square() * torch.where(paths.is_reciprocal, both, torch.ones_like(both))
    return _points(paths.length_m / 2, paths.rate_mps / 2, towards, power.sqrt(), response)


def _agreement(paths: Paths, response: PointResponse) -> Tensor:
    """Mean cosine (..., path) of the phase between both directions of a path over the antenna pairs."""
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
