"""Paths -> noise-free ADC samples, exact in time: fast time x (slow time . antennas), one matrix product a block.

Phases are counted in double precision, everything else in single, on the CPU or a GPU. `exact.py` is the sum that these
factors approximate. Reference: docs/radar_primer.md, equations 7 and 12.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.paths.frame_clock import FrameClock, Segment
from mmweaver.paths.paths import Paths, ScenePaths, StaticPaths
from mmweaver.paths.transmit_elements import TransmitElements

COARSE = 16  # samples of which the fast-time factor is made, and steps between them
ROWS_AT_ONCE = 2048  # static paths, which bounds memory


class AdcSynthesis:
    """The ADC samples that paths leave in one radar, on one device. `tx` axes are slots where the radar is coded."""

    def __init__(self, config: RadarConfig, device: str | torch.device = "cpu"):
        self._elements = TransmitElements(config)
        self.config, self.device = self._elements.config, torch.device(device)
        self.clock = FrameClock(self.config)
        self.array = ArrayPhases(self.config, self.device)
        self._centre_m = _double(self.clock.centre_m, self.device)
        self._segments = [_SegmentFactors(segment, self.device) for segment in self.clock.segments]

    def moving(self, paths: Paths) -> Tensor:
        """Samples of moving paths (frame * segment, path): complex64 (frame, loop, tx, rx, sample), in sqrt(mW)."""
        config, count = self.config, len(self._segments)
        frames = len(paths) // count
        adc = torch.empty(
            frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples,
            dtype=torch.complex64, device=self.device,
        )  # fmt: skip
        # On the CPU frame by frame: nothing is padded, and the caches hold it.
        batches = [slice(0, frames)] if self.device.type != "cpu" else [slice(at, at + 1) for at in range(frames)]
        for index, segment in enumerate(self._segments):
            for batch in batches:
                some = unpadded(paths[index::count][batch]).to(self.device)
                self._add_segment(some, segment, adc[batch, segment.loops])
        return self._elements.slots(adc, 2)

    def static(self, paths: StaticPaths, weight: Tensor | None = None) -> Tensor:
        """Samples of static paths, complex64 (tx, rx, sample); the same in every loop.

        With `weight` (set, path), float or complex, those of so many sums of weighted paths: (set, tx, rx, sample).
        """
        config = self.config
        weights = torch.ones(1, len(paths)) if weight is None else weight
        some = weights.ne(0).any(dim=0).nonzero()[:, 0]
        chosen = paths if len(some) == len(paths) else paths[some]
        amplitude = (weights[:, some] * chosen.amplitude).to(torch.complex64)  # (set, path)
        shape = (config.num_tx, len(weights), config.num_rx, config.num_samples)
        adc = torch.zeros(shape, dtype=torch.complex64, device=self.device)
        for first in range(0, len(some), ROWS_AT_ONCE):
            rows = slice(first, first + ROWS_AT_ONCE)
            length_m = self._elements.lengths(chosen.length_m[rows]).to(self.device)
            slow = phasor(length_m / config.wavelength_m)  # (path, tx, rx)
            each = amplitude[:, rows].to(self.device)
            for m in range(config.num_tx):
                fast = fast_time(length_m[:, m].mean(dim=-1) / SPEED_OF_LIGHT_MPS, 0.0, config)
                left = (each[:, None, :] * slow[:, m].T).flatten(0, 1)  # (set * rx, path)
                adc[m] += (left @ fast).unflatten(0, (len(weights), config.num_rx))
        adc = self._elements.slots(adc, 0).transpose(0, 1)
        return adc[0] if weight is None else adc

    def occluded(self, paths: ScenePaths) -> Tensor:
        """Samples of the static paths that are occluded in each frame, complex64 (frame, tx, rx, sample)."""
        weight = paths.occluded.float()
        if self.device.type != "cpu":
            return self.static(paths.static, weight)
        # each frame on its own: its bits do not depend on which others are asked for
        return torch.cat([self.static(paths.static, weight[frame : frame + 1]) for frame in range(len(weight))])

    def static_rate(self, paths: StaticPaths) -> Tensor:
        """How fast the samples of static paths change within a chirp, complex64 (tx, rx, sample) in sqrt(mW)/s."""
        delay_s = paths.length_m.mean(dim=(1, 2)) / SPEED_OF_LIGHT_MPS
        beat_rad_per_s = 2 * math.pi * self.config.chirp_slope_hz_per_s * delay_s
        return self.static(paths, 1j * beat_rad_per_s[None])[0]

    def _add_segment(self, paths: Paths, segment: "_SegmentFactors", adc: Tensor) -> None:
        """Writes the samples of one segment of frames, paths (frame, path), to adc (frame, loop, tx, rx, sample)."""
        config = self.config
        if paths.amplitude.shape[-1] == 0:
            adc.zero_()
            return
        length_m = paths.departure.at(segment.node_s).norm(dim=-1) + paths.arrival.at(segment.node_s).norm(dim=-1)
        shift_hz = length_m @ segment.slope_at_blocks / config.wavelength_m  # (frame, path, block)
        carrier = phasor(length_m @ segment.to_chirps / config.wavelength_m) * paths.amplitude[..., None]
        carrier = carrier.unflatten(-1, (-1, config.num_tx))  # (frame, path, loop, tx)
        ends_m = [end.at(segment.block_s).transpose(1, 2) for end in (paths.departure, paths.arrival)]
        for index, block in enumerate(segment.segment.blocks):
            departure_m, arrival_m = (end[:, index] for end in ends_m)  # (frame, path, 3)
            array = self.array(departure_m, arrival_m, paths.is_reciprocal)
            centred_m = torch.stack([departure_m, arrival_m])[:, None] - self._centre_m[:, None, None]
            delay_s = centred_m.norm(dim=-1).sum(dim=0) / SPEED_OF_LIGHT_MPS  # (tx, frame, path)
            for m in range(config.num_tx):
                slow = carrier[:, :, block, m, None] * array[:, :, None, m]  # (frame, path, loop, rx)
                fast = fast_time(delay_s[m], shift_hz[..., index], config)
                product = slow.flatten(2).transpose(1, 2) @ fast
                adc[:, block, m] = product.unflatten(1, (-1, config.num_rx))


class _SegmentFactors:
    """A segment of the frame's clock as tensors."""

    def __init__(self, segment: Segment, device: torch.device):
        self.segment, self.loops = segment, segment.loops
        self.node_s, self.block_s = _double(segment.node_s, device), _double(segment.block_s, device)
        self.to_chirps = _double(segment.weights(segment.chirp_s.ravel()), device)  # (node, loop * tx)
        self.slope_at_blocks = _double(segment.slopes(segment.block_s), device)  # (node, block)


class ArrayPhases:
    """Near-field phases of a radar's antennas relative to the array's centre."""

    def __init__(self, config: RadarConfig, device: torch.device):
        self.wavelength_m = config.wavelength_m
        self.tx_m = _double(np.asarray(config.tx_position_m), device)
        self.rx_m = _double(np.asarray(config.rx_position_m), device)

    def __call__(self, departure_m: Tensor, arrival_m: Tensor, is_reciprocal: Tensor) -> Tensor:
        """Complex64 (frame, path, tx, rx) of paths between these places (frame, path, 3); both orders of reciprocal."""
        array = self._to_each(departure_m, self.tx_m)[..., :, None] * self._to_each(arrival_m, self.rx_m)[..., None, :]
        both = is_reciprocal.nonzero(as_tuple=True)
        if len(both[0]):
            out, back = self._to_each(arrival_m[both], self.tx_m), self._to_each(departure_m[both], self.rx_m)
            array[both] += out[..., :, None] * back[..., None, :]
        return array

    def _to_each(self, place_m: Tensor, antenna_m: Tensor) -> Tensor:
        """exp(j k (|p - a| - |p|)) for each place and antenna; written so that nothing cancels."""
        distance = place_m.norm(dim=-1)[..., None]
        excess = antenna_m.square().sum(dim=-1) - 2 * (place_m @ antenna_m.T)
        difference = excess / ((distance.square() + excess).clamp(min=0).sqrt() + distance)
        return phasor(difference / self.wavelength_m)


def unpadded(paths: Paths) -> Paths:
    """Paths (frame, path) without the padding that all frames have."""
    there = paths.amplitude.ne(0).any(dim=0).nonzero()[:, 0]
    longest = int(there[-1]) + 1 if len(there) else 0
    return paths if longest == paths.amplitude.shape[1] else paths[:, :longest]


def phasor(cycles: Tensor) -> Tensor:
    """exp(2 pi j cycles), complex64; wrapped in double precision first."""
    angle = (cycles - cycles.round()).to(torch.float32).mul_(2 * math.pi)
    return torch.complex(angle.cos(), angle.sin())


def fast_time(delay_s: Tensor, shift_hz: Tensor | float, config: RadarConfig) -> Tensor:
    """Fast-time factor (..., sample) of beats S tau + shift, zero phase in the middle of the sampling (eq. 7)."""
    slope, num = config.chirp_slope_hz_per_s, config.num_samples
    cycles_a_sample = ((slope * delay_s + shift_hz) / config.sample_rate_hz)[..., None]
    fine = phasor(cycles_a_sample * torch.arange(COARSE, device=delay_s.device))
    steps = COARSE * torch.arange(-(-num // COARSE), device=delay_s.device) - num / 2
    rough = phasor(cycles_a_sample * steps - (slope * delay_s**2 / 2)[..., None])
    return (rough[..., :, None] * fine[..., None, :]).flatten(-2)[..., :num]


def _double(values: np.ndarray, device: torch.device) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(values, np.float64)).to(device)


@contextmanager
def one_thread() -> Iterator[None]:
    """20 frames are 30 ms of one thread; several are hardly quicker, and on a busy machine a hundred times slower."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
