"""Self-training with a guard: confident labels of unlabelled windows join the generated ones, if nothing collapses."""

from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from mmweaver.recognition.tree_ensemble import TreeEnsemble, grow_trees

if TYPE_CHECKING:
    from mmweaver.recognition.train_recogniser import GeneratedWindows, TrainingOptions

CONFIDENT_SHARE = 0.6  # of the windows given to each label, those with the highest votes
REAL_WEIGHT = 1.0  # of all pseudo-labelled windows relative to all generated ones
LEAST_SHARE, MOST_CHANGED = 0.2, 0.35  # the guard: of a label's fair share of windows; of labels that change


def self_trained(
    made: "GeneratedWindows", features: Float[np.ndarray, "window feature"], trees: TreeEnsemble,
    options: "TrainingOptions",
) -> tuple[TreeEnsemble, dict[str, Any]]:  # fmt: skip
    """The trees to use, and what was done: the same trees where the guard refuses.

    `features` (window, feature) of unlabelled windows, matched. The guard asks that no label all but vanishes, and
    that most labels stay as they were.
    """
    votes = trees.probabilities(features)
    guess, classes = votes.argmax(axis=1), votes.shape[1]
    kept = np.zeros(len(guess), bool)
    for label in range(classes):
        own = np.flatnonzero(guess == label)
        kept[own[np.argsort(-votes[own, label])][: int(np.ceil(CONFIDENT_SHARE * len(own)))]] = True
    note: dict[str, Any] = {"windows": int(kept.sum()), "used": False}
    count = np.bincount(guess[kept], minlength=classes)
    if count.min() < LEAST_SHARE * kept.sum() / classes:
        return trees, note | {"why": "a label is hardly ever given to the unlabelled windows"}
    weight = 1.0 / count[guess[kept]] * kept.sum()
    weight *= REAL_WEIGHT * made.weights.sum() / weight.sum()
    again = grow_trees(
        np.concatenate([made.features, features[kept]]), np.concatenate([made.label, guess[kept]]),
        np.concatenate([made.weights, weight]), classes, trees=options.trees, leaf_size=options.leaf_size,
        feature_share=options.feature_share, seed=options.seed,
    )  # fmt: skip
    new = again.probabilities(features).argmax(axis=1)
    changed = float((new != guess).mean())
    note["labels_changed"] = round(changed, 4)
    if changed > MOST_CHANGED or np.bincount(new, minlength=classes).min() < LEAST_SHARE * len(new) / classes:
        return trees, note | {"why": "too many labels would change"}
    return again, note | {"used": True}
