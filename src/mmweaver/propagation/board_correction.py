"""A recording without the errors of the board that made it: `board_effects` the other way round.

Noise stays noise, so nothing is gained where the IF passes little: there it is raised by MAX_GAIN_DB at most. What
is another error each time (drift) cannot be taken away. Reference: docs/board.md.
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
WORST_CONDITION = 1e3  # of coupled antennas, beyond which they cannot be taken apart
LIKE_THE_LEAKAGE = 0.5  # correlation of a recording of unknown scale with a board's leakage, from which it is that


@dataclass(frozen=True, kw_only=True)
class CorrectedSamples:
    """Samples without errors, of a radar whose antennas are where the board has them; and what was done, in words."""

    adc: AdcCube
    corrected: tuple[str, ...]
    left_in: tuple[str, ...]


def corrected(adc: AdcCube, board: Board) -> CorrectedSamples:
    """Recorded samples as an ideal board would have recorded them.

    Args:
        adc: samples (frame, loop, tx, rx, sample).
        board: that recorded them.

    Raises:
        InputError: for the board of another radar, and for antennas whose coupling cannot be undone.
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
    """Takes the leakage away from samples, in place; whether that could be done."""
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
    """Sqrt(mW) of 1.0 in a recording that holds this leakage; None if it seems to hold another."""
    still = samples.mean(axis=(0, 1), dtype=np.complex128)
    # the nearest bins alone: further off the room's echoes are as strong
    near, wanted = (np.fft.fft(each * np.hanning(each.shape[-1]), axis=-1)[..., :4] for each in (still, leakage))
    common, own = np.vdot(wanted, near), np.vdot(near, near).real
    power = np.vdot(wanted, wanted).real
    if own <= 0 or power <= 0 or common.real / np.sqrt(own * power) < LIKE_THE_LEAKAGE:
        return None
    return float(power / common.real)


def _unmixed(samples: np.ndarray, mixing: np.ndarray, board: Board) -> np.ndarray:
    """Samples (frame, loop, tx, rx, sample) of antenna pairs as each alone receives."""
    if np.linalg.cond(mixing) > WORST_CONDITION:
        raise InputError(f"board {board.name!r} couples antennas so that they cannot be taken apart")
    inverse = np.linalg.inv(mixing).astype(np.complex64)
    shape = samples.shape
    pairs = samples.reshape(*shape[:2], shape[2] * shape[3], shape[4])
    return (inverse @ pairs).reshape(shape)


def _unfiltered(samples: np.ndarray, config: RadarConfig, effects: BoardEffects) -> np.ndarray:
    """Samples before the IF filter: each beat over the response at it. Of real samples the other half is conjugate."""
    from scipy import fft

    share = np.fft.fftfreq(config.num_samples)
    if config.complex_samples:
        response = effects.response(share % 1.0)
    else:
        response = effects.response(np.abs(share))
        response = np.where(share < 0, response.conj(), response)
        response = np.where(np.isin(share, (0.0, -0.5)), np.abs(response), response)  # these bins of it are real
    response = response * effects.gain
    least = 10 ** (-MAX_GAIN_DB / 20) * effects.gain
    response *= np.maximum(1, least / np.maximum(np.abs(response), 1e-12))
    spectrum = fft.fft(samples, axis=-1, overwrite_x=True) / response.astype(np.complex64)
    return np.asarray(fft.ifft(spectrum, axis=-1, overwrite_x=True))


def _nearer(samples: np.ndarray, config: RadarConfig, bias_m: float) -> np.ndarray:
    """Samples without the range bias; of real ones the analytic signal is moved, and its real part kept."""
    beat_hz = 2 * config.chirp_slope_hz_per_s * bias_m / SPEED_OF_LIGHT_MPS
    since_middle_s = (np.arange(config.num_samples) - config.num_samples / 2) / config.sample_rate_hz
    turn = np.exp(-2j * np.pi * beat_hz * since_middle_s).astype(np.complex64)
    if config.complex_samples:
        return samples * turn
    from scipy.signal import hilbert

    return ((hilbert(samples.real, axis=-1) * turn).real + 0j).astype(np.complex64)
