"""The recognisers of RadHAR's five activities that were frozen: features of generated windows, and their settings.

`blind` was made before any score on a real recording was looked at, `development` after. Both hold generated windows
alone; training from them takes seconds and gives the same trees each time.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from mmweaver.recognition.zero_shot import TrainingSet, read_training_set, write_training_set

FOLDER = Path(__file__).parent / "frozen"
NAMES = ("blind", "development")


@dataclass(frozen=True, kw_only=True)
class Frozen:
    """A training set and all that decides what is made of it."""

    made: TrainingSet
    classifier: ClassifierSettings
    window_s: float
    provenance: dict[str, Any]  # commits and seeds of what was generated, and how many windows

    @property
    def labels(self) -> tuple[str, ...]:
        """The activities."""
        return tuple(sorted({str(label) for label in self.made.labels}))

    def train(self) -> ActivityClassifier:
        """The recogniser."""
        return self.made.train(self.classifier)


def load_frozen(name: str) -> Frozen:
    """One of NAMES. Raises InputError where there is none of this name."""
    settings = FOLDER / f"{name}.json"
    if not settings.is_file():
        raise InputError(f"no frozen recogniser is called {name!r}; known: {', '.join(NAMES)}")
    held = json.loads(settings.read_text(encoding="utf-8"))
    made = read_training_set(FOLDER / f"{name}.npz")
    return Frozen(
        made=made,
        classifier=ClassifierSettings(**held["classifier"]),
        window_s=held["sources"][0]["recipe"]["window_s"],
        provenance={
            "commits": [source["commit"] for source in held["sources"]],
            "seeds": [source["seed"] for source in held["sources"]],
            "generated_windows": sum(source["windows"] for source in held["sources"]),
            "with_disturbed_copies": len(made.labels),
        },
    )


def save_frozen(name: str, made: TrainingSet, settings: dict[str, Any], folder: Path = FOLDER) -> None:
    """Writes both files; `settings` holds the classifier's, and for each source its commit, seed and recipe."""
    write_training_set(folder / f"{name}.npz", made)
    with atomic_file(folder / f"{name}.json") as temporary:
        temporary.write_text(json.dumps(settings, indent=1) + "\n", encoding="utf-8")
