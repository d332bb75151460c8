"""RadarConfig: the chirp, the array and the frame, and every resolution and limit that follows from them."""

import dataclasses
import json
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mmweaver.core.constants import BOLTZMANN_J_PER_K, NOISE_TEMPERATURE_K, SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_limits import problems
from mmweaver.core.record_values import record_fields
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.shapes import AntennaPositions, PerDoppler, PerRange
from mmweaver.core.transmit_code import TxCode, decoder, separates_transmitters, virtual_tx_m, weights_of

SCHEMA_VERSION = 1
# fields that radar files have only where they differ from the default
RARE_FIELDS = (
    "loop_gap_s",
    "tx_code",
    "lvds_lanes",
    "lvds_iq_order",
    "rx_channels",
    "rx_inverted",
    "frame_words_before",
    "frame_words_after",
)
Position = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class RadarConfig:
    """One MIMO FMCW radar. All lengths in metres, times in seconds, frequencies in hertz.

    Positions are seen from behind the radar: x right, y away from the radar, z up. The transmitters fire in the order
    of `tx_order` (TDM-MIMO); a loop is one chirp of each of them. With a `tx_code` several send in one chirp, and a
    loop is one chirp of each of its rows ("slots"; `core.transmit_code`).
    Radial velocity is positive for a target that moves away. Raises InputError where the radar could not exist.

    Reference: docs/radar_primer.md, equations 1 to 9.
    """

    name: str
    start_frequency_hz: float
    chirp_slope_hz_per_s: float
    idle_time_s: float
    adc_start_time_s: float
    ramp_end_time_s: float
    num_samples: int
    sample_rate_hz: float
    num_loops: int
    frame_period_s: float
    tx_position_m: tuple[Position, ...]
    rx_position_m: tuple[Position, ...]
    tx_order: tuple[int, ...]
    complex_samples: bool = True
    first_range_bin: int = 0
    num_range_bins: int = 64
    tx_power_dbm: float = 12.0
    antenna_gain_dbi: float = 10.5
    noise_figure_db: float = 15.0
    rx_gain_db: float = 30.0
    azimuth_beamwidth_deg: float = 56.0
    elevation_beamwidth_deg: float = 28.0
    adc_full_scale_v: float = 0.5
    frequency_limits_hz: tuple[float, float] = (57.0e9, 81.5e9)
    loop_gap_s: float = 0.0  # pause between the last chirp of a loop and the next loop
    tx_code: TxCode = ()  # (slot, tx) weights of simultaneous transmitters; () = TDM-MIMO in tx_order
    lvds_lanes: int = 2  # of a DCA1000's recording: 2 or 4, see io.dca1000; 0: it cannot have one
    lvds_iq_order: str = "iq"  # which of a sample's parts comes first there, "iq" or "qi"
    rx_channels: tuple[int, ...] = ()  # the receivers' numbers on the board; () = 0, 1, 2 ...
    rx_inverted: tuple[int, ...] = ()  # receivers (indices) whose feed turns the phase by 180 degrees
    frame_words_before: int = 0  # int16 words of other sub-frames in each frame of a recording, before this one
    frame_words_after: int = 0

    def __post_init__(self) -> None:
        for text in problems(self):
            raise InputError(f"radar {self.name!r} is impossible: {text}")

    # counts -----------------------------------------------------------------------------------------------------
    @property
    def num_tx(self) -> int:
        return len(self.tx_position_m)

    @property
    def num_rx(self) -> int:
        return len(self.rx_position_m)

    @property
    def is_coded(self) -> bool:
        """Whether several transmitters send in one chirp."""
        return bool(self.tx_code)

    @property
    def num_slots(self) -> int:
        """Chirps of a loop, the second axis of its ADC samples: physical transmitters, or rows of the code."""
        return len(self.tx_code) or self.num_tx

    @cached_property
    def tx_decoder(self) -> np.ndarray:
        """Matrix (virtual tx, slot) from the slots of a coded radar to its transmitters or beams. Raises InputError."""
        return decoder(weights_of(self.tx_code)) if self.is_coded else np.eye(self.num_tx)

    @property
    def num_virtual_tx(self) -> int:
        """Transmitters that can be separated: all, or the beams of a coded radar."""
        return len(self.tx_decoder)

    @property
    def num_antennas(self) -> int:
        """Number of virtual antennas; antenna index = tx * num_rx + rx, where tx is the (virtual) transmitter."""
        return self.num_virtual_tx * self.num_rx

    @property
    def num_unambiguous_range_bins(self) -> int:
        return self.num_samples if self.complex_samples else self.num_samples // 2

    # frequency and range ----------------------------------------------------------------------------------------
    @property
    def bandwidth_hz(self) -> float:
        """Bandwidth of the part of the sweep that the ADC samples."""
        return self.chirp_slope_hz_per_s * self.num_samples / self.sample_rate_hz

    @property
    def centre_frequency_hz(self) -> float:
        """Frequency at the middle of the sampled part of the sweep."""
        return self.start_frequency_hz + self.chirp_slope_hz_per_s * self.adc_start_time_s + self.bandwidth_hz / 2

    @property
    def wavelength_m(self) -> float:
        return SPEED_OF_LIGHT_MPS / self.centre_frequency_hz

    @property
    def range_resolution_m(self) -> float:
        return SPEED_OF_LIGHT_MPS / (2 * self.bandwidth_hz)

    @property
    def max_range_m(self) -> float:
        """End of the unambiguous range axis; beyond it range aliases."""
        return self.range_resolution_m * self.num_unambiguous_range_bins

    @property
    def farthest_bin_m(self) -> float:
        """Range of the last unambiguous bin: what a window can reach."""
        return self.max_range_m - self.range_resolution_m

    @cached_property
    def range_m(self) -> PerRange:
        """Range of each kept bin in metres, (range,)."""
        return (self.first_range_bin + np.arange(self.num_range_bins)) * self.range_resolution_m

    # time and velocity ------------------------------------------------------------------------------------------
    @property
    def chirp_period_s(self) -> float:
        return self.idle_time_s + self.ramp_end_time_s

    @property
    def loop_period_s(self) -> float:
        return self.num_slots * self.chirp_period_s + self.loop_gap_s

    @property
    def active_time_s(self) -> float:
        """Duration of all chirps of one frame."""
        return self.num_loops * self.loop_period_s

    @property
    def max_velocity_mps(self) -> float:
        """Radial velocity beyond which Doppler aliases."""
        return self.wavelength_m / (4 * self.loop_period_s)

    @property
    def velocity_resolution_mps(self) -> float:
        return self.wavelength_m / (2 * self.active_time_s)

    @cached_property
    def radial_velocity_mps(self) -> PerDoppler:
        """Radial velocity of each Doppler bin in m/s, (doppler,), ascending; bin num_loops // 2 is zero."""
        return (np.arange(self.num_loops) - self.num_loops // 2) * self.velocity_resolution_mps

    @cached_property
    def tx_delay_s(self) -> np.ndarray:
        """Time within a loop at which each physical transmitter fires, (tx,), the first at 0; of a code, each slot."""
        if self.is_coded:
            return np.arange(self.num_slots) * self.chirp_period_s
        slot = np.argsort(np.asarray(self.tx_order))
        return slot * self.chirp_period_s

    @cached_property
    def antenna_delay_s(self) -> np.ndarray:
        """Time within a loop at which each virtual antenna is measured, (antenna,); decoded from all slots: 0."""
        if self.is_coded and separates_transmitters(weights_of(self.tx_code)):
            return np.zeros(self.num_antennas)
        return np.repeat(self.tx_delay_s, self.num_rx)

    @property
    def tx_noise_gain(self) -> np.ndarray:
        """Power of the noise of each (virtual) transmitter's signal relative to that of a sample, (tx,); TDM: 1."""
        return (np.abs(self.tx_decoder) ** 2).sum(axis=1)

    # array ------------------------------------------------------------------------------------------------------
    @cached_property
    def virtual_tx_position_m(self) -> np.ndarray:
        """Positions (tx, 3) of the transmitters, or of the beams' phase centres, in metres."""
        tx = np.asarray(self.tx_position_m)
        return virtual_tx_m(weights_of(self.tx_code), tx) if self.is_coded else tx

    @cached_property
    def antenna_position_m(self) -> AntennaPositions:
        """Virtual antennas in metres, (antenna, 3): tx + rx. A far target in direction u has the phase
        -2 pi / wavelength (u . p)."""
        tx, rx = self.virtual_tx_position_m, np.asarray(self.rx_position_m)
        return (tx[:, None, :] + rx[None, :, :]).reshape(-1, 3)

    # noise ------------------------------------------------------------------------------------------------------
    @property
    def noise_power_mw(self) -> float:
        """Thermal noise of one ADC sample, in mW at the receiver's port."""
        power_w = BOLTZMANN_J_PER_K * NOISE_TEMPERATURE_K * self.sample_rate_hz
        return power_w * 1e3 * 10 ** (self.noise_figure_db / 10)

    @property
    def adc_count_sqrt_mw(self) -> float:
        """Amplitude at the receiver's port, in sqrt(mW), of one count of the 16-bit converter (50 ohm)."""
        full_scale_mw = self.adc_full_scale_v**2 / (2 * 50) * 1e3
        return math.sqrt(full_scale_mw / 10 ** (self.rx_gain_db / 10)) / 32768

    # files ------------------------------------------------------------------------------------------------------
    def to_json(self) -> str:
        """JSON in SI units; `from_json` restores the same RadarConfig."""
        return json.dumps(self.to_values(), indent=2) + "\n"

    def to_values(self) -> dict[str, Any]:
        """The content of the JSON: numbers, texts and lists; rare fields only where they are not the default."""
        values = {"schema_version": SCHEMA_VERSION, **dataclasses.asdict(self)}
        for field in dataclasses.fields(self):
            if field.name in RARE_FIELDS and values[field.name] == field.default:
                del values[field.name]
        return {name: _as_list(value) for name, value in values.items()}

    @property
    def notes(self) -> tuple[str, ...]:
        """What is unusual about this radar, in sentences for people."""
        end_hz = self.start_frequency_hz + self.chirp_slope_hz_per_s * self.ramp_end_time_s
        over_hz = end_hz - self.frequency_limits_hz[1]
        if over_hz <= 1e3:
            return ()
        return (
            f"the ramp ends {over_hz / 1e6:.0f} MHz past {self.frequency_limits_hz[1] / 1e9:g} GHz; boards run this,"
            " but the band's end is not specified",
        )

    @classmethod
    def from_json(cls, text: str) -> "RadarConfig":
        """Reads the JSON of `to_json`. Raises InputError for anything else; an unknown key is an error."""
        return cls.from_values(parse_json(text, "the radar file"))

    @classmethod
    def from_values(cls, values: Any) -> "RadarConfig":
        """The radar of `to_values`. Raises InputError for anything else."""
        if not isinstance(values, dict):
            raise InputError(
                "the radar file holds no object; make one with: mmweaver radar awr1843 --json > radar.json"
            )
        values = dict(values)
        version = values.pop("schema_version", None)
        if version != SCHEMA_VERSION:
            raise InputError(f"the radar file has schema_version {version!r}; this version reads {SCHEMA_VERSION}")
        return cls(**record_fields(cls, values, "the radar file"))


def _as_list(value: Any) -> Any:
    return [_as_list(item) for item in value] if isinstance(value, tuple) else value
