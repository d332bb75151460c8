"""What a board does over time: the first chirp of a frame, and the slow drift of its carrier."""

from collections.abc import Sequence

import numpy as np

from mmweaver.calibration.finding import Finding
from mmweaver.comparison.board_features import drift_slopes, first_chirp
from mmweaver.comparison.measured_feature import CannotSeeError
from mmweaver.comparison.signal_evidence import SignalEvidence

SURE = 2.0  # standard errors
NEIGHBOURS = 4.0  # neighbouring range bins share noise, so the fit's error is half of what it is


def fit_first_chirp(evidence: Sequence[SignalEvidence]) -> Finding:
    """Amplitude and phase of a frame's first chirp against later ones."""
    title = "first chirp of a frame"
    percent, mrad, why = [], [], ""
    for one in evidence:
        try:
            amplitude, phase = first_chirp(one)
        except CannotSeeError as error:
            why = str(error)
            continue
        percent += amplitude.tolist()
        mrad += phase.tolist()
    if not percent:
        return Finding(title=title, text=why)
    fields: dict[str, float] = {}
    said = []
    for values, unit, name in (
        (percent, "%", "first_chirp_amplitude_percent"), (mrad, "mrad", "first_chirp_phase_mrad"),
    ):  # fmt: skip
        mean, error = float(np.mean(values)), float(np.std(values) / max(len(values) - 1, 1) ** 0.5)
        said.append(f"{mean:+.2f} {unit}" + (f" (+-{error:.2f})" if len(values) > 1 else ""))
        if abs(mean) > SURE * error:
            fields[name] = round(mean, 4)
    many = f"{len(percent)} frames" if len(percent) > 1 else "1 frame, so its error is not known"
    return Finding(title=title, fields=fields, text=f"{', '.join(said)}; {many}")


def fit_drift(evidence: Sequence[SignalEvidence]) -> Finding:
    """Rms over the frames of the carrier's relative error, from the phase of static cells that grows with range."""
    title = "drift"
    ppm, why = [], ""
    for one in evidence:
        try:
            slope, error = drift_slopes(one)
        except CannotSeeError as cannot:
            why = str(cannot)
            continue
        noise = NEIGHBOURS * float((error**2).mean())
        power = float((slope**2).mean()) - noise
        per_slope = 1e3 * one.cube.config.wavelength_m / (4 * np.pi)  # ppm of a mrad a metre
        if power < noise:
            why = f"at most {per_slope * noise**0.5:.2g} ppm over {len(slope)} frames"
        else:
            ppm.append(per_slope * power**0.5)
    if not ppm:
        return Finding(title=title, text=why)
    return Finding(
        title=title, fields={"drift_ppm": round(float(np.median(ppm)), 4)}, text=f"{np.median(ppm):.2g} ppm rms"
    )
