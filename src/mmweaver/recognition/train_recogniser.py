"""Training of a recogniser from a task file: sequences, windows, copies, features, trees and expected accuracy."""

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.output_checks import check_output_folder
from mmweaver.core.version import __version__
from mmweaver.recognition.adaptation import fewest_recordings, following, own_trees, self_trained
from mmweaver.recognition.background_mask import left_out_lines, persistent_motion_cells
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
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
from mmweaver.recognition.tree_ensemble import joined_trees
from mmweaver.recognition.window_features import moving_points

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
    persistent = persistent_motion_cells(unlabelled, radar)
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
