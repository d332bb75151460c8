"""From a task file to a recogniser: sequences, windows, disturbed copies, features, trees, and what to expect of it."""

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import check_output_folder
from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from mmweaver.core.version import __version__
from mmweaver.recognition.background_mask import (
    NO_CELLS,
    Cells,
    background_cells,
    left_out_lines,
    persistent_motion_cells,
)
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.labelled_training import fewest_recordings, own_trees
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
    window_row,
)
from mmweaver.recognition.recording_checks import contradictions
from mmweaver.recognition.scoring import balanced_accuracy
from mmweaver.recognition.self_training import following, self_trained
from mmweaver.recognition.task_file import RecognitionTask, read_task
from mmweaver.recognition.training_windows import (
    SEQUENCES,
    TrainingOptions,
    TrainingWindows,
    trees_of,
    with_recorded,
)
from mmweaver.recognition.tree_ensemble import joined_trees
from mmweaver.recognition.window_augmentation import WindowAugmentation, augmented, varied
from mmweaver.recognition.window_features import moving_points
from mmweaver.recognition.window_filter import WindowFilter

QUICK_SEQUENCES = 8  # people an activity
SINGLE_SEQUENCES = 100  # of single performances, which give one window each
SEQUENCE_FOLDER = "sequences"
HELD_OUT = 4  # one person in so many is held out to test on generated people
SNR_CUT_DB = 18.0  # of copies: how much less sensitive a board may be
CROWDED_SHARE = 0.3  # of copies before a furnished room
OVERLAP = 3  # windows of a generated sequence begin every so many parts of a window
INSIDE_SHARE = 0.99  # of generated windows
Listener = Callable[[str, int, int], object]


def train_recogniser(
    task_file: Path | str, out: Path | str, options: TrainingOptions | None = None, listener: Listener | None = None,
    labelled: Path | str | None = None,
) -> Recogniser:  # fmt: skip
    """Trains a recogniser of a task and writes its folder; sequences stay in OUT/sequences, so it may be interrupted.

    `labelled`: a folder of recordings that train along, a folder an activity; not every activity needs one. `listener`
    is called with a stage, what is done of it and how much there is. Raises InputError.
    """
    options, out = options or TrainingOptions(), Path(out)
    task = read_task(task_file)
    check_output_folder(out, overwrite=True, files=MODEL_FILES)
    recipe = SequenceRecipe.of(task, options.prior, options.seed)
    began_s = time.process_time()
    tell = listener or (lambda *_: None)
    background = [] if task.background is None else [read_task_recording(task.background, task.recordings)]
    unlabelled = unlabelled_recordings(task)
    constant = persistent_motion_cells(unlabelled, Quantisation.of(task))
    taught = [] if labelled is None else labelled_windows(labelled, task)
    sequences = generate_sequences(
        recipe, options.sequences, out / SEQUENCE_FOLDER, lambda done, of: tell("sequences", done, of)
    )
    made = generated_windows(sequences, task, options, background, constant)
    tell("trees", 0, 1)
    seen = [window for recording in unlabelled for window in windows_of(recording, task.recordings)]
    model = fitted(made, seen, task, options, taught)
    note = {
        "mmweaver": __version__, "task_file": Path(task_file).name, "options": asdict(options),
        "task": task_values(task), "radar_facts": asdict(Quantisation.of(task)),
        "moving_points_a_frame": moving_points_of(sequences),
        "contradictions": contradictions([*unlabelled, *taught, *background], Quantisation.of(task)),
        "left_out": left_out_lines(constant),
        "cpu_seconds": round(time.process_time() - began_s, 1),
    }  # fmt: skip
    model = replace(model, meta={**note, **model.meta})
    save_recogniser(out, model)
    tell("trees", 1, 1)
    return model


def moving_points_of(sequences: Sequence[PointRecording]) -> dict[str, float]:
    """The mean number of moving points a frame, of each label."""
    labels = sorted({one.label for one in sequences})
    return {
        label: round(float(np.mean([moving_points(one) for one in sequences if one.label == label])), 2)
        for label in labels
    }


def usual_sequences(task: RecognitionTask) -> int:
    """How many people perform each activity if nobody says."""
    return SINGLE_SEQUENCES if task.recordings.has_single_performances else SEQUENCES


def task_values(task: RecognitionTask) -> dict[str, Any]:
    """What a task says, for meta.json."""
    return {
        "radar": task.radar.name, "activities": {label: list(said) for label, said in task.activities.items()},
        "mount": asdict(task.mount), "background": None if task.background is None else task.background.name,
        "unlabelled": None if task.unlabelled is None else task.unlabelled.name,
    }  # fmt: skip


def unlabelled_recordings(task: RecognitionTask) -> list[PointRecording]:
    """The task's unlabelled recordings; none where it names none."""
    return [] if task.unlabelled is None else read_task_recordings(task.unlabelled, task.recordings, labelled=False)


def labelled_windows(folder: Path | str, task: RecognitionTask) -> list[PointRecording]:
    """The windows of labelled recordings. Raises InputError where there are none."""
    recordings = read_task_recordings(folder, task.recordings)
    windows = [window for recording in recordings for window in windows_of(recording, task.recordings)]
    if not windows:
        raise InputError(f"no recording of {folder} lasts {task.recordings.window_s:g} s, which is one window")
    return windows


def generated_windows(
    sequences: Sequence[PointRecording], task: RecognitionTask, options: TrainingOptions,
    background: Sequence[PointRecording] = (), constant: Cells = NO_CELLS,
) -> TrainingWindows:  # fmt: skip
    """Windows of sequences with their disturbed copies, each in front of the recorded background where there is one.

    Points that do not count are left out, also those that move in the cells `constant`. Raises InputError where an
    activity gave no window.
    """
    shows_room = not (task.firmware.static_removal or background)
    how = WindowAugmentation(
        cell_m=task.radar.range_resolution_m, velocity_step_mps=task.radar.velocity_resolution_mps,
        most_objects=WindowAugmentation().most_objects if shows_room else 0,
        crowded_share=CROWDED_SHARE if shows_room else 0.0,
        reversed_share=0.0, reflected_share=0.0, snr_cut_db=SNR_CUT_DB,
    )  # fmt: skip
    step_s, radar = task.recordings.window_s / OVERLAP, Quantisation.of(task)
    pairs = [(one, window) for one in sequences for window in windows_of(one, task.recordings, step_s)]
    windows = [window for _, window in pairs]
    found = {window.label for window in windows}
    if missing := [label for label in task.recordings.labels if label not in found]:
        raise InputError(
            f"the radar sees nothing of {missing[0]!r}: no window of it was generated; check radar, mount and sentences"
        )
    copies: list[PointRecording] = []
    for copy in range(options.copies):
        for number, (sequence, window) in enumerate(pairs):
            rng = stream(options.seed, "disturbed", window.name, number, copy)
            another = varied(
                sequence, window.first_frame, window.num_frames, rng, radar, options.variation,
                once=task.recordings.has_single_performances,
            )  # fmt: skip
            copies.append(_before(augmented(another, rng, how), background, rng))
    everything = [
        _before(window, background, stream(options.seed, "behind", number)) for number, window in enumerate(windows)
    ]
    everything += copies
    points = WindowFilter(busy=background_cells(background), radar=radar).without(constant)
    everything = [points(window) for window in everything]
    names = tuple(window_row(everything[0]))
    return TrainingWindows(
        features=recognition_features(everything, names),
        label=np.array([task.recordings.labels.index(window.label) for window in everything]),
        person=np.array([int(window.name.rpartition("_")[2]) for window in everything]),
        is_copy=np.arange(len(everything)) >= len(windows), names=names, points=points,
    )  # fmt: skip


def _before(window: PointRecording, background: Sequence[PointRecording], rng: np.random.Generator) -> PointRecording:
    """The window with the points of a stretch of the recorded empty place."""
    if not background:
        return window
    place = background[int(rng.integers(len(background)))]
    first = int(rng.integers(max(place.num_frames - window.num_frames, 0) + 1))
    behind = place.part(first, window.num_frames).cloud
    names = ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
    columns = {name: np.concatenate([getattr(window.cloud, name), getattr(behind, name)]) for name in names}
    order = np.argsort(columns["frame"], kind="stable")
    return replace(window, cloud=PointCloud(**{name: column[order] for name, column in columns.items()}))


# fitting ------------------------------------------------------------------------------------------------------------
def fitted(
    made: TrainingWindows, unlabelled: Sequence[PointRecording], task: RecognitionTask, options: TrainingOptions,
    labelled: Sequence[PointRecording] = (),
) -> Recogniser:  # fmt: skip
    """Trees on all generated windows and the labelled ones, adapted to unlabelled ones.

    With the accuracy on generated people who were held out.
    """
    is_own = ~made.is_copy
    generated = quantiles_of(made.features)
    shares = outside_share(made.features, generated)
    meta: dict[str, Any] = {
        "generated_windows": int(is_own.sum()), "with_disturbed_copies": len(made.label),
        "generated_on_generated": generated_accuracy(made, options),
    }  # fmt: skip
    seen = [made.points(window) for window in unlabelled]
    features = recognition_features(seen, made.names) if unlabelled else None
    own = None
    if labelled:
        known = recognition_features([made.points(window) for window in labelled], made.names)
        labels = np.array([task.recordings.labels.index(window.label) for window in labelled])
        fewest = fewest_recordings(labelled, task.recordings.labels)
        own, options = own_trees(made, known, labels, fewest, options)
        made = with_recorded(made, known, labels, options.labelled_weight)
        meta |= {"labelled_windows": len(labelled), "trees_of_labelled_alone": 0 if own is None else len(own.root)}
    trees = trees_of(made, options)
    if features is not None:
        meta["unlabelled_windows"] = len(unlabelled)
        if options.self_training:
            follows = None if task.recordings.has_single_performances else following(unlabelled)
            trees, meta["self_training"] = self_trained(made, features, trees, options, follows)
    return Recogniser(
        settings=task.recordings, names=made.names, trees=joined_trees(trees, own), generated=generated,
        outside_above=float(np.quantile(shares, INSIDE_SHARE)), points=made.points,
        meta=meta,
    )  # fmt: skip


def generated_accuracy(made: TrainingWindows, options: TrainingOptions) -> dict[str, Any]:
    """Balanced accuracy on generated windows of people who were held out: what the radar can tell apart at best.

    `confusion`: true labels in rows, recognised ones in columns, in the order of the labels.
    """
    held = made.person % HELD_OUT == HELD_OUT - 1
    if held.all() or not held.any():
        held = made.person == made.person.max()
    votes = trees_of(made, options, which=~held, num_trees=100).probabilities(made.features[held])
    truth, guess, classes = made.label[held], votes.argmax(axis=1), votes.shape[1]
    confusion = np.zeros((classes, classes), int)
    np.add.at(confusion, (truth, guess), 1)
    return {
        "balanced_accuracy": round(balanced_accuracy(truth, guess), 4), "windows": len(truth),
        "chance": round(1 / classes, 4), "confusion": confusion.tolist(),
    }  # fmt: skip
