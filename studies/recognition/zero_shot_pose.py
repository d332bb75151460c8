"""How well does a network trained on generated people alone recover poses of a real person from points?

    python -m studies run zero_shot_pose --recordings MARS/subject1 --split validate --sequences FOLDER \\
        --models weights/pose_mars
    python -m studies run zero_shot_pose --recordings MARS/subject1 --split test --sequences FOLDER --runs FOLDER

The task is examples/tasks/mars_poses.toml, the recordings are those of subject 1 of MARS; what is chosen is chosen on
split `validate`. Next to the network: the mean pose of the generated people; the mean pose of the same real person (on
`validate` of the very frames, which flatters it); the generated frame whose points are most alike. On `test` also the
same network trained on the other split of the same person, a calibration per joint fitted there (an offset and a
shrink), and a curve of some of its minutes with and without generated people first, at equal steps. Other subjects of
MARS are not at hand. With `--models` networks are read, else one is trained for each seed.
"""

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.models.point_frames import middle_m, near
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.task_file import RecognitionTask, read_task
from mmweaver.recognition.train_pose import PoseEstimator, generated_frames, load_estimator, posed_frames, split_people
from mmweaver.training.pose_training import PosedFrames, PoseRecipe, PoseWindows, mean_pose_m, train_pose
from mmweaver.training.trainer import Trainer
from mmweaver.viz.motion_strip import draw_pose_strips
from studies.manifest import StudyRun, content_of
from studies.recognition.score_poses import (
    JointCalibration,
    Joints,
    as_kinect,
    errors,
    mean_pose,
    predicted,
    read_subject,
    repeated,
    truth,
)
from studies.schema import metric
from studies.study import Reads

TASK = Path(__file__).resolve().parents[2] / "examples" / "tasks" / "mars_poses.toml"
MINUTES, FEW_STEPS, CURVE_SEEDS = (1.0, 3.9), 200, 2
BEFORE_AND_AFTER = 5  # frames whose points the nearest neighbour looks at
EDGES_M = {0: (-0.9, -0.5, -0.2, 0.2, 0.5, 0.9), 2: (-1.1, -0.8, -0.5, -0.2, 0.1, 0.4, 0.7, 1.0)}
WORDS = {
    "root": "both pelvises at the origin (predicted ones between the hips, as the Kinect has them)",
    "centroid": "the means of the scored joints at the origin", "procrustes": "rotated and scaled as fits best",
}  # fmt: skip


def estimator_of(trainers: Sequence[Trainer], task: RecognitionTask) -> PoseEstimator:
    """The networks of trainings, whose poses are averaged."""
    return PoseEstimator(networks=[one.learner.network for one in trainers], settings=task.recordings)


# the nearest neighbour ----------------------------------------------------------------------------------------------
def counts_of(one: PosedFrames) -> np.ndarray:
    """How many points lie in each part of the picture plane (frame, part), within half a second."""
    close = near(one.frames, middle_m(one.frames))
    found = np.zeros((len(one), *(len(edges) - 1 for edges in EDGES_M.values())))
    middle = middle_m(one.frames)
    for frame in range(len(one)):
        around = slice(max(frame - BEFORE_AND_AFTER, 0), frame + BEFORE_AND_AFTER + 1)
        points = close.values[around][close.is_there[around]][:, :3] - middle
        found[frame] = np.histogram2d(points[:, 0], points[:, 2], bins=list(EDGES_M.values()))[0]
    flat = np.sqrt(found.reshape(len(one), -1))
    return flat / np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-9)


def nearest(known: Sequence[PosedFrames], asked: Sequence[PosedFrames]) -> Joints:
    """The joints, relative to the pelvis, of the known frame whose points lie most alike."""
    joints = np.concatenate([one.joints_m - one.joints_m[:, :1] for one in known])
    counts = np.concatenate([counts_of(one) for one in known])
    return np.concatenate([joints[np.argmax(counts_of(one) @ counts.T, axis=1)] for one in asked])


# rows ---------------------------------------------------------------------------------------------------------------
def row_of(method: str, found: Sequence[dict[str, Any]], data: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A row of the mean errors over seeds (or one), with the standard deviation over seeds."""
    metrics = {}
    for alignment, words in WORDS.items():
        for group in found[0][alignment]:
            values = [one[alignment][group] for one in found]
            metrics[f"{alignment}_{group}"] = {
                "values": [round(value, 2) for value in values],
                **metric(round(float(np.mean(values)), 2), "cm", f"mean distance of joints ({group}), {words}"),
            }
    return {"method": method, "dataset": data, "n": data["frames"], "seeds": list(range(len(found))),
            "metrics": metrics, **more}  # fmt: skip


def compared(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows with the mean poses as baselines, and the network trained on the same person as the oracle."""
    by_method = {row["method"]: row["metrics"] for row in rows}
    for row in rows:
        for name, one in row["metrics"].items():
            one["baseline"] = {
                base: by_method[base][name]["value"] for base in ("generated_mean_pose", "real_mean_pose")
            }
            if "supervised_same_person" in by_method:
                one["oracle"] = {"supervised_same_person": by_method["supervised_same_person"][name]["value"]}
    return rows


def minutes_of(recordings: Sequence[PointRecording], minutes: float, least: int) -> list[PosedFrames]:
    """The beginning of every stretch, together about so many minutes."""
    total = sum(one.num_frames for one in recordings) / recordings[0].frame_rate_hz / 60
    share = min(minutes / total, 1.0)
    parts = [one.part(0, max(round(share * one.num_frames), least)) for one in recordings if one.num_frames >= least]
    return [posed_frames(one) for one in parts]


class PoseStudy:
    """What all rows share: the task, generated and real recordings, and where trainings are kept."""

    def __init__(self, options: argparse.Namespace):
        self.task, self.options = read_task(TASK), options
        self.frames = self.task.recordings.window_frames
        made = generated_frames(self.task, options.people, 0, options.sequences)
        self.trained, self.unseen = split_people(made, self.frames)
        other = "validate" if options.split == "test" else "test"
        self.asked = read_subject(options.recordings, options.split, self.frames)
        self.known = [] if options.split == "validate" else read_subject(options.recordings, other, self.frames)
        self.truth = truth(self.asked)
        self.recipe = PoseRecipe(steps=options.steps)

    def on_generated(self, seed: int) -> Trainer:
        """Trained on generated people; resumed from its folder."""
        folder = self.options.runs / f"generated_{seed}"
        return train_pose(self.trained, self.unseen, folder, replace(self.recipe, seed=seed))

    def on_person(self, seed: int, minutes: float, start: Trainer | None, steps: int) -> Trainer:
        """Trained on minutes of the real person; the weights at the end, as nothing is held out to choose by."""
        known = minutes_of(self.known, minutes, self.frames)
        windows = PoseWindows(recordings=known, window_frames=self.frames)
        recipe = replace(self.recipe, seed=seed, steps=steps, validate_every=steps, validation_batches=1)
        folder = self.options.runs / f"person_{minutes:g}_{seed}_{steps}_{'pretrained' if start else 'anew'}"
        weights = None if start is None else start.learner.network.state_dict()
        return train_pose(windows, replace(windows, disturbance=None), folder, recipe, start=weights)

    def scored(self, *trainers: Trainer) -> dict[str, Any]:
        """Errors of networks, averaged."""
        return errors(predicted(estimator_of(trainers, self.task), self.asked), self.truth)


def run_rows(study: PoseStudy, data: dict[str, Any]) -> tuple[list[dict[str, Any]], list[Trainer], PoseEstimator]:
    """The rows of all methods, the networks trained on generated people, and the first one of all."""
    began = time.process_time()
    known_pose = mean_pose(truth(study.known or study.asked))
    pose = as_kinect(mean_pose_m(study.trained)[None])[0]
    neighbours = as_kinect(nearest(study.trained.recordings, [posed_frames(one) for one in study.asked]))
    rows = [
        row_of("generated_mean_pose", [errors(repeated(pose, study.truth), study.truth)], data),
        row_of("real_mean_pose", [errors(repeated(known_pose, study.truth), study.truth)], data),
        row_of("nearest_generated", [errors(neighbours, study.truth)], data),
    ]
    trainers = [] if study.options.models else [study.on_generated(seed) for seed in range(study.options.seeds)]
    estimators = [load_estimator(file) for file in study.options.models or ()]
    estimators += [estimator_of([one], study.task) for one in trainers]
    found = [errors(predicted(one, study.asked), study.truth) for one in estimators]
    rows.append(row_of("network", found, data))
    if len(trainers) > 1:
        rows.append(row_of("networks_averaged", [study.scored(*trainers)], data))
    if study.known:
        calibrated = []
        for estimator in estimators:
            fit = JointCalibration.of(predicted(estimator, study.known), truth(study.known))
            calibrated.append(errors(fit.apply(predicted(estimator, study.asked)), study.truth))
        same = [study.on_person(seed, MINUTES[-1], None, study.recipe.steps // 2) for seed in range(CURVE_SEEDS)]
        rows.append(row_of("network_calibrated", calibrated, data))
        rows.append(row_of("supervised_same_person", [study.scored(one) for one in same], data))
    seconds = {"training_and_scoring": round(time.process_time() - began, 1)}
    return [row | {"seconds": seconds} for row in compared(rows)], trainers, estimators[0]


def curve_rows(study: PoseStudy, trainers: Sequence[Trainer], data: dict[str, Any]) -> list[dict[str, Any]]:
    """With and without generated people first, by minutes of the real person."""
    rows = []
    for minutes in MINUTES:
        began = time.process_time()
        pairs = [
            [study.scored(study.on_person(seed, minutes, start, FEW_STEPS)) for seed in range(CURVE_SEEDS)]
            for start in (trainers[0], None)
        ]
        first, anew = (row_of("", found, data)["metrics"] for found in pairs)
        for name, one in first.items():
            one["baseline"] = {"without_generated": anew[name]["value"]}
        seconds = {"training_and_scoring": round(time.process_time() - began, 1)}
        rows.append({"method": "pretrained", "minutes": minutes, "dataset": data, "n": data["frames"],
                     "seeds": list(range(CURVE_SEEDS)), "metrics": first, "seconds": seconds})  # fmt: skip
    return rows


def draw(study: PoseStudy, estimator: PoseEstimator, path: Path) -> None:
    """True and predicted skeletons of every second long stretch."""
    chosen = [one for one in study.asked if one.num_frames > 100][::2]
    strips = []
    for one in chosen:
        part = one.part(one.num_frames // 3, 60)
        assert part.joints_m is not None
        whole = predicted(estimator, [one])[part.first_frame : part.first_frame + 60]
        strips.append((f"{one.name}: network over Kinect (grey)", whole, part.joints_m))
    draw_pose_strips(strips, path, frame_rate_hz=chosen[0].frame_rate_hz)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--recordings", type=Path, action=Reads, required=True, help="folder of MARS's subject 1")
    parser.add_argument("--split", choices=("validate", "test"), default="test")
    parser.add_argument("--sequences", type=Path, required=True, help="folder of generated sequences; made if missing")
    parser.add_argument("--runs", type=Path, default=Path("build/pose"), help="folder of trainings; resumed")
    parser.add_argument("--models", type=Path, nargs="+", action=Reads, help="trained networks, instead of training")
    parser.add_argument("--people", type=int, default=40)
    parser.add_argument("--steps", type=int, default=PoseRecipe().steps)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--picture", type=Path, help="draws true and predicted skeletons")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    study = PoseStudy(options)
    measured = int(np.isfinite(study.truth).all(axis=(1, 2)).sum())
    data = {
        "name": "MARS, subject 1", "split": options.split, "sha256": content_of(options.recordings)["sha256"],
        "frames": measured,
    }  # fmt: skip
    config = {"people": options.people, "steps": options.steps, "window_s": study.task.recordings.window_s}
    rows, trainers, first = run_rows(study, data)
    run.write("zero_shot_pose", f"mars_{options.split}", config=config, rows=rows)
    if options.picture is not None:
        draw(study, first, options.picture)
    if study.known and trainers:
        run.write("zero_shot_pose", f"curve_{options.split}", config=config, rows=curve_rows(study, trainers, data))
