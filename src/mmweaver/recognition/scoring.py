"""Scores of a recogniser on labelled recordings, with confidence intervals, and their distance from generated data."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.recognition.background_mask import left_out_lines, persistent_motion_cells
from mmweaver.recognition.guard_report import removed_points
from mmweaver.recognition.point_recordings import PointRecording, windows_of
from mmweaver.recognition.recogniser import FEWEST, QUANTILES, Features, Quantiles, Recogniser
from mmweaver.recognition.window_features import moving_points

RESAMPLINGS = 2000
LONG_WINDOWS = 3  # windows that are averaged: 6 s
LISTED = 10  # features with the largest differences
MISTAKEN = 0.3  # share of generated windows of a label that are confused with another label
FAR = 0.5  # Kolmogorov-Smirnov distance above which a feature is out of distribution
MAX_FAR, MAX_OUTSIDE = 0.25, 0.3  # shares of features and of windows above which a warning is given


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """Votes of a recogniser on labelled windows.

    Attributes:
        classes: Names of the activities.
        votes: Votes (window, activity).
        truth: Index of the true activity (window,).
        recording: Index of the recording (window,).
        names: Names of the recordings.
    """

    classes: tuple[str, ...]
    votes: Float[np.ndarray, "window activity"]
    truth: Int[np.ndarray, " window"]
    recording: Int[np.ndarray, " window"]
    names: tuple[str, ...]

    @property
    def guess(self) -> Int[np.ndarray, " window"]:
        """Index of the recognised activity (window,)."""
        return np.argmax(self.votes, axis=1)

    def part(self, which: np.ndarray) -> "Evaluation":
        """The windows selected by a mask or index (window,)."""
        return replace(self, votes=self.votes[which], truth=self.truth[which], recording=self.recording[which])

    def pooled(self, group: np.ndarray) -> "Evaluation":
        """Mean vote over the windows of each group.

        Args:
            group: Group number (window,).
        """
        _, first, inverse = np.unique(group, return_index=True, return_inverse=True)
        total = np.zeros((len(first), self.votes.shape[1]))
        np.add.at(total, inverse.ravel(), self.votes)
        return replace(self.part(first), votes=total / np.bincount(inverse.ravel())[:, None])


# scores of windows --------------------------------------------------------------------------------------------------
def balanced_accuracy(truth: Int[np.ndarray, " n"], guess: Int[np.ndarray, " n"]) -> float:
    """Recall averaged over the classes that occur.

    Args:
        truth: True classes (n,).
        guess: Recognised classes (n,).

    >>> balanced_accuracy(np.array([0, 0, 0, 1]), np.array([0, 0, 0, 0]))
    0.5
    """
    return float(np.mean([np.mean(guess[truth == kind] == kind) for kind in np.unique(truth)]))


def confusion(
    truth: Int[np.ndarray, " n"], guess: Int[np.ndarray, " n"], classes: int
) -> Int[np.ndarray, "true guessed"]:
    """Confusion matrix in counts.

    Args:
        truth: True activities (n,).
        guess: Recognised activities (n,).
        classes: Number of activities.

    Returns:
        Counts (true, recognised).
    """
    return np.bincount(truth * classes + guess, minlength=classes**2).reshape(classes, classes)


def interval(evaluation: Evaluation, seed: int = 0) -> tuple[float, float]:
    """95 % bootstrap interval of the balanced accuracy, resampling recordings within each activity.

    Args:
        evaluation: Votes on labelled windows.
        seed: Seed of the resampling.

    Returns:
        Lower and upper end.
    """
    rng, recordings = stream(seed, "recordings drawn again"), len(evaluation.names)
    hits = np.bincount(evaluation.recording, evaluation.guess == evaluation.truth, minlength=recordings)
    count = np.bincount(evaluation.recording, minlength=recordings).astype(float)
    kind = np.full(recordings, -1)
    kind[evaluation.recording] = evaluation.truth
    shares = []
    for one in range(len(evaluation.classes)):
        own = np.flatnonzero(kind == one)
        if len(own):
            resampled = own[rng.integers(len(own), size=(RESAMPLINGS, len(own)))]
            shares.append(hits[resampled].sum(axis=1) / count[resampled].sum(axis=1))
    low, high = np.quantile(np.mean(shares, axis=0), [0.025, 0.975])
    return float(low), float(high)


def report(evaluation: Evaluation) -> dict[str, Any]:
    """Balanced accuracy of windows, of groups of three and of whole recordings, with intervals and baseline."""
    place = np.concatenate([np.arange(n) for n in np.bincount(evaluation.recording) if n])
    classes = len(evaluation.classes)
    rows: dict[str, Any] = {"classes": list(evaluation.classes), "recordings": len(np.unique(evaluation.recording))}
    for name, one in (
        ("window", evaluation),
        ("three_windows", evaluation.pooled(evaluation.recording * 10_000 + place // LONG_WINDOWS)),
        ("recording", evaluation.pooled(evaluation.recording)),
    ):
        rows[name] = {
            "balanced_accuracy": round(balanced_accuracy(one.truth, one.guess), 4),
            "interval_95": [round(end, 4) for end in interval(one)],
            "baseline": {"chance": round(1 / classes, 4)},
            "n": len(one.truth),
            "confusion": confusion(one.truth, one.guess, classes).tolist(),
        }
    return rows


# scores of recordings -----------------------------------------------------------------------------------------------
def score_recordings(model: Recogniser, recordings: Sequence[PointRecording]) -> dict[str, Any]:
    """Scores on labelled recordings, as in `recognise score --json`.

    Args:
        model: The recogniser.
        recordings: Labelled recordings.

    Returns:
        `window`, `three_windows` and `recording`; `generated_on_generated` (accuracy on generated people that were held
        out); `distance` (recorded windows against generated ones, without labels); `warning` where the recordings are
        out of distribution; `contradictions` with the task; `left_out`, places with persistent motion that were
        ignored; `removed`, what guards removed from each recording, and its missing frames; and `hardly_distinct`,
        labels that the radar cannot discriminate.

    Raises:
        InputError: If the recordings contain no complete window.
    """
    cut = [windows_of(recording, model.settings) for recording in recordings]
    windows = [window for own in cut for window in own]
    if not windows:
        raise InputError(f"no recording lasts {model.settings.window_s:g} s, which is one window; give longer ones")
    model, left_out = mask_persistent_motion(model, recordings)
    removed = removed_points(model.points, recordings, [len(own) for own in cut])
    features = model.features(windows)
    evaluation = Evaluation(
        classes=model.labels,
        votes=model.votes(features),
        truth=np.array([model.labels.index(window.label) for window in windows]),
        recording=np.repeat(np.arange(len(cut)), [len(own) for own in cut]),
        names=tuple(recording.name for recording in recordings),
    )
    generated = model.meta.get("moving_points_a_frame")
    far = distance(model, features) | {
        "moving_points_a_frame": {
            "recorded": round(float(np.mean([moving_points(window) for window in windows])), 2),
            "generated": round(float(np.mean(list(generated.values()))), 2) if generated else None,
        },
    }
    return {
        **report(evaluation),
        "chance": round(1 / len(model.labels), 4),
        "generated_on_generated": model.meta.get("generated_on_generated"),
        "distance": far,
        "warning": warning(far),
        "contradictions": model.contradictions(recordings),
        "left_out": left_out,
        "removed": removed,
        "hardly_distinct": hardly_distinct(model),
    }


def mask_persistent_motion(model: Recogniser, recordings: Sequence[PointRecording]) -> tuple[Recogniser, list[str]]:
    """The recogniser without cells of persistent motion in these recordings, and lines of text about them."""
    if "persistent" in model.points.off:
        return model, []
    cells = persistent_motion_cells(recordings, model.points.radar)
    known = np.concatenate([model.points.persistent, cells])
    return replace(model, points=replace(model.points, persistent=np.unique(known, axis=0))), left_out_lines(cells)


def hardly_distinct(model: Recogniser) -> list[str]:
    """Labels that this radar hardly discriminates, judged by generated people.

    Recordings cannot be expected to do better.
    """
    expected = model.meta.get("generated_on_generated") or {}
    found: list[str] = []
    for label, row in zip(model.labels, expected.get("confusion", []), strict=False):
        for other, count in zip(model.labels, row, strict=True):
            share = count / max(sum(row), 1)
            if other != label and share >= MISTAKEN:
                found.append(
                    f"{label} is taken for {other} in {share:.0%} of generated windows: the radar, so set, hardly tells"
                    " them apart; other settings, a longer window or one label for both may help"
                )
    return found


def distance(model: Recogniser, features: Features) -> dict[str, Any]:
    """Distance of recorded windows from generated ones in feature space.

    Args:
        model: The recogniser.
        features: Features (window, feature) of recorded windows.

    Returns:
        Number, mean and largest of the feature distances, and shares out of distribution.
    """
    far = feature_distances(features, model.generated, model.names)
    values = np.array(list(far.values()) or [0.0])
    return {
        "features": len(far),
        "mean": round(float(values.mean()), 4),
        "features_far": round(float((values > FAR).mean()), 4),
        "largest": sorted(far, key=lambda name: -far[name])[:LISTED],
        "windows_outside": round(float(model.is_outside(features).mean()), 4),
    }


def feature_distances(features: Features, generated: Quantiles, names: tuple[str, ...]) -> dict[str, float]:
    """Kolmogorov-Smirnov distance of each feature between recorded and generated windows, at the stored quantiles.

    Args:
        features: Features (window, feature) of recorded windows.
        generated: Quantiles of generated windows.
        names: Names of the features.
    """
    found: dict[str, float] = {}
    for name, values, edges in zip(names, features.T, generated.T, strict=True):
        values = np.sort(values[np.isfinite(values)])
        if len(values) < FEWEST or np.isnan(edges).any():
            continue
        below, under = (np.searchsorted(values, edges, side=side) / len(values) for side in ("right", "left"))
        # where a value is frequent, any share between the two agrees
        found[name] = float(np.maximum(np.maximum(under - QUANTILES, QUANTILES - below), 0.0).max())
    return found


def warning(found: dict[str, Any]) -> str | None:
    """Text of the warning for recordings that are out of distribution, None if they are not."""
    if found["features_far"] <= MAX_FAR and found["windows_outside"] <= MAX_OUTSIDE:
        return None
    largest = ", ".join(found["largest"][:3])
    named = f" (most of all {largest})" if largest else ""
    features = f"{found['features_far']:.0%} of the features are far off{named} and " if found["features"] else ""
    return (
        f"the recordings lie outside what was generated: {features}"
        f"{found['windows_outside']:.0%} of the windows are unlike any; check radar,"
        " mount and sentences, or name the recordings as `unlabelled`; expect less than the score on generated"
        " people says"
    )
