"""Scores of a recogniser on recordings: single windows, groups of windows and whole recordings, with intervals."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.seeding import stream

RESAMPLINGS = 2000
LONG_WINDOWS = 3  # windows that are averaged: 6 s


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """Votes (window, activity), index of the true activity (window,), and index of the recording (window,)."""

    classes: tuple[str, ...]
    votes: Float[np.ndarray, "window activity"]
    truth: Int[np.ndarray, " window"]
    recording: Int[np.ndarray, " window"]
    names: tuple[str, ...]  # of the recordings

    @property
    def guess(self) -> Int[np.ndarray, " window"]:
        return np.argmax(self.votes, axis=1)

    def part(self, which: np.ndarray) -> "Evaluation":
        """The windows selected by a mask (window,)."""
        return replace(self, votes=self.votes[which], truth=self.truth[which], recording=self.recording[which])

    def pooled(self, group: np.ndarray) -> "Evaluation":
        """Mean vote of the windows of each group; `group` (window,)."""
        _, first, inverse = np.unique(group, return_index=True, return_inverse=True)
        total = np.zeros((len(first), self.votes.shape[1]))
        np.add.at(total, inverse.ravel(), self.votes)
        votes = total / np.bincount(inverse.ravel())[:, None]
        return Evaluation(
            classes=self.classes, votes=votes, truth=self.truth[first], recording=self.recording[first],
            names=self.names,
        )  # fmt: skip


def balanced_accuracy(truth: Int[np.ndarray, " n"], guess: Int[np.ndarray, " n"]) -> float:
    """Recall averaged over the classes that occur.

    >>> balanced_accuracy(np.array([0, 0, 0, 1]), np.array([0, 0, 0, 0]))
    0.5
    """
    return float(np.mean([np.mean(guess[truth == kind] == kind) for kind in np.unique(truth)]))


def confusion(evaluation: Evaluation) -> Int[np.ndarray, "true guessed"]:
    """Confusion matrix in counts: true activity (row), recognised activity (column)."""
    size = len(evaluation.classes)
    return np.bincount(evaluation.truth * size + evaluation.guess, minlength=size * size).reshape(size, size)


def interval(evaluation: Evaluation, seed: int = 0) -> tuple[float, float]:
    """95 % bootstrap interval of the balanced accuracy, resampling recordings within each activity."""
    rng = stream(seed, "recordings drawn again")
    size = len(evaluation.classes)
    hits = np.bincount(evaluation.recording, evaluation.guess == evaluation.truth, minlength=len(evaluation.names))
    count = np.bincount(evaluation.recording, minlength=len(evaluation.names)).astype(float)
    kind = np.full(len(evaluation.names), -1)
    kind[evaluation.recording] = evaluation.truth
    shares = []
    for one in range(size):
        own = np.flatnonzero(kind == one)
        if len(own):
            resampled = own[rng.integers(len(own), size=(RESAMPLINGS, len(own)))]
            shares.append(hits[resampled].sum(axis=1) / count[resampled].sum(axis=1))
    low, high = np.quantile(np.mean(shares, axis=0), [0.025, 0.975])
    return float(low), float(high)


def report(evaluation: Evaluation) -> dict[str, Any]:
    """Balanced accuracy of windows, groups of three and whole recordings, with intervals and baseline."""
    place = np.concatenate([np.arange(n) for n in np.bincount(evaluation.recording) if n])
    whole = evaluation.pooled(evaluation.recording)
    long = evaluation.pooled(evaluation.recording * 10_000 + place // LONG_WINDOWS)
    chance = 1 / len(evaluation.classes)
    rows: dict[str, Any] = {"classes": list(evaluation.classes), "recordings": len(np.unique(evaluation.recording))}
    for name, one in (("window", evaluation), ("three_windows", long), ("recording", whole)):
        low, high = interval(one)
        rows[name] = {
            "balanced_accuracy": round(balanced_accuracy(one.truth, one.guess), 4),
            "interval_95": [round(low, 4), round(high, 4)],
            "baseline": {"chance": round(chance, 4)},
            "n": len(one.truth),
            "confusion": confusion(one).tolist(),
        }
    return rows
