"""Radar presets and antenna tables from radars.toml, one section per preset or board."""

from pathlib import Path
from typing import Any

from mmweaver.core.antenna_tables import AntennaTable, Places, antenna_table
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import Position, RadarConfig
from mmweaver.core.record_values import record_fields
from mmweaver.core.registry import Registry
from mmweaver.core.safe_files.safe_text import read_toml

BAND_77_HZ = (76.0e9, 81.0e9)
BAND_60_HZ = (57.0e9, 64.0e9)
_FILE = read_toml(Path(__file__).with_name("radars.toml"))
_ARRAYS = {name: antenna_table(name, values) for part in ("antennas", "arrays") for name, values in _FILE[part].items()}

ANTENNAS: Registry[AntennaTable] = Registry("antenna table", [(name, _ARRAYS[name]) for name in _FILE["antennas"]])


def halfwave_positions(places: Places, centre_frequency_hz: float) -> tuple[Position, ...]:
    """Converts antenna positions from half wavelengths to metres.

    Args:
        places: (x, z) in half wavelengths.
        centre_frequency_hz: Frequency of that wavelength.

    Returns:
        (x, y, z) in metres, with y = 0.
    """
    half_m = SPEED_OF_LIGHT_MPS / centre_frequency_hz / 2
    return tuple((x * half_m, 0.0, z * half_m) for x, z in places)


def ti_board(name: str, board: AntennaTable, *, spaced_at_hz: float | None = None, **chirp: Any) -> RadarConfig:
    """Builds the radar configuration of a TI board.

    Args:
        name: Name of the radar.
        board: Antenna positions.
        spaced_at_hz: Frequency at which the spacing is half a wavelength. Default: centre of the sampled sweep.
        **chirp: Fields of RadarConfig. Defaults: start at 77 GHz, a frame every 0.1 s, transmitters in numerical order.

    Returns:
        The radar.

    Raises:
        InputError: If the radar is impossible.
    """
    values: dict[str, Any] = {
        "start_frequency_hz": 77.0e9,
        "frame_period_s": 0.1,
        "tx_order": tuple(range(len(board.tx_halfwaves))),
        "frequency_limits_hz": BAND_77_HZ,
        "rx_inverted": board.rx_inverted,
        **dict(board.electrical),
        **chirp,
    }
    sampled_s = values["num_samples"] / values["sample_rate_hz"]
    middle_hz = values["start_frequency_hz"] + values["chirp_slope_hz_per_s"] * (
        values["adc_start_time_s"] + sampled_s / 2
    )
    return RadarConfig(
        name=name,
        tx_position_m=halfwave_positions(board.tx_halfwaves, spaced_at_hz or middle_hz),
        rx_position_m=halfwave_positions(board.rx_halfwaves, spaced_at_hz or middle_hz),
        **values,
    )


def _preset(name: str, values: dict[str, Any]) -> RadarConfig:
    spaced_at_hz, board = values.pop("spaced_at_hz", None), _ARRAYS[values.pop("array")]
    chirp = record_fields(RadarConfig, values, f"preset {name}", partial=True)
    return ti_board(name, board, spaced_at_hz=spaced_at_hz, **chirp)


PRESETS: Registry[RadarConfig] = Registry(
    "radar preset",
    [(name, _preset(name, values)) for name, values in _FILE["presets"].items()],
    entry_points="mmweaver.radars",
)
AWR1843, MMMESH, RF_GENESIS, HUPR = (PRESETS[name] for name in ("awr1843", "mmmesh", "rf_genesis", "hupr"))
IWR6843, IWR6843_ISK, BGT60 = (PRESETS[name] for name in ("iwr6843", "iwr6843isk", "bgt60"))
IWR1443_RADHAR, IWR1443_MARS = PRESETS["iwr1443_radhar"], PRESETS["iwr1443_mars"]
