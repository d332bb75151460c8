"""What are some labelled recordings worth, with and without what was generated? The tasks of examples/tasks.

    python -m studies run labelled_recognition radhar --recordings RADHAR --sequences FOLDER --people 24

Of every activity 0, 1, 5 and 20 recordings train, sampled anew for each seed, as `mmweaver recognise train --labelled`
does it. Those of `TRAINING` may train where the data set tells people or takes apart, and all others are the test set;
else whichever does not train is tested. MARS has one take of an exercise to train on and one to test, so there a
recording is a stretch of one window. The baselines are trees on the same recordings alone, and chance. The difference
of both is a mean over the same samples, with Student's interval over samples. A data set with too few recordings has
fewer rows.
"""

import argparse
import re
import time
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from scipy.stats import t as student

from mmweaver.core.seeding import stream
from mmweaver.recognition.point_recordings import windows_of
from mmweaver.recognition.recogniser import recognition_features
from mmweaver.recognition.scoring import balanced_accuracy
from mmweaver.recognition.train_recogniser import OWN_LEAF, labelled_alone, own_trees
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows
from mmweaver.recognition.tree_ensemble import joined_trees
from studies.manifest import StudyRun, content_of
from studies.recognition.blind_recognition import add_task_options, task_data
from studies.schema import metric

EACH, SEEDS = (0, 1, 5, 20), tuple(range(10, 40))  # 0 to 9 were drawn before, and left open what five are worth
TREES = 150
TRAINING = {"mhomeges": "80[0-5]_", "mars_exercises": ".* validate"}  # how names of recordings that may train begin


def chosen_recordings(labels: np.ndarray, each: int, seed: int) -> np.ndarray:
    """Indices of the training recordings (of these labels): `each` of every activity, at random."""
    rng = stream(seed, "real recordings", each)
    kinds = np.unique(labels)
    return np.concatenate([rng.permutation(np.flatnonzero(labels == kind))[:each] for kind in kinds]).astype(int)


def accuracy(
    made: TrainingWindows, features: np.ndarray, labels: np.ndarray, trains: np.ndarray, tested: np.ndarray, *,
    each: int, generated: bool,
) -> float:  # fmt: skip
    """Balanced accuracy on the windows `tested` (window,) of all (window, feature), of which some train (window,)."""
    options, own, training = TrainingOptions(trees=TREES), None, made
    if trains.any() and generated:
        own, options = own_trees(made, features[trains], labels[trains], each, options)
        training = made.joined(features[trains], labels[trains], options.labelled_weight)
    elif trains.any():
        training, options = labelled_alone(made, features[trains], labels[trains]), replace(options, leaf_size=OWN_LEAF)
    trees = joined_trees(training.trees(options), own)
    guess = trees.probabilities(features[tested]).argmax(axis=1)
    return balanced_accuracy(labels[tested], guess)


def curve(
    made: TrainingWindows, features: np.ndarray, labels: np.ndarray, owner: np.ndarray, kinds: np.ndarray,
    may_train: np.ndarray | None = None, seeds: tuple[int, ...] = SEEDS,
) -> list[dict[str, Any]]:  # fmt: skip
    """Scores by number of recordings; `owner` (window,) is the recording, `kinds` (recording,) its label.

    `may_train` (recording,): the others are the test set. None: whichever does not train is.
    """
    allowed = np.arange(len(kinds)) if may_train is None else np.flatnonzero(may_train)
    most = int(np.bincount(kinds[allowed]).min()) - (1 if may_train is None else 0)
    rows = []
    for each in (number for number in EACH if number <= most):
        alone: list[float] = []
        for generated in (False, True) if each else (True,):
            began = time.process_time()
            scores = []
            for seed in seeds if each else seeds[:1]:
                trains = np.isin(owner, allowed[chosen_recordings(kinds[allowed], each, seed)])
                tested = ~trains if may_train is None else ~may_train[owner]
                scores.append(accuracy(made, features, labels, trains, tested, each=each, generated=generated))
            rows.append({
                "real_recordings_each": each, "generated": generated, "seeds": list(seeds[: len(scores)]),
                "n": len(scores),
                "seconds": {"all": round(time.process_time() - began, 1)}, "scores": scores,
                "alone": alone if generated else [],
            })  # fmt: skip
            alone = scores
            print(each, generated, np.round(scores, 3), flush=True)
    return rows


def add_options(parser: argparse.ArgumentParser) -> None:
    add_task_options(parser)
    parser.add_argument(
        "--samples", type=int, choices=range(2, len(SEEDS) + 1), default=len(SEEDS), metavar="N",
        help="of the recordings that train",
    )  # fmt: skip


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    task, made, recordings = task_data(options)
    if options.task == "mars_exercises":
        recordings = [window for one in recordings for window in windows_of(one, task.recordings)]
    may_train = None
    if options.task in TRAINING:
        may_train = np.array([re.match(TRAINING[options.task], one.name) is not None for one in recordings])
    windows = [windows_of(one, task.recordings) for one in recordings]
    number = {label: place for place, label in enumerate(task.recordings.labels)}
    rows = curve(
        made, recognition_features([made.points(window) for own in windows for window in own], made.names),
        np.array([number[window.label] for own in windows for window in own]),
        np.repeat(np.arange(len(windows)), [len(own) for own in windows]),
        np.array([number[one.label] for one in recordings]), may_train, SEEDS[: options.samples],
    )  # fmt: skip
    data = {"name": options.task, "sha256": content_of(options.recordings)["sha256"], "recordings": len(recordings)}
    settings = asdict(replace(TrainingOptions(), sequences=options.people, trees=TREES))
    complete = [row_of(row, data, len(number)) for row in rows]
    run.write("labelled_recognition", options.task, config={"options": settings}, rows=complete)


def row_of(row: dict[str, Any], data: dict[str, Any], classes: int) -> dict[str, Any]:
    """A row of the schema of results."""
    scores, alone = row.pop("scores"), row.pop("alone")
    found = metric(
        float(np.mean(scores)), "share", "balanced accuracy of windows, mean over samples of the recordings that train",
        baseline={"chance": 1 / classes},
    )  # fmt: skip
    spread = {"lowest": round(min(scores), 4), "highest": round(max(scores), 4)}
    metrics = {"window": found | spread | {"samples": [round(score, 4) for score in scores]}}
    if alone:
        metrics["gain"] = gain(np.subtract(scores, alone))
    return {"dataset": data, **row, "metrics": metrics}


def gain(differences: np.ndarray) -> dict[str, Any]:
    """Mean difference with its interval over the samples (sample,)."""
    mean, error = float(differences.mean()), float(differences.std(ddof=1)) / len(differences) ** 0.5
    half = float(student.ppf(0.975, len(differences) - 1)) * error
    return metric(
        round(mean, 4), "share", "balanced accuracy with generated windows less that without, same samples",
        baseline={"none": 0.0}, interval_95=(round(mean - half, 4), round(mean + half, 4)),
    )  # fmt: skip
