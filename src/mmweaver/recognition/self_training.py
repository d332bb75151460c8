"""Self-training with a guard: confident labels of unlabelled windows join the generated ones, if nothing collapses.

Reference: docs/decisions/recogniser-adaptation.md.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, trees_of, with_recorded
from mmweaver.recognition.tree_ensemble import TreeEnsemble

CONFIDENT_SHARE = 0.6  # of the windows given to each label, those with the highest votes
WITH_NEIGHBOURS = 0.8  # the same, where the windows before and after vote along
REAL_WEIGHT = 1.0  # of a label's pseudo-labelled windows relative to its others
LEAST_SHARE, MOST_CHANGED = 0.2, 0.35  # the guard: of a label's fair share of windows; of labels that change


def self_trained(
    made: TrainingWindows, features: Float[np.ndarray, "window feature"], trees: TreeEnsemble,
    options: TrainingOptions, follows: Bool[np.ndarray, " window"] | None = None,
) -> tuple[TreeEnsemble, dict[str, Any]]:  # fmt: skip
    """The trees to use, and what was done: the same trees where the guard refuses.

    `features` (window, feature) of unlabelled windows. `follows`, as `following` gives it: where people go on
    with what they do, windows before and after vote along for a label. The guard asks that no label all but vanishes,
    and that most labels stay as they were.
    """
    votes, share = trees.probabilities(features), CONFIDENT_SHARE
    if follows is not None:
        votes, share = with_neighbours(votes, follows), WITH_NEIGHBOURS
    guess, classes = votes.argmax(axis=1), votes.shape[1]
    kept = np.zeros(len(guess), bool)
    for label in range(classes):
        own = np.flatnonzero(guess == label)
        kept[own[np.argsort(-votes[own, label])][: int(np.ceil(share * len(own)))]] = True
    note: dict[str, Any] = {"windows": int(kept.sum()), "used": False}
    count = np.bincount(guess[kept], minlength=classes)
    if count.min() < LEAST_SHARE * kept.sum() / classes:
        return trees, note | {"why": "a label is hardly ever given to the unlabelled windows"}
    again = trees_of(with_recorded(made, features[kept], guess[kept], REAL_WEIGHT), options)
    new = again.probabilities(features).argmax(axis=1)
    changed = float((new != guess).mean())
    note["labels_changed"] = round(changed, 4)
    if changed > MOST_CHANGED or np.bincount(new, minlength=classes).min() < LEAST_SHARE * len(new) / classes:
        return trees, note | {"why": "too many labels would change"}
    return again, note | {"used": True}


def following(windows: Sequence[PointRecording]) -> Bool[np.ndarray, " window"]:
    """Whether a window begins where the one before it in the list ends, in the same recording."""
    found = np.zeros(len(windows), bool)
    found[1:] = [
        one.name == after.name and after.first_frame == one.first_frame + one.num_frames
        for one, after in pairwise(windows)
    ]
    return found


def with_neighbours(
    votes: Float[np.ndarray, "window label"], follows: Bool[np.ndarray, " window"]
) -> Float[np.ndarray, "window label"]:
    """The mean vote of each window, the one before it and the one after it, where they follow each other."""
    total, count = votes.copy(), np.ones(len(votes))
    after = np.flatnonzero(follows)
    for here, there in ((after, after - 1), (after - 1, after)):
        total[here] += votes[there]
        count[here] += 1
    return total / count[:, None]
