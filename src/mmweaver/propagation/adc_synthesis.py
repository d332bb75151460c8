"""Noise-free ADC samples of propagation paths, evaluated as one matrix product per block of chirps.

The beat signal is separable to first order: a fast-time factor times a factor of slow time and antenna pair. Phases are
accumulated in double precision, everything else in single precision, on the CPU or a GPU. `reference_sum.py` is the
exact sum that these factors approximate. Reference: docs/radar_primer.md, equations 7 and 12.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.propagation.fast_time import FastTime, phasor
from mmweaver.propagation.paths import NUM_NODES, FrameClock, Paths, ScenePaths, Segment, StaticPaths
from mmweaver.propagation.transmit_elements import TransmitElements

if TYPE_CHECKING:
    from mmweaver.propagation.board_effects import BoardEffects

ROWS_AT_ONCE = 2048  # static paths per matrix product, which bounds memory


class AdcSynthesis:
    """Renders paths as the ADC samples of one radar, on one device.

    For a radar whose transmitters send simultaneously under a code, `tx` axes of results are slots of the loop.
    """

    def __init__(
        self,
        config: RadarConfig,
        device: str | torch.device = "cpu",
        board: "BoardEffects | None" = None,
        *,
        is_faded: bool = False,
    ):
        """Prepares the factors that depend on the radar alone.

        Args:
            config: The radar.
            device: Where samples are computed.
            board: Board whose antenna errors and range bias are applied, by default an ideal one. Its IF response must
                already be contained in the amplitudes of the paths (`BoardEffects.recorded_static`, `recorded_moving`).
            is_faded: Whether neighbouring time segments of a frame are cross-faded, for paths whose amplitude or motion
                jumps between segments, as those of the networks do (`FrameClock.faded_segments`).
        """
        self._elements = TransmitElements(config)
        self.config, self.device = self._elements.config, torch.device(device)
        self.clock = FrameClock(self.config)
        mixing = None if board is None or board.channels is None else self._elements.mixing(board.channels)
        self.array = ArrayPhases(self.config, self.device, mixing)
        # phase in rad that each sample gains per metre of additional path length
        per_m = 2j * math.pi * self.config.chirp_slope_hz_per_s / SPEED_OF_LIGHT_MPS
        since_middle_s = (np.arange(self.config.num_samples) - self.config.num_samples / 2) / self.config.sample_rate_hz
        self._turn_per_m = torch.from_numpy((per_m * since_middle_s).astype(np.complex64)).to(self.device)
        self._extra_m = 0.0 if board is None else board.extra_length_m
        self._fast = FastTime(self.config)
        # each with its weight per chirp where segments are cross-faded
        self._segments: list[tuple[_SegmentFactors, tuple[int, int, float], Tensor | None]] = [
            (_SegmentFactors(one, self.device), (index, 0, 0.0), None) for index, one in enumerate(self.clock.segments)
        ]
        if is_faded and len(self.clock.faded_segments) > 1:
            self._segments = [
                (
                    _SegmentFactors(one.segment, self.device),
                    (one.source, one.frame, one.late_s),
                    self._share(one.share),
                )
                for one in self.clock.faded_segments
            ]

    def moving(self, paths: Paths) -> Tensor:
        """Samples of moving paths.

        Args:
            paths: Moving paths, (frame * segment, path), amplitudes in sqrt(mW).

        Returns:
            Samples (frame, loop, tx, rx, sample), complex64, in sqrt(mW).
        """
        config, count = self.config, len(self.clock.segments)
        frames = len(paths) // count
        adc = torch.empty(
            frames,
            config.num_loops,
            config.num_tx,
            config.num_rx,
            config.num_samples,
            dtype=torch.complex64,
            device=self.device,
        )
        # On the CPU one frame at a time: no padding is computed, and the working set stays in the cache.
        batches = [slice(0, frames)] if self.device.type != "cpu" else [slice(at, at + 1) for at in range(frames)]
        if any(share is not None for *_, share in self._segments):
            adc.zero_()
        for segment, (source, frame, late_s), share in self._segments:
            of_segment = paths.of_segment(source, count, frame, late_s).to(self.device)
            for batch in batches:
                some = unpadded(of_segment[batch])
                own = adc[batch, segment.loops]
                if share is None:
                    self._add_segment(some, segment, own)
                    continue
                part = torch.empty_like(own)
                self._add_segment(some, segment, part)
                own += part * share
        return self._elements.slots(adc, 2)

    def _share(self, share: np.ndarray) -> Tensor:
        """Weights (loop, tx) as factors of samples (frame, loop, tx, rx, sample)."""
        return torch.from_numpy(share[..., None, None].astype(np.float32)).to(self.device)

    def static(self, paths: StaticPaths, weight: Tensor | None = None) -> Tensor:
        """Samples of static paths, which are the same in every loop.

        Args:
            paths: Static paths, (path,).
            weight: Weights (set, path), real or complex; each set gives one weighted sum. By default one unweighted
                sum.

        Returns:
            Samples (tx, rx, sample), or (set, tx, rx, sample) with weights; complex64, in sqrt(mW).
        """
        weights = torch.ones(1, len(paths)) if weight is None else weight
        some = weights.ne(0).any(dim=0).nonzero()[:, 0]
        chosen = paths if len(some) == len(paths) else paths[some]
        total = None
        for first in range(0, max(len(some), 1), ROWS_AT_ONCE):
            rows = slice(first, first + ROWS_AT_ONCE)
            part = self._static_factors(chosen[rows]).summed(weights[:, some[rows]].to(self.device))
            total = part if total is None else total + part
        assert total is not None
        samples = self._recorded(total)
        return samples[0] if weight is None else samples

    def _static_factors(self, paths: StaticPaths) -> "_StaticFactors":
        length_m = self._elements.lengths(paths.length_m).to(self.device)
        mean_m = length_m.mean(dim=(1, 2))
        amplitude = paths.amplitude.to(torch.complex64).to(self.device)
        slow = phasor(length_m / self.config.wavelength_m) * amplitude[:, None, None]
        late = slow * (length_m - mean_m[:, None, None]).float()
        fast = self._fast.factor((mean_m + self._extra_m) / SPEED_OF_LIGHT_MPS, 0.0)
        return _StaticFactors(pairs=torch.stack([slow, late], dim=1), fast=fast)

    def _recorded(self, plain_and_tilted: Tensor) -> Tensor:
        """Samples (set, tx, rx, sample) of sums (2, set, tx, rx, sample) of the factors of static paths."""
        plain, tilted = plain_and_tilted
        return self._elements.slots(self.array.mixed(plain.addcmul(tilted, self._turn_per_m), 1), 1)

    def occluded(self, paths: ScenePaths) -> Tensor:
        """Samples of the occluded part of the static paths, to be subtracted from those of the empty room.

        Args:
            paths: All paths of the frames.

        Returns:
            Samples (row, tx, rx, sample), complex64, in sqrt(mW), one per row of `ScenePaths.occluded`.
        """
        weight = paths.occluded.float()
        if self.device.type != "cpu":
            return self.static(paths.static, weight)
        some = weight.any(dim=0).nonzero()[:, 0]
        factors = self._static_factors(paths.static[some])
        # one frame at a time, so that a frame is bit-identical whichever other frames are computed with it
        return torch.cat([self._recorded(factors.summed(frame[None])) for frame in weight[:, some]])

    def subtract_occluded(self, samples: Tensor, paths: ScenePaths) -> None:
        """Subtracts the occluded part of the static paths from samples, in place.

        Args:
            samples: Samples (frame, loop, tx, rx, sample).
            paths: All paths of the frames.
        """
        lost = self.occluded(paths)
        if len(lost) == len(samples):
            samples -= lost[:, None]
            return
        late = (self.clock.chirp_s.mean(axis=1) - self.clock.node_s[0]) / self.config.frame_period_s
        late = torch.from_numpy(late.astype(np.float32)).to(lost)[:, None, None, None]
        for frame, before, after in zip(samples, lost[:-1], lost[1:], strict=True):
            frame -= torch.lerp(before[None], after[None], late)

    def leakage(self, length_m: Tensor, amplitude: Tensor) -> Tensor:
        """Samples of the TX-RX leakage, which are the same in every loop.

        Args:
            length_m: Path lengths (tap,) in metres, as `BoardEffects.leakage` gives them.
            amplitude: Amplitudes (tap, tx, rx) in sqrt(mW).

        Returns:
            Samples (tx, rx, sample), complex64, in sqrt(mW).
        """
        fast = self._fast.factor(length_m / SPEED_OF_LIGHT_MPS, 0.0)  # (tap, sample)
        adc = torch.tensordot(self._elements.pair_values(amplitude), fast, dims=([0], [0]))
        return self._elements.slots(adc, 0)

    def static_rate(self, paths: StaticPaths) -> Tensor:
        """Time derivative of the samples of static paths within a chirp, by which clock errors act on them.

        Args:
            paths: Static paths, (path,).

        Returns:
            Rate (tx, rx, sample), complex64, in sqrt(mW)/s.
        """
        delay_s = paths.length_m.mean(dim=(1, 2)) / SPEED_OF_LIGHT_MPS
        beat_rad_per_s = 2 * math.pi * self.config.chirp_slope_hz_per_s * delay_s
        return self.static(paths, 1j * beat_rad_per_s[None])[0]

    def _add_segment(self, paths: Paths, segment: "_SegmentFactors", adc: Tensor) -> None:
        """Writes the samples of one segment of frames, paths (frame, path), to adc (frame, loop, tx, rx, sample)."""
        config = self.config
        if paths.amplitude.shape[-1] == 0:
            adc.zero_()
            return
        bands = None
        if self.device.type == "cpu" and len(paths) == 1:
            paths = paths[:, paths.length_m[0].argsort()]
            bands = self._fast.bands(paths.length_m[0] / SPEED_OF_LIGHT_MPS)
        # (frame, time, 3, path): paths come last, as loops over a few antennas or chirps are mostly overhead
        ends = paths.departure.positions_m(segment.place_s), paths.arrival.positions_m(segment.place_s)
        out_m, back_m = (distance_m(end[:, :NUM_NODES]) for end in ends)
        length_m = out_m + back_m  # (frame, node, path)
        by_chirp_m = (segment.to_chirps @ length_m).unflatten(1, (-1, config.num_tx))  # (frame, loop, tx, path)
        by_block_m = segment.to_blocks @ length_m  # (frame, block, path)
        shift_hz = segment.slope_at_blocks @ length_m / config.wavelength_m
        carrier = phasor(by_chirp_m / config.wavelength_m) * paths.amplitude[:, None, None]
        array = self.array(*(end[:, NUM_NODES:] for end in ends), paths.is_reciprocal)
        at_blocks = torch.view_as_real(array.phase).flatten(2)
        for index, block in enumerate(segment.segment.blocks):
            phases = (segment.between_blocks[block] @ at_blocks).unflatten(2, (*array.phase.shape[2:], 2))
            later_m = (by_chirp_m[:, block] - by_block_m[:, index, None, None]).to(phases.dtype)
            chirp = carrier[:, block, :, None]
            left = carrier.new_empty(len(paths), 2, *phases.shape[1:-1])
            slow, late = left.unbind(1)  # (frame, loop, tx, rx, path)
            torch.mul(chirp, torch.view_as_complex(phases), out=slow)
            torch.mul(chirp, array.excess[:, index, None], out=late)
            late += slow * later_m[:, :, :, None]
            delay_s = (by_block_m[:, index] + self._extra_m) / SPEED_OF_LIGHT_MPS
            both = self._fast.summed(left.flatten(1, 4), delay_s, shift_hz[:, index], bands)
            plain, tilted = both.unflatten(1, left.shape[1:-1]).unbind(1)
            torch.addcmul(plain, tilted, self._turn_per_m, out=adc[:, block])


@dataclass(frozen=True, kw_only=True)
class _StaticFactors(TensorRecord):
    """Separable factors of static paths."""

    pairs: Tensor  # (path, 2, tx, rx) complex64: phasor per antenna pair, and the same times the excess length in m
    fast: Tensor  # (path, sample) complex64

    def summed(self, weight: Tensor) -> Tensor:
        """Sums (2, set, tx, rx, sample) of paths with weights (set, path), real or complex."""
        some = weight.ne(0).any(dim=0).nonzero()[:, 0]
        # `index_select` takes half the time of indexing
        chosen = self if len(some) == len(weight[0]) else self.map(lambda factor: factor.index_select(0, some))
        left = weight[:, some].T.to(torch.complex64)[:, None, :, None, None] * chosen.pairs[:, :, None]
        shape = (*left.shape[1:], self.fast.shape[-1])
        return (left.flatten(1).T @ chosen.fast).view(shape)


class _SegmentFactors:
    """Tensors of one time segment of the frame: its nodes, and the interpolation from nodes to chirps and blocks."""

    def __init__(self, segment: Segment, device: torch.device):
        self.segment, self.loops = segment, segment.loops
        self.place_s = _double(np.concatenate([segment.node_s, segment.block_s]), device)
        self.to_chirps = _double(segment.weights(segment.chirp_s.ravel()).T, device)  # (loop * tx, node)
        self.to_blocks = _double(segment.weights(segment.block_s).T, device)  # (block, node)
        self.slope_at_blocks = _double(segment.slopes(segment.block_s).T, device)
        in_between = interpolation(segment.block_s, segment.chirp_s.mean(axis=1)).T
        self.between_blocks = _double(in_between, device).float()  # (loop, block)


class ArrayPhases:
    """Near-field phases of a radar's antenna pairs relative to the array's centre."""

    def __init__(self, config: RadarConfig, device: torch.device, mixing: Tensor | None = None):
        """Keeps the antenna positions of a radar on a device.

        Args:
            config: The radar.
            device: Where phases are computed.
            mixing: Antenna errors of a board, (tx * rx, tx * rx): recorded pairs by ideal pairs. By default none.
        """
        self._mixing = None if mixing is None else mixing.to(device)
        self.wavelength_m = config.wavelength_m
        self.tx_m = _double(np.asarray(config.tx_position_m), device)
        self.rx_m = _double(np.asarray(config.rx_position_m), device)

    def __call__(self, departure_m: Tensor, arrival_m: Tensor, is_reciprocal: Tensor) -> "PairPhases":
        """Phases of paths at all antenna pairs, with both directions of travel of reciprocal paths.

        Args:
            departure_m: Apparent departure points (frame, ..., 3, path), float64.
            arrival_m: Apparent arrival points, of the same shape.
            is_reciprocal: Bool (frame, path): whether the wave travels the path in the opposite direction, too.

        Returns:
            Phases and excess lengths (frame, ..., tx, rx, path).
        """
        pairs = self._pairs(departure_m, arrival_m)
        some = is_reciprocal.any(dim=0).nonzero()[:, 0]
        if len(some):
            back = self._pairs(arrival_m[..., some], departure_m[..., some])
            counts = is_reciprocal[:, some].unflatten(0, (-1, *[1] * (departure_m.dim() - 1)))
            pairs.phase[..., some] += back.phase * counts
            pairs.excess[..., some] += back.excess * counts
        return PairPhases(phase=self.mixed(pairs.phase, -3), excess=self.mixed(pairs.excess, -3))

    def mixed(self, values: Tensor, axis: int) -> Tensor:
        """Applies the board's antenna errors.

        Args:
            values: Values of ideal antenna pairs, transmitters on one axis and receivers on the next.
            axis: Axis of the transmitters.

        Returns:
            Values of the same shape, as the board records them.
        """
        if self._mixing is None:
            return values
        axis %= values.dim()
        pairs = values.flatten(axis, axis + 1).movedim(axis, -1) @ self._mixing.T
        return pairs.movedim(-1, axis).unflatten(axis, values.shape[axis : axis + 2])

    def _pairs(self, departure_m: Tensor, arrival_m: Tensor) -> "PairPhases":
        out_m, back_m = excess_m(departure_m, self.tx_m)[..., None, :], excess_m(arrival_m, self.rx_m)[..., None, :, :]
        phase = phasor(out_m / self.wavelength_m) * phasor(back_m / self.wavelength_m)
        return PairPhases(phase=phase, excess=phase * (out_m + back_m).float())


@dataclass(frozen=True, kw_only=True)
class PairPhases:
    """Phasors of a path at all antenna pairs, relative to the array's centre."""

    phase: Tensor  # (..., tx, rx, path) complex64, summed over both directions of a reciprocal path
    excess: Tensor  # the same, each weighted by its excess length in m


def distance_m(place_m: Tensor) -> Tensor:
    """Distance (..., path) in metres from the array's centre to places (..., 3, path)."""
    return place_m.square().sum(dim=-2).sqrt()


def excess_m(place_m: Tensor, antenna_m: Tensor) -> Tensor:
    """Path length from an antenna relative to the array's centre, |p - a| - |p|, without cancellation.

    Args:
        place_m: Places p (..., 3, path) in metres.
        antenna_m: Antenna positions a (antenna, 3) in metres.

    Returns:
        Differences (..., antenna, path) in metres.
    """
    distance = distance_m(place_m)[..., None, :]
    excess = antenna_m.square().sum(dim=-1)[:, None] - 2 * (antenna_m @ place_m)
    both_m = (distance.square() + excess).clamp(min=0).sqrt() + distance
    return excess / both_m.clamp(min=1e-12)  # 0 at the antenna itself, where padding lies


def interpolation(nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Weights of linear interpolation, extrapolated beyond the ends.

    Args:
        nodes: Abscissae (node,), increasing.
        at: Abscissae (time,) at which values are wanted.

    Returns:
        (node, time): `values_at_nodes @ weights` are the interpolated values.
    """
    if len(nodes) == 1:
        return np.ones((1, len(at)))
    left = np.clip(np.searchsorted(nodes, at) - 1, 0, len(nodes) - 2)
    share = (at - nodes[left]) / (nodes[left + 1] - nodes[left])
    weights = np.zeros((len(nodes), len(at)))
    weights[left, np.arange(len(at))] = 1 - share
    weights[left + 1, np.arange(len(at))] += share
    return weights


def unpadded(paths: Paths) -> Paths:
    """Paths without the padding that all frames share.

    Args:
        paths: Paths (frame, path), padded at the end with amplitudes of zero.

    Returns:
        The same paths, cut after the last one with a non-zero amplitude in any frame.
    """
    there = paths.amplitude.ne(0).any(dim=0).nonzero()[:, 0]
    longest = int(there[-1]) + 1 if len(there) else 0
    return paths if longest == paths.amplitude.shape[1] else paths[:, :longest]


def _double(values: np.ndarray, device: torch.device) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(values, np.float64)).to(device)


@contextmanager
def one_thread() -> Iterator[None]:
    """Restricts torch to one thread.

    20 frames take 30 ms on one thread; more threads are hardly faster, and a hundred times slower on a busy machine.
    """
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
