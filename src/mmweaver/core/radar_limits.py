"""Limits on radar parameters, alone and in combination, that keep every signal finite and nonzero."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from mmweaver.core.antenna_tables import pattern_grid

if TYPE_CHECKING:
    from mmweaver.core.radar_config import RadarConfig

LIMITS: dict[str, tuple[float, float]] = {
    "start_frequency_hz": (1e9, 1e12),
    "chirp_slope_hz_per_s": (1e6, 1e17),
    "idle_time_s": (0.0, 1e3),
    "adc_start_time_s": (0.0, 1.0),
    "ramp_end_time_s": (1e-9, 1.0),
    "num_samples": (1, 65536),
    "sample_rate_hz": (1e3, 1e11),
    "num_loops": (1, 65536),
    "frame_period_s": (1e-6, 1e4),
    "first_range_bin": (0, 65536),
    "num_range_bins": (1, 65536),
    "tx_power_dbm": (-60.0, 100.0),
    "antenna_gain_dbi": (-30.0, 60.0),
    "noise_figure_db": (0.0, 100.0),
    "rx_gain_db": (-60.0, 120.0),
    "azimuth_beamwidth_deg": (0.1, 360.0),
    "elevation_beamwidth_deg": (0.1, 360.0),
    "adc_full_scale_v": (1e-6, 1e3),
}
MAX_POSITION_M = 10.0
MAX_ANTENNAS = 1024
MAX_FRAME_NUMBERS = 2**25  # complex numbers of one frame: 256 MB
MAX_NAME = 100
RAMP_BEYOND_BAND_HZ = 100e6  # overrun of the band that boards accept, since the ADC has stopped by then
MAX_COUNT_TO_NOISE = 4.0  # power of one ADC count / noise power; above this the noise rounds to 0


def problems(config: "RadarConfig") -> Iterator[str]:
    """Lists what makes a radar impossible.

    Args:
        config: The radar.

    Yields:
        One sentence per problem, starting with those that make the following ones meaningless; none for a valid radar.

    Raises:
        InputError: If the transmit code cannot be decoded.
    """
    yield from _value_problems(config)
    if any(len(row) != config.num_tx or not any(map(any, row)) for row in config.tx_code):
        yield f"each row of tx_code needs a weight of each of its {config.num_tx} transmitters, not all 0"
    adc_end_us = (config.adc_start_time_s + config.num_samples / config.sample_rate_hz) * 1e6
    ramp_end_us = config.ramp_end_time_s * 1e6
    if adc_end_us > ramp_end_us * (1 + 1e-9):
        yield (
            f"the ADC samples until {adc_end_us:.2f} us, but the ramp ends at {ramp_end_us:.2f} us; take fewer samples,"
            " a higher sample rate or a longer ramp"
        )
    low_hz, high_hz = config.frequency_limits_hz
    end_hz = config.start_frequency_hz + config.chirp_slope_hz_per_s * config.ramp_end_time_s
    if config.start_frequency_hz < low_hz or end_hz > high_hz + RAMP_BEYOND_BAND_HZ:
        yield (
            f"the chirp runs from {config.start_frequency_hz / 1e9:.3f} to {end_hz / 1e9:.3f} GHz, outside"
            f" {low_hz / 1e9:g} to {high_hz / 1e9:g} GHz; lower the slope or the ramp end"
        )
    if config.active_time_s > config.frame_period_s * (1 + 1e-9):
        yield (
            f"its {config.num_loops} loops last {config.active_time_s * 1e3:.2f} ms, longer than the frame period of"
            f" {config.frame_period_s * 1e3:.2f} ms; fewer loops or frames further apart"
        )
    yield from _array_problems(config)
    last, bins = config.first_range_bin + config.num_range_bins - 1, config.num_unambiguous_range_bins
    if last >= bins:
        yield (
            f"range bins {config.first_range_bin} to {last} are wanted, but {config.num_samples} samples give only"
            f" {bins}"
        )
    _ = config.tx_decoder  # raises where transmitters cannot be separated
    yield from _signal_problems(config)


def _array_problems(config: "RadarConfig") -> Iterator[str]:
    """Problems of the antenna array and the channel order of recordings."""
    if sorted(config.tx_order) != list(range(config.num_tx)):
        yield f"tx_order {config.tx_order} must name each of its {config.num_tx} transmitters once"
    if config.loop_gap_s < 0:
        yield "loop_gap_s cannot be negative"
    if config.lvds_lanes not in (0, 2, 4):
        yield f"a DCA1000 records 2 or 4 lanes, not {config.lvds_lanes}"
    if config.lvds_iq_order not in ("iq", "qi"):
        yield f"I/Q order is iq or qi, not {config.lvds_iq_order!r}"
    if config.rx_channels and len(set(config.rx_channels)) != config.num_rx:
        yield f"rx_channels {config.rx_channels} must name each of its {config.num_rx} receivers once"
    if not set(config.rx_inverted) <= set(range(config.num_rx)):
        yield f"rx_inverted {config.rx_inverted} names receivers that it does not have"
    if config.antenna_pattern:
        try:
            pattern_grid(config.antenna_pattern)
        except ValueError as error:
            yield str(error)
    if min(config.frame_words_before, config.frame_words_after) < 0:
        yield "words of a frame cannot be negative"


def _value_problems(config: "RadarConfig") -> Iterator[str]:
    """Problems of single values."""
    if not config.name or len(config.name) > MAX_NAME or not config.name.isprintable():
        yield f"its name must have 1 to {MAX_NAME} printable characters"
    for name, (low, high) in LIMITS.items():
        value: Any = getattr(config, name)
        if not low <= value <= high:  # also true for nan
            yield f"{name} must be {low:g} to {high:g}, not {value}"
    if not all(math.isfinite(limit) for limit in config.frequency_limits_hz):
        yield f"frequency_limits_hz is {config.frequency_limits_hz}"
    if not config.tx_position_m or not config.rx_position_m:
        yield "it needs at least one transmitter and one receiver"
    for name in ("tx_position_m", "rx_position_m"):
        for position in getattr(config, name):
            if not all(abs(number) <= MAX_POSITION_M for number in position):
                yield f"{name} holds {position}; antennas are within {MAX_POSITION_M:g} m, in metres"
    if config.num_tx * config.num_rx > MAX_ANTENNAS:
        yield f"it has more than {MAX_ANTENNAS} virtual antennas"


def _signal_problems(config: "RadarConfig") -> Iterator[str]:
    """Problems of combinations of individually valid values."""
    numbers = config.num_samples * config.num_loops * config.num_antennas
    if numbers > MAX_FRAME_NUMBERS:
        yield f"one frame has {numbers} samples, more than {MAX_FRAME_NUMBERS}; take fewer samples, loops or antennas"
    count_mw, noise_mw = config.adc_count_sqrt_mw**2, config.noise_power_mw
    if count_mw > MAX_COUNT_TO_NOISE * noise_mw:
        yield (
            f"one count of its converter is {10 * math.log10(count_mw / noise_mw):.0f} dB above its noise, so that"
            " signals become zero; raise rx_gain_db or lower adc_full_scale_v"
        )
    if count_mw * 32768**2 < noise_mw:
        yield "its noise exceeds the full scale of its converter; lower rx_gain_db or raise adc_full_scale_v"
