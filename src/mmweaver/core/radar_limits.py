"""What the parameters of a radar may be at most: wide of every device, so that each signal is finite and not zero."""

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mmweaver.core.radar_config import RadarConfig

LIMITS: dict[str, tuple[float, float]] = {
    "start_frequency_hz": (1e9, 1e12), "chirp_slope_hz_per_s": (1e6, 1e17), "idle_time_s": (0.0, 1e3),
    "adc_start_time_s": (0.0, 1.0), "ramp_end_time_s": (1e-9, 1.0), "num_samples": (1, 65536),
    "sample_rate_hz": (1e3, 1e11), "num_loops": (1, 65536), "frame_period_s": (1e-6, 1e4),
    "first_range_bin": (0, 65536), "num_range_bins": (1, 65536), "tx_power_dbm": (-60.0, 100.0),
    "antenna_gain_dbi": (-30.0, 60.0), "noise_figure_db": (0.0, 100.0), "rx_gain_db": (-60.0, 120.0),
    "azimuth_beamwidth_deg": (0.1, 360.0), "elevation_beamwidth_deg": (0.1, 360.0), "adc_full_scale_v": (1e-6, 1e3),
}  # fmt: skip
MAX_POSITION_M = 10.0
MAX_ANTENNAS = 1024
MAX_FRAME_NUMBERS = 2**25  # complex numbers of one frame: 256 MB
MAX_NAME = 100
MAX_COUNT_TO_NOISE = 4.0  # power of one count of the converter over that of the noise: more, and the noise rounds to 0


def impossible_values(config: "RadarConfig") -> str | None:
    """What is wrong with a radar's values one by one; None if nothing is."""
    if not config.name or len(config.name) > MAX_NAME or not config.name.isprintable():
        return f"its name must have 1 to {MAX_NAME} printable characters"
    for name, (low, high) in LIMITS.items():
        value: Any = getattr(config, name)
        if not low <= value <= high:  # not so of NaN
            return f"{name} must be {low:g} to {high:g}, not {value}"
    if not all(math.isfinite(limit) for limit in config.frequency_limits_hz):
        return f"frequency_limits_hz is {config.frequency_limits_hz}"
    if not config.tx_position_m or not config.rx_position_m:
        return "it needs at least one transmitter and one receiver"
    for name in ("tx_position_m", "rx_position_m"):
        for position in getattr(config, name):
            if not all(abs(number) <= MAX_POSITION_M for number in position):
                return f"{name} holds {position}; antennas are within {MAX_POSITION_M:g} m, in metres"
    if len(config.tx_position_m) * len(config.rx_position_m) > MAX_ANTENNAS:
        return f"it has more than {MAX_ANTENNAS} virtual antennas"
    return None


def impossible_together(config: "RadarConfig") -> str | None:
    """What is wrong with a radar's values, each possible, in combination; None if nothing is."""
    numbers = config.num_samples * config.num_loops * config.num_antennas
    if numbers > MAX_FRAME_NUMBERS:
        return f"one frame has {numbers} samples, more than {MAX_FRAME_NUMBERS}; take fewer samples, loops or antennas"
    count_mw, noise_mw = config.adc_count_sqrt_mw**2, config.noise_power_mw
    if count_mw > MAX_COUNT_TO_NOISE * noise_mw:
        return (
            f"one count of its converter is {10 * math.log10(count_mw / noise_mw):.0f} dB above its noise, so that"
            " signals become zero; raise rx_gain_db or lower adc_full_scale_v"
        )
    if count_mw * 32768**2 < noise_mw:
        return "its noise exceeds the full scale of its converter; lower rx_gain_db or raise adc_full_scale_v"
    return None
