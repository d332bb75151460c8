"""From the wave at the port to the numbers of the converter: noise, an uneasy clock, whole numbers.

Reference: docs/radar_primer.md, section 6.
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream


@dataclass(frozen=True, kw_only=True)
class Impairments:
    """What keeps a real receiver from the ideal; each can be switched off.

    Phase noise and the jitter of a chirp's start shift the beat signal in time by delta: s(t + delta). Phase noise of
    L(1 MHz) that falls by 20 dB a decade is white in frequency, so delta is white; only the room's echoes, the
    strongest, are shifted.
    """

    thermal_noise: bool = True
    leakage_db: float | None = -62.0  # transmitter to receiver, after the high-pass filter; None = none
    phase_noise_dbc_per_hz: float | None = -93.0  # at 1 MHz; None = none
    chirp_jitter_s: float = 1.1e-9  # a chirp starts at one of two instants so far apart (TI SPRACV2: 0.4 deg at 1 MHz)
    quantise: bool = True
    channel_gain_db: float = 0.0  # rms of each transmitter's and each receiver's gain error; a board keeps its own
    channel_phase_rad: float = 0.0
    board: int = 0  # which board: draws these errors, whatever the seed


IDEAL = Impairments(
    thermal_noise=False, leakage_db=None, phase_noise_dbc_per_hz=None, chirp_jitter_s=0.0, quantise=False
)
LEAKAGE_PATH_LENGTH_M = 0.05


class Receiver:
    """Adds to the ADC samples of one frame what the receiver adds. Each frame draws from its own stream."""

    def __init__(self, config: RadarConfig, impairments: Impairments, seed: int):
        self.config, self.impairments, self.seed = config, impairments, seed
        self.channels = channel_errors(config, impairments)
        # rms of either part of a sample's noise, and of a sample's shift in time by phase noise
        self.noise_sqrt_mw = float(np.sqrt(config.noise_power_mw / 2)) if impairments.thermal_noise else 0.0
        self.phase_noise_s = 0.0
        if impairments.phase_noise_dbc_per_hz is not None:
            # S_f = f^2 S_phi = (1 MHz)^2 . 2 L, white up to half the sample rate
            density = 2e12 * 10 ** (impairments.phase_noise_dbc_per_hz / 10)
            deviation_hz = np.sqrt(density * config.sample_rate_hz / 2)
            self.phase_noise_s = float(deviation_hz / config.chirp_slope_hz_per_s)

    def receive(self, person: np.ndarray, room: np.ndarray, room_rate: np.ndarray, frame: int) -> np.ndarray:
        """Person (loop, tx, rx, sample) + room (tx, rx, sample) and its time derivative -> samples, complex64."""
        samples = person + room
        samples += self.shift(frame)[:, :, None, :] * room_rate
        if self.impairments.channel_gain_db or self.impairments.channel_phase_rad:
            samples *= self.channels[:, :, None]
        if self.impairments.thermal_noise:
            samples += self.noise(samples.shape, frame)
        if not self.config.complex_samples:
            samples = np.real(samples).astype(np.complex64)
        if self.impairments.quantise:
            samples = quantised(samples, self.config.adc_count_sqrt_mw)
        return samples

    def noise(self, shape: tuple[int, ...], frame: int) -> np.ndarray:
        """Thermal noise of one frame's samples, complex64."""
        rng = stream(self.seed, "thermal noise", frame)
        noise = rng.standard_normal((*shape, 2), dtype=np.float32).view(np.complex64)[..., 0]
        noise *= np.float32(self.noise_sqrt_mw)
        return noise

    def shift(self, frame: int) -> np.ndarray:
        """How late each sample of one frame is, delta (loop, tx, sample) in seconds."""
        config, jitter_s = self.config, self.impairments.chirp_jitter_s
        rng = stream(self.seed, "clock", frame)
        shift = np.zeros((config.num_loops, config.num_tx, config.num_samples), np.float32)
        if jitter_s:
            late = rng.random((config.num_loops, config.num_tx, 1)) < 0.5
            shift += (late - 0.5).astype(np.float32) * np.float32(jitter_s)
        if self.phase_noise_s:
            shift += rng.standard_normal(shift.shape, dtype=np.float32) * np.float32(self.phase_noise_s)
        return shift


def channel_errors(config: RadarConfig, impairments: Impairments) -> np.ndarray:
    """Factors (tx, rx), complex64, of an uncalibrated board: one of each transmitter times one of each receiver."""
    rng = stream(impairments.board, "channel errors")
    drawn = rng.standard_normal((2, config.num_tx + config.num_rx))
    gain_db, phase_rad = impairments.channel_gain_db * drawn[0], impairments.channel_phase_rad * drawn[1]
    each = 10 ** (gain_db / 20) * np.exp(1j * phase_rad)
    return (each[: config.num_tx, None] * each[None, config.num_tx :]).astype(np.complex64)


def quantised(samples: np.ndarray, count: float) -> np.ndarray:
    """Samples as a 16-bit converter gives them: whole multiples of `count` in either part, clipped."""
    parts = np.ascontiguousarray(samples).view(np.float32)
    parts = np.clip(np.rint(parts / np.float32(count)), -32768, 32767) * np.float32(count)
    return parts.view(np.complex64)


def leakage(config: RadarConfig, impairments: Impairments) -> complex:
    """Amplitude of the transmitter's direct way into the receiver, sqrt(mW)."""
    if impairments.leakage_db is None:
        return 0j
    return complex(10 ** ((config.tx_power_dbm + impairments.leakage_db) / 20))
