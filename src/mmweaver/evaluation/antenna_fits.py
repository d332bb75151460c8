"""Gain and phase of each antenna pair from static cells of an unknown room.

A strong cell is mostly one plane wave, so its phases over the antennas are those of a direction plus those of the
board. Over many cells with many directions only the board's remain: directions and errors are estimated alternately,
each in closed form. A phase that is linear in antenna position is indistinguishable from a direction, so neither a
rotated board nor the offset between two rows of antennas can be observed.
"""

from collections.abc import Sequence

import numpy as np
from scipy.stats import t as student_t

from mmweaver.core.radar_config import RadarConfig
from mmweaver.evaluation.finding import Finding, signal_fit
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence

NEAREST_M = 0.6  # excludes leakage and its skirt
OVER_NOISE = 100.0  # minimum power of a strong cell relative to noise
MIN_CELLS, BLOCKS, ROUNDS = 16, 8, 30
SINES, HEIGHTS = np.linspace(-0.85, 0.85, 69), np.linspace(-0.4, 0.4, 13)
SEEN_OVER_ERROR = 2.0  # minimum ratio of the rms estimate to its rms error


@signal_fit("antenna gains and phases")
def fit_channels(evidence: Sequence[SignalEvidence]) -> Finding:
    """Estimates gain and phase of each antenna pair relative to their means.

    Args:
        evidence: Recordings of one radar.

    Returns:
        `channel_gain_db` and `channel_phase_deg`, (tx, rx), with standard errors; zero where they are not significant.

    Raises:
        CannotSeeError: For coded radars, too few strong static cells, or insignificant errors.
    """
    config = evidence[0].cube.config
    if config.is_coded:
        raise CannotSeeError("simultaneous transmitters do not show them separately")
    cells = np.concatenate([_strong_cells(one) for one in evidence])
    if len(cells) < MIN_CELLS:
        raise CannotSeeError(f"{len(cells)} strong static cells; it takes {MIN_CELLS}")
    steering = _steering(config)
    found, share = _channel_errors(cells, steering, config)
    gain_error_db, phase_error_deg = _standard_errors(found, cells, steering, config)
    gain_db, phase_deg = 20 * np.log10(np.abs(found)), np.degrees(np.angle(found))
    what = f"{len(cells)} cells, {share:.0%} of their energy in one plane wave each"
    is_gain_seen = gain_db.std() > SEEN_OVER_ERROR * gain_error_db
    is_phase_seen = _free_phases(config) > 0 and phase_deg.std() > SEEN_OVER_ERROR * phase_error_deg
    if not is_gain_seen and not is_phase_seen:
        raise CannotSeeError(
            f"{gain_db.std():.1f} dB and {phase_deg.std():.0f} degrees are no more than their errors"
            f" ({gain_error_db:.1f} dB, {phase_error_deg:.0f} degrees; {what})"
        )
    gains, phases = f"gains are alike within {gain_error_db:.1f} dB", f"phases within {phase_error_deg:.0f} degrees"
    if is_gain_seen:
        gains = f"gains differ by {gain_db.std():.1f} dB rms (+-{gain_error_db:.1f})"
    if is_phase_seen:
        phases = f"phases by {phase_deg.std():.0f} degrees rms (+-{phase_error_deg:.0f})"
    pairs = config.num_tx, config.num_rx
    return Finding(
        text=f"{gains}, {phases}; {what}; what is linear in an antenna's place is a direction, too",
        fields={
            "channel_gain_db": (gain_db * is_gain_seen).reshape(pairs),
            "channel_phase_deg": (phase_deg * is_phase_seen).reshape(pairs),
        },
        errors={"channel_gain_db": gain_error_db, "channel_phase_deg": phase_error_deg},
    )


def _strong_cells(evidence: SignalEvidence) -> np.ndarray:
    """Strong static range bins (cell, antenna), averaged over frames, in order of range."""
    still = evidence.mean_still
    power = (np.abs(still) ** 2).mean(axis=1)
    limit = OVER_NOISE * float(np.median(evidence.noise)) if evidence.has_doppler else float(np.median(power))
    return still[(power > limit) & (evidence.range_m > NEAREST_M) & evidence.in_window]


def _places(config: RadarConfig) -> np.ndarray:
    """x and z of the antennas in wavelengths, (antenna, 2)."""
    return config.antenna_position_m[:, [0, 2]] / config.wavelength_m


def _free_phases(config: RadarConfig) -> int:
    """Number of antenna phases that no direction can explain."""
    places = _places(config)
    return len(places) - int(np.linalg.matrix_rank(np.column_stack([np.ones(len(places)), places]), tol=0.05))


def _steering(config: RadarConfig) -> np.ndarray:
    """Steering vectors (direction, antenna) of plane waves."""
    places = _places(config)
    heights = HEIGHTS if np.ptp(places[:, 1]) > 0.05 else np.zeros(1)
    sines = SINES if np.ptp(places[:, 0]) > 0.05 else np.zeros(1)
    directions = np.stack(np.meshgrid(sines, heights, indexing="ij"), -1).reshape(-1, 2)
    return np.exp(-2j * np.pi * directions @ places.T)


def _channel_errors(cells: np.ndarray, steering: np.ndarray, config: RadarConfig) -> tuple[np.ndarray, float]:
    """Factors (antenna,) with geometric mean 1 and no linear phase, and the median share of the best plane wave."""
    values = cells / np.sqrt((np.abs(cells) ** 2).mean(axis=1, keepdims=True))
    factor = np.ones(values.shape[1], complex)
    share = np.zeros(len(values))
    for _ in range(ROUNDS):
        corrected = values / factor
        beams = corrected @ steering.conj().T / values.shape[1]
        best = np.abs(beams).argmax(axis=1)
        wave = np.take_along_axis(beams, best[:, None], axis=1) * steering[best]
        share = (np.abs(wave) ** 2).mean(axis=1) / (np.abs(corrected) ** 2).mean(axis=1)
        weight = (1 / (1 - share + 0.05))[:, None]  # inverse residual power
        factor = (weight * values * wave.conj()).sum(axis=0) / (weight * np.abs(wave) ** 2).sum(axis=0)
        factor = _remove_direction(factor, config)
    return factor, float(np.median(share))


def _standard_errors(
    found: np.ndarray, cells: np.ndarray, steering: np.ndarray, config: RadarConfig
) -> tuple[float, float]:
    """Standard errors of gains in dB and phases in degrees, rms over antennas, by a jackknife over blocks of ranges.

    They are dominated by multipath in the cells of one room, so more rooms reduce them but more frames do not.
    Student's t accounts for the small number of blocks, at 68 % coverage.
    """
    kept_cells = [np.arange(len(cells)) * BLOCKS // len(cells) != block for block in range(BLOCKS)]
    change = np.stack([_channel_errors(cells[kept], steering, config)[0] for kept in kept_cells]) / found
    parts = 20 * np.log10(np.abs(change)), np.degrees(np.angle(change))
    sure = float(student_t.ppf(0.841, BLOCKS - 1))
    gain_db, phase_deg = (sure * float(np.sqrt((BLOCKS - 1) * part.var(axis=0).mean())) for part in parts)
    return gain_db, phase_deg


def _remove_direction(factor: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Normalises factors to geometric mean 1 and removes the phase that is linear in antenna position."""
    design = np.column_stack([np.ones(len(factor)), _places(config)])
    phase = np.angle(factor * np.exp(-1j * np.angle(factor.sum())))
    phase = phase - design @ np.linalg.lstsq(design, phase, rcond=0.05)[0]
    return np.abs(factor) / np.exp(np.log(np.abs(factor)).mean()) * np.exp(1j * phase)
