"""From the wave at the port to the converter's numbers: channel errors, thermal and phase noise, jitter, quantisation.

Reference: docs/radar_primer.md, section 6.
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.paths.transmit_elements import TransmitElements

if TYPE_CHECKING:
    from mmweaver.paths.board_effects import BoardEffects


@dataclass(frozen=True, kw_only=True)
class Impairments:
    """What keeps a real receiver from the ideal; each can be switched off.

    Phase noise and the jitter of a chirp's start shift the beat signal in time by delta: s(t + delta). Phase noise of
    L(1 MHz) that falls by 20 dB a decade is white in frequency, so delta is white; only static
    paths, the strongest, are shifted.
    """

    thermal_noise: bool = True
    leakage_db: float | None = -62.0  # transmitter to receiver, after the high-pass filter; None = none
    phase_noise_dbc_per_hz: float | None = -93.0  # at 1 MHz; None = none
    chirp_jitter_s: float = 1.1e-9  # a chirp starts at one of two instants so far apart (TI SPRACV2: 0.4 deg at 1 MHz)
    quantise: bool = True
    channel_gain_db: float = 0.0  # rms of each transmitter's and each receiver's gain error; a board keeps its own
    channel_phase_rad: float = 0.0
    board: int = 0  # which board: determines these errors, whatever the seed


IDEAL = Impairments(
    thermal_noise=False, leakage_db=None, phase_noise_dbc_per_hz=None, chirp_jitter_s=0.0, quantise=False
)
LEAKAGE_PATH_LENGTH_M = 0.05


class Receiver:
    """One receiver's noise and errors. Each frame has a random stream of its own, so frames may come in any order."""

    def __init__(
        self, config: RadarConfig, impairments: Impairments, seed: int, board: "BoardEffects | None" = None
    ):  # fmt: skip
        self.config, self.impairments, self.seed, self.board = config, impairments, seed, board
        self.channels = TransmitElements(config).with_weights(channel_errors(config, impairments))
        self.count_sqrt_mw = config.adc_count_sqrt_mw
        # rms of either part of a sample's noise, and of a sample's shift in time by phase noise
        self.noise_sqrt_mw = float(np.sqrt(config.noise_power_mw / 2)) if impairments.thermal_noise else 0.0
        self.phase_noise_s = 0.0
        if impairments.phase_noise_dbc_per_hz is not None:
            # S_f = f^2 S_phi = (1 MHz)^2 . 2 L, white up to half the sample rate
            density = 2e12 * 10 ** (impairments.phase_noise_dbc_per_hz / 10)
            deviation_hz = np.sqrt(density * config.sample_rate_hz / 2)
            self.phase_noise_s = float(deviation_hz / config.chirp_slope_hz_per_s)

    def with_noise(self, noise_power_mw: float, count_sqrt_mw: float) -> "Receiver":
        """The same with thermal noise of this power a sample and a converter of this count."""
        other = copy(self)
        other.count_sqrt_mw = count_sqrt_mw
        if self.impairments.thermal_noise:
            other.noise_sqrt_mw = float(np.sqrt(noise_power_mw / 2))
        return other

    def receive(
        self, moving: Tensor, static: Tensor, static_rate: Tensor, frames: Sequence[int], *, on_device: bool = False
    ) -> Tensor:
        """Samples as recorded, complex64 (frame, loop, tx, rx, sample), in sqrt(mW), of frames of these numbers.

        `moving` (frame, loop, tx, rx, sample) may be overwritten; `static` (frame, tx, rx, sample) is the same in every
        loop, `static_rate` (tx, rx, sample) how fast it changes within a chirp. Noise comes from the seed's streams, or
        with `on_device` from the tensors' device, which is quicker on a GPU and gives other noise of the same kind.
        """
        if not on_device and moving.device.type == "cpu":  # frame by frame: the caches hold it
            for index, frame in enumerate(frames):
                one = slice(index, index + 1)
                self._receive(moving[one], static[one], static_rate, *self._streamed([frame], moving))
            return moving
        impairments = self._sampled(frames, moving) if on_device else self._streamed(frames, moving)
        self._receive(moving, static, static_rate, *impairments)
        return moving

    def _receive(
        self, samples: Tensor, static: Tensor, static_rate: Tensor, delay_s: Tensor, noise: Tensor | None
    ) -> None:
        """Adds all of it to the samples of moving paths, in place."""
        samples += static[:, None]
        if self._has_unstable_clock:
            samples += delay_s[..., None, :] * static_rate
        if self.impairments.channel_gain_db or self.impairments.channel_phase_rad:
            samples *= torch.from_numpy(self.channels).to(samples.device)[:, :, None]
        if self.board is not None:
            samples[:, 0, self.board.first_slot] *= self.board.first_chirp
        if noise is not None:
            samples += noise
        if not self.config.complex_samples:
            torch.view_as_real(samples)[..., 1] = 0.0
        if self.impairments.quantise:
            quantise(samples, self.count_sqrt_mw)

    @property
    def _has_unstable_clock(self) -> bool:
        return bool(self.impairments.chirp_jitter_s or self.phase_noise_s)

    def _streamed(self, frames: Sequence[int], samples: Tensor) -> tuple[Tensor, Tensor | None]:
        """Clock errors (frame, loop, tx, sample), thermal noise (frame, loop, tx, rx, sample) of the seed's streams."""
        delay_s = torch.from_numpy(_stacked([self.shift(int(frame)) for frame in frames])).to(samples.device)
        if not self.impairments.thermal_noise:
            return delay_s, None
        noise = _stacked([self.noise(tuple(samples.shape[1:]), int(frame)) for frame in frames])
        return delay_s, torch.from_numpy(noise).to(samples.device)

    def _sampled(self, frames: Sequence[int], samples: Tensor) -> tuple[Tensor, Tensor]:
        """The same from a generator of the samples' device."""
        device = samples.device
        generator = torch.Generator(device)
        generator.manual_seed(int(stream(self.seed, "device noise", int(frames[0])).integers(2**62)))
        size = samples.shape[:3]
        late = torch.rand((*size, 1), generator=generator, device=device) < 0.5
        white = torch.randn((*size, samples.shape[-1]), generator=generator, device=device)
        delay_s = (late.to(white.dtype) - 0.5) * self.impairments.chirp_jitter_s + white * self.phase_noise_s
        noise = torch.randn((*samples.shape, 2), generator=generator, device=device) * self.noise_sqrt_mw
        return delay_s, torch.view_as_complex(noise)

    def noise(self, shape: tuple[int, ...], frame: int) -> np.ndarray:
        """Thermal noise of one frame's samples, complex64."""
        rng = stream(self.seed, "thermal noise", frame)
        if self.board is not None and self.board.has_filter:
            return filtered_noise(rng, shape, self.board) * np.float32(self.noise_sqrt_mw)
        noise = rng.standard_normal((*shape, 2), dtype=np.float32).view(np.complex64)[..., 0]
        noise *= np.float32(self.noise_sqrt_mw)
        return noise

    def shift(self, frame: int) -> np.ndarray:
        """Clock error delta (loop, tx, sample) of one frame in seconds: s(t + delta) is sampled."""
        config, jitter_s = self.config, self.impairments.chirp_jitter_s
        rng = stream(self.seed, "clock", frame)
        shift = np.zeros((config.num_loops, config.num_slots, config.num_samples), np.float32)
        if jitter_s:
            late = rng.random((config.num_loops, config.num_slots, 1)) < 0.5
            shift += (late - 0.5).astype(np.float32) * np.float32(jitter_s)
        if self.phase_noise_s:
            shift += rng.standard_normal(shift.shape, dtype=np.float32) * np.float32(self.phase_noise_s)
        return shift


def channel_errors(config: RadarConfig, impairments: Impairments) -> np.ndarray:
    """Factors (tx, rx), complex64, of an uncalibrated board: one of each transmitter times one of each receiver."""
    rng = stream(impairments.board, "channel errors")
    errors = rng.standard_normal((2, config.num_tx + config.num_rx))
    gain_db, phase_rad = impairments.channel_gain_db * errors[0], impairments.channel_phase_rad * errors[1]
    each = 10 ** (gain_db / 20) * np.exp(1j * phase_rad)
    return (each[: config.num_tx, None] * each[None, config.num_tx :]).astype(np.complex64)


def filtered_noise(rng: np.random.Generator, shape: tuple[int, ...], board: "BoardEffects") -> np.ndarray:
    """Noise of power 2 before the IF filter, complex64 (..., sample): sampled in the spectrum, where the filter is."""
    generator = torch.Generator().manual_seed(int(rng.integers(1 << 62)))  # three times as fast as numpy's
    spectrum = torch.view_as_complex(torch.empty(*shape, 2).normal_(generator=generator))
    gain = board.noise_gain(np.fft.fftfreq(shape[-1]) % 1.0) * np.sqrt(shape[-1])
    spectrum *= torch.from_numpy(gain.astype(np.float32))
    return torch.fft.ifft(spectrum).numpy()


def _stacked(frames: list[np.ndarray]) -> np.ndarray:
    """Frames along a new axis; one alone is not copied."""
    return frames[0][None] if len(frames) == 1 else np.stack(frames)


def quantise(samples: Tensor, count: float) -> None:
    """Makes samples those of a 16-bit converter, in place: whole multiples of `count` in either part, clipped."""
    torch.view_as_real(samples).div_(count).round_().clamp_(-32768, 32767).mul_(count)


def leakage(config: RadarConfig, impairments: Impairments) -> complex:
    """Amplitude of the transmitter's direct path into the receiver, sqrt(mW)."""
    if impairments.leakage_db is None:
        return 0j
    return complex(10 ** ((config.tx_power_dbm + impairments.leakage_db) / 20))
