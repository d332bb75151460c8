"""How well does a recogniser from a page of text do on recordings? The tasks of examples/tasks, one method for all.

    python -m studies run blind_recognition radhar --role development --recordings RADHAR --sequences FOLDER --people 16
    python -m studies run blind_recognition mars_exercises --role development --recordings MARS/subject1 ...
    python -m studies run blind_recognition mhomeges --role blind --recordings MHOMEGES ...

`role`: a data set on which the general method was developed; `blind`, one that was scored once after a commit had fixed
the method and never before; `frozen`, one that was scored once after such a commit, though earlier methods had seen it.
Each is scored alone, with no recording at all, and adapted, when the same recordings served as `unlabelled`. MARS's
recordings are cut into exercises. `--named REGEX --part WORDS` scores the recordings whose names
begin so, as a row of its own. Persons or places are held out of nothing: no recorded label trains anything.
"""

import argparse
import re
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recordings import PointRecording, read_task_recordings, windows_of
from mmweaver.recognition.scoring import score_recordings
from mmweaver.recognition.task_file import CLOUDS, RecognitionTask, read_task
from mmweaver.recognition.train_recogniser import fitted
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, generated_windows
from studies.manifest import StudyRun, content_of
from studies.schema import metric
from studies.study import Reads

TASKS = Path(__file__).resolve().parents[2] / "examples" / "tasks"
WORDS = {
    "window": "balanced accuracy of windows (of gestures: one repetition)",
    "three_windows": "balanced accuracy of the mean vote of three windows in turn",
    "recording": "balanced accuracy of the mean vote of a recording",
}
SPLITS = ("validate", "test")
# rows of each exercise in MARS's frames of splits validate and test
EXERCISES = {
    "left upper limb extension": ((0, 178), (0, 148)),
    "right upper limb extension": ((214, 431), (196, 428)),
    "both upper limbs extension": ((432, 673), (443, 668)),
    "left front lunge": ((674, 934), (669, 927)),
    "right front lunge": ((935, 1128), (928, 1120)),
    "squat": ((1129, 1393), (1121, 1384)),
    "left side lunge": ((1394, 1620), (1385, 1623)),
    "right side lunge": ((1635, 1847), (1624, 1835)),
    "left limb extension": ((1848, 2100), (1836, 2090)),
    "right limb extension": ((2172, 2366), (2110, 2351)),
}  # fmt: skip


def recordings_of(name: str, folder: Path, task: RecognitionTask) -> list[PointRecording]:
    """The labelled recordings of a task; those of MARS are cut into exercises."""
    if name != "mars_exercises":
        return read_task_recordings(folder, task.recordings)
    found: list[PointRecording] = []
    for place, split in enumerate(SPLITS):
        table = np.loadtxt(folder / f"radar_data_{split}.csv", delimiter=",", skiprows=1)
        frame = table[:, 0].astype(int)
        number = np.unique(frame)
        for exercise, spans in EXERCISES.items():
            first, last = spans[place]
            own = (frame >= number[first]) & (frame <= number[min(last, len(number) - 1)])
            x, y, z, velocity = table[own, 2:6].T
            cloud = PointCloud(
                frame=frame[own] - number[first], x_m=x, y_m=y, z_m=z, radial_velocity_mps=velocity,
                snr_db=np.full(int(own.sum()), np.nan),
            )  # fmt: skip
            found.append(
                PointRecording(
                    name=f"{exercise} {split}", cloud=cloud, num_frames=int(cloud.frame[-1]) + 1,
                    frame_rate_hz=task.recordings.frame_rate_hz, label=exercise.replace(" ", "_"),
                )
            )  # fmt: skip
    return found


def scored(
    made: TrainingWindows, recordings: list[PointRecording], task: RecognitionTask, *, adapted: bool
) -> dict[str, Any]:
    """Scores, alone or with the recordings as unlabelled ones, and what was done."""
    options = TrainingOptions()
    windows = [window for one in recordings for window in windows_of(one, task.recordings)] if adapted else []
    model = fitted(made, windows, task, options)
    return score_recordings(model, recordings) | {"self_training": model.meta.get("self_training")}


def result_row(scores: dict[str, Any], data: dict[str, Any], how: str, role: str, seconds: float) -> dict[str, Any]:
    """A row of the schema of results."""
    far, expected = scores["distance"], scores["generated_on_generated"]
    return {
        "dataset": data | {"recordings": scores["recordings"]}, "n": scores["window"]["n"], "seeds": [0], "how": how,
        "role": role, "seconds": {"training_and_scoring": round(seconds, 1)}, "classes": scores["classes"],
        "self_training": scores["self_training"], "warning": scores["warning"],
        "distance": {name: far[name] for name in ("mean", "features_far", "windows_outside", "largest")},
        "metrics": {
            **{
                key: metric(
                    scores[key]["balanced_accuracy"], "share", words, baseline=scores[key]["baseline"],
                    interval_95=tuple(scores[key]["interval_95"]), n=scores[key]["n"],
                    confusion=scores[key]["confusion"],
                )
                for key, words in WORDS.items()
            },
            "generated": metric(
                expected["balanced_accuracy"], "share", "balanced accuracy on generated people held out",
                baseline={"chance": expected["chance"]},
            ),
        },
    }  # fmt: skip


def add_task_options(parser: argparse.ArgumentParser) -> None:
    """Options of every study that trains recognisers of a task and scores them on its recordings."""
    parser.add_argument("task", choices=sorted(path.stem for path in TASKS.glob("*.toml")))
    parser.add_argument("--recordings", type=Path, action=Reads, required=True)
    parser.add_argument("--sequences", type=Path, required=True, help="folder of generated sequences; made if missing")
    parser.add_argument("--people", type=int, default=TrainingOptions().sequences)
    parser.add_argument("--clouds", choices=CLOUDS, help="instead of the task's")


def add_options(parser: argparse.ArgumentParser) -> None:
    add_task_options(parser)
    parser.add_argument("--role", choices=("development", "frozen", "blind"), required=True)
    parser.add_argument("--named", default="", metavar="REGEX", help="how names of the recordings begin")
    parser.add_argument("--part", metavar="WORDS", help="what these recordings are called")


def task_data(options: argparse.Namespace) -> tuple[RecognitionTask, TrainingWindows, list[PointRecording]]:
    """A task with its generated windows and its recordings."""
    task = read_task(TASKS / f"{options.task}.toml")
    task = replace(task, clouds=options.clouds or task.clouds)
    sequences = generate_sequences(SequenceRecipe.of(task), options.people, options.sequences)
    made = generated_windows(sequences, task, TrainingOptions())
    return task, made, recordings_of(options.task, options.recordings, task)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    task, made, recordings = task_data(options)
    recordings = [one for one in recordings if re.match(options.named, one.name)]
    name = f"{options.task}, {options.part}" if options.part else options.task
    data = {"name": name, "sha256": content_of(options.recordings)["sha256"]}
    rows = []
    for how in ("alone", "adapted"):
        began = time.process_time()
        scores = scored(made, recordings, task, adapted=how == "adapted")
        rows.append(result_row(scores, data, how, options.role, time.process_time() - began))
        print(how, {key: scores[key]["balanced_accuracy"] for key in WORDS}, scores["warning"])
    settings = asdict(replace(TrainingOptions(), sequences=options.people))
    config = {"options": settings, "role": options.role, "named": options.named}
    run.write("blind_recognition", re.sub(r"\W+", "_", name), config=config, rows=rows)
