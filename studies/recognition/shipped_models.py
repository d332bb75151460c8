"""How well do the recogniser and the pose networks of weights/ do on the recordings that their model cards name?

    python -m studies run shipped_models --radhar RADHAR --mars MARS

RadHAR: all recordings, as `mmweaver evaluate zero-shot-activity` scores them. MARS: split `test` of the subjects that
are there (`score_poses`). The files are scored as they are; nothing is trained.
"""

import argparse
import time
from pathlib import Path
from typing import Any

from mmweaver.recognition.point_recordings import read_task_recordings
from mmweaver.recognition.recogniser import load_recogniser
from mmweaver.recognition.scoring import score_recordings
from mmweaver.recognition.train_pose import load_estimator
from studies.manifest import StudyRun, content_of
from studies.recognition.blind_recognition import WORDS
from studies.recognition.score_poses import score_poses
from studies.recognition.zero_shot_pose import WORDS as ALIGNMENTS
from studies.schema import metric
from studies.study import Reads

WEIGHTS = Path(__file__).resolve().parents[2] / "weights"
SPLIT = "test"


def recogniser_row(scores: dict[str, Any], data: dict[str, Any], seconds: float) -> dict[str, Any]:
    """A row of the balanced accuracies of windows, three windows and recordings."""
    metrics = {
        name: metric(
            scores[name]["balanced_accuracy"], "share", words, baseline=scores[name]["baseline"],
            interval_95=tuple(scores[name]["interval_95"]), n=scores[name]["n"],
        )
        for name, words in WORDS.items()
    }  # fmt: skip
    return {"method": "recogniser_radhar", "dataset": data, "n": scores["window"]["n"], "seeds": [0],
            "seconds": {"scoring": seconds}, "metrics": metrics}  # fmt: skip


def pose_row(scores: dict[str, Any], data: dict[str, Any], seconds: float) -> dict[str, Any]:
    """A row of the mean errors by alignment and group of joints, next to mean poses."""
    mean = scores["mean"]
    baselines = [name for name in mean if name.endswith("_mean_pose")]
    metrics = {
        f"{alignment}_{group}": metric(
            value, "cm", f"mean distance of joints ({group}), {words}",
            baseline={name: mean[name][alignment][group] for name in baselines},
        )
        for alignment, words in ALIGNMENTS.items()
        for group, value in mean["network"][alignment].items()
    }  # fmt: skip
    frames = sum(one["frames"] for one in scores["subjects"])
    return {"method": "pose_mars", "dataset": data | {"split": SPLIT}, "n": frames, "seeds": [0, 1],
            "seconds": {"scoring": seconds}, "metrics": metrics}  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--radhar", type=Path, action=Reads, required=True, metavar="DIR", help="RadHAR's recordings")
    parser.add_argument("--mars", type=Path, action=Reads, required=True, metavar="DIR", help="MARS's subjects")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    for name, folder, place in (("RadHAR", "recogniser_radhar", options.radhar), ("MARS", "pose_mars", options.mars)):
        began = time.process_time()
        weights = WEIGHTS / folder
        data = {"name": name, "sha256": content_of(place)["sha256"]}
        if name == "RadHAR":
            model = load_recogniser(weights)
            scores = score_recordings(model, read_task_recordings(place, model.settings))
            row = recogniser_row(scores, data, round(time.process_time() - began, 1))
        else:
            scores = score_poses(load_estimator(weights), place, SPLIT)
            row = pose_row(scores, data, round(time.process_time() - began, 1))
        run.write("shipped_models", folder, config={"weights": content_of(weights)}, rows=[row])
