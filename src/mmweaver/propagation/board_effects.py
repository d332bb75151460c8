"""Effects of a board on signals: on path amplitudes, antennas, chirps, and the receiver's noise.

Both renderers use them. A path is a tone at the IF, so the IF response and the drift of the carrier are factors of its
amplitude; antenna errors mix the phases of antenna pairs; a range bias shifts beat frequencies.
Reference: docs/board.md.
"""

from dataclasses import replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.board import Board
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.radar_config import Position, RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.propagation.paths import Interaction, Paths, StaticPaths

DRIFT_PERIODS_S = (3.0, 7.0, 17.0, 41.0)  # of the sinusoids of equal strength that make up a drift
SAME_ROW_M = 1e-6


class BoardEffects:
    """Errors of one board with one radar.

    Attributes:
        board: The board.
        nominal: The radar as users know it, which results are labelled with.
        radar: The radar as built, with the board's antenna spacing and noise figure.
        extra_length_m: Additional path length in metres by the range bias.
        channels: Antenna errors (antenna, antenna), complex64, or None without any.
        first_chirp: Complex factor of the first chirp of each frame.
        first_slot: Slot in which that chirp is sent.
    """

    def __init__(self, board: Board, config: RadarConfig):
        """Evaluates a board.

        Args:
            board: The board.
            config: The nominal radar.

        Raises:
            InputError: If the board does not fit the radar (`Board.check_fits`).
        """
        board.check_fits(config)
        self.board, self.nominal = board, config
        self.radar = built_radar(board, config)
        self.extra_length_m = 2 * board.range_bias_m
        self.channels = _channels(board, config)
        first = 1 + board.first_chirp_amplitude_percent / 100
        # first order in the errors: a signal's image at the negative frequency, relative to the signal
        gain = 10 ** (board.iq_gain_db / 20)
        self.iq_image = complex((1 - gain * np.exp(1j * np.radians(board.iq_phase_deg))) / 2)
        self.first_chirp = complex(first * np.exp(1e-3j * board.first_chirp_phase_mrad))
        self.first_slot = 0 if config.is_coded else config.tx_order[0]

    # paths ----------------------------------------------------------------------------------------------------------
    def recorded_static(self, paths: StaticPaths) -> StaticPaths:
        """Static paths with the gain and IF response of the receiver.

        Diffuse clutter is not amplified by the board's gain: its level was taken from recordings over the noise of
        boards whose gains it already contains.

        Args:
            paths: Static paths, (path,).

        Returns:
            The same paths with amplitudes behind the IF filter.
        """
        gain = torch.where(paths.interaction == int(Interaction.CLUTTER), 1.0, self.gain)
        factor = self.if_response(paths.length_m.mean(dim=(-2, -1))) * gain
        return replace(paths, amplitude=paths.amplitude * factor)

    def recorded_moving(self, paths: Paths, frames: np.ndarray, seed: int) -> Paths:
        """Moving paths with the gain and IF response of the receiver, and the drift of its carrier.

        Args:
            paths: Moving paths, (frame * segment, path).
            frames: Frame numbers (frame,), which the drift depends on.
            seed: Seed of the drift.

        Returns:
            The same paths with amplitudes behind the IF filter.
        """
        length_m = paths.length_m
        factor = self.if_response(length_m) * self.gain
        if self.board.drift_ppm:
            drift = torch.from_numpy(np.repeat(self.drift(frames, seed), len(length_m) // len(frames)))
            turn = length_m * (2 * torch.pi / self.radar.wavelength_m) * drift[:, None]
            factor = factor * torch.polar(torch.ones_like(turn), turn)
        return replace(paths, amplitude=(paths.amplitude * factor).to(torch.complex64))

    @property
    def gain(self) -> float:
        """Amplitude gain of echoes."""
        return 10 ** (self.board.gain_db / 20)

    def if_response(self, length_m: Tensor) -> Tensor:
        """Complex gain (...) of the IF at the beat frequencies of path lengths (...) in metres."""
        config = self.radar
        beat_hz = config.chirp_slope_hz_per_s * (length_m + self.extra_length_m) / SPEED_OF_LIGHT_MPS
        return torch.from_numpy(self.response((beat_hz / config.sample_rate_hz).numpy()))

    def noise_gain(self, share: np.ndarray) -> np.ndarray:
        """Amplitude gain (...) of noise at frequencies (...) given as shares of the sample rate."""
        return np.abs(self.response(share))

    def response(self, share: np.ndarray) -> np.ndarray:
        """Complex gain (...) of the IF at frequencies (...) given as shares of the sample rate."""
        board = self.board
        if not len(board.if_share):
            return np.ones(share.shape, complex)
        level_db, phase_deg = (
            np.interp(share, board.if_share, part) for part in (board.if_gain_db, board.if_phase_deg)
        )
        return 10 ** (level_db / 20) * np.exp(1j * np.radians(phase_deg))

    @property
    def has_filter(self) -> bool:
        return bool(len(self.board.if_share))

    def drift(self, frames: np.ndarray, seed: int) -> np.ndarray:
        """Relative frequency error of the carrier, a sum of slow sinusoids of random phase.

        Args:
            frames: Frame numbers (frame,).
            seed: Seed of the phases.

        Returns:
            Relative error (frame,), with the rms value that the board states in ppm.
        """
        phase = stream(seed, "carrier drift").uniform(0, 2 * np.pi, len(DRIFT_PERIODS_S))
        turns = np.asarray(frames)[:, None] * self.nominal.frame_period_s / np.array(DRIFT_PERIODS_S)
        waves = np.sin(2 * np.pi * turns + phase).sum(axis=1) * np.sqrt(2 / len(DRIFT_PERIODS_S))
        return 1e-6 * self.board.drift_ppm * waves

    # leakage --------------------------------------------------------------------------------------------------------
    @property
    def leakage(self) -> tuple[Tensor, Tensor]:
        """Path lengths (tap,) in metres and amplitudes (tap, tx, rx) in sqrt(mW), complex64, of the TX-RX leakage."""
        board, config = self.board, self.nominal
        level_db, phase = board.leakage_level_db, np.radians(board.leakage_phase_deg)
        amplitude = 10 ** ((level_db + config.tx_power_dbm) / 20) * np.exp(1j * phase)
        shaped = amplitude.reshape(-1, config.num_tx, config.num_rx).astype(np.complex64)
        return torch.from_numpy(2 * board.leakage_range_m), torch.from_numpy(shaped)

    @property
    def leakage_rate(self) -> tuple[Tensor, Tensor]:
        """Path lengths as in `leakage`, and the derivative of its amplitudes by the relative error of the carrier."""
        length_m, amplitude = self.leakage
        turn = 2j * torch.pi / self.radar.wavelength_m * length_m
        return length_m, (amplitude * turn[:, None, None]).to(torch.complex64)


def built_radar(board: Board, config: RadarConfig) -> RadarConfig:
    """The radar with the antenna spacing and noise figure of its board.

    Args:
        board: The board; what it does not state stays nominal.
        config: The nominal radar.

    Returns:
        The radar as built.
    """
    values: dict[str, object] = {}
    if board.noise_figure_db is not None:
        values["noise_figure_db"] = board.noise_figure_db
    if board.element_spacing_m is not None:
        times = board.element_spacing_m / (config.wavelength_m / 2)
        values |= {"tx_position_m": _scaled(config.tx_position_m, times)}
        values |= {"rx_position_m": _scaled(config.rx_position_m, times)}
    return replace(config, **values) if values else config  # type: ignore[arg-type]


def _scaled(places_m: tuple[Position, ...], times: float) -> tuple[Position, ...]:
    return tuple((x * times, y * times, z * times) for x, y, z in places_m)


def _channels(board: Board, config: RadarConfig) -> Tensor | None:
    """Antenna errors (antenna, antenna): recorded pairs by ideal pairs; None for the identity."""
    count = config.num_tx * config.num_rx
    gain_db = board.channel_gain_db if board.channel_gain_db.size else np.zeros((config.num_tx, config.num_rx))
    phase_deg = board.channel_phase_deg if board.channel_phase_deg.size else np.zeros((config.num_tx, config.num_rx))
    height_m = np.array(config.tx_position_m)[:, 2]
    off_row = np.abs(height_m - height_m[0]) > SAME_ROW_M
    phase_deg = phase_deg + board.elevation_phase_deg * off_row[:, None]
    factor = (10 ** (gain_db / 20) * np.exp(1j * np.radians(phase_deg))).ravel()
    mixing = np.eye(count, dtype=complex)
    if board.coupling_real.size:
        mixing = board.coupling_real + 1j * board.coupling_imag
    mixing = factor[:, None] * mixing
    if np.array_equal(mixing, np.eye(count)):
        return None
    return torch.from_numpy(mixing.astype(np.complex64))
