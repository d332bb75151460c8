"""From the wave at the port to the converter's output: thermal noise, phase noise, jitter, quantisation.

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

if TYPE_CHECKING:
    from mmweaver.propagation.board_effects import BoardEffects


@dataclass(frozen=True, kw_only=True)
class Impairments:
    """Deviations of a real receiver from the ideal; each can be switched off.

    Phase noise and the jitter of a chirp's start shift the beat signal in time by delta, s(t + delta). Phase noise of
    L(1 MHz) that falls by 20 dB per decade is white in frequency, so delta is white. Only static paths, the
    strongest, are shifted.
    """

    thermal_noise: bool = True
    leakage_db: float | None = -62.0  # transmitter to receiver, after the high-pass filter; None = none
    phase_noise_dbc_per_hz: float | None = -93.0  # at 1 MHz; None = none
    chirp_jitter_s: float = 1.1e-9  # between the two instants at which a chirp may start (TI SPRACV2: 0.4 deg at 1 MHz)
    quantise: bool = True


IDEAL = Impairments(
    thermal_noise=False, leakage_db=None, phase_noise_dbc_per_hz=None, chirp_jitter_s=0.0, quantise=False
)
LEAKAGE_PATH_LENGTH_M = 0.05


class Receiver:
    """Noise and errors of one receiver. Every frame has its own random stream, so frames may come in any order."""

    def __init__(self, config: RadarConfig, impairments: Impairments, seed: int, board: "BoardEffects | None" = None):
        """Computes noise levels.

        Args:
            config: The radar.
            impairments: Which impairments apply.
            seed: Seed of noise and clock errors.
            board: Board whose IF filter shapes the noise and whose first chirp differs; by default none.
        """
        self.config, self.impairments, self.seed, self.board = config, impairments, seed, board
        self.count_sqrt_mw = config.adc_count_sqrt_mw
        # rms of either part of a sample's noise, and of a sample's shift in time by phase noise
        self.noise_sqrt_mw = float(np.sqrt(config.noise_power_mw / 2)) if impairments.thermal_noise else 0.0
        self.phase_noise_s = 0.0
        if impairments.phase_noise_dbc_per_hz is not None:
            # S_f = f^2 S_phi = (1 MHz)^2 . 2 L, white up to half the sample rate
            density = 2e12 * 10 ** (impairments.phase_noise_dbc_per_hz / 10)
            deviation_hz = np.sqrt(density * config.sample_rate_hz / 2)
            self.phase_noise_s = float(deviation_hz / config.chirp_slope_hz_per_s)

    def adopt_noise(self, noise_power_mw: float, count_sqrt_mw: float) -> "Receiver":
        """The same receiver with the noise and converter of a recording.

        Args:
            noise_power_mw: Thermal noise power per sample in mW.
            count_sqrt_mw: Converter count in sqrt(mW).
        """
        other = copy(self)
        other.count_sqrt_mw = count_sqrt_mw
        if self.impairments.thermal_noise:
            other.noise_sqrt_mw = float(np.sqrt(noise_power_mw / 2))
        return other

    def receive(
        self, moving: Tensor, static: Tensor, static_rate: Tensor, frames: Sequence[int], *, on_device: bool = False
    ) -> Tensor:
        """Recorded samples: static and moving samples with clock errors, noise and quantisation.

        Args:
            moving: Samples of moving paths (frame, loop, tx, rx, sample) in sqrt(mW); overwritten.
            static: Samples of static paths (frame, tx, rx, sample), the same in every loop.
            static_rate: Time derivative of the static samples within a chirp (tx, rx, sample), in sqrt(mW)/s.
            frames: Frame numbers.
            on_device: Whether noise is generated on the tensors' device, which is faster on a GPU and gives another
                realization; by default it comes from the streams of the seed.

        Returns:
            Samples (frame, loop, tx, rx, sample), complex64, in sqrt(mW).
        """
        if on_device:
            self._add(moving, static, static_rate, *self._sampled(frames, moving))
            return moving
        for index, frame in enumerate(map(int, frames)):  # one at a time: a frame fits into the cache
            one, device = slice(index, index + 1), moving.device
            noise = None
            if self.impairments.thermal_noise:
                noise = torch.from_numpy(self.noise(tuple(moving.shape[1:]), frame)).to(device)
            delay_s = torch.from_numpy(self.shift(frame)).to(device)
            self._add(moving[one], static[one], static_rate, delay_s, noise)
        return moving

    def _add(self, samples: Tensor, static: Tensor, static_rate: Tensor, delay_s: Tensor, noise: Tensor | None) -> None:
        """Turns samples of moving paths into recorded ones, in place.

        Clock errors are (loop, tx, sample) in seconds, noise has the shape of the samples.
        """
        samples += static[:, None]
        if self.impairments.chirp_jitter_s or self.phase_noise_s:
            samples += delay_s[..., None, :] * static_rate
        if self.board is not None:
            samples[:, 0, self.board.first_slot] *= self.board.first_chirp
        if noise is not None:
            samples += noise
        if not self.config.complex_samples:
            torch.view_as_real(samples)[..., 1] = 0.0
        if self.impairments.quantise:
            quantise(samples, self.count_sqrt_mw)

    def _sampled(self, frames: Sequence[int], samples: Tensor) -> tuple[Tensor, Tensor]:
        """Clock errors (frame, loop, tx, sample) and noise (frame, loop, tx, rx, sample), generated on the device."""
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
        """Thermal noise of one frame.

        Args:
            shape: Shape of the frame's samples, (loop, tx, rx, sample).
            frame: Frame number.

        Returns:
            Noise of that shape, complex64, in sqrt(mW).
        """
        rng = stream(self.seed, "thermal noise", frame)
        if self.board is not None and self.board.has_filter:
            return filtered_noise(rng, shape, self.board) * np.float32(self.noise_sqrt_mw)
        noise = rng.standard_normal((*shape, 2), dtype=np.float32).view(np.complex64)[..., 0]
        noise *= np.float32(self.noise_sqrt_mw)
        return noise

    def shift(self, frame: int) -> np.ndarray:
        """Clock error of one frame: s(t + delta) is sampled.

        Args:
            frame: Frame number.

        Returns:
            Delta (loop, tx, sample) in seconds.
        """
        config, jitter_s = self.config, self.impairments.chirp_jitter_s
        rng = stream(self.seed, "clock", frame)
        shift = np.zeros((config.num_loops, config.num_slots, config.num_samples), np.float32)
        if jitter_s:
            late = rng.random((config.num_loops, config.num_slots, 1)) < 0.5
            shift += (late - 0.5).astype(np.float32) * np.float32(jitter_s)
        if self.phase_noise_s:
            shift += rng.standard_normal(shift.shape, dtype=np.float32) * np.float32(self.phase_noise_s)
        return shift


def filtered_noise(rng: np.random.Generator, shape: tuple[int, ...], board: "BoardEffects") -> np.ndarray:
    """Noise behind the IF filter, of power 2 before it; generated in the spectrum, where the filter is a product.

    Args:
        rng: Random stream.
        shape: Shape of the samples, (..., sample).
        board: Board whose IF response applies.

    Returns:
        Noise, complex64.
    """
    generator = torch.Generator().manual_seed(int(rng.integers(1 << 62)))  # three times faster than numpy's
    spectrum = torch.view_as_complex(torch.empty(*shape, 2).normal_(generator=generator))
    gain = board.noise_gain(np.fft.fftfreq(shape[-1]) % 1.0) * np.sqrt(shape[-1])
    spectrum *= torch.from_numpy(gain.astype(np.float32))
    return torch.fft.ifft(spectrum).numpy()


def quantise(samples: Tensor, count: float) -> None:
    """Quantises samples as a 16-bit converter does, in place.

    Args:
        samples: Complex samples in sqrt(mW).
        count: Converter count in sqrt(mW); real and imaginary parts become multiples of it, clipped to 16 bits.
    """
    torch.view_as_real(samples).div_(count).round_().clamp_(-32768, 32767).mul_(count)


def leakage(config: RadarConfig, impairments: Impairments) -> complex:
    """Amplitude of the direct path from transmitter to receiver.

    Args:
        config: The radar, for its transmit power.
        impairments: The leakage level.

    Returns:
        Amplitude in sqrt(mW), 0 without leakage.
    """
    if impairments.leakage_db is None:
        return 0j
    return complex(10 ** ((config.tx_power_dbm + impairments.leakage_db) / 20))
