"""RadarConfig: chirp, array and frame, with the resolutions and limits that follow from them.

Limits on radar parameters, alone and in combination, that keep every signal finite and nonzero.
"""

import dataclasses
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mmweaver.core.antenna_pattern import pattern_grid
from mmweaver.core.constants import BOLTZMANN_J_PER_K, NOISE_TEMPERATURE_K, SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
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
