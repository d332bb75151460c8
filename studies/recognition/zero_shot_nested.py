"""What choosing settings by scores on real recordings is worth: chosen on one half, scored on the other.

    python -m studies run zero_shot_nested --caches windows/ --recordings RADHAR

RadHAR's two groups of names are the halves. Each candidate (features, number of augmented copies, trees) is trained on
the same generated windows. The recipe itself was developed on both halves: that effect is not measured here.
"""

import argparse
import time
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.scoring import balanced_accuracy
from mmweaver.recognition.window_features import body_features, window_features
from studies.manifest import StudyRun
from studies.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from studies.recognition.zero_shot_scores import digest, in_first_half, read_cache
from studies.recognition.zero_shot_training import COPIES, feature_matrix, featurize, radhar_recordings
from studies.study import Reads

TREES = {
    "many leaves": ClassifierSettings(num_trees=200),
    "few leaves": ClassifierSettings(num_trees=200, leaf_size=10, leaves=7),
}


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """Settings of one recogniser of the windows."""

    features: str
    copies: int
    trees: str


def feature_sets(window: PointRecording) -> dict[str, tuple[str, ...]]:
    """Names of the features in each set."""
    moving, static = tuple(window_features(window)), tuple(body_features(window))
    known = feature_matrix([window])[1]
    return {
        "moving points": tuple(name for name in known if name in moving),
        "moving points, heights": moving,
        "all": known,
        "all, heights": (*moving, *static),
    }


def guesses(windows: list[PointRecording], real: list[PointRecording]) -> dict[Candidate, np.ndarray]:
    """The labels that each candidate predicts for the real windows."""
    sets = feature_sets(real[0])
    everything = sets["all, heights"]
    made = featurize(windows, names=everything)
    rows, _ = feature_matrix(real, everything)
    found: dict[Candidate, np.ndarray] = {}
    for features, copies, trees in product(sets, (0, COPIES), TREES):
        columns = np.array([everything.index(name) for name in sets[features]])
        used = slice(len(windows) * (1 + copies))  # the windows stand first, then copies
        model = ActivityClassifier(TREES[trees]).fit(made.features[used][:, columns], made.labels[used])
        found[Candidate(features=features, copies=copies, trees=trees)] = model.predict(rows[:, columns])
    return found


def nested(
    found: dict[Candidate, np.ndarray], truth: np.ndarray, first_half: np.ndarray
) -> list[tuple[Candidate, float, float]]:
    """For each half: the candidate that is best on it, its score there, and its score on the other half."""
    kinds = np.unique(truth)

    def score(guess: np.ndarray, which: np.ndarray) -> float:
        return balanced_accuracy(kinds.searchsorted(truth[which]), kinds.searchsorted(guess[which]))

    chosen = []
    for half in (first_half, ~first_half):
        best = max(found, key=lambda one: score(found[one], half))
        chosen.append((best, score(found[best], half), score(found[best], ~half)))
    return chosen


def measure(caches: list[Path], recordings: Path, run: StudyRun) -> Path:
    """Writes results/zero_shot/nested.json."""
    began = time.process_time()
    read = [read_cache(cache) for cache in caches]
    windows = [window for one, _ in read for window in one]
    people = radhar_recordings(recordings)
    real = [window for one in people for window in one.windows(windows[0].num_frames / windows[0].frame_rate_hz)]
    first = np.array([in_first_half(window.name) for window in real])
    truth = np.array([window.label for window in real])
    found = guesses(windows, real)
    chosen = nested(found, truth, first)
    seconds = time.process_time() - began
    rows = [
        _row(best, on_it, other, recordings, ("first", "second")[half], int((first == bool(half)).sum()), seconds)
        for half, (best, on_it, other) in enumerate(chosen)
    ]
    sources = [_without_recipe(source) for _, source in read]
    return run.write("zero_shot", "nested", config={"candidates": len(found), "sources": sources}, rows=rows)


def _without_recipe(source: dict[str, Any]) -> dict[str, Any]:
    """The source without its recipe, which is in frozen.json."""
    return {key: value for key, value in source.items() if key != "recipe"}


def _row(
    best: Candidate, on_it: float, other: float, folder: Path, half: str, n: int, seconds: float
) -> dict[str, Any]:
    return {
        "dataset": {"name": f"RadHAR, chosen on the {half} half, scored on the other", "sha256": digest(folder)},
        "n": n, "seeds": [0], "seconds": {"all": round(seconds, 1)},
        "chosen": {"features": best.features, "copies": best.copies, "trees": best.trees},
        "metrics": {
            "window": {
                "value": round(other, 4), "unit": "share", "version": 1, "baseline": {"chance": 0.2},
                "chosen_on": round(on_it, 4),
                "definition": "balanced accuracy of windows of 2 s on the half that had no say",
            }
        },
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--caches", type=Path, action=Reads, nargs="+", required=True)
    parser.add_argument("--recordings", type=Path, action=Reads, required=True)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(options.caches, options.recordings, run)
