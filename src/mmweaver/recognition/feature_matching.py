"""Features of recordings compared with those of generated windows, without labels: quantiles, matching, distances.

Matching maps each feature of recorded windows monotonically, so that its distribution becomes the generated one. It
presumes that the unlabelled recordings hold about the same mixture of activities as was generated.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

QUANTILES = np.concatenate([[0.005, 0.02], np.linspace(0.05, 0.95, 19), [0.98, 0.995]])
FEWEST = 20  # known values for a distribution
FAR = 0.5  # Kolmogorov-Smirnov distance above which a feature lies elsewhere
MOST_FAR, MOST_OUTSIDE = 0.25, 0.3  # shares of features and of windows above which a warning is due

Features = Float[np.ndarray, "window feature"]
Quantiles = Float[np.ndarray, "quantile feature"]


def quantiles_of(features: Features) -> Quantiles:
    """Quantiles of the known values of each feature; nan with too few."""
    columns = [column[np.isfinite(column)] for column in features.T]
    none = np.full(len(QUANTILES), np.nan)
    return np.stack(
        [np.quantile(column, QUANTILES) if len(column) >= FEWEST else none for column in columns], axis=1
    ).astype(np.float32)


@dataclass(frozen=True, kw_only=True, eq=False)
class FeatureMatching:
    """Quantiles of recorded and of generated windows."""

    recorded: Quantiles
    generated: Quantiles

    def apply(self, features: Features) -> Features:
        """Recorded features as if they were generated; unknown values and unknown distributions stay."""
        matched = features.copy()
        for column in range(features.shape[1]):
            have, want = self.recorded[:, column], self.generated[:, column]
            if np.isnan(have).any() or np.isnan(want).any() or np.ptp(have) <= 0:
                continue
            values = features[:, column]
            known = np.isfinite(values)
            step = np.arange(len(have)) * 1e-9 * max(float(np.ptp(have)), 1e-9)  # interp needs rising places
            moved = np.interp(values[known], have + step, want)
            beyond = np.clip(values[known], have[0], have[-1])
            matched[known, column] = moved + (values[known] - beyond)
        return matched


def outside_per_feature(features: Features, generated: Quantiles) -> Float[np.ndarray, " feature"]:
    """The share of the windows that know a feature in which it lies beyond the outer quantiles; nan if none does.

    Of generated windows this is 0.01.
    """
    known = np.isfinite(features) & np.isfinite(generated[0])
    with np.errstate(invalid="ignore"):
        out = ((features < generated[0]) | (features > generated[-1])) & known
    return np.where(known.any(axis=0), out.sum(axis=0) / np.maximum(known.sum(axis=0), 1), np.nan)


def outside_share(features: Features, generated: Quantiles) -> Float[np.ndarray, " window"]:
    """The share of each window's known features that lie beyond the outer quantiles of generated windows."""
    known = np.isfinite(features) & np.isfinite(generated[0])
    with np.errstate(invalid="ignore"):
        out = (features < generated[0]) | (features > generated[-1])
    return (out & known).sum(axis=1) / np.maximum(known.sum(axis=1), 1)


def feature_distances(features: Features, generated: Quantiles, names: tuple[str, ...]) -> dict[str, float]:
    """Kolmogorov-Smirnov distance of each feature between recorded and generated windows, at the stored quantiles."""
    found: dict[str, float] = {}
    for column, name in enumerate(names):
        values, edges = features[:, column], generated[:, column]
        values = values[np.isfinite(values)]
        if len(values) < FEWEST or np.isnan(edges).any():
            continue
        below = np.searchsorted(np.sort(values), edges, side="right") / len(values)
        under = np.searchsorted(np.sort(values), edges, side="left") / len(values)
        # where a value is frequent, any share between the two agrees
        gap = np.maximum(np.maximum(under - QUANTILES, QUANTILES - below), 0.0)
        found[name] = float(gap.max())
    return found
