"""Echo rows -> ADC samples of one frame, by factors: fast time x (slow time . antennas), one matrix product a block.

Reference: docs/radar_primer.md, equations 7 and 12; `exact.py` is the sum these factors approximate.
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig

NodePositions = np.ndarray  # (row, node, 3)
BLOCK_S = 2.0e-3  # range and angle count as constant for so long


@dataclass(frozen=True, kw_only=True)
class EchoRows:
    """Moving echoes of one frame. The wave goes out to `out_m`, comes back from `back_m` (equal for a direct echo).

    A mixed row (a wall on one of the two ways) stands for both orders: out and back change places and add up.
    Positions are given at the nodes of `FrameClock`; a mirrored body point lies behind the mirror.
    """

    out_m: NodePositions
    back_m: NodePositions
    amplitude: np.ndarray  # (row,) complex, sqrt(mW)
    is_mixed: np.ndarray  # (row,) bool

    def __len__(self) -> int:
        return len(self.amplitude)

    @classmethod
    def joined(cls, parts: list["EchoRows"]) -> "EchoRows":
        return cls(
            out_m=np.concatenate([part.out_m for part in parts]),
            back_m=np.concatenate([part.back_m for part in parts]),
            amplitude=np.concatenate([part.amplitude for part in parts]),
            is_mixed=np.concatenate([part.is_mixed for part in parts]),
        )


class FrameClock:
    """When things happen within a frame: chirps, the nodes where positions are known, and the blocks.

    Nodes are the Chebyshev points of the frame's active time: positions between them follow by one polynomial, of
    degree 2 up to 10 ms and more for longer frames.
    """

    def __init__(self, config: RadarConfig):
        self.config = config
        # Fast time sees one delay for all receivers of a transmitter: taken at their middle it errs least.
        tx, rx = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)
        self.centre_m = (tx + rx.mean(axis=0)) / 2  # (tx, 3)
        middle_s = config.idle_time_s + config.adc_start_time_s + config.num_samples / config.sample_rate_hz / 2
        loop_s = np.arange(config.num_loops) * config.loop_period_s
        self.chirp_s = loop_s[:, None] + config.tx_delay_s[None, :] + middle_s  # (loop, tx) middle of the sampling
        degree = int(np.clip(np.ceil(config.active_time_s / 5e-3), 2, 12))
        first_s, last_s = self.chirp_s.min(), self.chirp_s.max()
        unit = -np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
        self.node_s = (first_s + last_s) / 2 + (last_s - first_s) / 2 * unit
        num_blocks = int(np.clip(np.ceil(config.active_time_s / BLOCK_S), 1, config.num_loops))
        self.blocks = np.array_split(np.arange(config.num_loops), num_blocks)
        self.to_chirps = self.weights(self.chirp_s.ravel())  # (node, loop * tx)
        middle = np.array([self.chirp_s[block].mean() for block in self.blocks])
        self.to_blocks = self.weights(middle)  # (node, block)
        self.slope_at_blocks = self.slopes(middle)  # (node, block)

    def weights(self, time_s: np.ndarray) -> np.ndarray:
        """(node, time): values at the nodes times this give values at the times (Lagrange)."""
        others = self.node_s[:, None] - self.node_s[None, :]
        np.fill_diagonal(others, 1.0)
        scale = 1 / others.prod(axis=1)
        gaps = time_s[None, :] - self.node_s[:, None]
        product = np.stack([np.delete(gaps, node, axis=0).prod(axis=0) for node in range(len(self.node_s))])
        return product * scale[:, None]

    def slopes(self, time_s: np.ndarray) -> np.ndarray:
        """(node, time): values at the nodes times this give rates at the times."""
        step_s = self.config.chirp_period_s
        return (self.weights(time_s + step_s) - self.weights(time_s - step_s)) / (2 * step_s)


def phasor(turns: np.ndarray) -> np.ndarray:
    """exp(2 pi j turns), complex64; wrapped in float64 first, or metres of way in wavelengths lose their phase."""
    angle = ((turns - np.rint(turns)) * (2 * np.pi)).astype(np.float32)
    out = np.empty(angle.shape, np.complex64)
    np.cos(angle, out=out.real)
    np.sin(angle, out=out.imag)
    return out


def fast_time(delay_s: np.ndarray, shift_hz: np.ndarray | float, config: RadarConfig) -> np.ndarray:
    """Fast-time factor (row, sample) of beats S tau + shift, zero phase in the middle of the sampling (eq. 7)."""
    slope = config.chirp_slope_hz_per_s
    turns_a_sample = (slope * delay_s + shift_hz) / config.sample_rate_hz
    num, coarse = config.num_samples, 16
    fine = phasor(turns_a_sample[..., None] * np.arange(coarse))
    steps = coarse * np.arange(-(-num // coarse)) - num / 2
    rough = phasor(turns_a_sample[..., None] * steps - (slope * delay_s**2 / 2)[..., None])
    grid = rough[..., :, None] * fine[..., None, :]
    return grid.reshape(*delay_s.shape, -1)[..., :num]


def array_factor(out_m: np.ndarray, back_m: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Near-field phases (row, tx, rx) of each transmitter and receiver relative to the origin, complex64."""
    tx, rx = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)
    return _to_each(out_m, tx, config)[:, :, None] * _to_each(back_m, rx, config)[:, None, :]


def _to_each(place_m: np.ndarray, antenna_m: np.ndarray, config: RadarConfig) -> np.ndarray:
    """exp(j k (|p - a| - |p|)) for each place and antenna; written so that nothing cancels."""
    distance = np.linalg.norm(place_m, axis=-1)[:, None]
    dot = place_m @ antenna_m.T
    square = (antenna_m**2).sum(axis=-1)[None, :]
    excess = square - 2 * dot
    difference = excess / (np.sqrt(np.maximum(distance**2 + excess, 0)) + distance)
    return phasor(difference / config.wavelength_m)


def synthesise(rows: EchoRows, clock: FrameClock) -> np.ndarray:
    """ADC samples of one frame, complex64 (loop, tx, rx, sample), in sqrt(mW)."""
    config = clock.config
    shape = (config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    if len(rows) == 0:
        return np.zeros(shape, np.complex64)
    way_m = np.linalg.norm(rows.out_m, axis=-1) + np.linalg.norm(rows.back_m, axis=-1)  # (row, node)
    shift_hz = way_m @ clock.slope_at_blocks / config.wavelength_m
    carrier = phasor(way_m @ clock.to_chirps / config.wavelength_m).reshape(len(rows), config.num_loops, config.num_tx)
    carrier *= rows.amplitude.astype(np.complex64)[:, None, None]
    out_m = np.einsum("rnc,nb->brc", rows.out_m, clock.to_blocks)
    back_m = np.einsum("rnc,nb->brc", rows.back_m, clock.to_blocks)
    adc = np.empty(shape, np.complex64)
    mixed = rows.is_mixed
    for index, block in enumerate(clock.blocks):
        array = array_factor(out_m[index], back_m[index], config)
        array[mixed] += array_factor(back_m[index][mixed], out_m[index][mixed], config)
        slow = carrier[:, block, :, None] * array[:, None]
        for m, centre_m in enumerate(clock.centre_m):
            delay_s = _distance(out_m[index], centre_m) + _distance(back_m[index], centre_m)
            fast = fast_time(delay_s / SPEED_OF_LIGHT_MPS, shift_hz[:, index], config)
            product = slow[:, :, m].reshape(len(rows), -1).T @ fast
            adc[block, m] = product.reshape(len(block), config.num_rx, -1)
    return adc


def _distance(place_m: np.ndarray, centre_m: np.ndarray) -> np.ndarray:
    return np.linalg.norm(place_m - centre_m, axis=-1)
