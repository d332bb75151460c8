"""Zero-shot activity recognition: generate windows, compute features, train; no recording is involved.

Training from stored features takes seconds. Trees need no scaling of features.
"""

import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.core.seeding import stream
from mmweaver.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from mmweaver.recognition.generated_windows import GenerationRecipe, generate_windows
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.window_augmentation import augmented
from mmweaver.recognition.window_features import feature_matrix

COPIES = 3


@dataclass(frozen=True, kw_only=True)
class TrainingSet:
    """Features of generated windows (window, feature) with their labels."""

    features: Float[np.ndarray, "window feature"]
    labels: np.ndarray  # (window,) str
    names: tuple[str, ...]  # of the features

    def train(self, settings: ClassifierSettings | None = None) -> ActivityClassifier:
        """Trains a recogniser on this set alone."""
        return ActivityClassifier(settings, self.names).fit(self.features, self.labels)


def training_set(
    recipe: GenerationRecipe, *, each: int, seed: int = 0, cache: Path | None = None, copies: int = COPIES,
    report: Callable[[int, int], object] | None = None,
) -> TrainingSet:  # fmt: skip
    """Features of `each` generated windows of every activity; about 0.7 CPU-seconds per window.

    Each window is joined by `copies` augmented copies. A `cache` folder stores the windows, so that an interrupted run
    resumes; recipes cannot share one. Raises InputError for the cache of another recipe.
    """
    if cache is not None:
        check_cache(Path(cache), recipe)
    windows = generate_windows(recipe, each=each, seed=seed, cache=cache, report=report)
    return featurize(windows, copies=copies, seed=seed)


def featurize(
    windows: list[PointRecording], *, copies: int = COPIES, seed: int = 0, names: tuple[str, ...] | None = None
) -> TrainingSet:
    """Features of windows, followed by those of the first augmented copy of each, the second, and so on."""
    copied = [
        augmented(window, stream(seed, "disturbed", window.name, copy)) for copy in range(copies) for window in windows
    ]
    features, names = feature_matrix([*windows, *copied], names)
    return TrainingSet(
        features=rounded_to_digits(features), labels=np.array([one.label for one in [*windows, *copied]]), names=names
    )


def rounded_to_digits(features: np.ndarray) -> np.ndarray:
    """Features (window, feature) rounded to half precision as in a frozen file, which then gives the same trees."""
    return features.astype(np.float16).astype(np.float32)


def check_cache(cache: Path, recipe: GenerationRecipe) -> None:
    """Writes the recipe into a cache, or checks the existing one. Raises InputError for another recipe."""
    note = cache / "recipe.json"
    text = recipe.as_json()
    if note.exists() and read_text(note) != text:
        raise InputError(f"{cache} holds windows of another recipe; choose another folder or empty it")
    with atomic_file(note) as temporary:
        temporary.write_text(text, encoding="utf-8")


# files --------------------------------------------------------------------------------------------------------------
def write_training_set(path: Path, training: TrainingSet) -> None:
    """An .npz of features (float16 or float32), labels and names; the same arrays give the same values.

    LZMA, feature by feature: 0.6 of the size of windows row by row in the usual compression.
    """
    features = np.asfortranarray(_small(training.features))
    arrays = {"features": features, "labels": training.labels, "names": np.array(training.names)}
    with atomic_file(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, array in arrays.items():
            member = zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0))
            member.compress_type = zipfile.ZIP_LZMA
            with archive.open(member, "w") as file:
                np.lib.format.write_array(file, array, allow_pickle=False)


def _small(features: np.ndarray) -> np.ndarray:
    """Half precision if lossless, else float32."""
    half = features.astype(np.float16)
    return half if np.array_equal(half.astype(np.float32), features, equal_nan=True) else features.astype(np.float32)


def read_training_set(path: Path) -> TrainingSet:
    """Reads a file of `write_training_set`. Raises InputError for other files."""
    held = read_npz(path)
    return TrainingSet(
        features=held.numbers("features", ("window", "name"), nan=True).astype(np.float32, order="C"),
        labels=held.take("labels"),
        names=held.texts("names"),
    )
