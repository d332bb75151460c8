"""Labelled recordings train along: they join what was generated, and grow a share of the trees by themselves.

Decision 270.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, trees_of
from mmweaver.recognition.tree_ensemble import TreeEnsemble

HALF_AT = 4.0  # recordings of every activity with which they grow half of the trees by themselves


def fewest_recordings(windows: Sequence[PointRecording], labels: Sequence[str]) -> int:
    """Recordings of the activity that has fewest, by the names of their windows."""
    count = Counter(label for label, _ in {(window.label, window.name) for window in windows})
    return min(count[label] for label in labels)


def own_trees(
    made: TrainingWindows, features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"],
    fewest: int, options: TrainingOptions,
) -> tuple[TreeEnsemble | None, TrainingOptions]:  # fmt: skip
    """Trees on labelled windows alone, None where an activity has none, and the options of all other trees.

    Their share is fewest / (fewest + HALF_AT), `fewest` being the recordings of the activity that has fewest.
    """
    count = round(options.trees * fewest / (fewest + HALF_AT))
    if count == 0:
        return None, options
    own = trees_of(labelled_alone(made, features, labels), replace(options, trees=count))
    return own, replace(options, trees=options.trees - count)


def labelled_alone(
    made: TrainingWindows, features: Float[np.ndarray, "other feature"], labels: Int[np.ndarray, " other"]
) -> TrainingWindows:
    """Labelled windows as if they were the only ones that train."""
    whole, nobody = np.zeros(len(labels), bool), np.zeros(len(labels), int)
    return replace(made, features=features, label=labels, person=nobody, is_copy=whole, importance=None)
