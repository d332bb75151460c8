"""Board: hardware errors of one radar board that affect every signal, and its file, board.json.

docs/board.md lists fields, units and where each enters the signal chain. The defaults describe an ideal board.

Channel calibration as applied by a board's firmware: one complex factor per antenna pair, and a range bias.
"""

import dataclasses
import functools
import hashlib
import json
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.record_values import record_fields
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.safe_text import MEGABYTE, parse_json, read_text


@dataclass(frozen=True, kw_only=True)
class ChannelCalibration:
    """Factors by which the firmware multiplies recorded samples, and the range bias of the board.

    Attributes:
        factors: Complex factors, (tx, rx).
        range_bias_m: Measured minus true range in metres.
        turns_receivers: Whether the factors also correct receivers with inverted feed (`rx_inverted`), which samples in
            an `AdcCube` already have corrected. Default: False.
    """

    factors: np.ndarray
    range_bias_m: float
    turns_receivers: bool = False

    def compensated(self, adc: AdcCube) -> AdcCube:
        """Corrects recorded samples as the firmware does.

        Args:
            adc: Recorded samples.

        Returns:
            Samples without channel errors and range bias.
        """
        return self._applied(adc, self.factors, -self.range_bias_m)

    def recorded(self, adc: AdcCube) -> AdcCube:
        """Applies the board's errors to ideal samples; inverse of `compensated`.

        Args:
            adc: Ideal samples.

        Returns:
            Samples as this board would record them.
        """
        return self._applied(adc, 1 / self.factors, self.range_bias_m)

    def _applied(self, adc: AdcCube, factors: np.ndarray, farther_m: float) -> AdcCube:
        config = adc.config
        beat_hz = 2 * config.chirp_slope_hz_per_s * farther_m / SPEED_OF_LIGHT_MPS
        turn = np.exp(2j * np.pi * beat_hz * np.arange(config.num_samples) / config.sample_rate_hz)
        if self.turns_receivers and config.rx_inverted:
            factors = factors.copy()
            factors[:, list(config.rx_inverted)] *= -1
        samples = adc.samples * (factors[:, :, None] * turn).astype(np.complex64)
        return replace(adc, samples=samples)


BOARD_VERSION = 1
MAX_BYTES = 4 * MEGABYTE
MAX_TAPS, MAX_ANTENNAS, MAX_SHARES = 256, 256, 4096
# largest magnitude of each number; anything beyond is a mistake
LIMITS = {
    "if_gain_db": 120.0,
    "if_phase_deg": 36e3,
    "channel_gain_db": 60.0,
    "channel_phase_deg": 720.0,
    "coupling_real": 10.0,
    "coupling_imag": 10.0,
    "leakage_range_m": 20.0,
    "leakage_level_db": 300.0,
    "leakage_phase_deg": 720.0,
    "elevation_phase_deg": 360.0,
    "range_bias_m": 2.0,
    "gain_db": 100.0,
    "first_chirp_amplitude_percent": 50.0,
    "first_chirp_phase_mrad": 3200.0,
    "drift_ppm": 100.0,
    "noise_figure_db": 100.0,
    "iq_gain_db": 20.0,
    "iq_phase_deg": 90.0,
    "phase_noise_dbc_per_hz": 200.0,
    "element_spacing_m": 1.0,
    "cfar_threshold": 65535.0,
}
SAME_SHAPE = (
    ("if_share", "if_gain_db", "if_phase_deg"),
    ("channel_gain_db", "channel_phase_deg"),
    ("coupling_real", "coupling_imag"),
    ("leakage_level_db", "leakage_phase_deg"),
)
_none = functools.partial(np.zeros, 0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Board:
    """Hardware errors of one board: IF response, channel imbalance, coupling, TX-RX leakage, drift, gain and noise.

    An empty array means that the error is absent. Tables of antenna pairs are (tx, rx) in the radar's order; a virtual
    antenna has index tx * num_rx + rx.

    Raises:
        InputError: If a number exceeds `LIMITS` or tables do not match each other.
    """

    name: str = "ideal"
    made_from: str = ""  # description of the recordings
    notes: tuple[str, ...] = ()  # parameters that the recordings do not determine, and why
    if_share: np.ndarray = field(default_factory=_none)  # (point,) IF frequency / sample rate, increasing, 0 to 1
    if_gain_db: np.ndarray = field(default_factory=_none)  # (point,) applies to echoes and noise
    if_phase_deg: np.ndarray = field(default_factory=_none)  # (point,)
    channel_gain_db: np.ndarray = field(default_factory=_none)  # (tx, rx)
    channel_phase_deg: np.ndarray = field(default_factory=_none)  # (tx, rx)
    coupling_real: np.ndarray = field(default_factory=_none)  # (antenna, antenna): recorded = coupling @ uncoupled
    coupling_imag: np.ndarray = field(default_factory=_none)
    leakage_range_m: np.ndarray = field(default_factory=_none)  # (tap,) apparent range
    leakage_level_db: np.ndarray = field(default_factory=_none)  # (tap, tx, rx) received / transmitted power
    leakage_phase_deg: np.ndarray = field(default_factory=_none)  # (tap, tx, rx)
    elevation_phase_deg: float = 0.0  # phase offset of transmitters outside the first one's row
    range_bias_m: float = 0.0  # measured minus true range
    first_chirp_amplitude_percent: float = 0.0  # excess amplitude of the first chirp of each frame
    first_chirp_phase_mrad: float = 0.0
    drift_ppm: float = 0.0  # relative carrier frequency error, rms over time
    gain_db: float = 0.0  # echo gain relative to the link budget of the radar
    noise_figure_db: float | None = None  # None keeps the radar's
    iq_gain_db: float = 0.0  # gain of Q over I of complex samples
    iq_phase_deg: float = 0.0  # by which Q is more than 90 degrees behind I
    phase_noise_dbc_per_hz: float | None = None  # at 1 MHz; correlated over range, as it is common to all echoes
    element_spacing_m: float | None = None  # true spacing of antennas half a wavelength apart; None keeps the radar's
    cfar_threshold: float | None = None  # range CFAR of TI's demo, in its counts; None keeps the settings'

    def __post_init__(self) -> None:
        self._check_sizes()
        self._check_shapes()

    def _check_sizes(self) -> None:
        """Checks all numbers against `LIMITS` and rounds tables to the precision of board.json."""
        for each in dataclasses.fields(self):
            value = getattr(self, each.name)
            if each.name in LIMITS and value is not None:
                array = np.asarray(value, float)
                if array.size and not (np.abs(array) <= LIMITS[each.name]).all():
                    raise self._impossible(f"{each.name} must be within {LIMITS[each.name]:g}")
                if isinstance(value, np.ndarray):
                    object.__setattr__(self, each.name, np.round(array, 6))

    def _check_shapes(self) -> None:
        """Checks that the shapes of related tables agree."""
        share, taps = self.if_share, self.leakage_range_m
        for names in SAME_SHAPE:
            if len({getattr(self, name).shape for name in names}) > 1:
                raise self._impossible(f"{', '.join(names[:-1])} and {names[-1]} must have one shape")
        if share.ndim != 1 or len(share) > MAX_SHARES or not ((share >= 0) & (share <= 1)).all():
            raise self._impossible(f"if_share must be a list of at most {MAX_SHARES} numbers from 0 to 1")
        if (np.diff(share) <= 0).any():
            raise self._impossible("if_share must rise")
        if taps.ndim != 1 or len(taps) > MAX_TAPS or (taps < 0).any():
            raise self._impossible(f"leakage_range_m must be a list of at most {MAX_TAPS} ranges from 0 on")
        if len(taps) != len(self.leakage_level_db) or (len(taps) and self.leakage_level_db.ndim != 3):
            raise self._impossible("leakage_level_db must be a list of (tx, rx) tables, one per leakage_range_m")
        for name in ("element_spacing_m", "cfar_threshold"):
            if (getattr(self, name) or 1.0) <= 0:
                raise self._impossible(f"{name} must be above 0")
        _ = self.pairs

    def _impossible(self, why: str) -> InputError:
        return InputError(f"board {self.name!r} is impossible: {why}")

    @property
    def pairs(self) -> tuple[int, int] | None:
        """Number of transmitters and receivers of the tables, (tx, rx); None without tables.

        Raises:
            InputError: If the tables disagree.
        """
        found = {table.shape[-2:] for table in (self.channel_gain_db, self.leakage_level_db) if table.size}
        if len(found) > 1 or any(len(shape) != 2 for shape in found):
            raise self._impossible("channel_gain_db and leakage_level_db must be tables of the same (tx, rx)")
        pairs = next(iter(found), None)
        if self.coupling_real.size:
            rows, *columns = self.coupling_real.shape
            if columns != [rows] or rows > MAX_ANTENNAS or (pairs is not None and rows != pairs[0] * pairs[1]):
                raise self._impossible("coupling_real must be a square table of all antennas")
        return pairs

    @cached_property
    def is_ideal(self) -> bool:
        """Whether the board leaves every signal unchanged."""
        return set(self.to_values()) <= {"board_version", "name", "made_from", "notes"}

    def check_fits(self, config: RadarConfig) -> None:
        """Checks that the tables match a radar's antennas.

        Args:
            config: The radar.

        Raises:
            InputError: If the number of transmitters, receivers or antennas differs.
        """
        pairs, antennas = self.pairs, len(self.coupling_real)
        own = config.num_tx, config.num_rx
        if pairs is not None and pairs != own:
            raise InputError(
                f"board {self.name!r} has {pairs[0]} x {pairs[1]} antenna pairs, radar {config.name!r} {own[0]} x"
                f" {own[1]}; take the board of this radar (mmweaver calibrate)"
            )
        if antennas and antennas != own[0] * own[1]:
            raise InputError(
                f"board {self.name!r} couples {antennas} antennas, radar {config.name!r} has {own[0] * own[1]}"
            )

    # files ----------------------------------------------------------------------------------------------------------
    def to_values(self) -> dict[str, Any]:
        """Fields that differ from their default, as plain JSON values, with the schema version."""
        values: dict[str, Any] = {"board_version": BOARD_VERSION}
        ideal = Board()
        for each in dataclasses.fields(self):
            value = getattr(self, each.name)
            if isinstance(value, np.ndarray):
                if value.size:
                    values[each.name] = value.tolist()
            elif each.name == "name" or value != getattr(ideal, each.name):
                values[each.name] = list(value) if isinstance(value, tuple) else value
        return values

    def to_json(self) -> str:
        """Serialises the board as JSON, one line per field; `from_json` restores an equal Board."""
        lines = [f"  {json.dumps(name)}: {json.dumps(value)}" for name, value in self.to_values().items()]
        return "{\n" + ",\n".join(lines) + "\n}\n"

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the content, hexadecimal; equal boards have equal digests."""
        return hashlib.sha256(self.to_json().encode()).hexdigest()

    def meta(self) -> dict[str, Any]:
        """Entry for meta.json: name and scalar fields; the tables are in board.json."""
        tables = {each.name for each in dataclasses.fields(self) if isinstance(getattr(self, each.name), np.ndarray)}
        return {name: value for name, value in self.to_values().items() if name not in tables}

    @classmethod
    def from_json(cls, text: str, place: str = "the board file") -> "Board":
        """Parses the output of `to_json`.

        Args:
            text: JSON text.
            place: Name of the source for error messages.

        Returns:
            The board.

        Raises:
            InputError: If the text is not a board file, has another version, or contains an unknown key.
        """
        values = parse_json(text, place)
        if not isinstance(values, dict) or "board_version" not in values:
            raise InputError(f"{place} is no board file (it has no board_version); mmweaver calibrate makes one")
        version = values.pop("board_version")
        if version != BOARD_VERSION:
            raise InputError(f"{place} has board_version {version!r}; this version reads {BOARD_VERSION}")
        return cls(**record_fields(cls, values, place))

    def save(self, path: Path) -> None:
        """Writes board.json atomically.

        Args:
            path: The file.

        Raises:
            InputError: If it cannot be written.
        """
        with atomic_file(path) as partial:
            partial.write_text(self.to_json(), encoding="utf-8")


def read_board(path: Path | str) -> Board:
    """Reads a board.json.

    Args:
        path: The file, at most 4 MB.

    Returns:
        The board.

    Raises:
        InputError: If the file is missing, unreadable or not a board.
    """
    return Board.from_json(read_text(path, max_bytes=MAX_BYTES), str(path))
