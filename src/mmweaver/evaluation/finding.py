"""Result of one fit of a board, or why it cannot be determined; fits are registered by a decorator.

Differences between two sets of values: medians with bootstrap intervals, effect size, overlap, distance.

References: Künsch, "The jackknife and the bootstrap for general stationary observations", Annals of Statistics 17,
1989 (blocks of frames, since neighbouring frames are correlated); Hedges and Olkin, "Statistical Methods for
Meta-Analysis", 1985 (standardised difference).

A feature of a signal: one function of the evidence, registered by a decorator.

@feature("noise_level", "noise of a sample", "dBm", tolerance=3.0)
def noise_level(evidence: SignalEvidence) -> FrameValues: ...
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np

from mmweaver.core.seeding import stream
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence


@dataclass(frozen=True)
class FrameValues:
    """One value per frame (or window of frames) in the feature's unit; nan for frames that do not show it."""

    values: np.ndarray
    at_most: bool = False  # upper limits, since most frames show nothing above the noise


Measure = Callable[[SignalEvidence], FrameValues]


@dataclass(frozen=True, kw_only=True)
class Feature:
    """A quantity that can be measured on any recording."""

    name: str
    title: str
    unit: str
    tolerance: float  # typical difference between similar recordings, in `unit`
    definition: str
    measure: Measure  # raises CannotSeeError
    whole_frames: bool  # cannot be measured on quarters of a frame


FEATURES: list[Feature] = []


def feature(
    name: str, title: str, unit: str, tolerance: float, *, definition: str = "", whole_frames: bool = False
) -> Callable[[Measure], Measure]:
    """Decorator that registers a function as a feature of `compare`.

    Args:
        name: Key in comparison.json.
        title: Label in tables.
        unit: Unit of the values.
        tolerance: Typical difference between similar recordings, in `unit`.
        definition: What is measured. Default: first line of the docstring.
        whole_frames: Whether it cannot be measured on quarters of a frame. Default: False.

    Returns:
        A decorator that leaves the function unchanged.
    """

    def register(measure: Measure) -> Measure:
        text = definition or (measure.__doc__ or "").partition("\n")[0]
        FEATURES.append(
            Feature(
                name=name,
                title=title,
                unit=unit,
                tolerance=tolerance,
                definition=text.rstrip("."),
                measure=measure,
                whole_frames=whole_frames,
            )
        )
        return measure

    return register


DRAWS = 1000
MIN_FOR_INTERVAL = 4
INTERVAL = (2.5, 97.5)

Interval = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Spread:
    """Median of a feature over its units, with a 95 % interval and the central 80 % of the units."""

    median: float
    interval_95: Interval | None  # None for fewer than four units
    percentile_10_90: Interval
    units: int


@dataclass(frozen=True, kw_only=True)
class Difference:
    """Difference between B and A."""

    difference: float  # median of B minus median of A, in the feature's unit
    interval_95: Interval | None
    effect_size: float  # difference / (spread of the units combined with the feature's tolerance)
    effect_interval_95: Interval | None
    separable: float | None  # AUC of this feature alone, from 0.5 (none) to 1; None for few units
    wasserstein: float  # 1-Wasserstein distance of the distributions, in the feature's unit


def bootstrap_medians(values: np.ndarray, seed: int, *, in_order: bool) -> np.ndarray:
    """Bootstraps the median.

    Args:
        values: Values, (unit,).
        seed: Seed of the bootstrap.
        in_order: Whether neighbours are correlated, so that blocks of them are sampled.

    Returns:
        Medians of 1000 samples with replacement, (sample,).
    """
    count = len(values)
    block = max(1, round(count ** (1 / 3))) if in_order else 1
    starts = stream(seed, "bootstrap of features").integers(0, count, (DRAWS, -(-count // block)))
    index = (starts[:, :, None] + np.arange(block)).reshape(DRAWS, -1)[:, :count] % count
    return np.median(values[index], axis=1)


def spread_of(values: np.ndarray, *, in_order: bool, seed: int = 0) -> Spread:
    """Computes median, confidence interval and spread of values.

    Args:
        values: Values without nan, (unit,).
        in_order: Whether neighbours are correlated, so that the bootstrap samples blocks.
        seed: Seed of the bootstrap. Default: 0.

    Returns:
        The spread, without an interval for fewer than four values.
    """
    low, high = (float(one) for one in np.percentile(values, (10, 90)))
    interval = None
    if len(values) >= MIN_FOR_INTERVAL:
        interval = _interval(bootstrap_medians(values, seed, in_order=in_order))
    return Spread(
        median=float(np.median(values)), interval_95=interval, percentile_10_90=(low, high), units=len(values)
    )


def difference_of(a: np.ndarray, b: np.ndarray, tolerance: float, *, in_order: bool, seed: int = 0) -> Difference:
    """Computes the difference between two sets of values.

    Args:
        a: Values of A without nan, (unit,).
        b: Values of B without nan, (unit,).
        tolerance: Lower bound of the spread in the feature's unit, so that features with little variation over frames
            do not give infinite effect sizes.
        in_order: Whether neighbours are correlated.
        seed: Seed of the bootstrap. Default: 0.

    Returns:
        Difference, effect size, overlap and distance.
    """
    from scipy.stats import wasserstein_distance

    scale = float(np.sqrt((_variance(a) + _variance(b)) / 2 + tolerance**2))
    gap = float(np.median(b) - np.median(a))
    interval = None
    is_enough = min(len(a), len(b)) >= MIN_FOR_INTERVAL
    if is_enough:
        draws = [bootstrap_medians(one, seed + at, in_order=in_order) for at, one in enumerate((a, b))]
        interval = _interval(draws[1] - draws[0])
    larger = (b[:, None] > a[None, :]).mean() + 0.5 * (b[:, None] == a[None, :]).mean()
    return Difference(
        difference=gap,
        interval_95=interval,
        effect_size=gap / scale,
        effect_interval_95=None if interval is None else (interval[0] / scale, interval[1] / scale),
        separable=float(max(larger, 1 - larger)) if is_enough else None,
        wasserstein=float(wasserstein_distance(a, b)),
    )


def _interval(draws: np.ndarray) -> Interval:
    low, high = np.percentile(draws, INTERVAL)
    return float(low), float(high)


def _variance(values: np.ndarray) -> float:
    """Variance from the interquartile range, robust against single outlier frames."""
    low, high = np.percentile(values, (25, 75))
    return float(((high - low) / 1.349) ** 2)


Measured = TypeVar("Measured")


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Result of a fit.

    Attributes:
        title: Name of the fit.
        text: Result in words, or the reason why it cannot be determined.
        fields: Fields of `Board`; empty if it cannot be determined.
        errors: One standard error per field where it is known, in the field's unit, rms over a table's entries.
    """

    title: str = ""
    text: str
    fields: dict[str, Any] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)

    @property
    def is_found(self) -> bool:
        """Whether the fit determined anything."""
        return bool(self.fields)


Fit = Callable[[Sequence[SignalEvidence]], Finding]
SIGNAL_FITS: list[Fit] = []


def signal_fit(title: str) -> Callable[[Fit], Fit]:
    """Decorator that registers a fit of signals; the text of a CannotSeeError becomes its finding.

    Args:
        title: Title of its findings.

    Returns:
        The decorator.
    """

    def register(fit: Fit) -> Fit:
        @functools.wraps(fit)
        def run(evidence: Sequence[SignalEvidence]) -> Finding:
            try:
                found = fit(evidence)
            except CannotSeeError as reason:
                found = Finding(text=str(reason))
            return replace(found, title=title)

        SIGNAL_FITS.append(run)
        return run

    return register


def measured(evidence: Sequence[SignalEvidence], measure: Callable[[SignalEvidence], Measured]) -> list[Measured]:
    """Measures each recording and skips those that do not show the quantity.

    Args:
        evidence: Recordings.
        measure: Measures one recording.

    Returns:
        Results of the recordings that show it.

    Raises:
        CannotSeeError: If none does.
    """
    found, why = [], CannotSeeError("it takes a signal")
    for one in evidence:
        try:
            found.append(measure(one))
        except CannotSeeError as reason:
            why = reason
    if not found:
        raise why
    return found
