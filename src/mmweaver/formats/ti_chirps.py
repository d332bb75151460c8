"""Converts the chirp configuration of a TI radar, in TI's units, to a RadarConfig."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.antenna_tables import EVM_2944, ISK, AntennaTable
from mmweaver.core.errors import InputError
from mmweaver.core.presets import BAND_60_HZ, BAND_77_HZ, halfwave_positions
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.range_window import default_range_bins
from mmweaver.core.transmit_code import tx_code_of

MOST_TX = 4
SHIFTER_DEG = 5.625  # a step of the phase shifters
Chirp = tuple[complex, ...]  # weight of each of the board's transmitters


@dataclass(frozen=True, kw_only=True)
class SubFrame:
    """Which sub-frame of an advanced frame a configuration is, and the samples of the others in each frame."""

    index: int
    samples_before: int
    samples_after: int


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
    # phase of each transmitter (tx,) in each chirp, in degrees: BPM or phase shifters; () = all 0
    chirp_phase_deg: tuple[tuple[float, ...], ...] = ()
    profile_phase_deg: tuple[float, ...] = (0.0,) * MOST_TX  # of each transmitter in all chirps, added to the former
    antennas: AntennaTable | None = None  # None: the xWR1843BOOST's, or the AWR2944EVM's with a fourth transmitter
    lvds_lanes: int = 2
    lvds_iq_order: str = "iq"
    sub_frame: SubFrame | None = None


def profile_phases_deg(code: int) -> tuple[float, ...]:
    """A profile's txPhaseShifter as phases in the samples: six bits a transmitter, in steps of 5.625 degrees.

    Samples turn against the shifter: they are the ramp times the conjugate echo. Source: rlProfileCfg_t of mmWaveLink.

    >>> profile_phases_deg(0x00_40_20_00)
    (0.0, -45.0, -90.0, 0.0)
    """
    return tuple(-SHIFTER_DEG * (code >> (8 * tx + 2) & 0x3F) + 0.0 for tx in range(MOST_TX))


def radar_from_ti(chirps: TiChirps) -> RadarConfig:
    """The radar with the board's array, restricted to the transmitters that fire.

    Transmitters are renumbered in the board's order. All range bins are kept, up to a cube of 4 MiB a frame. Raises
    InputError where the chirps cannot be separated, or where the radar could not exist.
    """
    board = _board(chirps)
    sequence, repeats = _repeated_sequence(_weights(chirps, board))
    enabled = [tx for tx in range(len(board.tx_halfwaves)) if any(chirp[tx] for chirp in sequence)]
    weights = np.array([[chirp[tx] for tx in enabled] for chirp in sequence])
    is_tdm = len(weights) == len(enabled) and (np.count_nonzero(weights, axis=1) == 1).all()
    is_tdm = is_tdm and np.linalg.matrix_rank(weights) == len(enabled)
    order = tuple(int(np.flatnonzero(row)[0]) for row in weights) if is_tdm else tuple(range(len(enabled)))
    receivers = [bit for bit in range(len(board.rx_halfwaves)) if chirps.rx_mask >> bit & 1]
    if not receivers or chirps.rx_mask >> len(board.rx_halfwaves):
        raise InputError(f"receiver mask {chirps.rx_mask} must name some of the {len(board.rx_halfwaves)} receivers")
    start_hz, slope = chirps.start_frequency_ghz * 1e9, chirps.slope_mhz_per_us * 1e12
    sample_rate_hz = chirps.sample_rate_ksps * 1e3
    if slope <= 0 or sample_rate_hz <= 0 or chirps.num_samples <= 0:
        raise InputError("the profile's slope, samples and sample rate must be above 0")
    middle_hz = start_hz + slope * (chirps.adc_start_time_us * 1e-6 + chirps.num_samples / sample_rate_hz / 2)
    bins = chirps.num_samples if chirps.complex_samples else chirps.num_samples // 2
    loops = max(chirps.num_loops * repeats, 1)
    lanes = len(receivers) if chirps.lvds_lanes == 2 else 4
    words = 2 * lanes if chirps.complex_samples else lanes  # of a sample of all receivers
    other = chirps.sub_frame or SubFrame(index=0, samples_before=0, samples_after=0)
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
        tx_position_m=halfwave_positions(tuple(board.tx_halfwaves[bit] for bit in enabled), middle_hz),
        rx_position_m=halfwave_positions(tuple(board.rx_halfwaves[bit] for bit in receivers), middle_hz),
        tx_order=order,
        complex_samples=chirps.complex_samples,
        num_range_bins=default_range_bins(max(bins, 1), loops * len(enabled) * len(receivers)),
        rx_gain_db=chirps.rx_gain_db,
        frequency_limits_hz=_band_hz(start_hz),
        tx_code=() if is_tdm else tx_code_of(weights),
        lvds_lanes=chirps.lvds_lanes,
        lvds_iq_order=chirps.lvds_iq_order,
        rx_channels=() if receivers == list(range(len(receivers))) else tuple(receivers),
        rx_inverted=tuple(index for index, bit in enumerate(receivers) if bit in board.rx_inverted),
        frame_words_before=other.samples_before * words,
        frame_words_after=other.samples_after * words,
    )


def _board(chirps: TiChirps) -> AntennaTable:
    if chirps.antennas is not None:
        return chirps.antennas
    return EVM_2944 if any(mask >> 3 & 1 for mask in chirps.chirp_tx_masks) else ISK


def _band_hz(start_hz: float) -> tuple[float, float]:
    for band in (BAND_60_HZ, BAND_77_HZ):
        if band[0] <= start_hz < band[1]:
            return band
    raise InputError(
        f"the profile starts at {start_hz / 1e9:g} GHz; TI's radars work in 57 to 64 GHz (xWR6843) and 76 to 81 GHz"
        " (xWR1443, xWR1843, AWR2944)"
    )


def _repeated_sequence(chirps: tuple[Chirp, ...]) -> tuple[tuple[Chirp, ...], int]:
    """The shortest sequence that the chirps repeat, and its number of repetitions."""
    if not chirps:
        raise InputError("the frame names no chirps")
    for length in range(1, len(chirps) + 1):
        if len(chirps) % length == 0 and chirps[:length] * (len(chirps) // length) == chirps:
            return chirps[:length], len(chirps) // length
    raise AssertionError("a sequence repeats itself once")


def _weights(chirps: TiChirps, board: AntennaTable) -> tuple[Chirp, ...]:
    """The weights of the board's transmitters in each chirp, the first that fires with phase 0 where it is alone."""
    num_tx = len(board.tx_halfwaves)
    phases = chirps.chirp_phase_deg or ((0.0,) * MOST_TX,) * len(chirps.chirp_tx_masks)
    found: list[Chirp] = []
    for mask, phase_deg in zip(chirps.chirp_tx_masks, phases, strict=True):
        if mask == 0 or mask >> num_tx:
            raise InputError(
                f"a chirp with transmitter mask {mask} must fire some of the {num_tx} transmitters of board"
                f" {board.name!r}; another board: --radar-set antennas=NAME"
            )
        if mask & ~chirps.tx_mask:
            raise InputError(
                f"a chirp fires transmitter mask {mask}, but the channel mask {chirps.tx_mask} does not enable it"
            )
        phase_deg = tuple(map(sum, zip(phase_deg, chirps.profile_phase_deg, strict=True)))
        on = [tx for tx in range(num_tx) if mask >> tx & 1]
        turn = 0.0 if len(on) > 1 else phase_deg[on[0]]  # of one alone it means nothing
        found.append(tuple(_phasor(phase_deg[tx] - turn) if tx in on else 0j for tx in range(num_tx)))
    return tuple(found)


def _phasor(degrees: float) -> complex:
    """exp(j phase), exact at whole quarter turns."""
    value = np.exp(1j * np.radians(degrees % 360))
    return complex(np.round(value.real, 12), np.round(value.imag, 12))
