"""Configuration of a TI radar in TI's units, independent of the file format, and its conversion to a RadarConfig.

Readers fill a `TiSetup`: profiles, chirps by index, and the frame or the sub-frames of an advanced one.
"""

from dataclasses import dataclass, field

import numpy as np

from mmweaver.core.boards import ANTENNAS, BAND_60_HZ, BAND_77_HZ, halfwave_positions
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.range_window import default_range_bins
from mmweaver.core.transmit_code import tx_code_of
from mmweaver.core.virtual_array import AntennaTable
from mmweaver.io.radar_options import RadarOptions

MAX_TX = 4
MAX_CHIRPS = 512
SHIFTER_DEG = 5.625  # resolution of the phase shifters
NO_PHASE = (0.0,) * MAX_TX
Chirp = tuple[complex, ...]  # weight of each transmitter of the board


@dataclass(frozen=True, kw_only=True)
class TiProfile:
    """A chirp profile; units are part of the names."""

    start_frequency_ghz: float
    idle_time_us: float
    adc_start_time_us: float
    ramp_end_time_us: float
    slope_mhz_per_us: float
    num_samples: int
    sample_rate_ksps: float
    rx_gain_db: float
    phase_code: int = 0  # txPhaseShifter


@dataclass(frozen=True, kw_only=True)
class TiChirp:
    """One chirp: profile, active transmitters, and their phases as seen in the samples (BPM or phase shifters)."""

    profile: int
    tx_mask: int
    phase_deg: tuple[float, ...] = NO_PHASE


@dataclass(frozen=True, kw_only=True)
class TiFrame:
    """Chirp indices of a loop, first and last inclusive, of the frame or a sub-frame."""

    first: int
    last: int
    num_loops: int


@dataclass(frozen=True, kw_only=True)
class TiSetup:
    """Configuration before a sub-frame is selected."""

    name: str
    profiles: dict[int, TiProfile]
    frames: list[TiFrame]  # one frame, or the sub-frames
    has_sub_frames: bool
    frame_period_ms: float  # total of all sub-frames
    rx_mask: int
    tx_mask: int
    complex_samples: bool
    lvds_iq_order: str
    lvds_lanes: int
    antennas: AntennaTable | None = None  # None: xWR1843BOOST, or AWR2944EVM if a fourth transmitter fires
    chirps: dict[int, TiChirp] = field(default_factory=dict)

    def add_chirps(self, first: int, last: int, chirp: TiChirp) -> None:
        """Defines chirps `first` to `last`, inclusive.

        Raises:
            InputError: If an index exceeds the device's limit.
        """
        if not 0 <= first <= last < MAX_CHIRPS:
            raise InputError(f"chirps {first} to {last} must lie in 0 to {MAX_CHIRPS - 1}")
        self.chirps.update(dict.fromkeys(range(first, last + 1), chirp))

    def chosen_frame(self, sub_frame: int | None) -> int:
        """Index of the selected frame.

        Args:
            sub_frame: Index of a sub-frame; None if the frame is plain.

        Returns:
            Index into `frames`.

        Raises:
            InputError: If a sub-frame must be selected, or does not exist.
        """
        count = len(self.frames)
        if not self.has_sub_frames and sub_frame is not None:
            raise InputError("it has one plain frame and no sub-frames; leave out --radar-set subframe=N")
        if sub_frame is None and count > 1:
            raise InputError(f"it has {count} sub-frames; choose one of 0 to {count - 1}: --radar-set subframe=N")
        if not 0 <= (sub_frame or 0) < count:
            raise InputError(f"it has sub-frames 0 to {count - 1}, not {sub_frame}")
        return sub_frame or 0

    def loop(self, index: int) -> tuple[list[TiChirp], TiProfile]:
        """Chirps of a frame's loop and their common profile.

        Args:
            index: Index into `frames`.

        Returns:
            Chirps in order, and the profile.

        Raises:
            InputError: If a chirp or profile is undefined, or profiles differ.
        """
        frame = self.frames[index]
        if not 0 <= frame.first <= frame.last < MAX_CHIRPS:
            raise InputError(f"the frame's chirps {frame.first} to {frame.last} must lie in 0 to {MAX_CHIRPS - 1}")
        numbers = range(frame.first, frame.last + 1)
        if missing := [number for number in numbers if number not in self.chirps]:
            raise InputError(f"the frame uses chirp {missing[0]}, which is not defined")
        chirps = [self.chirps[number] for number in numbers]
        profiles = sorted({chirp.profile for chirp in chirps})
        if len(profiles) > 1:
            raise InputError(f"the frame's chirps use profiles {profiles}; only one profile can be read")
        if profiles[0] not in self.profiles:
            raise InputError(f"the chirps use profile {profiles[0]}, which is not defined")
        return chirps, self.profiles[profiles[0]]

    def num_samples(self, index: int) -> int:
        """Samples per receiver in a frame."""
        chirps, profile = self.loop(index)
        return len(chirps) * self.frames[index].num_loops * profile.num_samples


def profile_phases_deg(code: int) -> tuple[float, ...]:
    """Decodes a profile's txPhaseShifter: six bits per transmitter in steps of 5.625 degrees.

    Samples are the ramp times the conjugate echo, so they rotate opposite to the shifter. Source: rlProfileCfg_t of
    mmWaveLink.

    Args:
        code: Value of txPhaseShifter.

    Returns:
        Phases in the samples in degrees, one per transmitter.

    >>> profile_phases_deg(0x00_40_20_00)
    (0.0, -45.0, -90.0, 0.0)
    """
    return tuple(-SHIFTER_DEG * (code >> (8 * tx + 2) & 0x3F) + 0.0 for tx in range(MAX_TX))


def radar_from_ti(setup: TiSetup, options: RadarOptions) -> RadarConfig:
    """Converts a configuration to a RadarConfig with the board's array, restricted to the transmitters that fire.

    Transmitters are renumbered in the board's order. All range bins are kept, up to a cube of 4 MiB per frame.

    Args:
        setup: The configuration.
        options: Sub-frame, antennas and lanes that override those of the file.

    Returns:
        The radar.

    Raises:
        InputError: If a sub-frame must be selected, chirps differ or cannot be separated, or the radar is impossible.
    """
    index = setup.chosen_frame(options.sub_frame)
    chirps, profile = setup.loop(index)
    is_77_ghz = profile.start_frequency_ghz > 70
    usual = "evm2944" if any(one.tx_mask >> 3 for one in chirps) else "boost" if is_77_ghz else "isk"
    board = options.antennas or setup.antennas or ANTENNAS[usual]
    lanes = options.lanes or setup.lvds_lanes
    sequence, repeats = _repeated_sequence(_weights(setup.tx_mask, chirps, profile, board))
    enabled = [tx for tx in range(len(board.tx_halfwaves)) if any(chirp[tx] for chirp in sequence)]
    weights = np.array([[chirp[tx] for tx in enabled] for chirp in sequence])
    is_tdm = len(weights) == len(enabled) and (np.count_nonzero(weights, axis=1) == 1).all()
    is_tdm = is_tdm and np.linalg.matrix_rank(weights) == len(enabled)
    order = tuple(int(np.flatnonzero(row)[0]) for row in weights) if is_tdm else tuple(range(len(enabled)))
    receivers = [bit for bit in range(len(board.rx_halfwaves)) if setup.rx_mask >> bit & 1]
    if not receivers or setup.rx_mask >> len(board.rx_halfwaves):
        raise InputError(f"receiver mask {setup.rx_mask} must name some of the {len(board.rx_halfwaves)} receivers")
    start_hz, slope = profile.start_frequency_ghz * 1e9, profile.slope_mhz_per_us * 1e12
    sample_rate_hz = profile.sample_rate_ksps * 1e3
    if slope <= 0 or sample_rate_hz <= 0 or profile.num_samples <= 0:
        raise InputError("the profile's slope, samples and sample rate must be above 0")
    middle_hz = start_hz + slope * (profile.adc_start_time_us * 1e-6 + profile.num_samples / sample_rate_hz / 2)
    bins = profile.num_samples if setup.complex_samples else profile.num_samples // 2
    num_loops = setup.frames[index].num_loops * repeats
    channels = len(receivers) if lanes == 2 else 4
    words = 2 * channels if setup.complex_samples else channels  # per sample of all receivers
    counts = [setup.num_samples(at) for at in range(len(setup.frames))]
    return RadarConfig(
        name=f"{setup.name}_{index}" if setup.has_sub_frames else setup.name,
        start_frequency_hz=start_hz,
        chirp_slope_hz_per_s=slope,
        idle_time_s=profile.idle_time_us * 1e-6,
        adc_start_time_s=profile.adc_start_time_us * 1e-6,
        ramp_end_time_s=profile.ramp_end_time_us * 1e-6,
        num_samples=profile.num_samples,
        sample_rate_hz=sample_rate_hz,
        num_loops=num_loops,
        frame_period_s=setup.frame_period_ms * 1e-3,
        tx_position_m=halfwave_positions(tuple(board.tx_halfwaves[bit] for bit in enabled), middle_hz),
        rx_position_m=halfwave_positions(tuple(board.rx_halfwaves[bit] for bit in receivers), middle_hz),
        tx_order=order,
        complex_samples=setup.complex_samples,
        num_range_bins=default_range_bins(max(bins, 1), max(num_loops, 1) * len(enabled) * len(receivers)),
        rx_gain_db=profile.rx_gain_db,
        frequency_limits_hz=_band_hz(start_hz),
        tx_code=() if is_tdm else tx_code_of(weights),
        lvds_lanes=lanes,
        lvds_iq_order=setup.lvds_iq_order,
        rx_channels=() if receivers == list(range(len(receivers))) else tuple(receivers),
        rx_inverted=tuple(at for at, bit in enumerate(receivers) if bit in board.rx_inverted),
        frame_words_before=sum(counts[:index]) * words,
        frame_words_after=sum(counts[index + 1 :]) * words,
        **dict(board.electrical),
    )


def _band_hz(start_hz: float) -> tuple[float, float]:
    for band in (BAND_60_HZ, BAND_77_HZ):
        if band[0] <= start_hz < band[1]:
            return band
    raise InputError(
        f"the profile starts at {start_hz / 1e9:g} GHz; TI's radars work in 57 to 64 GHz (xWR6843) and 76 to 81 GHz"
        " (xWR1443, xWR1843, AWR2944)"
    )


def _repeated_sequence(chirps: tuple[Chirp, ...]) -> tuple[tuple[Chirp, ...], int]:
    """Shortest sequence that the chirps repeat, and its number of repetitions."""
    lengths = (length for length in range(1, len(chirps) + 1) if len(chirps) % length == 0)
    length = next(length for length in lengths if chirps[:length] * (len(chirps) // length) == chirps)
    return chirps[:length], len(chirps) // length


def _weights(tx_mask: int, chirps: list[TiChirp], profile: TiProfile, board: AntennaTable) -> tuple[Chirp, ...]:
    """Weights of the board's transmitters in each chirp; a transmitter that fires alone has phase 0."""
    num_tx, profile_deg = len(board.tx_halfwaves), profile_phases_deg(profile.phase_code)
    found: list[Chirp] = []
    for chirp in chirps:
        mask = chirp.tx_mask
        if mask == 0 or mask >> num_tx:
            raise InputError(
                f"a chirp with transmitter mask {mask} must fire some of the {num_tx} transmitters of board"
                f" {board.name!r}; another board: --radar-set antennas=NAME"
            )
        if mask & ~tx_mask:
            raise InputError(
                f"a chirp fires transmitter mask {mask}, but the channel mask {tx_mask} does not enable it"
            )
        phase_deg = [sum(both) for both in zip(chirp.phase_deg, profile_deg, strict=True)]
        on = [tx for tx in range(num_tx) if mask >> tx & 1]
        turn = 0.0 if len(on) > 1 else phase_deg[on[0]]  # irrelevant for a single transmitter
        found.append(tuple(_phasor(phase_deg[tx] - turn) if tx in on else 0j for tx in range(num_tx)))
    return tuple(found)


def _phasor(degrees: float) -> complex:
    """exp(j phase), exact at multiples of 90 degrees."""
    value = np.exp(1j * np.radians(degrees % 360))
    return complex(np.round(value.real, 12), np.round(value.imag, 12))
