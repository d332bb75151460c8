"""Differences between two sets of values: medians with bootstrap intervals, effect size, overlap, distance.

References: Künsch, "The jackknife and the bootstrap for general stationary observations", Annals of Statistics 17,
1989 (blocks of frames, since neighbouring frames are correlated); Hedges and Olkin, "Statistical Methods for
Meta-Analysis", 1985 (standardised difference).
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.seeding import stream

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
