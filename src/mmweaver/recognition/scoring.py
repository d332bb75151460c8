"""How well a recogniser does on recordings: windows, longer windows, whole recordings, with intervals."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.recognition.activity_classifier import ActivityClassifier
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.window_features import feature_matrix

RESAMPLINGS = 2000
LONG_WINDOWS = 3  # windows that vote together: 6 s of 2 s each


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """Votes of each window (window, activity), the true activity's index, and the recording it comes from."""

    classes: tuple[str, ...]
    votes: Float[np.ndarray, "window activity"]
    truth: Int[np.ndarray, " window"]
    recording: Int[np.ndarray, " window"]
    names: tuple[str, ...]  # of the recordings

    @property
    def guess(self) -> Int[np.ndarray, " window"]:
        return np.argmax(self.votes, axis=1)

    def part(self, which: np.ndarray) -> "Evaluation":
        """Some of the windows, by mask."""
        return replace(self, votes=self.votes[which], truth=self.truth[which], recording=self.recording[which])

    def pooled(self, group: np.ndarray) -> "Evaluation":
        """One row a group: the mean vote of its windows."""
        _, first, inverse = np.unique(group, return_index=True, return_inverse=True)
        total = np.zeros((len(first), self.votes.shape[1]))
        np.add.at(total, inverse.ravel(), self.votes)
        votes = total / np.bincount(inverse.ravel())[:, None]
        return Evaluation(
            classes=self.classes, votes=votes, truth=self.truth[first], recording=self.recording[first],
            names=self.names,
        )  # fmt: skip


def evaluate_recogniser(model: ActivityClassifier, recordings: list[PointRecording], window_s: float) -> Evaluation:
    """The recogniser's votes on all windows, one after the other. Raises InputError where none is long enough."""
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


def balanced_accuracy(truth: Int[np.ndarray, " n"], guess: Int[np.ndarray, " n"]) -> float:
    """Mean over the classes that occur of the share recognised.

    >>> balanced_accuracy(np.array([0, 0, 0, 1]), np.array([0, 0, 0, 0]))
    0.5
    """
    return float(np.mean([np.mean(guess[truth == kind] == kind) for kind in np.unique(truth)]))


def confusion(judged: Evaluation) -> Int[np.ndarray, "true guessed"]:
    """How often each activity (row) was taken for which (column)."""
    size = len(judged.classes)
    return np.bincount(judged.truth * size + judged.guess, minlength=size * size).reshape(size, size)


def interval(judged: Evaluation, seed: int = 0) -> tuple[float, float]:
    """95 % interval of the balanced accuracy: recordings of each activity drawn again with replacement."""
    rng = stream(seed, "recordings drawn again")
    size = len(judged.classes)
    hits = np.bincount(judged.recording, judged.guess == judged.truth, minlength=len(judged.names))
    count = np.bincount(judged.recording, minlength=len(judged.names)).astype(float)
    kind = np.full(len(judged.names), -1)
    kind[judged.recording] = judged.truth
    shares = []
    for one in range(size):
        own = np.flatnonzero(kind == one)
        if len(own):
            drawn = own[rng.integers(len(own), size=(RESAMPLINGS, len(own)))]
            shares.append(hits[drawn].sum(axis=1) / count[drawn].sum(axis=1))
    low, high = np.quantile(np.mean(shares, axis=0), [0.025, 0.975])
    return float(low), float(high)


def report(judged: Evaluation) -> dict[str, Any]:
    """Balanced accuracy of windows, of three windows together and of whole recordings, each with its interval."""
    place = np.concatenate([np.arange(n) for n in np.bincount(judged.recording) if n])
    whole = judged.pooled(judged.recording)
    long = judged.pooled(judged.recording * 10_000 + place // LONG_WINDOWS)
    chance = 1 / len(judged.classes)
    rows: dict[str, Any] = {"classes": list(judged.classes), "recordings": len(np.unique(judged.recording))}
    for name, one in (("window", judged), ("three_windows", long), ("recording", whole)):
        low, high = interval(one)
        rows[name] = {
            "balanced_accuracy": round(balanced_accuracy(one.truth, one.guess), 4),
            "interval_95": [round(low, 4), round(high, 4)],
            "floor": round(chance, 4),
            "n": len(one.truth),
            "confusion": confusion(one).tolist(),
        }
    return rows
