"""A cube summarised in some hundred numbers: power, profiles, textures, changes, antennas, activity features."""

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.records import RadarCube
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.models.activity_network import ActivityNetwork

LEVELS = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999)
POOLED = 4  # neighbouring cells of a profile that are taken together


def cube_statistics(cube: RadarCube, network: ActivityNetwork) -> np.ndarray:
    """Statistics of the log maps and of the antennas, and the features of the activity network's head, (number,)."""
    values = torch.from_numpy(cube.values)
    with torch.no_grad():
        doppler, angle = network.maps(values)
        summary = network.head.summary(network.frames(doppler[None], angle[None]))[0]
    maps = [doppler[:, 0], angle[:, 0], angle[:, 1]]
    parts = [_of_map(one) for one in maps] + [_of_antennas(cube), summary]
    return torch.cat([part.flatten().float() for part in parts]).numpy()


def _of_map(maps: Tensor) -> Tensor:
    """Statistics of log maps (frame, range, other): levels, profiles along both axes, differences along all three,
    static part."""
    levels = torch.quantile(maps.flatten(), torch.tensor(LEVELS))
    profiles = [maps.mean(dim=axes) for axes in ((0, 1), (0, 2))] + [maps.amax(dim=axes) for axes in ((0, 1), (0, 2))]
    pooled = [profile.unflatten(0, (-1, POOLED)).mean(dim=1) for profile in profiles]
    steps = [maps.diff(dim=axis).abs() for axis in range(3)]
    texture = [figure for step in steps for figure in (step.mean(), step.square().mean().sqrt(), step.amax())]
    over_time = maps.std(dim=0)
    return torch.cat([levels, *pooled, torch.stack([*texture, over_time.mean(), over_time.amax()])])


def _of_antennas(cube: RadarCube) -> Tensor:
    """Normalised eigenvalues of the covariance of the horizontal row, and the similarity of the antennas' power."""
    row = azimuth_row(cube.grid.antenna_position_m, cube.grid.wavelength_m)
    signal = cube.values[..., row].reshape(-1, len(row)).astype(np.complex128)
    covariance = signal.T @ signal.conj()
    shares = np.linalg.eigvalsh(covariance)[::-1] / max(np.trace(covariance).real, 1e-30)
    loudness = np.log10(np.maximum((np.abs(cube.values) ** 2).mean(axis=(0, 1, 2)), 1e-30))
    return torch.from_numpy(np.concatenate([np.log10(np.maximum(shares, 1e-12)), loudness - loudness.mean()]))
