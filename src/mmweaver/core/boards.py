"""Boards by name: ideal, from a file, or typical, i.e. sampled from the spread measured in recordings.

docs/board.md documents the source of each figure.

Radar presets and antenna tables from radars.toml, one section per preset or board.
"""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board, read_board
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import Position, RadarConfig
from mmweaver.core.record_values import record_fields
from mmweaver.core.registry import Registry
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.core.seeding import stream
from mmweaver.core.virtual_array import AntennaTable, Places, antenna_table

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


IDEAL_BOARD = Board()
MAX_NUMBER = 2**31 - 1
MAX_BAND_HZ = 10e9  # a wider band is not that of a single board
# spread between boards: lowest and highest, unless a standard deviation is stated
IF_END_DB, IF_NEAR_DB = (-9.0, -4.5), (-5.0, -1.0)  # of power: last 5 % of the band, range bins 2 to 6
NEAR_SHAPE = ((0, 1.0), (2, 1.0), (6, 0.95), (10, 0.6), (16, 0.35), (30, 0.0))  # range bin, share of IF_NEAR_DB
END_SHAPE = ((0.89, 0.0), (0.905, -1.0), (0.92, -3.0), (0.935, -6.0), (0.955, -9.3))  # share of the band, dB
GAIN_DB = (-8.0, -4.0)  # losses: echo SNR relative to the link budget
CHANNEL_GAIN_DB, CHANNEL_PHASE_DEG = 0.4, (4.0, 14.0)  # standard deviations per transmitter and per receiver
LEAKAGE_OVER_NOISE_DB = (33.0, 41.0)  # in the range bin of one chirp; 2 dB more including the skirt
LEAKAGE_PAIRS_DB = 4.5  # standard deviation over pairs: 10 to 20 dB between the weakest and strongest of 12
SKIRT_END_M = (0.4, 1.5)  # range at which the skirt reaches the noise floor of a range-Doppler cell
# real-valued samples (one board), including the ADC's DC offset
REAL_LEAKAGE_OVER_NOISE_DB, REAL_SKIRT_END_M = (50.0, 58.0), (0.15, 0.3)
ELEVATION_PHASE_DEG = (4.0, 12.0)
RANGE_BIAS_M = (0.0, 0.10)
FIRST_CHIRP_PERCENT, FIRST_CHIRP_MRAD = (0.3, 0.7), (1.0, 3.0)
DRIFT_PPM = (0.3, 0.9)


def find_board(name: str | Path | Board, config: RadarConfig, seed: int = 0) -> Board:
    """Resolves a board by name.

    Args:
        name: "ideal", "typical" (sampled with `seed`), "typical:N", path of a board.json, or a Board.
        config: The radar to which it belongs.
        seed: Seed of "typical".

    Returns:
        The board.

    Raises:
        InputError: If the name is unknown, the file is not a board, or the board does not fit the radar.
    """
    if isinstance(name, Board):
        board = name
    elif name == "ideal":
        board = IDEAL_BOARD
    elif isinstance(name, str) and (name == "typical" or name.startswith("typical:")):
        board = typical_board(config, _number(name, seed))
    elif Path(name).suffix.lower() == ".json" or Path(name).is_file():
        board = read_board(name)
    else:
        raise InputError(f"unknown board {str(name)[:100]!r}; known: typical, typical:N, ideal, or a board.json")
    board.check_fits(config)
    return board


def compensated(board: Board) -> Board:
    """Removes the errors that a radar's own calibration corrects: channel imbalance, coupling and range bias.

    Args:
        board: The board.

    Returns:
        A copy without these errors.
    """
    none = np.zeros(0)
    return replace(
        board,
        channel_gain_db=none,
        channel_phase_deg=none,
        coupling_real=none,
        coupling_imag=none,
        elevation_phase_deg=0.0,
        range_bias_m=0.0,
    )


def _number(name: str, seed: int) -> int:
    _, colon, digits = name.partition(":")
    if not colon:
        return seed % (MAX_NUMBER + 1)
    if not (digits.isascii() and digits.isdecimal() and len(digits) <= 10 and int(digits) <= MAX_NUMBER):
        raise InputError(f"boards are typical:0 to typical:{MAX_NUMBER}, not {name[:100]!r}")
    return int(digits)


@lru_cache(maxsize=16)
def typical_board(config: RadarConfig, number: int) -> Board:
    """Samples a board from the spread of hardware errors measured on several boards (docs/board.md).

    Args:
        config: The radar.
        number: Number of the board; equal numbers give equal boards.

    Returns:
        The board.
    """
    rng = stream(number, "typical board")

    def between(limits: tuple[float, float]) -> float:
        return float(rng.uniform(*limits))

    tx, rx = config.num_tx, config.num_rx
    if_share, if_gain_db = _filters(config, between(IF_NEAR_DB), between(IF_END_DB))
    gain_db = rng.normal(0, CHANNEL_GAIN_DB, (tx, 1)) + rng.normal(0, CHANNEL_GAIN_DB, (1, rx))
    phase_deg = between(CHANNEL_PHASE_DEG) * (rng.normal(size=(tx, 1)) + rng.normal(size=(1, rx)))
    sign = 1 if rng.random() < 0.5 else -1
    starts = float(config.complex_samples)  # real-valued samples (one board): no first-chirp error, no loss
    level_db, end_m = LEAKAGE_OVER_NOISE_DB, SKIRT_END_M
    if not config.complex_samples:
        level_db, end_m = REAL_LEAKAGE_OVER_NOISE_DB, REAL_SKIRT_END_M
    leakage = _leakage(config, rng, between(level_db), between(end_m))
    return Board(
        name=f"typical:{number}",
        made_from="the spread of recorded boards, docs/board.md",
        if_share=if_share,
        if_gain_db=if_gain_db,
        if_phase_deg=np.zeros(len(if_share)),
        channel_gain_db=gain_db,
        channel_phase_deg=phase_deg,
        leakage_range_m=leakage[0],
        leakage_level_db=leakage[1],
        leakage_phase_deg=leakage[2],
        elevation_phase_deg=sign * between(ELEVATION_PHASE_DEG),
        range_bias_m=between(RANGE_BIAS_M),
        first_chirp_amplitude_percent=starts * between(FIRST_CHIRP_PERCENT),
        first_chirp_phase_mrad=starts * between(FIRST_CHIRP_MRAD),
        drift_ppm=between(DRIFT_PPM),
        gain_db=starts * float(stream(number, "typical board", "gain").uniform(*GAIN_DB)),
        element_spacing_m=_spacing_m(config),
    )


def _spacing_m(config: RadarConfig) -> float | None:
    """Half a wavelength at the centre of the board's band, if the radar states one."""
    low_hz, high_hz = config.frequency_limits_hz
    return SPEED_OF_LIGHT_MPS / (low_hz + high_hz) if high_hz - low_hz < MAX_BAND_HZ else None


def _filters(config: RadarConfig, near_db: float, end_db: float) -> tuple[np.ndarray, np.ndarray]:
    """IF high-pass near range 0 and low-pass at the band edge: IF frequency / sample rate, and gain in dB.

    Shapes as measured on two boards: the low-pass falls to -9 dB at 95 % of the band, where aliasing sets in.
    Real-valued samples (one board) show neither, only a slow roll-off.
    """
    if not config.complex_samples:
        return np.array([0.0, 0.25, 0.5]), np.array([0.0, 0.0, 0.3 * end_db])
    near, end = NEAR_SHAPE, END_SHAPE
    low = np.minimum(np.array([at for at, _ in near]) / config.num_samples, 0.5)
    share = np.concatenate([low, [at for at, _ in end], [0.975, 0.99, 1.0]])
    gain_db = [times * near_db for _, times in near] + [gain for _, gain in end] + [end_db, end_db + 2, end_db + 2]
    rising = np.concatenate([[True], np.diff(share) > 0])
    return share[rising], np.array(gain_db)[rising]


def _leakage(
    config: RadarConfig, rng: np.random.Generator, level_db: float, end_m: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ranges (tap,), levels (tap, tx, rx) in dB relative to the transmitted power, and phases in degrees.

    The skirt falls exponentially and reaches the noise floor of a range-Doppler cell at `end_m`.
    """
    step_m = config.range_resolution_m
    taps = np.arange(max(1, min(40, round(end_m / step_m)))) * step_m
    a_chirp_dbm = 10 * np.log10(config.noise_power_mw * 1.5 / config.num_samples)
    whole_frame_db = 10 * np.log10(max(config.num_loops / 1.5, 1.0))
    fall_db = (level_db + whole_frame_db) * taps / max(end_m, step_m)
    shape = (len(taps), config.num_tx, config.num_rx)
    pairs_db = rng.normal(0, LEAKAGE_PAIRS_DB, shape[1:])
    pairs_db -= 10 * np.log10((10 ** (pairs_db / 10)).mean())
    levels = a_chirp_dbm - config.tx_power_dbm + level_db - fall_db[:, None, None] + pairs_db
    levels = levels + np.where(taps > 0, -6.0, 0.0)[:, None, None]  # the skirt consists of separate reflections
    return taps, levels, rng.uniform(-180, 180, shape)
