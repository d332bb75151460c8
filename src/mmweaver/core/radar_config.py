"""RadarConfig: chirp, array and frame, with the resolutions and limits that follow from them."""

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
# fields that radar files contain only if they differ from the default
RARE_FIELDS = (
    "loop_gap_s",
    "tx_code",
    "lvds_lanes",
    "lvds_iq_order",
    "rx_channels",
    "rx_inverted",
    "antenna_pattern",
    "frame_words_before",
    "frame_words_after",
)
Position = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class RadarConfig:
    """Configuration of one FMCW MIMO radar. Lengths in metres, times in seconds, frequencies in hertz.

    Positions are seen from behind the radar: x right, y away from the radar, z up. In TDM-MIMO the transmitters fire in
    the order of `tx_order`, and a loop is one chirp per transmitter. With a `tx_code` several transmitters are active
    in one chirp, and a loop is one chirp per row of the code ("slot"; `core.transmit_code`). Radial velocity is
    positive for receding targets.

    Reference: docs/radar_primer.md, equations 1 to 9.

    Raises:
        InputError: If the radar is impossible; the message states the first problem.
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
    # rows of azimuth and elevation in degrees and gain in dB, a grid or two cuts; () = falls with the beamwidths
    antenna_pattern: tuple[tuple[float, float, float], ...] = ()
    adc_full_scale_v: float = 0.5
    frequency_limits_hz: tuple[float, float] = (57.0e9, 81.5e9)
    loop_gap_s: float = 0.0  # pause between the last chirp of a loop and the next loop
    tx_code: TxCode = ()  # (slot, tx) weights of simultaneous transmitters; () = TDM-MIMO in tx_order
    lvds_lanes: int = 2  # LVDS lanes of a DCA1000 recording: 2 or 4, see io.dca1000; 0 = not supported
    lvds_iq_order: str = "iq"  # order of I and Q in a DCA1000 recording, "iq" or "qi"
    rx_channels: tuple[int, ...] = ()  # receiver numbers on the board; () = 0, 1, 2 ...
    rx_inverted: tuple[int, ...] = ()  # indices of receivers whose feed shifts the phase by 180 degrees
    frame_words_before: int = 0  # int16 words of other sub-frames that precede this one in each recorded frame
    frame_words_after: int = 0

    def __post_init__(self) -> None:
        for text in problems(self):
            raise InputError(f"radar {self.name!r} is impossible: {text}")

    # counts -----------------------------------------------------------------------------------------------------
    @property
    def num_tx(self) -> int:
        """Number of physical transmitters."""
        return len(self.tx_position_m)

    @property
    def num_rx(self) -> int:
        """Number of receivers."""
        return len(self.rx_position_m)

    @property
    def is_coded(self) -> bool:
        """Whether several transmitters are active in one chirp."""
        return bool(self.tx_code)

    @property
    def num_slots(self) -> int:
        """Chirps per loop, the third axis of ADC samples: physical transmitters in TDM-MIMO, or rows of the code."""
        return len(self.tx_code) or self.num_tx

    @cached_property
    def tx_decoder(self) -> np.ndarray:
        """Decoding matrix (virtual tx, slot) from slots to transmitters or beams; identity for TDM-MIMO.

        Raises:
            InputError: If the code cannot be decoded.
        """
        return decoder(weights_of(self.tx_code)) if self.is_coded else np.eye(self.num_tx)

    @property
    def num_virtual_tx(self) -> int:
        """Number of separable transmitters, or of beams of a coded radar."""
        return len(self.tx_decoder)

    @property
    def num_antennas(self) -> int:
        """Number of virtual antennas; index = tx * num_rx + rx, with the (virtual) transmitter tx."""
        return self.num_virtual_tx * self.num_rx

    @property
    def num_unambiguous_range_bins(self) -> int:
        """Range bins of the FFT: num_samples for complex sampling, half of that for real sampling."""
        return self.num_samples if self.complex_samples else self.num_samples // 2

    # frequency and range ----------------------------------------------------------------------------------------
    @property
    def bandwidth_hz(self) -> float:
        """Sweep bandwidth during the ADC sampling window."""
        return self.chirp_slope_hz_per_s * self.num_samples / self.sample_rate_hz

    @property
    def centre_frequency_hz(self) -> float:
        """Frequency at the centre of the ADC sampling window."""
        return self.start_frequency_hz + self.chirp_slope_hz_per_s * self.adc_start_time_s + self.bandwidth_hz / 2

    @property
    def wavelength_m(self) -> float:
        """Wavelength at the centre frequency."""
        return SPEED_OF_LIGHT_MPS / self.centre_frequency_hz

    @property
    def range_resolution_m(self) -> float:
        """Range resolution, c / (2 B), which is also the spacing of range bins."""
        return SPEED_OF_LIGHT_MPS / (2 * self.bandwidth_hz)

    @property
    def max_range_m(self) -> float:
        """Unambiguous range; targets beyond it alias."""
        return self.range_resolution_m * self.num_unambiguous_range_bins

    @property
    def farthest_bin_m(self) -> float:
        """Range of the last unambiguous bin, the largest far end of a range window."""
        return self.max_range_m - self.range_resolution_m

    @cached_property
    def range_m(self) -> PerRange:
        """Range of each kept bin in metres, (range,)."""
        return (self.first_range_bin + np.arange(self.num_range_bins)) * self.range_resolution_m

    # time and velocity ------------------------------------------------------------------------------------------
    @property
    def chirp_period_s(self) -> float:
        """Time from chirp to chirp: idle time plus ramp."""
        return self.idle_time_s + self.ramp_end_time_s

    @property
    def loop_period_s(self) -> float:
        """Time from loop to loop, the pulse repetition interval of one transmitter."""
        return self.num_slots * self.chirp_period_s + self.loop_gap_s

    @property
    def active_time_s(self) -> float:
        """Duration of all loops of one frame."""
        return self.num_loops * self.loop_period_s

    @property
    def max_velocity_mps(self) -> float:
        """Unambiguous radial velocity, +-wavelength / (4 loop periods); faster targets alias in Doppler."""
        return self.wavelength_m / (4 * self.loop_period_s)

    @property
    def velocity_resolution_mps(self) -> float:
        """Velocity resolution, wavelength / (2 active time), which is also the spacing of Doppler bins."""
        return self.wavelength_m / (2 * self.active_time_s)

    @cached_property
    def radial_velocity_mps(self) -> PerDoppler:
        """Radial velocity of each Doppler bin in m/s, (doppler,), ascending; zero at bin num_loops // 2."""
        return (np.arange(self.num_loops) - self.num_loops // 2) * self.velocity_resolution_mps

    @cached_property
    def tx_delay_s(self) -> np.ndarray:
        """Firing time of each physical transmitter within a loop, (tx,); with a code, start of each slot."""
        if self.is_coded:
            return np.arange(self.num_slots) * self.chirp_period_s
        slot = np.argsort(np.asarray(self.tx_order))
        return slot * self.chirp_period_s

    @cached_property
    def antenna_delay_s(self) -> np.ndarray:
        """Time within a loop at which each virtual antenna is sampled, (antenna,); 0 if decoded from all slots."""
        if self.is_coded and separates_transmitters(weights_of(self.tx_code)):
            return np.zeros(self.num_antennas)
        return np.repeat(self.tx_delay_s, self.num_rx)

    @property
    def tx_noise_gain(self) -> np.ndarray:
        """Noise power of each (virtual) transmitter relative to one ADC sample, (tx,); 1 for TDM-MIMO."""
        return (np.abs(self.tx_decoder) ** 2).sum(axis=1)

    # array ------------------------------------------------------------------------------------------------------
    @cached_property
    def virtual_tx_position_m(self) -> np.ndarray:
        """Positions of the transmitters, or of the phase centres of beams, in metres, (tx, 3)."""
        tx = np.asarray(self.tx_position_m)
        return virtual_tx_m(weights_of(self.tx_code), tx) if self.is_coded else tx

    @cached_property
    def antenna_position_m(self) -> AntennaPositions:
        """Virtual antenna positions p = tx + rx in metres, (antenna, 3).

        The phase of a far target in direction u is -2 pi / wavelength (u . p).
        """
        tx, rx = self.virtual_tx_position_m, np.asarray(self.rx_position_m)
        return (tx[:, None, :] + rx[None, :, :]).reshape(-1, 3)

    # noise ------------------------------------------------------------------------------------------------------
    @property
    def noise_power_mw(self) -> float:
        """Thermal noise power of one ADC sample in mW, referred to the receiver input."""
        power_w = BOLTZMANN_J_PER_K * NOISE_TEMPERATURE_K * self.sample_rate_hz
        return power_w * 1e3 * 10 ** (self.noise_figure_db / 10)

    @property
    def adc_count_sqrt_mw(self) -> float:
        """Amplitude of one count of the 16-bit ADC in sqrt(mW), referred to the receiver input (50 ohm)."""
        full_scale_mw = self.adc_full_scale_v**2 / (2 * 50) * 1e3
        return math.sqrt(full_scale_mw / 10 ** (self.rx_gain_db / 10)) / 32768

    # files ------------------------------------------------------------------------------------------------------
    def to_json(self) -> str:
        """Serialises the radar as JSON in SI units; `from_json` restores an equal RadarConfig."""
        return json.dumps(self.to_values(), indent=2) + "\n"

    def to_values(self) -> dict[str, Any]:
        """Plain JSON values of all fields; rarely used ones only if they differ from their default."""
        values = {"schema_version": SCHEMA_VERSION, **dataclasses.asdict(self)}
        for field in dataclasses.fields(self):
            if field.name in RARE_FIELDS and values[field.name] == field.default:
                del values[field.name]
        return {name: _listed(value) for name, value in values.items()}

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on unusual properties of this radar, such as a ramp that ends beyond the specified band."""
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
        """Parses the output of `to_json`.

        Args:
            text: JSON text.

        Returns:
            The radar.

        Raises:
            InputError: If the text is not a radar file, or contains an unknown or missing key.
        """
        return cls.from_values(parse_json(text, "the radar file"))

    @classmethod
    def from_values(cls, values: Any) -> "RadarConfig":
        """Builds a radar from the output of `to_values`.

        Args:
            values: Decoded JSON.

        Returns:
            The radar.

        Raises:
            InputError: If the values are not those of a radar, or the radar is impossible.
        """
        if not isinstance(values, dict):
            raise InputError(
                "the radar file holds no object; make one with: mmweaver radar awr1843 --json > radar.json"
            )
        values = dict(values)
        version = values.pop("schema_version", None)
        if version != SCHEMA_VERSION:
            raise InputError(f"the radar file has schema_version {version!r}; this version reads {SCHEMA_VERSION}")
        return cls(**record_fields(cls, values, "the radar file"))


def _listed(value: Any) -> Any:
    return [_listed(item) for item in value] if isinstance(value, tuple) else value
