"""Frozen recognisers of RadHAR's five activities: features of generated windows, and classifier settings.

`blind` was frozen before any score on real recordings was seen, `development` after. Both contain generated windows
only; training from them takes seconds and is deterministic.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.repository_files import repository_file
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from mmweaver.recognition.zero_shot import TrainingSet, read_training_set, write_training_set

FOLDER = Path(__file__).parent / "frozen"
NAMES = ("blind", "development")
PACKAGED = "development"  # the other is a file of the repository


@dataclass(frozen=True, kw_only=True)
class Frozen:
    """A training set and the settings of its classifier."""

    training: TrainingSet
    classifier: ClassifierSettings
    window_s: float
    provenance: dict[str, Any]  # commits and seeds of the generated windows, and their number

    @property
    def labels(self) -> tuple[str, ...]:
        """The activities, sorted."""
        return tuple(sorted({str(label) for label in self.training.labels}))

    def train(self) -> ActivityClassifier:
        """The trained recogniser."""
        return self.training.train(self.classifier)


def settings_file(name: str) -> Path:
    """The .json of one of NAMES, next to its .npz. Raises InputError for an unknown name or a missing file."""
    if name not in NAMES:
        raise InputError(f"no frozen recogniser is called {name!r}; known: {', '.join(NAMES)}")
    if name == PACKAGED:
        return FOLDER / f"{name}.json"
    return repository_file(
        f"frozen_activity/{name}.json", f"the frozen recogniser {name!r}", f"take {PACKAGED!r}, or work in a clone"
    )


def load_frozen(name: str) -> Frozen:
    """Loads one of NAMES. Raises InputError for an unknown name, or where the file is not here."""
    settings = settings_file(name)
    held = read_json(settings)
    training = read_training_set(settings.with_suffix(".npz"))
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


def save_frozen(name: str, training: TrainingSet, settings: dict[str, Any], folder: Path = FOLDER) -> None:
    """Writes both files; `settings`: the classifier's, and for each source its commit, seed and recipe."""
    write_training_set(folder / f"{name}.npz", training)
    with atomic_file(folder / f"{name}.json") as temporary:
        temporary.write_text(json.dumps(settings, indent=1) + "\n", encoding="utf-8")
