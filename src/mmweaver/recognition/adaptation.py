"""Adaptation to recordings: labelled ones grow a share of the trees, unlabelled ones join the training under a guard.

Reference: docs/decisions/recogniser-adaptation.md.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.seeding import stream
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.scoring import balanced_accuracy
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows
from mmweaver.recognition.tree_ensemble import Features, TreeEnsemble, joined_trees

MAX_WORTH = 3.0  # equivalent recordings per activity of generated people, if they recognise all labelled windows
MIN_KNOWN = 0.1  # lower bound of the accuracy above chance
ASKED_TREES = 100
OWN_LEAF = 1  # windows; labelled ones are few and correct
GUIDED = 5.0  # number of recordings at which half of the trees on labelled windows use sampled features
TREES_PER_SAMPLE = 5

CONFIDENT_SHARE = 0.6  # of the windows given to each label, those with the highest votes
WITH_NEIGHBOURS = 0.8  # the same, where votes are averaged with neighbouring windows
REAL_WEIGHT = 1.0  # of a label's pseudo-labelled windows relative to its others
MIN_SHARE, MAX_CHANGED = 0.2, 0.35  # the guard: minimum of a label's fair share of windows; maximum of changed labels

Votes = Float[np.ndarray, "window label"]
Labels = Int[np.ndarray, " window"]


# labelled recordings ------------------------------------------------------------------------------------------------
def fewest_recordings(windows: Sequence[PointRecording], labels: Sequence[str]) -> int:
    """Number of recordings of the activity with the fewest.

    Args:
        windows: Labelled windows; those of the same name belong to one recording.
        labels: All activities.
    """
    count = Counter(label for label, _ in {(window.label, window.name) for window in windows})
    return min(count[label] for label in labels)


def own_trees(
    made: TrainingWindows, features: Features, labels: Labels, fewest: int, options: TrainingOptions
) -> tuple[TreeEnsemble | None, TrainingOptions]:
    """Trees grown on labelled windows alone.

    Their share is fewest / (fewest + worth), with the number of recordings of the activity that has the fewest, and the
    number of recordings that generated people are worth. The fewer there are, the more of the trees use the features
    that discriminate activities of generated people.

    Args:
        made: Generated windows.
        features: Features (window, feature) of labelled windows.
        labels: Labels (window,) of these.
        fewest: As given by `fewest_recordings`.
        options: Options of all trees.

    Returns:
        The trees, None where an activity has no recording, and the options of all other trees.
    """
    if fewest == 0:
        return None, options
    asked, importance = made.weighed_trees(replace(options, trees=min(ASKED_TREES, options.trees)))
    worth = generated_worth(asked.probabilities(features), labels)
    count = min(max(round(options.trees * fewest / (fewest + worth)), 1), options.trees - 1)
    alone, own = labelled_alone(made, features, labels), replace(options, leaf_size=OWN_LEAF)
    guided = round(count * GUIDED / (fewest + GUIDED))
    trees = alone.trees(replace(own, trees=count - guided)) if guided < count else None
    for first in range(0, guided, TREES_PER_SAMPLE):
        share = replace(own, trees=min(TREES_PER_SAMPLE, guided - first), seed=options.seed + first + 1)
        # as many features as there are, sampled by importance with replacement
        sampled = stream(share.seed, "features drawn").choice(
            len(importance), size=len(importance), p=importance / importance.sum()
        )
        more = replace(alone, features=alone.features[:, sampled]).trees(share)
        trees = joined_trees(replace(more, feature=sampled[more.feature].astype(more.feature.dtype)), trees)
    return trees, replace(options, trees=options.trees - count)


def generated_worth(votes: Votes, labels: Labels) -> float:
    """Number of recordings per activity that generated people are worth, by their accuracy on labelled windows.

    Args:
        votes: Votes (window, label) of trees grown on generated people.
        labels: True labels (window,).
    """
    chance = 1 / votes.shape[1]
    known = (balanced_accuracy(labels, votes.argmax(axis=1)) - chance) / (1 - chance)
    return MAX_WORTH * max(known, MIN_KNOWN)


def labelled_alone(made: TrainingWindows, features: Features, labels: Labels) -> TrainingWindows:
    """Labelled windows as the only training windows.

    Args:
        made: Training windows whose settings are kept.
        features: Features (window, feature) of the labelled windows.
        labels: Their labels (window,).
    """
    whole, nobody = np.zeros(len(labels), bool), np.zeros(len(labels), int)
    return replace(made, features=features, label=labels, person=nobody, is_copy=whole, importance=None)


# unlabelled recordings ----------------------------------------------------------------------------------------------
def self_trained(
    made: TrainingWindows,
    features: Features,
    trees: TreeEnsemble,
    options: TrainingOptions,
    follows: Bool[np.ndarray, " window"] | None = None,
) -> tuple[TreeEnsemble, dict[str, Any]]:
    """Self-training on unlabelled windows.

    Windows with confident labels join the generated ones. The guard requires that no label nearly vanishes, and that
    most labels stay as they were.

    Args:
        made: Generated windows.
        features: Features (window, feature) of unlabelled windows.
        trees: Trees grown on the generated windows.
        options: How trees are grown.
        follows: As given by `following`, where people continue what they do: votes are then averaged with the windows
            before and after.

    Returns:
        The trees to use, unchanged if the guard refuses, and a report.
    """
    votes, share = trees.probabilities(features), CONFIDENT_SHARE
    if follows is not None:
        votes, share = smoothed_votes(votes, follows), WITH_NEIGHBOURS
    guess, classes = votes.argmax(axis=1), votes.shape[1]
    kept = np.zeros(len(guess), bool)
    for label in range(classes):
        own = np.flatnonzero(guess == label)
        kept[own[np.argsort(-votes[own, label])][: int(np.ceil(share * len(own)))]] = True
    note: dict[str, Any] = {"windows": int(kept.sum()), "used": False}
    if np.bincount(guess[kept], minlength=classes).min() < MIN_SHARE * kept.sum() / classes:
        return trees, note | {"why": "a label is hardly ever given to the unlabelled windows"}
    again = made.joined(features[kept], guess[kept], REAL_WEIGHT).trees(options)
    new = again.probabilities(features).argmax(axis=1)
    changed = float((new != guess).mean())
    note["labels_changed"] = round(changed, 4)
    if changed > MAX_CHANGED or np.bincount(new, minlength=classes).min() < MIN_SHARE * len(new) / classes:
        return trees, note | {"why": "too many labels would change"}
    return again, note | {"used": True}


def following(windows: Sequence[PointRecording]) -> Bool[np.ndarray, " window"]:
    """Mask (window,) of windows that begin where the preceding one in the list ends, in the same recording."""
    found = np.zeros(len(windows), bool)
    found[1:] = [
        one.name == after.name and after.first_frame == one.first_frame + one.num_frames
        for one, after in pairwise(windows)
    ]
    return found


def smoothed_votes(votes: Votes, follows: Bool[np.ndarray, " window"]) -> Votes:
    """Mean vote of each window and its neighbours in the same recording.

    Args:
        votes: Votes (window, label).
        follows: As given by `following`.
    """
    total, count = votes.copy(), np.ones(len(votes))
    after = np.flatnonzero(follows)
    for here, there in ((after, after - 1), (after - 1, after)):
        total[here] += votes[there]
        count[here] += 1
    return total / count[:, None]
