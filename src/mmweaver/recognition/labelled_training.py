"""Labelled recordings train along: they join what was generated, and grow a share of the trees by themselves.

Decisions 270 and 281.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.scoring import balanced_accuracy
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, trees_of
from mmweaver.recognition.tree_ensemble import TreeEnsemble

MOST_WORTH = 3.0  # recordings of every activity that generated people are worth, where they recognise all of these
LEAST_KNOWN = 0.1  # of the way from chance to all
ASKED_TREES = 100


def fewest_recordings(windows: Sequence[PointRecording], labels: Sequence[str]) -> int:
    """Recordings of the activity that has fewest, by the names of their windows."""
    count = Counter(label for label, _ in {(window.label, window.name) for window in windows})
    return min(count[label] for label in labels)


def own_trees(
    made: TrainingWindows, features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"],
    fewest: int, options: TrainingOptions,
) -> tuple[TreeEnsemble | None, TrainingOptions]:  # fmt: skip
    """Trees on labelled windows alone, None where an activity has none, and the options of all other trees.

    Their share is fewest / (fewest + worth), `fewest` being the recordings of the activity that has fewest, and `worth`
    how many recordings what was generated is worth.
    """
    if fewest == 0:
        return None, options
    votes = trees_of(made, options, num_trees=min(ASKED_TREES, options.trees)).probabilities(features)
    share = fewest / (fewest + generated_worth(votes, labels))
    count = min(max(round(options.trees * share), 1), options.trees - 1)
    own = trees_of(labelled_alone(made, features, labels), replace(options, trees=count))
    return own, replace(options, trees=options.trees - count)


def generated_worth(votes: Float[np.ndarray, "other label"], labels: Int[np.ndarray, " other"]) -> float:
    """How many recordings of every activity generated people are worth, by their votes for labelled windows."""
    chance = 1 / votes.shape[1]
    known = (balanced_accuracy(labels, votes.argmax(axis=1)) - chance) / (1 - chance)
    return MOST_WORTH * max(known, LEAST_KNOWN)


def labelled_alone(
    made: TrainingWindows, features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"]
) -> TrainingWindows:
    """Labelled windows as if they were the only ones that train."""
    whole, nobody = np.zeros(len(labels), bool), np.zeros(len(labels), int)
    return replace(made, features=features, label=labels, person=nobody, is_copy=whole, importance=None)
