"""Temporal errors of a board: the first chirp of a frame, and slow drift of the carrier."""

from collections.abc import Sequence

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.evaluation.board_features import drift_slopes, first_chirp
from mmweaver.evaluation.finding import Finding, measured, signal_fit
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence
from mmweaver.propagation.board_effects import DRIFT_PERIODS_S, BoardEffects

SURE = 2.0  # standard errors
NEIGHBOURS = 4.0  # neighbouring range bins share noise, so the fit underestimates its error by half
PHASES = 300  # random phases of simulated drift, to estimate how much of it a short recording shows
ONE_SIGMA, RARELY_LESS = (0.16, 0.84), 0.1  # quantiles over these phases


@signal_fit("first chirp of a frame")
def fit_first_chirp(evidence: Sequence[SignalEvidence]) -> Finding:
    """Estimates amplitude and phase of a frame's first chirp relative to later ones.

    Args:
        evidence: Recordings with raw samples.

    Returns:
        `first_chirp_amplitude_percent` and `first_chirp_phase_mrad` if they are significant.

    Raises:
        CannotSeeError: As in `first_chirp`.
    """
    percent, mrad = (np.concatenate(parts) for parts in zip(*measured(evidence, first_chirp), strict=True))
    fields: dict[str, float] = {}
    parts = []
    for values, unit, name in (
        (percent, "%", "first_chirp_amplitude_percent"),
        (mrad, "mrad", "first_chirp_phase_mrad"),
    ):
        mean, error = float(np.mean(values)), float(np.std(values) / max(len(values) - 1, 1) ** 0.5)
        parts.append(f"{mean:+.2f} {unit}" + (f" (+-{error:.2f})" if len(values) > 1 else ""))
        if abs(mean) > SURE * error:
            fields[name] = round(mean, 4)
    many = f"{len(percent)} frames" if len(percent) > 1 else "1 frame, so its error is not known"
    return Finding(fields=fields, text=f"{', '.join(parts)}; {many}")


@signal_fit("drift")
def fit_drift(evidence: Sequence[SignalEvidence]) -> Finding:
    """Estimates the relative carrier error, rms over time, from the phase slope of static cells over range.

    A recording shows how a slow error varies within its own length, which is less than the long-term rms. The ratio is
    estimated from simulated drift with many random phases.

    Args:
        evidence: Recordings.

    Returns:
        `drift_ppm` with its standard error; the median over recordings.

    Raises:
        CannotSeeError: If drift does not exceed noise in any recording; the message states the upper limit.
    """
    found = measured(evidence, _drift)
    ppm, low_ppm, high_ppm, own_ppm, seconds = sorted(found)[len(found) // 2]
    periods = f"{DRIFT_PERIODS_S[0]:.0f} to {DRIFT_PERIODS_S[-1]:.0f} s"
    return Finding(
        fields={"drift_ppm": round(ppm, 4)},
        errors={"drift_ppm": (high_ppm - low_ppm) / 2},
        text=f"{own_ppm:.2g} ppm rms within {seconds}, which is {ppm:.2g} ppm ({low_ppm:.2g} to {high_ppm:.2g}) over"
        f" longer times if its waves last {periods}, as simulated ones do",
    )


def _drift(evidence: SignalEvidence) -> tuple[float, float, float, float, str]:
    """Long-term rms with its limits and rms within the recording, all in ppm, and the recording's length."""
    slope, error = drift_slopes(evidence)
    config = evidence.cube.config
    per_slope = 1e3 * config.wavelength_m / (4 * np.pi)  # ppm per mrad/m
    whole, noise = float((slope**2).mean()), NEIGHBOURS * float((error**2).mean())
    whole_ppm, shown = per_slope * whole**0.5, _shown_drift(config, len(slope))
    seconds = f"{len(slope) * config.frame_period_s:.2g} s"
    if whole < 2 * noise:
        longer_ppm = whole_ppm / np.quantile(shown, RARELY_LESS)
        raise CannotSeeError(
            f"at most {whole_ppm:.2g} ppm rms within these {seconds}, {longer_ppm:.2g} ppm over longer times"
        )
    own_ppm = per_slope * (whole - noise) ** 0.5
    least, middle, most = np.quantile(shown, (ONE_SIGMA[0], 0.5, ONE_SIGMA[1]))
    return own_ppm / middle, own_ppm / most, whole_ppm / least, own_ppm, seconds


def _shown_drift(config: RadarConfig, frames: int) -> np.ndarray:
    """Rms within some frames of drifts with 1 ppm long-term rms, means removed, (phase,) in ppm."""
    effects = BoardEffects(Board(drift_ppm=1.0), config)
    return np.array([1e6 * effects.drift(np.arange(frames), seed).std() for seed in range(PHASES)])
