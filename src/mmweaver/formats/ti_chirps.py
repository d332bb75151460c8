"""Converts the chirp configuration of a TI radar, in TI's units, to a RadarConfig."""

from dataclasses import dataclass

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.presets import (
    BAND_60_HZ,
    BAND_77_HZ,
    XWR1843_TX_HALFWAVES,
    XWR_RX_HALFWAVES,
    halfwave_positions,
)
from mmweaver.core.radar_config import RadarConfig

MIN_RANGE_M = 0.7  # where the kept range bins start, as in the awr1843 preset
MAX_RANGE_BINS = 64


@dataclass(frozen=True, kw_only=True)
class TiChirps:
    """The profile, chirps and frame of a TI configuration. Units are in the names."""

    name: str
    start_frequency_ghz: float
    idle_time_us: float
    adc_start_time_us: float
    ramp_end_time_us: float
    slope_mhz_per_us: float
    num_samples: int
    sample_rate_ksps: float
    rx_gain_db: float
    rx_mask: int
    tx_mask: int
    chirp_tx_masks: tuple[int, ...]  # of one loop, in firing order
    num_loops: int
    frame_period_ms: float
    complex_samples: bool = True


def radar_from_ti(chirps: TiChirps) -> RadarConfig:
    """The radar with the array of the xWR1443/1843/6843, restricted to the transmitters that fire.

    Transmitters are renumbered in the board's order. Up to 64 range bins from about 0.7 m are kept. Raises InputError
    where the chirps do not fire one transmitter after the other, or where the radar could not exist.
    """
    masks, repeats = _repeated_sequence(chirps.chirp_tx_masks)
    boards = _transmitters(masks, chirps.tx_mask)
    enabled = sorted(boards)
    receivers = [bit for bit in range(len(XWR_RX_HALFWAVES)) if chirps.rx_mask >> bit & 1]
    if not receivers or chirps.rx_mask >> len(XWR_RX_HALFWAVES):
        raise InputError(f"receiver mask {chirps.rx_mask} must name some of the {len(XWR_RX_HALFWAVES)} receivers")
    start_hz, slope = chirps.start_frequency_ghz * 1e9, chirps.slope_mhz_per_us * 1e12
    sample_rate_hz = chirps.sample_rate_ksps * 1e3
    if slope <= 0 or sample_rate_hz <= 0 or chirps.num_samples <= 0:
        raise InputError("the profile's slope, samples and sample rate must be above 0")
    sampled_s = chirps.num_samples / sample_rate_hz
    middle_hz = start_hz + slope * (chirps.adc_start_time_us * 1e-6 + sampled_s / 2)
    bins = chirps.num_samples if chirps.complex_samples else chirps.num_samples // 2
    resolution_m = SPEED_OF_LIGHT_MPS / (2 * slope * sampled_s)
    kept = min(MAX_RANGE_BINS, bins)
    return RadarConfig(
        name=chirps.name,
        start_frequency_hz=start_hz,
        chirp_slope_hz_per_s=slope,
        idle_time_s=chirps.idle_time_us * 1e-6,
        adc_start_time_s=chirps.adc_start_time_us * 1e-6,
        ramp_end_time_s=chirps.ramp_end_time_us * 1e-6,
        num_samples=chirps.num_samples,
        sample_rate_hz=sample_rate_hz,
        num_loops=chirps.num_loops * repeats,
        frame_period_s=chirps.frame_period_ms * 1e-3,
        tx_position_m=halfwave_positions(tuple(XWR1843_TX_HALFWAVES[bit] for bit in enabled), middle_hz),
        rx_position_m=halfwave_positions(tuple(XWR_RX_HALFWAVES[bit] for bit in receivers), middle_hz),
        tx_order=tuple(enabled.index(bit) for bit in boards),
        complex_samples=chirps.complex_samples,
        first_range_bin=min(round(MIN_RANGE_M / resolution_m), bins - kept),
        num_range_bins=kept,
        rx_gain_db=chirps.rx_gain_db,
        frequency_limits_hz=_band_hz(start_hz),
    )


def _band_hz(start_hz: float) -> tuple[float, float]:
    for band in (BAND_60_HZ, BAND_77_HZ):
        if band[0] <= start_hz < band[1]:
            return band
    raise InputError(
        f"the profile starts at {start_hz / 1e9:g} GHz; TI's radars work in 57 to 64 GHz (xWR6843) and 76 to 81 GHz"
        " (xWR1443, xWR1843)"
    )


def _repeated_sequence(masks: tuple[int, ...]) -> tuple[tuple[int, ...], int]:
    """The shortest sequence that the chirps repeat, and its number of repetitions."""
    if not masks:
        raise InputError("the frame names no chirps")
    for length in range(1, len(masks) + 1):
        if len(masks) % length == 0 and masks[:length] * (len(masks) // length) == masks:
            return masks[:length], len(masks) // length
    raise AssertionError("a sequence repeats itself once")


def _transmitters(masks: tuple[int, ...], tx_mask: int) -> list[int]:
    """The transmitter that each chirp of a sequence fires."""
    fired = []
    for mask in masks:
        bits = [bit for bit in range(len(XWR1843_TX_HALFWAVES)) if mask >> bit & 1]
        if len(bits) != 1 or mask != 1 << bits[0]:
            raise InputError(
                f"a chirp with transmitter mask {mask} is not TDM-MIMO; each chirp must fire one of"
                f" {len(XWR1843_TX_HALFWAVES)} transmitters (mask 1, 2 or 4)"
            )
        if not tx_mask >> bits[0] & 1:
            raise InputError(
                f"a chirp fires transmitter mask {mask}, but the channel mask {tx_mask} does not enable it"
            )
        fired.append(bits[0])
    if len(set(fired)) < len(fired):
        raise InputError(f"the chirps fire transmitters {fired} in one loop; each may fire once")
    return fired
