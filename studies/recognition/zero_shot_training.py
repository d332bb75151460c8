"""Training and scoring of the older recogniser of RadHAR's activities, and its frozen training sets.

`blind` was frozen before any score on real recordings was seen, `development` after. Both hold features of generated
windows alone; training on them takes seconds and is deterministic.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.repository_files import WEIGHTS
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.seeding import stream
from mmweaver.recognition.point_recordings import PointRecording, read_task_recordings
from mmweaver.recognition.scoring import Evaluation
from mmweaver.recognition.task_file import read_task
from mmweaver.recognition.window_augmentation import augmented
from mmweaver.recognition.window_features import UNPREDICTABLE, body_features, window_features
from studies.recognition.activity_classifier import ActivityClassifier, ClassifierSettings

COPIES = 3
FROZEN = WEIGHTS / "frozen_activity"
TASK = WEIGHTS.parent / "examples" / "tasks" / "radhar.toml"


@dataclass(frozen=True, kw_only=True)
class TrainingSet:
    """Features of generated windows (window, feature) with their labels."""

    features: Float[np.ndarray, "window feature"]
    labels: np.ndarray  # (window,) str
    names: tuple[str, ...]  # of the features

    def train(self, settings: ClassifierSettings | None = None) -> ActivityClassifier:
        """Trains a recogniser on this set alone."""
        return ActivityClassifier(settings, self.names).fit(self.features, self.labels)


def feature_matrix(
    windows: list[PointRecording], names: tuple[str, ...] | None = None
) -> tuple[Float[np.ndarray, "window feature"], tuple[str, ...]]:
    """Features of windows, float32, and their names; by default all except those a simulation cannot predict."""
    rows = [{**window_features(window), **body_features(window)} for window in windows]
    chosen = names or tuple(name for name in rows[0] if not UNPREDICTABLE & set(name.split("_")))
    return np.array([[row[name] for name in chosen] for row in rows], np.float32), chosen


def featurize(
    windows: list[PointRecording], *, copies: int = COPIES, seed: int = 0, names: tuple[str, ...] | None = None
) -> TrainingSet:
    """Features of windows, followed by those of the first augmented copy of each, the second, and so on.

    Rounded to half precision, as in a frozen file.
    """
    copied = [
        augmented(window, stream(seed, "disturbed", window.name, copy)) for copy in range(copies) for window in windows
    ]
    features, names = feature_matrix([*windows, *copied], names)
    return TrainingSet(
        features=features.astype(np.float16).astype(np.float32),
        labels=np.array([one.label for one in [*windows, *copied]]), names=names,
    )  # fmt: skip


def radhar_recordings(folder: Path) -> list[PointRecording]:
    """RadHAR's recordings with their activities, sorted by name."""
    return read_task_recordings(folder, read_task(TASK).recordings)


def evaluate_recogniser(model: ActivityClassifier, recordings: list[PointRecording], window_s: float) -> Evaluation:
    """Evaluates on all consecutive windows. Raises InputError where no recording is long enough."""
    cut = [recording.windows(window_s) for recording in recordings]
    windows = [window for windows in cut for window in windows]
    if not windows:
        raise InputError(f"no recording lasts {window_s:g} s, which is one window; give longer ones")
    features, _ = feature_matrix(windows, model.names)
    return Evaluation(
        classes=model.classes,
        votes=model.probabilities(features),
        truth=np.array([model.classes.index(window.label) for window in windows]),
        recording=np.repeat(np.arange(len(cut)), [len(windows) for windows in cut]),
        names=tuple(recording.name for recording in recordings),
    )


@dataclass(frozen=True, kw_only=True)
class Frozen:
    """A training set and the settings of its classifier."""

    training: TrainingSet
    classifier: ClassifierSettings
    window_s: float
    provenance: dict[str, Any]  # commits and seeds of the generated windows, and their number

    def train(self) -> ActivityClassifier:
        """The trained recogniser."""
        return self.training.train(self.classifier)


def load_frozen(name: str) -> Frozen:
    """Loads "blind" or "development". Raises InputError for an unknown name."""
    file = FROZEN / f"{name}.json"
    if not file.is_file():
        raise InputError(f"no frozen recogniser is called {name!r}; known: blind, development")
    held, arrays = read_json(file), read_npz(file.with_suffix(".npz"))
    training = TrainingSet(
        features=arrays.numbers("features", ("window", "name"), nan=True).astype(np.float32, order="C"),
        labels=arrays.take("labels"),
        names=arrays.texts("names"),
    )
    return Frozen(
        training=training,
        classifier=ClassifierSettings(**held["classifier"]),
        window_s=held["sources"][0]["recipe"]["window_s"],
        provenance={
            "commits": [source["commit"] for source in held["sources"]],
            "seeds": [source["seed"] for source in held["sources"]],
            "generated_windows": sum(source["windows"] for source in held["sources"]),
            "with_disturbed_copies": len(training.labels),
        },
    )
