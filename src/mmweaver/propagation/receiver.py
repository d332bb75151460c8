"""From the wave at the port to the converter's output: thermal noise, phase noise, jitter, quantisation.

Reference: docs/radar_primer.md, section 6.

A background recording in place of sampled static phases.

Static clutter is then the recording's own. How much of it a body occludes is inferred: the static paths receive the
posterior mean amplitudes given the recording.
Reference: linear Gaussian conditioning (Rasmussen and Williams, Gaussian Processes, 2006, appendix A.2).
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.mean_power import MeanPower
from mmweaver.propagation.paths import StaticPaths
from mmweaver.signal.cube import static_cube
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    moving_doppler,
    noise_power,
    range_azimuth_power,
    range_doppler_power,
)

if TYPE_CHECKING:
    from mmweaver.propagation.board_effects import BoardEffects


MISFIT = 0.01  # share of the recording's mean power that a photo's geometry cannot explain
SHOWN = 1e-4  # cells above this share of the strongest are used to compare levels
MOVES = 10.0  # times the noise power: moving cells above it count as motion
NO_SCALE = "the background recording has no absolute scale: it was taken to be as strong as the scene's paths predict"
SOMEBODY = "something moves in the background recording: its mean over time was taken"


@dataclass(frozen=True, kw_only=True)
class BackgroundRecording:
    """Static clutter, noise level and scale that a recording without people provides."""

    static: Tensor  # complex (range, antenna), the cube at zero Doppler, in sqrt(mW)
    noise_power: float  # mW in a cell of the cube
    sample_noise_mw: float  # noise power per ADC sample
    unit: float  # sqrt(mW) per unit of the recording
    count_sqrt_mw: float  # sqrt(mW) per count of the converter
    assumptions: tuple[str, ...]

    @classmethod
    def of(cls, recording: RadarCube, expected: Tensor, radar: MeanPower) -> "BackgroundRecording":
        """Evaluates a recording by the same radar (`check_recording`).

        Args:
            recording: Cube without people.
            expected: Mean power (range, azimuth) in mW that the scene's paths predict; it sets the scale of a recording
                that has none.
            radar: Mean power maps of the radar, for its configuration and noise.

        Returns:
            The background, with assumptions about scale and motion in words.

        Raises:
            InputError: If a recording without scale has no cell in common with the scene's paths.
        """
        middle = radar.config.num_loops // 2
        mean = recording.values[:, :, middle].mean(axis=0, dtype=np.complex128)
        notes: list[str] = []
        unit = recording.scale
        if not np.isfinite(unit):
            own = range_azimuth_power(static_cube(mean, radar.config), azimuth_axis_rad())[0]
            unit = agreeing_gain([(expected, torch.from_numpy(own).float())])
            notes.append(NO_SCALE)
        noise = noise_power(recording)
        if noise is not None and _moves(recording, noise):
            notes.append(SOMEBODY)
        config, power = radar.config, radar.noise if noise is None else noise * unit**2
        is_calibrated = np.isfinite(recording.scale)  # else 1.0 is a count of the converter
        return cls(
            static=torch.from_numpy((mean * unit).astype(np.complex64)),
            unit=float(unit),
            noise_power=float(power),
            sample_noise_mw=float(power * config.noise_power_mw / radar.noise),
            count_sqrt_mw=config.adc_count_sqrt_mw if is_calibrated else float(unit),
            assumptions=tuple(notes),
        )

    def conditioned(self, paths: StaticPaths, renderer: CubeRenderer) -> StaticPaths:
        """Static paths with the amplitudes that are most likely given the recording.

        A priori each amplitude is multiplied by an independent complex Gaussian of mean power 1.

        Args:
            paths: Static paths of the scene, (path,).
            renderer: Renderer of the radar that made the recording.

        Returns:
            The same paths with posterior mean amplitudes.
        """
        seen = renderer.static(paths).each()  # (range and antenna, path)
        wanted = self.static.flatten()
        misfit = MISFIT * float(wanted.abs().square().mean()) + self.noise_power
        if seen.shape[0] <= seen.shape[1]:
            both = seen @ seen.mH
            both.diagonal().add_(misfit)
            times = seen.mH @ torch.linalg.solve(both, wanted)
        else:
            both = seen.mH @ seen
            both.diagonal().add_(misfit)
            times = torch.linalg.solve(both, seen.mH @ wanted)
        return replace(paths, amplitude=times * paths.amplitude)


def check_recording(recording: RadarCube, config: RadarConfig) -> None:
    """Checks that a background recording fits the radar.

    Args:
        recording: Cube without people.
        config: The radar to generate for; its name and frame period may differ.

    Raises:
        InputError: If the recording is from a radar with other settings, empty, zero or not finite.
    """
    own = {field.name for field in fields(config)} - {"name", "frame_period_s"}
    if any(getattr(recording.config, name) != getattr(config, name) for name in own):
        raise InputError(
            f"the background was recorded by {recording.config.name!r} with other settings than those of"
            f" {config.name!r}; generate for the radar that recorded it (its radar.json)"
        )
    if not len(recording.values) or not np.isfinite(recording.values).all() or not recording.values.any():
        raise InputError("the background recording holds no signal, or values that are not finite")


def agreeing_gain(maps: Sequence[tuple[Tensor, Tensor]]) -> float:
    """Amplitude factor that brings recorded power maps to the level of expected ones.

    The median log ratio over the cells that are visible in both.

    Args:
        maps: Pairs of (expected, recorded) power maps of equal shape.

    Returns:
        Factor of the recorded amplitude.

    Raises:
        InputError: If no cell is visible in both.
    """
    ratios = []
    for expected, own in maps:
        shown = (own > SHOWN * own.max()) & (expected > SHOWN * expected.max())
        ratios.append((expected[shown] / own[shown]).log())
    both = torch.cat(ratios)
    if not len(both):
        raise InputError(
            "the recording shows no echo where the photo has a surface, so its scale cannot be found; is it of this"
            " room, and is the range window that of the room?"
        )
    return float(both.median().div(2).exp())


def _moves(recording: RadarCube, noise: float) -> bool:
    power = range_doppler_power(recording).mean(axis=0)[:, moving_doppler(recording)]
    return bool(power.max() > MOVES * noise)


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
        level_dbc = impairments.phase_noise_dbc_per_hz
        if board is not None and board.board.phase_noise_dbc_per_hz is not None:
            level_dbc = board.board.phase_noise_dbc_per_hz
        if level_dbc is not None:
            # S_f = f^2 S_phi = (1 MHz)^2 . 2 L, white up to half the sample rate
            density = 2e12 * 10 ** (level_dbc / 10)
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
        if self.board is not None and self.board.iq_image and self.config.complex_samples:
            samples += self.board.iq_image * samples.conj()
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
