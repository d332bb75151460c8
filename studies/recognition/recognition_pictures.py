"""Recorded windows of a task next to generated ones: moving points in range over time, coloured by velocity.

    python -m studies run recognition_pictures mhomeges --recordings MHOMEGES --sequences FOLDER --out docs/images

Of every label the window whose number of moving points is the median, so that nobody chose it. And of the largest
confusions, which a recogniser trained on the sequences makes: recorded windows that are mistaken and that are right,
next to generated ones of either label, those at a third and at two thirds of the numbers of moving points.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recordings import PointRecording, windows_of
from mmweaver.recognition.task_file import read_task
from mmweaver.recognition.train_recogniser import fitted
from mmweaver.recognition.training_windows import TrainingOptions, generated_windows
from studies.manifest import StudyRun
from studies.recognition.blind_recognition import TASKS, add_task_options, recordings_of
from studies.recognition.confusion_picture import confusion_picture, usual_windows
from studies.recognition.zero_shot_pictures import draw

RANGES_M, WIDE = (0.5, 4.0), 1.7


def median_windows(windows: Sequence[PointRecording]) -> dict[str, PointRecording]:
    """By label, the window with the median number of moving points."""
    labels = sorted({window.label for window in windows})
    return {label: usual_windows([one for one in windows if one.label == label], (0.5,))[0] for label in labels}


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
    model = fitted(generated_windows(sequences, task, TrainingOptions()), [], task, TrainingOptions())
    place = options.out / f"recognise_{options.task}_confusions.png"
    print(confusion_picture(model, sequences, recordings, place))
