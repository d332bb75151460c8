"""Training of a recogniser from a task file: sequences, windows, copies, features, trees and expected accuracy.

Adaptation to recordings: labelled ones grow a share of the trees, unlabelled ones join the training under a guard.

Reference: docs/decisions/recogniser-adaptation.md.
"""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.output_checks import check_output_folder
from mmweaver.core.seeding import stream
from mmweaver.recognition.background_mask import NO_CELLS, left_out_lines, persistent_motion_cells
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.guard_report import removed_points
from mmweaver.recognition.point_recordings import (
    PointRecording,
    read_task_recording,
    read_task_recordings,
    windows_of,
)
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.recogniser import (
    MODEL_FILES,
    Recogniser,
    outside_share,
    quantiles_of,
    recognition_features,
    save_recogniser,
)
from mmweaver.recognition.recording_checks import contradictions
from mmweaver.recognition.scoring import balanced_accuracy, confusion
from mmweaver.recognition.task_file import RecognitionTask, read_task
from mmweaver.recognition.training_windows import SEQUENCES, TrainingOptions, TrainingWindows, generated_windows
from mmweaver.recognition.tree_ensemble import Features, TreeEnsemble, joined_trees
from mmweaver.recognition.window_features import moving_points

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


QUICK_SEQUENCES = 8  # people per activity
SINGLE_SEQUENCES = 100  # for single performances, which give one window each
SEQUENCE_FOLDER = "sequences"
HELD_OUT = 4  # one person in so many is held out to test on generated people
HELD_OUT_TREES = 100
INSIDE_SHARE = 0.99  # of generated windows
Listener = Callable[[str, int, int], object]


def train_recogniser(
    task_file: Path | str,
    out: Path | str,
    options: TrainingOptions | None = None,
    listener: Listener | None = None,
    labelled: Path | str | None = None,
) -> Recogniser:
    """Trains the recogniser of a task and writes its folder.

    Sequences are stored in OUT/sequences, so it can be resumed.

    Args:
        task_file: The task as TOML.
        out: Folder of the recogniser.
        options: How it is trained; by default `TrainingOptions()`.
        listener: Called with a stage, the amount done and the total.
        labelled: Folder of recordings for training, a folder per activity; not every activity needs one.

    Returns:
        The recogniser.

    Raises:
        InputError: For a task, recordings or a folder that cannot be used.
    """
    options, out = options or TrainingOptions(), Path(out)
    need("evaluate", "training a recogniser", "sklearn")
    task = read_task(task_file)
    check_output_folder(out, overwrite=True, files=MODEL_FILES)
    began_s = time.process_time()
    tell = listener or (lambda *_: None)
    radar, settings = Quantisation.of(task), task.recordings
    background = [] if task.background is None else [read_task_recording(task.background, settings)]
    unlabelled = [] if task.unlabelled is None else read_task_recordings(task.unlabelled, settings, labelled=False)
    persistent = NO_CELLS if "persistent" in options.guards_off else persistent_motion_cells(unlabelled, radar)
    recorded = [] if labelled is None else read_task_recordings(labelled, settings)
    taught, seen = ([window for one in some for window in windows_of(one, settings)] for some in (recorded, unlabelled))
    if recorded and not taught:
        raise InputError(f"no recording of {labelled} lasts {settings.window_s:g} s, which is one window")
    recipe = SequenceRecipe.of(task, options.prior, options.seed)
    sequences = generate_sequences(
        recipe, options.sequences, out / SEQUENCE_FOLDER, lambda done, of: tell("sequences", done, of)
    )
    made = generated_windows(sequences, task, options, background, persistent)
    tell("trees", 0, 1)
    model = fitted(made, seen, task, options, taught)
    note = {
        "mmweaver": __version__,
        "task_file": Path(task_file).name,
        "options": asdict(options),
        "task": {
            "radar": task.radar.name,
            "activities": {label: list(lines) for label, lines in task.activities.items()},
            "mount": asdict(task.mount),
            "background": task.background and task.background.name,
            "unlabelled": task.unlabelled and task.unlabelled.name,
        },
        "radar_facts": asdict(radar),
        "moving_points_a_frame": {
            label: round(float(np.mean([moving_points(one) for one in sequences if one.label == label])), 2)
            for label in settings.labels
        },
        "contradictions": contradictions([*unlabelled, *taught, *background], radar),
        "left_out": left_out_lines(persistent),
        "removed": removed_points(model.points, [*unlabelled, *recorded]),
        "cpu_seconds": round(time.process_time() - began_s, 1),
    }
    model = replace(model, meta={**note, **model.meta})
    save_recogniser(out, model)
    tell("trees", 1, 1)
    return model


def usual_sequences(task: RecognitionTask) -> int:
    """Default number of people who perform each activity."""
    return SINGLE_SEQUENCES if task.recordings.has_single_performances else SEQUENCES


def fitted(
    made: TrainingWindows,
    unlabelled: Sequence[PointRecording],
    task: RecognitionTask,
    options: TrainingOptions,
    labelled: Sequence[PointRecording] = (),
) -> Recogniser:
    """Trees grown on all generated windows and the labelled ones, adapted to unlabelled ones.

    Args:
        made: Generated windows with their copies.
        unlabelled: Recorded windows of unknown activity; may be empty.
        task: The task, for its labels and windows.
        options: How trees are grown.
        labelled: Recorded windows with their activity; not every activity needs one.

    Returns:
        The recogniser, with the accuracy on held-out generated people in `meta`.
    """
    generated = quantiles_of(made.features)
    outside_above = float(np.quantile(outside_share(made.features, generated), INSIDE_SHARE))
    meta: dict[str, Any] = {
        "generated_windows": int((~made.is_copy).sum()),
        "with_disturbed_copies": len(made.label),
        "generated_on_generated": generated_accuracy(made, options),
    }
    own = None
    if labelled:
        known = recognition_features([made.points(window) for window in labelled], made.names)
        labels = np.array([task.recordings.labels.index(window.label) for window in labelled])
        own, options = own_trees(made, known, labels, fewest_recordings(labelled, task.recordings.labels), options)
        made = made.joined(known, labels, options.labelled_weight)
        meta |= {"labelled_windows": len(labelled), "trees_of_labelled_alone": 0 if own is None else len(own.root)}
    trees = made.trees(options)
    if unlabelled:
        features = recognition_features([made.points(window) for window in unlabelled], made.names)
        follows = None if task.recordings.has_single_performances else following(unlabelled)
        trees, note = self_trained(made, features, trees, options, follows)
        meta |= {"unlabelled_windows": len(unlabelled), "self_training": note}
    return Recogniser(
        settings=task.recordings,
        names=made.names,
        trees=joined_trees(trees, own),
        generated=generated,
        outside_above=outside_above,
        points=made.points,
        meta=meta,
    )


def generated_accuracy(made: TrainingWindows, options: TrainingOptions) -> dict[str, Any]:
    """Balanced accuracy on generated windows of held-out people: an upper bound of what the radar can discriminate.

    Args:
        made: Generated windows with their copies.
        options: How trees are grown.

    Returns:
        Accuracy, number of windows, chance level, and `confusion` (true labels in rows, recognised ones in columns).
    """
    held = made.person % HELD_OUT == HELD_OUT - 1
    if held.all() or not held.any():
        held = made.person == made.person.max()
    votes = made.trees(replace(options, trees=HELD_OUT_TREES), ~held).probabilities(made.features[held])
    truth, guess, classes = made.label[held], votes.argmax(axis=1), votes.shape[1]
    return {
        "balanced_accuracy": round(balanced_accuracy(truth, guess), 4),
        "windows": len(truth),
        "chance": round(1 / classes, 4),
        "confusion": confusion(truth, guess, classes).tolist(),
    }
