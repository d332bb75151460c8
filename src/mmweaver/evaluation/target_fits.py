"""Range bias and gain from an echo at a known distance: a corner reflector, a metal plate, a wall straight ahead.

The strongest static echo near the stated distance is taken as the target. Its sub-bin position follows from the known
response of the Hann window; its power is compared with the radar equation. Reference: docs/radar_primer.md, equation
10.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.evaluation.finding import Finding, measured
from mmweaver.evaluation.receiver_fits import noise_unit
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence, decibels
from mmweaver.propagation.antenna import scatterer_gain

REACH_M = 0.4  # upper limit of the range bias
NEAREST_M = 0.3  # nearer echoes are covered by leakage
OVER_OTHERS = 10.0  # minimum power of the target relative to either side
SIDE_BINS = 4  # distance from the peak at which its own response is low
BIAS_TITLE, GAIN_TITLE = "range bias", "gain of echoes"


@dataclass(frozen=True)
class KnownTarget:
    """A target at boresight.

    Attributes:
        range_m: True distance from the antennas in metres, 0.3 to 100.
        cross_section_dbsm: Radar cross section in dBsm; None if unknown.

    Raises:
        InputError: If a value is out of range.
    """

    range_m: float
    cross_section_dbsm: float | None = None

    def __post_init__(self) -> None:
        if not NEAREST_M <= self.range_m <= 100:
            raise InputError(f"a target must be {NEAREST_M:g} to 100 m away, not {self.range_m:g} m")
        if self.cross_section_dbsm is not None and not -60 <= self.cross_section_dbsm <= 60:
            raise InputError(f"a cross section must lie within -60 to 60 dBsm, not {self.cross_section_dbsm:g}")


def unknown_targets() -> list[Finding]:
    """Findings if no target is known."""
    return [
        Finding(title=BIAS_TITLE, text="it takes an echo at a known distance (--target)"),
        Finding(title=GAIN_TITLE, text="it takes an echo of known cross section at a known distance (--target)"),
    ]


def fit_target(evidence: Sequence[SignalEvidence], target: KnownTarget) -> list[Finding]:
    """Estimates range bias and gain from a known target.

    Args:
        evidence: Recordings, of which the first one that shows the target is used.
        target: Distance and cross section.

    Returns:
        Findings of `range_bias_m` and `gain_db`, or why they cannot be determined.
    """
    try:
        return measured(evidence, lambda one: _fit(one, target))[0]
    except CannotSeeError as reason:
        return [Finding(title=title, text=str(reason)) for title in (BIAS_TITLE, GAIN_TITLE)]


def _fit(evidence: SignalEvidence, target: KnownTarget) -> list[Finding]:
    config, range_m = evidence.cube.config, evidence.range_m
    near = np.abs(range_m - target.range_m) <= REACH_M
    if not near.any():
        raise CannotSeeError(f"the range window does not hold {target.range_m:g} m")
    power = (np.abs(evidence.still[~evidence.is_lost]) ** 2).mean(axis=0)  # (range, antenna)
    mean = power.mean(axis=1)
    at = int(np.flatnonzero(near)[mean[near].argmax()])
    outer = [mean[k] for k in (at - SIDE_BINS, at + SIDE_BINS) if 0 <= k < len(mean)]
    if not 0 < at < len(mean) - 1 or mean[at] < OVER_OTHERS * max(outer):
        raise CannotSeeError(f"no echo stands out within {REACH_M:g} m of {target.range_m:g} m")
    step_m = config.range_resolution_m
    offsets = _bin_offsets(power[at - 1 : at + 2])  # per antenna, in bins
    found_m = range_m[at] + float(np.mean(offsets)) * step_m
    bias_m, error_m = found_m - target.range_m, float(np.std(offsets) / np.sqrt(len(offsets))) * step_m
    text = f"{100 * bias_m:+.1f} cm (+-{100 * error_m:.1f}): an echo from {target.range_m:g} m is at {found_m:.3f} m"
    bias = Finding(title=BIAS_TITLE, text=text, fields={"range_bias_m": round(bias_m, 4)})
    if target.cross_section_dbsm is None:
        return [bias, Finding(title=GAIN_TITLE, text="the target's cross section is not known (--target RANGE,DBSM)")]
    unit = noise_unit(evidence)
    peak = mean[at] / _hann_response(float(np.mean(offsets))) ** 2 * unit**2
    wanted = scatterer_gain(config) ** 2 * 10 ** (target.cross_section_dbsm / 10) / target.range_m**4
    gain_db = float(decibels(peak / wanted))
    scale = "" if np.isfinite(evidence.cube.scale) else ", if its noise is that of the radar's noise figure"
    gain = Finding(
        title=GAIN_TITLE,
        fields={"gain_db": round(gain_db, 2)},
        text=f"{gain_db:+.1f} dB over what {config.tx_power_dbm:g} dBm and antennas of {config.antenna_gain_dbi:g} dBi"
        f" give{scale}; a target that is not in the middle of the view looks weaker",
    )
    return [bias, gain]


def _hann_response(offset: float) -> float:
    """Relative amplitude of a Hann-windowed tone at a fractional bin offset."""
    return float(np.sinc(offset) / max(1 - offset**2, 1e-9))


def _bin_offsets(power: np.ndarray) -> np.ndarray:
    """Fractional offsets (antenna,) of tones from the centre bin, from power (3, antenna) under a Hann window."""
    before, middle, after = np.sqrt(power)
    # a Hann window's main lobe: neighbour over peak = (1 + d) / (2 - d) for a tone d bins towards it
    ahead = after >= before
    ratio = np.where(ahead, after, before) / np.maximum(middle, 1e-300)
    offset = np.clip((2 * ratio - 1) / (1 + ratio), 0.0, 0.5)
    return np.where(ahead, offset, -offset)
