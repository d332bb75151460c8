"""Labelled recordings train along: they join what was generated, and grow a share of the trees by themselves.

Decision 270.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.tree_ensemble import TreeEnsemble, grow_trees

if TYPE_CHECKING:
    from mmweaver.recognition.train_recogniser import GeneratedWindows, TrainingOptions

HALF_AT = 4.0  # recordings of every activity with which they grow half of the trees by themselves


def fewest_recordings(windows: Sequence[PointRecording], labels: Sequence[str]) -> int:
    """Recordings of the activity that has fewest, by the names of their windows."""
    count = Counter(label for label, _ in {(window.label, window.name) for window in windows})
    return min(count[label] for label in labels)


def own_trees(
    made: "GeneratedWindows", features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"],
    fewest: int, options: "TrainingOptions",
) -> tuple[TreeEnsemble | None, "TrainingOptions"]:  # fmt: skip
    """Trees on labelled windows alone, None where an activity has none, and the options of all other trees.

    Their share is fewest / (fewest + HALF_AT), `fewest` being the recordings of the activity that has fewest.
    """
    count = round(options.trees * fewest / (fewest + HALF_AT))
    if count == 0:
        return None, options
    alone = labelled_alone(made, features, labels)
    own = grow_trees(
        alone.features, alone.label, alone.weights, int(made.label.max()) + 1, trees=count,
        leaf_size=options.leaf_size, feature_share=options.feature_share, seed=options.seed,
    )  # fmt: skip
    return own, replace(options, trees=options.trees - count)


def with_labelled(
    made: "GeneratedWindows", features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"],
    options: "TrainingOptions",
) -> "GeneratedWindows":  # fmt: skip
    """The generated windows and labelled recorded ones, which weigh `labelled_weight` times as much in each label."""
    own = np.ones(len(made.label)) if made.importance is None else made.importance
    classes = int(made.label.max()) + 1
    of_made, of_real = np.bincount(made.label, own, classes), np.bincount(labels, minlength=classes)
    weight = options.labelled_weight * of_made[labels] / of_real[labels]
    return replace(
        made, features=np.concatenate([made.features, features]), label=np.concatenate([made.label, labels]),
        person=np.concatenate([made.person, np.full(len(labels), -1)]),
        is_copy=np.concatenate([made.is_copy, np.zeros(len(labels), bool)]), importance=np.concatenate([own, weight]),
    )  # fmt: skip


def labelled_alone(
    made: "GeneratedWindows", features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"]
) -> "GeneratedWindows":
    """Labelled windows as if they were the only ones that train."""
    whole, nobody = np.zeros(len(labels), bool), np.zeros(len(labels), int)
    return replace(made, features=features, label=labels, person=nobody, is_copy=whole, importance=None)
