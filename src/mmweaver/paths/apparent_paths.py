"""The simulator's echoes as one radar sees them on average: where each appears, and how strong."""

import math

import numpy as np
import torch

from mmweaver.core.radar_config import RadarConfig
from mmweaver.dsp.point_response import PointResponse, Points
from mmweaver.paths.adc_synthesis import EchoRows
from mmweaver.paths.static_paths import StaticEchoes


def between(first_m: np.ndarray, last_m: np.ndarray) -> np.ndarray:
    """Unit directions (row, 3) in which echoes appear whose waves leave towards one place and return from another.

    An array of transmitter and receiver pairs hears such a wave between its two ends.
    """
    towards = (_unit(first_m) + _unit(last_m)) / 2
    towards[:, 1] = np.sqrt(np.clip(1 - towards[:, 0] ** 2 - towards[:, 2] ** 2, 0, 1))
    return towards


def static_points(echoes: StaticEchoes, response: PointResponse) -> Points:
    """Resting echoes as points; amplitudes are real, in sqrt(mW)."""
    towards = between(echoes.first_m, echoes.last_m)
    range_m = echoes.way_m.mean(axis=(1, 2)) / 2
    return _points(range_m, np.zeros(len(range_m)), towards, np.abs(echoes.amplitude), response)


def moving_points(rows: EchoRows, node_s: np.ndarray, response: PointResponse) -> Points:
    """One frame's moving echoes as points at the frame's middle.

    A mixed row stands for two orders of one way; they add up as far as the array cannot tell their ends apart.
    """
    middle = len(node_s) // 2
    way_m = np.linalg.norm(rows.out_m, axis=-1) + np.linalg.norm(rows.back_m, axis=-1)
    velocity = np.polyfit(node_s - node_s[middle], way_m.T / 2, 1)[0]
    out, back = rows.out_m[:, middle], rows.back_m[:, middle]
    power = np.abs(rows.amplitude) ** 2 * np.where(rows.is_mixed, 2 + 2 * _agreement(out, back, response.config), 1.0)
    return _points(way_m[:, middle] / 2, velocity, between(out, back), np.sqrt(power), response)


def _agreement(out_m: np.ndarray, back_m: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Mean cosine between both orders of a way over the array's pairs."""
    apart = np.asarray(config.tx_position_m)[:, None] - np.asarray(config.rx_position_m)[None]
    turn = (_unit(out_m) - _unit(back_m)) @ apart.reshape(-1, 3).T * (2 * math.pi / config.wavelength_m)
    return np.cos(turn).mean(axis=1)


def _points(
    range_m: np.ndarray, velocity_mps: np.ndarray, towards: np.ndarray, amplitude: np.ndarray, response: PointResponse
) -> Points:
    doppler_bin = _tensor(velocity_mps / response.velocity_a_bin_mps)
    return Points(
        range_bin=_tensor(range_m / response.range_a_bin_m) + response.coupling * doppler_bin,
        doppler_bin=doppler_bin,
        direction=_tensor(towards[:, [0, 2]]),
        amplitude=_tensor(amplitude),
    )


def _tensor(values: np.ndarray) -> torch.Tensor:
    return torch.from_numpy(np.ascontiguousarray(values, dtype=np.float32))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)
