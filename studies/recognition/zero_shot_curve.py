"""Accuracy against the number of real recordings of each activity, with and without generated data.

    python -m studies run zero_shot_curve --recordings shared/data/pointclouds/radhar

Training recordings are sampled anew for each seed; all others are the test set. Real windows together have the weight
of the generated ones. Trees are trained once, not as often as in the frozen recogniser.
"""

import argparse
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.seeding import stream
from mmweaver.recognition.scoring import balanced_accuracy
from studies.manifest import StudyRun
from studies.recognition.activity_classifier import ActivityClassifier
from studies.recognition.zero_shot_scores import digest
from studies.recognition.zero_shot_training import Frozen, feature_matrix, load_frozen, radhar_recordings
from studies.study import Reads

RECORDINGS = (0, 1, 5, 20)
SEEDS = (0, 1, 2)


def chosen_recordings(labels: np.ndarray, each: int, seed: int) -> np.ndarray:
    """Indices of the training recordings (of these labels): `each` of every activity, at random."""
    rng = stream(seed, "real recordings", each)
    kinds = np.unique(labels)
    return np.concatenate([rng.permutation(np.flatnonzero(labels == kind))[:each] for kind in kinds]).astype(int)


def accuracy(
    frozen: Frozen, features: np.ndarray, labels: np.ndarray, is_training: np.ndarray, *, generated: bool
) -> float:
    """Balanced accuracy on the windows that are not trained on, with or without the generated ones."""
    rows, names = [features[is_training]], [labels[is_training]]
    weights = [np.ones(int(is_training.sum()))]
    if generated:
        made = frozen.training
        rows, names = [*rows, made.features], [*names, made.labels]
        weights = [weights[0] * len(made.labels) / max(int(is_training.sum()), 1), np.ones(len(made.labels))]
    model = ActivityClassifier(replace(frozen.classifier, repetitions=1))
    model.fit(np.concatenate(rows), np.concatenate(names), np.concatenate(weights))
    guess = np.argmax(model.probabilities(features[~is_training]), axis=1)
    return balanced_accuracy(np.searchsorted(np.array(model.classes), labels[~is_training]), guess)


def measure(name: str, recordings: Path, run: StudyRun) -> Path:
    """Writes results/zero_shot/curve.json."""
    frozen = load_frozen(name)
    people = radhar_recordings(recordings)
    windows = [window for one in people for window in one.windows(frozen.window_s)]
    owner = np.repeat(np.arange(len(people)), [len(one.windows(frozen.window_s)) for one in people])
    features, _ = feature_matrix(windows, frozen.training.names)
    labels = np.array([window.label for window in windows])
    kinds = np.array([one.label for one in people])
    rows: list[dict[str, Any]] = []
    for each in RECORDINGS:
        for generated in (True, False):
            if each == 0 and not generated:
                continue
            began = time.process_time()
            seeds = SEEDS if each else SEEDS[:1]
            scores = []
            for seed in seeds:
                is_training = np.isin(owner, chosen_recordings(kinds, each, seed))
                scores.append(accuracy(frozen, features, labels, is_training, generated=generated))
            rows.append(_row(scores, each, generated, recordings, seeds, time.process_time() - began))
    config = {"frozen": name, **frozen.provenance, "classifier": asdict(frozen.classifier)}
    return run.write("zero_shot", "curve", config=config, rows=rows)


def _row(scores: list[float], each: int, generated: bool, folder: Path, seeds: tuple[int, ...], seconds: float) -> dict:
    return {
        "dataset": {"name": "RadHAR, all recordings but those that train", "sha256": digest(folder)},
        "real_recordings_each": each,
        "generated": generated,
        "n": len(scores),
        "seeds": list(seeds),
        "seconds": {"all": round(seconds, 1)},
        "metrics": {
            "window": {
                "value": round(float(np.mean(scores)), 4), "unit": "share", "version": 1, "baseline": {"chance": 0.2},
                "definition": "balanced accuracy of windows of 2 s, mean over samples of the recordings that train",
                "lowest": round(min(scores), 4), "highest": round(max(scores), 4),
            }
        },
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--frozen", default="development")
    parser.add_argument("--recordings", type=Path, action=Reads, required=True)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(options.frozen, options.recordings, run)
