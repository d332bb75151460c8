"""Extremely randomised trees as plain arrays: trained by scikit-learn, stored without pickles, evaluated by NumPy.

Reference: Geurts, Ernst and Wehenkel, "Extremely randomized trees", Machine Learning 63, 2006.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.safe_arrays import read_npz

MAX_NODES = 50_000_000
Features = Float[np.ndarray, "window feature"]


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeEnsemble:
    """All nodes of all trees in one array; leaves point to themselves. Votes are shares of the training windows."""

    root: Int[np.ndarray, " tree"]
    left: Int[np.ndarray, " node"]
    right: Int[np.ndarray, " node"]
    feature: Int[np.ndarray, " node"]
    threshold: Float[np.ndarray, " node"]
    unknown_left: Int[np.ndarray, " node"]  # 1 where an unknown value (nan) goes left
    votes: Float[np.ndarray, "node activity"]

    def probabilities(self, features: Features) -> Float[np.ndarray, "window activity"]:
        """Mean vote of all trees.

        Args:
            features: Features (window, feature), nan where unknown.

        Returns:
            Votes (window, activity).
        """
        features = np.asarray(features, np.float32)
        rows = np.arange(len(features))[:, None]
        node = np.broadcast_to(self.root, (len(features), len(self.root))).copy()
        while True:
            value = features[rows, self.feature[node]]
            goes_left = np.where(np.isnan(value), self.unknown_left[node] == 1, value <= self.threshold[node])
            following = np.where(goes_left, self.left[node], self.right[node])
            if np.array_equal(following, node):
                break
            node = following
        return self.votes[node].mean(axis=1, dtype=np.float64)


def grow_trees(
    features: Features,
    labels: Int[np.ndarray, " window"],
    weights: Float[np.ndarray, " window"],
    classes: int,
    *,
    trees: int,
    leaf_size: int,
    feature_share: float,
    seed: int,
) -> tuple[TreeEnsemble, Float[np.ndarray, " feature"]]:
    """Grows extremely randomised trees.

    Args:
        features: Features (window, feature), nan where unknown.
        labels: Labels (window,).
        weights: Weights (window,).
        classes: Number of labels.
        trees: Number of trees.
        leaf_size: Minimum number of windows per leaf.
        feature_share: Share of the features considered at each split.
        seed: Random seed.

    Returns:
        The trees, and the importance (feature,) of each feature: the impurity that its splits remove.

    Raises:
        InputError: If scikit-learn is missing.
    """
    need("evaluate", "training a recogniser", "sklearn")
    from sklearn.ensemble import ExtraTreesClassifier

    grown = ExtraTreesClassifier(
        trees, min_samples_leaf=leaf_size, max_features=feature_share, n_jobs=1, random_state=seed
    ).fit(features, labels, sample_weight=weights)
    parts = [tree.tree_ for tree in grown.estimators_]
    root = np.cumsum([0, *(part.node_count for part in parts)])[:-1]

    def nodes(name: str) -> np.ndarray:
        return np.concatenate([getattr(part, name) for part in parts])

    own = np.arange(sum(part.node_count for part in parts))
    start = np.repeat(root, [part.node_count for part in parts])
    left, right = (
        np.where(child < 0, own, child + start) for child in (nodes("children_left"), nodes("children_right"))
    )
    votes = nodes("value")[:, 0]
    whole = np.zeros((len(votes), classes), np.float32)
    whole[:, grown.classes_] = votes / votes.sum(axis=1, keepdims=True)
    is_leaf = left == own
    ensemble = TreeEnsemble(
        root=root,
        left=left.astype(np.int32),
        right=right.astype(np.int32),
        feature=np.where(is_leaf, 0, nodes("feature")).astype(np.int16),
        threshold=np.where(is_leaf, 0.0, nodes("threshold")),
        unknown_left=nodes("missing_go_to_left").astype(np.int8),
        votes=np.where(is_leaf[:, None], whole, 0.0).astype(np.float16),
    )
    return ensemble, grown.feature_importances_


def joined_trees(one: TreeEnsemble, other: TreeEnsemble | None) -> TreeEnsemble:
    """The trees of both ensembles, with equal votes."""
    if other is None:
        return one
    start = len(one.left)
    moved = replace(other, root=other.root + start, left=other.left + start, right=other.right + start)
    return TreeEnsemble(**{name: np.concatenate([array, vars(moved)[name]]) for name, array in vars(one).items()})


def write_trees(file: Path, ensemble: TreeEnsemble) -> None:
    """Writes the arrays of an ensemble.

    Args:
        file: The .npz.
        ensemble: The trees.
    """
    with atomic_file(file) as temporary, temporary.open("wb") as stream:
        np.savez_compressed(stream, **vars(ensemble))


def read_trees(file: Path, features: int, classes: int) -> TreeEnsemble:
    """Reads the file of `write_trees`.

    Args:
        file: The file.
        features: Number of features.
        classes: Number of labels.

    Raises:
        InputError: If the arrays are not trees over that many features and labels.
    """
    held = read_npz(file)
    nodes = len(held.take("left"))
    if not 0 < nodes <= MAX_NODES:
        raise InputError(f"{file} holds {nodes} nodes; train the recogniser again")

    def numbers(name: str, most: int) -> np.ndarray:
        return held.numbers(name, ("node",), kinds="iu", low=0, high=most)

    found = TreeEnsemble(
        root=held.numbers("root", ("tree",), kinds="iu", low=0, high=nodes - 1),
        left=numbers("left", nodes - 1),
        right=numbers("right", nodes - 1),
        feature=numbers("feature", features - 1),
        threshold=held.numbers("threshold", ("node",)),
        unknown_left=numbers("unknown_left", 1),
        votes=held.numbers("votes", ("node", classes), low=0, high=1),
    )
    # children follow their parents, so every descent ends
    here = np.arange(nodes)
    if (found.left < here).any() or (found.right < here).any():
        raise InputError(f"{file} holds trees that lead back to themselves; train the recogniser again")
    if ((found.left == here) != (found.right == here)).any():
        raise InputError(f"{file} holds nodes with one child; train the recogniser again")
    return found
