"""Range-Doppler cubes of paths without ADC samples: per path a range kernel times Doppler spectrum and antenna phases.

Gives what `adc_synthesis` and the transforms give together, at a fraction of the cost. In range a path contributes the
window's spectrum K, in Doppler the transform of its own chirps. Within a time segment a path moves by a fraction of a
range bin, so K is expanded to first order, K(r - b - d) = K(r - b) - d K'(r - b), with d per chirp and antenna.
Reference: docs/radar_primer.md, equations 7 and 12.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.propagation.adc_synthesis import ArrayPhases, unpadded
from mmweaver.propagation.fast_time import phasor
from mmweaver.propagation.paths import FadedSegment, FrameClock, Paths, StaticPaths
from mmweaver.propagation.transmit_elements import TransmitElements
from mmweaver.signal.cube import doppler_weight, slot_compensation, tdm_compensation
from mmweaver.signal.windows import WindowKernel, hann

if TYPE_CHECKING:
    from mmweaver.propagation.board_effects import BoardEffects

FRAMES_AT_ONCE = 4  # fit into the cache


@dataclass(frozen=True, kw_only=True)
class StaticResponse(TensorRecord):
    """Contribution of each static path to the cube at zero Doppler: two products of range and antenna factors."""

    at_range: Tensor  # (path, range) range kernel
    range_slope: Tensor  # (path, range) its slope
    echo: Tensor  # (path, antenna) complex
    tilted: Tensor  # (path, antenna) complex: `echo` times the antenna's range offset in bins from the array's mean

    def layer(self) -> Tensor:
        """The sum of all paths, complex64 (range, antenna), in sqrt(mW)."""
        in_range = torch.cat([self.at_range, self.range_slope])
        antennas = torch.view_as_real(torch.cat([self.echo, self.tilted])).flatten(1)
        return torch.view_as_complex((in_range.T @ antennas).unflatten(1, (-1, 2)))

    def layers(self, chosen: Tensor) -> Tensor:
        """Weighted sums of the paths of each frame.

        Args:
            chosen: Weights (frame, path), or a mask.

        Returns:
            Layers (frame, range, antenna), complex64, in sqrt(mW).
        """
        in_range = torch.cat([self.at_range, self.range_slope])
        antennas = torch.view_as_real(torch.cat([self.echo, self.tilted])).flatten(1)
        share = chosen.float().repeat(1, 2)  # with their slopes
        changes = torch.cat([share[:1], share.diff(dim=0)])  # few paths change from frame to frame
        rows = [one.nonzero()[:, 0] for one in changes]
        each = [in_range[row].T @ (antennas[row] * one[row, None]) for row, one in zip(rows, changes, strict=True)]
        return torch.view_as_complex(torch.stack(each).cumsum(dim=0).unflatten(2, (-1, 2)))

    def each(self) -> Tensor:
        """Contribution of every single path, complex64 (range * antenna, path)."""
        both = self.at_range[..., None] * self.echo[:, None] + self.range_slope[..., None] * self.tilted[:, None]
        return both.flatten(1).T

    def scaled(self, factor: Tensor) -> "StaticResponse":
        """The response of paths whose amplitudes are multiplied by real or complex factors (path,)."""
        return StaticResponse(
            at_range=self.at_range,
            range_slope=self.range_slope,
            echo=self.echo * factor[:, None],
            tilted=self.tilted * factor[:, None],
        )


class CubeRenderer:
    """Renders paths as the range-Doppler cube of one radar, on the CPU; scaled as `signal.cube.radar_cube`."""

    def __init__(self, config: RadarConfig, board: "BoardEffects | None" = None):
        """Prepares kernels and transforms that depend on the radar alone.

        Args:
            config: The radar.
            board: Board whose antenna errors, range bias and first chirp are applied, by default an ideal one. Its IF
                response must already be contained in the amplitudes of the paths.
        """
        self._elements = TransmitElements(config)
        self._static_mixing = _static_mixing(config) if config.is_coded else None
        config = self._elements.config
        self.config, self.clock = config, FrameClock(config)
        mixing = None if board is None or board.channels is None else self._elements.mixing(board.channels)
        self._array = ArrayPhases(config, torch.device("cpu"), mixing)
        self._range_kernel = WindowKernel(hann(config.num_samples))
        bins = config.first_range_bin + np.arange(config.num_range_bins)
        self._range_bin = torch.from_numpy(bins).float()
        # the kernel's phase refers to the middle of the window, the transform's to its beginning
        self._range_sign = torch.from_numpy((-1.0) ** bins).float()
        weight = torch.from_numpy(doppler_weight(config.num_loops))
        compensation = torch.from_numpy(tdm_compensation(config))
        self._extra_m = 0.0 if board is None else board.extra_length_m
        static = torch.fft.fft(weight)[:, None] * compensation
        chirps = None if board is None else _chirps(config, board.first_chirp)
        if chirps is not None:
            by_antenna = (weight[:, None] * chirps).repeat_interleave(config.num_rx, dim=1)
            static = torch.fft.fft(by_antenna, dim=0) * compensation
        self.static_bins = torch.nonzero(static.abs().amax(dim=1) > 1e-6)[:, 0]  # a Hann window has three
        self._static_doppler = static[self.static_bins]
        late_s = self.clock.chirp_s.mean(axis=1) - self.clock.node_s[0]
        late = torch.from_numpy((late_s / config.frame_period_s).astype(np.float32))
        self._ramp_doppler = torch.fft.fft(weight * late)[:, None] * compensation  # of what grows by 1 per frame
        fourier = torch.fft.fft(torch.eye(config.num_loops, dtype=torch.complex64)) * weight[:, None]  # (loop, doppler)
        by_tx = fourier * compensation[:, :: config.num_rx].T[:, None]  # (tx, loop, doppler)
        by_tx = by_tx if chirps is None else by_tx * chirps.T[..., None]
        self._segments = [_SegmentDoppler.of(one, by_tx) for one in self.clock.faded_segments]

    def moving(self, paths: Paths) -> Tensor:
        """Cube of moving paths.

        Args:
            paths: Moving paths, (frame * segment, path), amplitudes in sqrt(mW).

        Returns:
            Values (frame, range, doppler, antenna), complex64, in sqrt(mW).
        """
        config, count = self.config, len(self.clock.segments)
        frames = len(paths) // count
        values = torch.empty(
            frames, config.num_range_bins, config.num_antennas, config.num_loops, dtype=torch.complex64
        )  # Doppler last: loops over a few antennas are mostly overhead
        flat = torch.view_as_real(values).flatten(2)  # (frame, range, 2 antenna doppler)
        for index, (faded, segment) in enumerate(zip(self.clock.faded_segments, self._segments, strict=True)):
            some = paths.of_segment(faded.source, count, faded.frame, faded.late_s)
            self._add_segment(unpadded(some), segment, flat, is_first=index == 0)
        return self._elements.decoded(values.transpose(2, 3).contiguous())

    def _add_segment(self, paths: Paths, segment: "_SegmentDoppler", values: Tensor, *, is_first: bool) -> None:
        """Writes or adds one segment's contribution, paths (frame, path), to values (frame, range, ...)."""
        config = self.config
        length_m, rate_mps = paths.length_m, paths.rate_mps
        pairs = self._array(paths.departure.position_m.mT, paths.arrival.position_m.mT, paths.is_reciprocal)
        amplitude = paths.amplitude[:, None, None]
        array, longer_m = ((part * amplitude).movedim(-1, 1)[..., None] for part in (pairs.phase, pairs.excess))
        longer = longer_m / (2 * config.range_resolution_m)  # excess in bins; (frame, path, tx, rx, 1)
        plain, late = segment.spectra(self._cycles(paths, length_m, rate_mps, segment.time_s))
        late = late * (rate_mps / (2 * config.range_resolution_m)).float()[..., None, None]
        plain, late = plain[..., None, :], late[..., None, :]  # (frame, path, tx, 1, doppler)
        shift_bin = rate_mps / config.wavelength_m * config.num_samples / config.sample_rate_hz  # by Doppler
        place = (length_m + self._extra_m) / (2 * config.range_resolution_m) + shift_bin
        kernel, slope = self._range_kernel(self._range_bin - place.float()[..., None])  # (frame, path, range)
        in_range = torch.cat([kernel * self._range_sign, slope * -self._range_sign], dim=1).transpose(1, 2)
        count = length_m.shape[1]
        cells = array.new_empty(FRAMES_AT_ONCE, 2 * count, *array.shape[2:4], config.num_loops)
        for first in range(0, len(values), FRAMES_AT_ONCE):
            some = slice(first, first + FRAMES_AT_ONCE)
            here = cells[: len(values[some])]
            torch.mul(plain[some], array[some], out=here[:, :count])
            torch.mul(late[some], array[some], out=here[:, count:]).addcmul_(plain[some], longer[some])
            right = torch.view_as_real(here).flatten(2)
            torch.baddbmm(values[some], in_range[some], right, beta=0 if is_first else 1, out=values[some])

    def _cycles(self, paths: Paths, length_m: Tensor, rate_mps: Tensor, time_s: Tensor) -> Tensor:
        """Phase at each chirp, in cycles, (frame, path, tx * loop), at times (tx * loop,)."""
        delay_s = (length_m + self._extra_m) / SPEED_OF_LIGHT_MPS
        residual = self.config.chirp_slope_hz_per_s * delay_s**2 / 2
        motion = torch.stack([length_m, rate_mps, paths.acceleration_mps2 / 2], dim=-1) / self.config.wavelength_m
        motion[..., 0] -= residual
        return motion @ torch.stack([torch.ones_like(time_s), time_s, time_s**2])

    def static(self, paths: StaticPaths) -> StaticResponse:
        """Contribution of static paths at zero Doppler.

        Args:
            paths: Static paths, (path,).

        Returns:
            The response of each path; `StaticResponse.layer` sums them.
        """
        config = self.config
        length_m = self._elements.lengths(paths.length_m).flatten(1)  # (path, antenna)
        mean_m = length_m.mean(dim=1)
        delay_s = (mean_m + self._extra_m) / SPEED_OF_LIGHT_MPS
        cycles = length_m / config.wavelength_m - (config.chirp_slope_hz_per_s * delay_s**2 / 2)[:, None]
        echo = phasor(cycles) * paths.amplitude.to(torch.complex64)[:, None]
        off_bin = ((length_m - mean_m[:, None]) / (2 * config.range_resolution_m)).float()
        place = ((mean_m + self._extra_m) / (2 * config.range_resolution_m)).float()
        kernel, slope = self._range_kernel(self._range_bin - place[:, None])
        at_range, range_slope = (part * self._range_sign for part in (kernel, slope))
        echo, tilted = (self._decoded(part) for part in (echo, -off_bin * echo))
        return StaticResponse(at_range=at_range, range_slope=range_slope, echo=echo, tilted=tilted)

    def _decoded(self, echo: Tensor) -> Tensor:
        return self._elements.decoded(self._array.mixed(echo.unflatten(1, (self.config.num_tx, -1)), 1).flatten(1))

    def leakage(self, length_m: Tensor, amplitude: Tensor) -> Tensor:
        """Contribution of the TX-RX leakage at zero Doppler.

        Args:
            length_m: Path lengths (tap,) in metres, as `BoardEffects.leakage` gives them.
            amplitude: Amplitudes (tap, tx, rx) in sqrt(mW).

        Returns:
            Layer (range, antenna), complex64, in sqrt(mW).
        """
        at_range = self.leakage_response(length_m)
        return at_range.T @ self._elements.decoded(self._elements.pair_values(amplitude).flatten(1))

    def leakage_response(self, length_m: Tensor) -> Tensor:
        """Range response of leakage of unit amplitude.

        Args:
            length_m: Path lengths (tap,) in metres.

        Returns:
            Response (tap, range), complex64.
        """
        config = self.config
        delay_s = length_m / SPEED_OF_LIGHT_MPS
        kernel, _ = self._range_kernel(self._range_bin - (length_m / (2 * config.range_resolution_m)).float()[:, None])
        turn = phasor(-config.chirp_slope_hz_per_s * delay_s**2 / 2)
        return (kernel * self._range_sign).to(torch.complex64) * turn[:, None]

    def add_ramp(self, values: Tensor, layer: Tensor) -> None:
        """Adds static layers that grow linearly from 0 at the start of a frame to the whole one frame period later.

        Args:
            values: Cube (frame, range, doppler, antenna), complex64, changed in place.
            layer: Layers (frame, range, antenna).
        """
        if self._static_mixing is not None:  # coded transmitters: the mean over the frame
            self.add_static(values, layer * float(np.mean(self.clock.chirp_s) / self.config.frame_period_s))
            return
        size = self._ramp_doppler.abs().amax(dim=1)
        bins = torch.nonzero(size > 1e-4 * self._static_doppler.abs().max())[:, 0]
        values[:, :, bins] += layer[..., None, :] * self._ramp_doppler[bins]

    def add_static(self, values: Tensor, layer: Tensor) -> None:
        """Adds static layers to cube values, in place.

        Args:
            values: Cube (frame, range, doppler, antenna), complex64.
            layer: Layer (range, antenna) of all frames, or (frame, range, antenna).
        """
        if self._static_mixing is not None:
            tx = layer.unflatten(-1, (self._static_mixing.shape[-1], -1))
            mixed = torch.einsum("bvw,...wr->...bvr", self._static_mixing, tx)
            values[:, :, self.static_bins] += mixed.flatten(-2)
            return
        values[:, :, self.static_bins] += layer[..., None, :] * self._static_doppler


def _chirps(config: RadarConfig, first: complex) -> Tensor:
    """Complex factors of the chirps (loop, tx) by the board."""
    chirps = np.ones((config.num_loops, config.num_tx), np.complex64)
    chirps[0, config.tx_delay_s == 0] = first
    return torch.from_numpy(chirps)


def _static_mixing(config: RadarConfig) -> Tensor:
    """Contribution of a static signal of each (virtual) transmitter to each static Doppler bin, (bin, tx, tx).

    The compensation of the slots' delays assumes the velocity of a bin, so away from zero Doppler it mixes the
    transmitters slightly.
    """
    encoder = np.linalg.pinv(config.tx_decoder)  # (slot, tx)
    each = np.einsum("vs,ds,sw->dvw", config.tx_decoder, slot_compensation(config)[:, :: config.num_rx], encoder)
    weight = np.fft.fft(doppler_weight(config.num_loops))
    seen = np.abs(weight) > 1e-6
    return torch.from_numpy((weight[:, None, None] * each)[seen]).to(torch.complex64)


@dataclass(frozen=True, kw_only=True)
class _SegmentDoppler(TensorRecord):
    """The chirps of one time segment, and their windowed and TDM-compensated transform."""

    time_s: Tensor  # (tx * loop,) since the segment's middle
    transform: Tensor  # (tx, loop, 2 doppler): for values at the chirps, and for values weighted by the chirps' times

    @classmethod
    def of(cls, faded: FadedSegment, by_tx: Tensor) -> "_SegmentDoppler":
        """Transform of a segment, from its weight per chirp and the transform of the whole frame."""
        time_s = torch.from_numpy(np.ascontiguousarray(faded.segment.chirp_s.T))  # (tx, loop)
        own = by_tx[:, faded.segment.loops] * torch.from_numpy(faded.share.T).float()[..., None]
        return cls(time_s=time_s.flatten(), transform=torch.cat([own, own * time_s.float()[..., None]], dim=-1))

    def spectra(self, cycles: Tensor) -> tuple[Tensor, Tensor]:
        """Doppler spectra (frame, path, tx, doppler) of phases (frame, path, tx * loop), plain and weighted by time."""
        num_tx, loops, width = self.transform.shape
        chirps = phasor(cycles).unflatten(-1, (num_tx, loops)).flatten(0, 1).transpose(0, 1)  # (tx, ..., loop)
        both = (chirps @ self.transform).unflatten(1, cycles.shape[:2]).unflatten(-1, (2, width // 2))
        plain, late = both.permute(3, 1, 2, 0, 4).contiguous()
        return plain, late
