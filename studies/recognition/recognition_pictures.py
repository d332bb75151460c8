"""Recorded windows of a task next to generated ones: moving points in range over time, coloured by velocity.

    python -m studies run recognition_pictures mhomeges --recordings MHOMEGES --sequences FOLDER --out docs/images

Of every label the window whose number of moving points is the median, so that nobody chose it.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.task_file import read_task
from mmweaver.recognition.task_recordings import windows_of
from mmweaver.recognition.window_features import STILL_MPS
from studies.manifest import StudyRun
from studies.recognition.blind_recognition import TASKS, add_task_options, recordings_of
from studies.recognition.zero_shot_pictures import draw

RANGES_M, WIDE = (0.5, 4.0), 1.7


def median_windows(windows: Sequence[PointRecording]) -> dict[str, PointRecording]:
    """By label, the window with the median number of moving points."""
    found: dict[str, PointRecording] = {}
    for label in sorted({window.label for window in windows}):
        own = [window for window in windows if window.label == label]
        order = np.argsort([int((np.abs(one.cloud.radial_velocity_mps) > STILL_MPS).sum()) for one in own])
        found[label] = own[order[len(own) // 2]]
    return found


def add_options(parser: argparse.ArgumentParser) -> None:
    add_task_options(parser)
    parser.set_defaults(people=8)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    task = read_task(TASKS / f"{options.task}.toml")
    recordings = recordings_of(options.task, options.recordings, task)
    sequences = generate_sequences(SequenceRecipe.of(task), options.people, options.sequences)
    real, made = (
        median_windows([window for one in some for window in windows_of(one, task.recordings)])
        for some in (recordings, sequences)
    )
    place = options.out / f"recognise_{options.task}.png"
    draw(real, made, place, seconds=task.recordings.window_s, ranges_m=RANGES_M, wide=WIDE)
