"""Recorded windows of a task next to generated ones: moving points in range over time, coloured by velocity.

    python -m studies run recognition_pictures mhomeges --recordings MHOMEGES --sequences FOLDER --out docs/images

Of every label the window whose number of moving points is the median, so that nobody chose it. And of the largest
confusions, which a recogniser trained on the sequences makes: recorded windows that are mistaken and that are right,
next to generated ones of either label, those at a third and at two thirds of the numbers of moving points.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mmweaver.core.atomic_files import atomic_file
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.recogniser import recognition_features
from mmweaver.recognition.task_file import read_task
from mmweaver.recognition.task_recordings import windows_of
from mmweaver.recognition.train_recogniser import TrainingOptions, generated_windows, trees_of
from mmweaver.recognition.window_features import STILL_MPS
from studies.manifest import StudyRun
from studies.recognition.blind_recognition import TASKS, add_task_options, recordings_of
from studies.recognition.zero_shot_pictures import SHOWN_MPS, draw

RANGES_M, WIDE = (0.5, 4.0), 1.7
CONFUSIONS, SHARES, REACH_M = 4, (1 / 3, 2 / 3), 1.0


def usual_windows(windows: Sequence[PointRecording], shares: Sequence[float]) -> list[PointRecording]:
    """The windows at these shares of their numbers of moving points; fewer of fewer windows."""
    order = np.argsort([int((np.abs(one.cloud.radial_velocity_mps) > STILL_MPS).sum()) for one in windows])
    places = dict.fromkeys(int(share * len(windows)) for share in shares) if windows else ()
    return [windows[order[place]] for place in places]


def median_windows(windows: Sequence[PointRecording]) -> dict[str, PointRecording]:
    """By label, the window with the median number of moving points."""
    labels = sorted({window.label for window in windows})
    return {label: usual_windows([one for one in windows if one.label == label], (0.5,))[0] for label in labels}


def largest_confusions(truth: np.ndarray, guess: np.ndarray, count: int) -> list[tuple[int, int]]:
    """Pairs of true and recognised label (window,), the largest share of the true label's windows first."""
    size = int(max(truth.max(), guess.max())) + 1
    table = np.zeros((size, size))
    np.add.at(table, (truth, guess), 1)
    table /= np.maximum(table.sum(axis=1, keepdims=True), 1)
    np.fill_diagonal(table, 0)
    order = np.argsort(-table, axis=None, kind="stable")[:count]
    return [(int(place // size), int(place % size)) for place in order if table.flat[place] > 0]


def draw_confusions(
    pairs: Sequence[tuple[int, int]], real: Sequence[PointRecording], guess: np.ndarray,
    made: Sequence[PointRecording], labels: Sequence[str], seconds: float, path: Path,
) -> None:  # fmt: skip
    """Two rows a confusion, range and height over time about the median of the moving points."""
    figure = Figure(figsize=(13.0, 2.7 * len(pairs)), layout="constrained", dpi=90)
    axes = figure.subplots(2 * len(pairs), 4 * len(SHARES), sharex=True, sharey=True, squeeze=False)
    for row, (true, taken) in enumerate(pairs):
        names = labels[true].replace("_", " "), labels[taken].replace("_", " ")
        own = [(one, found) for one, found in zip(real, guess, strict=True) if one.label == labels[true]]
        groups = {
            f"recorded {names[0]},\ntaken for {names[1]}": [one for one, found in own if found == taken],
            f"recorded {names[0]},\nrecognised": [one for one, found in own if found == true],
            f"generated {names[0]}": [one for one in made if one.label == labels[true]],
            f"generated {names[1]}": [one for one in made if one.label == labels[taken]],
        }
        for group, (title, windows) in enumerate(groups.items()):
            for column, window in enumerate(usual_windows(windows, SHARES), start=len(SHARES) * group):
                upper, lower = axes[2 * row : 2 * row + 2, column]
                _scatter(upper, lower, window)
                upper.set_title(title, fontsize=8)
    axes[0, 0].set_xlim(0.0, seconds)
    axes[0, 0].set_ylim(-REACH_M, REACH_M)
    for row in range(len(pairs)):
        axes[2 * row, 0].set_ylabel("range, m", fontsize=8)
        axes[2 * row + 1, 0].set_ylabel("height, m", fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("time, s", fontsize=8)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png")


def _scatter(upper: Axes, lower: Axes, window: PointRecording) -> None:
    cloud = window.cloud.select(np.abs(window.cloud.radial_velocity_mps) > STILL_MPS)
    range_m = np.sqrt(cloud.x_m**2 + cloud.y_m**2 + cloud.z_m**2)
    for axis, values in ((upper, range_m), (lower, cloud.z_m)):
        axis.scatter(
            cloud.frame / window.frame_rate_hz, values - (np.median(values) if len(values) else 0.0), s=4,
            c=cloud.radial_velocity_mps, cmap="coolwarm", vmin=-SHOWN_MPS, vmax=SHOWN_MPS, linewidths=0,
        )  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    add_task_options(parser)
    parser.set_defaults(people=8)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    task = read_task(TASKS / f"{options.task}.toml")
    recordings = recordings_of(options.task, options.recordings, task)
    sequences = generate_sequences(SequenceRecipe.of(task), options.people, options.sequences)
    real, made = (
        [window for one in some for window in windows_of(one, task.recordings)] for some in (recordings, sequences)
    )
    place, seconds = options.out / f"recognise_{options.task}.png", task.recordings.window_s
    draw(median_windows(real), median_windows(made), place, seconds=seconds, ranges_m=RANGES_M, wide=WIDE)
    training, labels = generated_windows(sequences, task, TrainingOptions()), task.recordings.labels
    votes = trees_of(training, TrainingOptions()).probabilities(recognition_features(real, training.names))
    guess = votes.argmax(axis=1)
    pairs = largest_confusions(np.array([labels.index(one.label) for one in real]), guess, CONFUSIONS)
    place = options.out / f"recognise_{options.task}_confusions.png"
    draw_confusions(pairs, real, guess, made, labels, seconds, place)
