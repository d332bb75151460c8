"""Removes the errors of a board from its recordings: the inverse of `board_effects`.

Noise is amplified where the IF response is weak, so the correction is limited to MAX_GAIN_DB. Errors that differ
between recordings (drift) cannot be removed. Reference: docs/board.md.
"""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.board_effects import BoardEffects

MAX_GAIN_DB = 30.0
WORST_CONDITION = 1e3  # condition number of the antenna coupling beyond which it is not inverted
LIKE_THE_LEAKAGE = 0.5  # minimum correlation between a recording of unknown scale and a board's leakage to remove it


@dataclass(frozen=True, kw_only=True)
class CorrectedSamples:
    """Samples with the board's errors removed.

    Attributes:
        adc: The samples; their radar has the antenna positions of the board.
        corrected: Errors that were removed, in words.
        left_in: Errors that remain, in words.
    """

    adc: AdcCube
    corrected: tuple[str, ...]
    left_in: tuple[str, ...]


def corrected(adc: AdcCube, board: Board) -> CorrectedSamples:
    """Recorded samples as an ideal board would have recorded them.

    Args:
        adc: Samples (frame, loop, tx, rx, sample).
        board: The board that recorded them.

    Returns:
        Corrected samples, and which errors were removed and which remain.

    Raises:
        InputError: If the board belongs to another radar, or its antenna coupling cannot be inverted.
    """
    effects = BoardEffects(board, adc.config)
    done, left = [], []
    samples = adc.samples.astype(np.complex64)  # a copy
    if effects.first_chirp != 1:
        samples[:, 0, effects.first_slot] /= np.complex64(effects.first_chirp)
        done.append("first chirp")
    if len(board.leakage_range_m):
        taken = _remove_leakage(samples, adc, effects)
        (done if taken else left).append("leakage" if taken else _WHY_LEAKAGE)
    mixing = effects.channels
    if mixing is not None and adc.config.is_coded:
        left.append("antenna errors: transmitters that send together do not show them apart")
    elif mixing is not None:
        samples = _unmixed(samples, mixing.numpy().astype(complex), board)
        done.append("antenna errors")
    if effects.has_filter or board.gain_db:
        samples = _unfiltered(samples, adc.config, effects)
        done.append("IF response" if effects.has_filter else "gain")
    if board.range_bias_m:
        samples = _nearer(samples, adc.config, board.range_bias_m)
        done.append("range bias")
    fixed = replace(adc, samples=samples)
    if board.element_spacing_m is not None:
        built = effects.radar
        antennas = {"tx_position_m": built.tx_position_m, "rx_position_m": built.rx_position_m}
        fixed = replace(fixed, config=replace(adc.config, **antennas))
        done.append("element spacing")
    if board.drift_ppm:
        left.append("drift: it is another one in each recording")
    return CorrectedSamples(adc=fixed, corrected=tuple(done), left_in=tuple(left))


_WHY_LEAKAGE = "leakage: the recording's static echoes are not like it, or its samples are real or coded"


def _remove_leakage(samples: np.ndarray, adc: AdcCube, effects: BoardEffects) -> bool:
    """Subtracts the leakage from samples, in place; returns whether that was possible."""
    config = adc.config
    if config.is_coded or not config.complex_samples:
        return False
    leakage = AdcSynthesis(config).leakage(*effects.leakage).numpy()
    scale = adc.scale if np.isfinite(adc.scale) else _scale(samples, leakage)
    if scale is None:
        return False
    samples -= leakage / np.complex64(scale)
    return True


def _scale(samples: np.ndarray, leakage: np.ndarray) -> float | None:
    """Sqrt(mW) per unit of a recording that contains this leakage; None if it seems to contain another."""
    still = samples.mean(axis=(0, 1), dtype=np.complex128)
    # only the nearest bins: farther away the room's echoes are as strong as the leakage
    near, wanted = (np.fft.fft(each * np.hanning(each.shape[-1]), axis=-1)[..., :4] for each in (still, leakage))
    common, own = np.vdot(wanted, near), np.vdot(near, near).real
    power = np.vdot(wanted, wanted).real
    if own <= 0 or power <= 0 or common.real / np.sqrt(own * power) < LIKE_THE_LEAKAGE:
        return None
    return float(power / common.real)


def _unmixed(samples: np.ndarray, mixing: np.ndarray, board: Board) -> np.ndarray:
    """Samples (frame, loop, tx, rx, sample) with the antenna coupling inverted."""
    if np.linalg.cond(mixing) > WORST_CONDITION:
        raise InputError(f"board {board.name!r} couples antennas so that they cannot be taken apart")
    inverse = np.linalg.inv(mixing).astype(np.complex64)
    shape = samples.shape
    pairs = samples.reshape(*shape[:2], shape[2] * shape[3], shape[4])
    return (inverse @ pairs).reshape(shape)


def _unfiltered(samples: np.ndarray, config: RadarConfig, effects: BoardEffects) -> np.ndarray:
    """Samples before the IF filter: the spectrum over the response, Hermitian for real samples."""
    from scipy import fft

    share = np.fft.fftfreq(config.num_samples)
    if config.complex_samples:
        response = effects.response(share % 1.0)
    else:
        response = effects.response(np.abs(share))
        response = np.where(share < 0, response.conj(), response)
        response = np.where(np.isin(share, (0.0, -0.5)), np.abs(response), response)  # DC and Nyquist bins are real
    response = response * effects.gain
    least = 10 ** (-MAX_GAIN_DB / 20) * effects.gain
    response *= np.maximum(1, least / np.maximum(np.abs(response), 1e-12))
    spectrum = fft.fft(samples, axis=-1, overwrite_x=True) / response.astype(np.complex64)
    return np.asarray(fft.ifft(spectrum, axis=-1, overwrite_x=True))


def _nearer(samples: np.ndarray, config: RadarConfig, bias_m: float) -> np.ndarray:
    """Samples without the range bias; real samples are shifted as analytic signals, and the real part is kept."""
    beat_hz = 2 * config.chirp_slope_hz_per_s * bias_m / SPEED_OF_LIGHT_MPS
    since_middle_s = (np.arange(config.num_samples) - config.num_samples / 2) / config.sample_rate_hz
    turn = np.exp(-2j * np.pi * beat_hz * since_middle_s).astype(np.complex64)
    if config.complex_samples:
        return samples * turn
    from scipy.signal import hilbert

    return ((hilbert(samples.real, axis=-1) * turn).real + 0j).astype(np.complex64)
