"""Labelled recordings train along: they join what was generated, and grow a share of the trees by themselves.

Reference: docs/decisions/recogniser-adaptation.md.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.seeding import stream
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.scoring import balanced_accuracy
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, trees_of, weighed_trees_of
from mmweaver.recognition.tree_ensemble import TreeEnsemble, joined_trees

MOST_WORTH = 3.0  # recordings of every activity that generated people are worth, where they recognise all of these
LEAST_KNOWN = 0.1  # of the way from chance to all
ASKED_TREES = 100
OWN_LEAF = 1  # windows; labelled ones are few, and none is wrong
GUIDED = 5.0  # recordings with which half of the trees on labelled windows look at drawn features
TREES_A_DRAW = 5


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
    how many recordings what was generated is worth. The fewer, the more of them look at the features that tell
    generated people's activities apart.
    """
    if fewest == 0:
        return None, options
    asked, importance = weighed_trees_of(made, replace(options, trees=min(ASKED_TREES, options.trees)))
    worth = generated_worth(asked.probabilities(features), labels)
    count = min(max(round(options.trees * fewest / (fewest + worth)), 1), options.trees - 1)
    alone = labelled_alone(made, features, labels)
    own = replace(options, leaf_size=OWN_LEAF)
    guided = round(count * GUIDED / (fewest + GUIDED))
    trees = trees_of(alone, replace(own, trees=count - guided)) if guided < count else None
    for first in range(0, guided, TREES_A_DRAW):
        share = replace(own, trees=min(TREES_A_DRAW, guided - first), seed=options.seed + first + 1)
        trees = joined_trees(_on_drawn(alone, importance, share), trees)
    return trees, replace(options, trees=options.trees - count)


def _on_drawn(
    alone: TrainingWindows, importance: Float[np.ndarray, " feature"], options: TrainingOptions
) -> TreeEnsemble:
    """Trees on as many features as there are, drawn by importance, with replacement."""
    count = len(importance)
    drawn = stream(options.seed, "features drawn").choice(count, size=count, p=importance / importance.sum())
    trees = trees_of(replace(alone, features=alone.features[:, drawn]), options)
    return replace(trees, feature=drawn[trees.feature].astype(trees.feature.dtype))


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
