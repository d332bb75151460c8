"""Activity classifier: the averaged votes of two kinds of tree ensembles on window features."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need

Features = Float[np.ndarray, "window feature"]


@dataclass(frozen=True, kw_only=True)
class ClassifierSettings:
    """Hyperparameters of the trees; equal settings, seed and data give equal trees."""

    num_trees: int = 400
    leaf_size: int = 3
    feature_share: float = 0.25
    boosting_rounds: int = 150
    learning_rate: float = 0.08
    leaves: int = 15
    repetitions: int = 1  # ensembles of both kinds with different seeds, averaged
    seed: int = 0


class ActivityClassifier:
    """Extremely randomised trees and gradient boosting. `classes` are the labels in the order of the columns.

    `names`: the window features it uses; None = all.
    """

    def __init__(self, settings: ClassifierSettings | None = None, names: tuple[str, ...] | None = None):
        self.settings = settings or ClassifierSettings()
        self.names = names
        self.classes: tuple[str, ...] = ()
        self._models: list[Any] = []
        self._used = np.zeros(0, bool)

    def fit(self, features: Features, labels: np.ndarray, weights: np.ndarray | None = None) -> "ActivityClassifier":
        """Fits on features (window, feature), nan = unknown; weights (window,) default to 1. Returns itself.

        Raises InputError where scikit-learn is missing.
        """
        need("evaluate", "this recogniser", "sklearn")
        from sklearn.ensemble import ExtraTreesClassifier, HistGradientBoostingClassifier

        chosen = self.settings
        shared: dict[str, Any] = {"max_features": chosen.feature_share, "class_weight": "balanced"}
        grown: dict[str, Any] = {"min_samples_leaf": chosen.leaf_size, "n_jobs": 1}
        boosted: dict[str, Any] = {"max_leaf_nodes": chosen.leaves, "early_stopping": False}
        self._models = []
        for seed in range(chosen.seed, chosen.seed + chosen.repetitions):
            self._models += [
                ExtraTreesClassifier(chosen.num_trees, random_state=seed, **grown, **shared),
                HistGradientBoostingClassifier(
                    max_iter=chosen.boosting_rounds, learning_rate=chosen.learning_rate, random_state=seed, **boosted,
                    **shared,
                ),
            ]  # fmt: skip
        self._used = _informative_columns(features)
        if not self._used.any():
            raise InputError("the features of all windows are identical; is anything detected at all?")
        for model in self._models:
            model.fit(features[:, self._used], labels, sample_weight=weights)
        self.classes = tuple(str(name) for name in self._models[0].classes_)
        return self

    def probabilities(self, features: Features) -> Float[np.ndarray, "window activity"]:
        """Mean vote of all trees of both kinds, (window, activity)."""
        return np.mean([model.predict_proba(features[:, self._used]) for model in self._models], axis=0)

    def predict(self, features: Features) -> np.ndarray:
        """The activity with most votes for each window (window,)."""
        return np.array(self.classes)[np.argmax(self.probabilities(features), axis=1)]


def _informative_columns(features: Features) -> np.ndarray:
    """Columns with more than one finite value; trees cannot use others."""
    filled = [column[np.isfinite(column)] for column in features.T]
    return np.array([len(column) > 0 and bool(np.ptp(column) > 0) for column in filled])
