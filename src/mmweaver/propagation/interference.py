"""Another FMCW radar in the room: its chirps cross those of the victim and leave short bursts in the samples.

Wherever the interferer's frequency passes the victim's within the IF band, the mixer shows a chirp of the difference of
both slopes, one way from the interferer to each receiver. Reference: Toth, Meissner, Melzer and Witrisal, "Analytical
investigation of non-coherent mutual FMCW radar interference", EuRAD 2018.
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.seeding import stream
from mmweaver.core.targets import Interferer
from mmweaver.propagation.antenna import pattern

IF_SHARE = 0.45  # cut-off of the anti-aliasing filter, of the sample rate
IF_ORDER = 4
SLOPE_RATIO, IDLE_S = (0.6, 1.4), (5e-6, 40e-6)  # of the interferer's slope to the victim's, and its pauses
EIRP_DBM = 22.5  # 12 dBm from 10.5 dBi


@dataclass(frozen=True, kw_only=True)
class InterfererChirps:
    """Chirps of one interferer, sampled by the seed: start, slope, ramp, period in Hz and seconds."""

    start_hz: float
    slope_hz_per_s: float
    ramp_s: float
    period_s: float
    offset_s: float

    @classmethod
    def sampled(cls, config: RadarConfig, seed: int) -> "InterfererChirps":
        """Chirps in the victim's band with another slope and period."""
        rng = stream(seed, "interferer")
        sweep_hz = config.chirp_slope_hz_per_s * config.ramp_end_time_s
        slope = config.chirp_slope_hz_per_s * rng.uniform(*SLOPE_RATIO)
        ramp_s = sweep_hz / slope
        period_s = ramp_s + rng.uniform(*IDLE_S)
        return cls(
            start_hz=config.start_frequency_hz,
            slope_hz_per_s=float(slope),
            ramp_s=float(ramp_s),
            period_s=float(period_s),
            offset_s=float(rng.uniform(0, period_s)),
        )

    def phase_cycles(self, time_s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Phase in cycles within the current chirp, frequency in Hz, and the number of that chirp; nan in pauses."""
        since_s = time_s - self.offset_s
        number = np.floor(since_s / self.period_s)
        late_s = since_s - number * self.period_s
        late_s = np.where(late_s < self.ramp_s, late_s, np.nan)
        frequency_hz = self.start_hz + self.slope_hz_per_s * late_s
        return self.start_hz * late_s + self.slope_hz_per_s * late_s**2 / 2, frequency_hz, number.astype(np.int64)


def interference(
    interferers: tuple[Interferer, ...], pose: RadarPose, config: RadarConfig, frames: np.ndarray, seed: int
) -> np.ndarray:
    """Samples of all interferers.

    Args:
        interferers: Their places in the camera's level frame.
        pose: Pose of the victim.
        config: The victim.
        frames: Frame numbers (frame,).
        seed: Seed of chirps and phases.

    Returns:
        Samples (frame, loop, slot, rx, sample), complex64, in sqrt(mW).
    """
    slots = config.num_slots
    total = np.zeros((len(frames), config.num_loops, slots, config.num_rx, config.num_samples), np.complex64)
    slot_s = np.arange(slots) if config.is_coded else np.argsort(np.argsort(np.asarray(config.tx_delay_s)))
    chirp_s = (
        np.arange(config.num_loops)[:, None] * config.loop_period_s
        + slot_s * config.chirp_period_s
        + config.idle_time_s
    )
    ramp_s = config.adc_start_time_s + np.arange(config.num_samples) / config.sample_rate_hz
    own_cycles = config.start_frequency_hz * ramp_s + config.chirp_slope_hz_per_s * ramp_s**2 / 2
    own_hz = config.start_frequency_hz + config.chirp_slope_hz_per_s * ramp_s
    for number, one in enumerate(interferers):
        chirps = InterfererChirps.sampled(config, seed + 7919 * number)
        place_m = pose.seen(np.array(one.place_m))
        distance_m = np.linalg.norm(place_m - np.asarray(config.rx_position_m), axis=1)
        gain_db = config.antenna_gain_dbi + 20 * np.log10(config.wavelength_m / (4 * np.pi * distance_m.mean()))
        level = 10 ** ((one.eirp_dbm + gain_db) / 20) * pattern(place_m[None] / np.linalg.norm(place_m), config)[0]
        receivers = level * np.exp(2j * np.pi * distance_m / config.wavelength_m)
        for row, frame in zip(total, frames, strict=True):
            time_s = frame * config.frame_period_s + chirp_s[..., None] + ramp_s  # (loop, slot, sample)
            cycles, their_hz, chirp = chirps.phase_cycles(time_s - distance_m.mean() / SPEED_OF_LIGHT_MPS)
            beat_hz = np.nan_to_num(own_hz - their_hz, nan=np.inf)
            passed = 1 / np.sqrt(1 + (beat_hz / (IF_SHARE * config.sample_rate_hz)) ** (2 * IF_ORDER))
            here = passed > 1e-4
            turn = np.modf(chirp[here] * 0.6180339887498949)[0]  # each chirp starts with a phase of its own
            whole = np.broadcast_to(own_cycles, here.shape)[here] - cycles[here]
            burst = np.zeros(here.shape, complex)
            burst[here] = passed[here] * np.exp(2j * np.pi * (np.modf(whole)[0] + turn))
            row += (burst[:, :, None] * receivers[:, None]).astype(np.complex64)
    return total if config.complex_samples else total.real.astype(np.complex64)
