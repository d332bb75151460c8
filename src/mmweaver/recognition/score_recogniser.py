"""Scores of a recogniser on labelled recordings, and how far these lie from what was generated."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.recognition.background_mask import left_out_lines, persistent_motion_cells
from mmweaver.recognition.point_recordings import PointRecording, read_task_recordings, windows_of
from mmweaver.recognition.recogniser import FEWEST, QUANTILES, Features, Quantiles, Recogniser
from mmweaver.recognition.scoring import Evaluation, report
from mmweaver.recognition.window_features import moving_points

LISTED = 10  # features that differ most
FAR = 0.5  # Kolmogorov-Smirnov distance above which a feature lies elsewhere
MOST_FAR, MOST_OUTSIDE = 0.25, 0.3  # shares of features and of windows above which a warning is due
MISTAKEN = 0.3  # of generated windows of a label, that are taken for another label


def score_recogniser(model: Recogniser, recordings: Path | str) -> dict[str, Any]:
    """Scores on a folder of labelled recordings: `window`, `three_windows`, `recording`, as `evaluate --json` has them.

    With them `generated_on_generated` (people who were generated and held out) and `distance` (recorded windows
    against generated ones, without labels), `warning` where the recordings lie outside, `contradictions`: what they
    show that cannot be if the task is right, `left_out`: what moves all the time in one place and was left out, and
    `hardly_distinct`: labels that the radar hardly tells apart. Raises InputError where the recordings give no window.
    """
    found = read_task_recordings(recordings, model.settings)
    return score_recordings(model, found)


def score_recordings(model: Recogniser, recordings: list[PointRecording]) -> dict[str, Any]:
    """As `score_recogniser`, of recordings that are read."""
    cut = [windows_of(recording, model.settings) for recording in recordings]
    windows = [window for own in cut for window in own]
    if not windows:
        raise InputError(f"no recording lasts {model.settings.window_s:g} s, which is one window; give longer ones")
    model, left_out = without_persistent_motion(model, recordings)
    features = model.features(windows)
    votes, outside = model.votes(features), model.is_outside(features)
    evaluation = Evaluation(
        classes=model.labels, votes=votes, truth=np.array([model.labels.index(window.label) for window in windows]),
        recording=np.repeat(np.arange(len(cut)), [len(own) for own in cut]),
        names=tuple(recording.name for recording in recordings),
    )  # fmt: skip
    generated = model.meta.get("moving_points_a_frame")
    far = distance(model, features) | {
        "windows_outside": round(float(outside.mean()), 4),
        "moving_points_a_frame": {
            "recorded": round(float(np.mean([moving_points(window) for window in windows])), 2),
            "generated": round(float(np.mean(list(generated.values()))), 2) if generated else None,
        },
    }
    return {
        **report(evaluation), "chance": round(1 / len(model.labels), 4),
        "generated_on_generated": model.meta.get("generated_on_generated"), "distance": far, "warning": warning(far),
        "contradictions": model.contradictions(recordings), "left_out": left_out,
        "hardly_distinct": hardly_distinct(model),
    }  # fmt: skip


def without_persistent_motion(model: Recogniser, recordings: Sequence[PointRecording]) -> tuple[Recogniser, list[str]]:
    """The recogniser without what moves all the time in one place of these recordings, and what to say of it."""
    cells = persistent_motion_cells(recordings, model.points.radar)
    points = model.points.without(cells)
    if len(points.busy) == len(model.points.busy):
        return model, []
    return replace(model, points=points), left_out_lines(cells)


def hardly_distinct(model: Recogniser) -> list[str]:
    """Labels that this radar hardly tells apart, by generated people: no recording can be expected to do better."""
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
    """How far features of recorded windows (window, feature) lie from those of generated ones."""
    far = feature_distances(features, model.generated, model.names)
    values = np.array(list(far.values()) or [0.0])
    return {
        "features": len(far), "mean": round(float(values.mean()), 4),
        "features_far": round(float((values > FAR).mean()), 4),
        "largest": sorted(far, key=lambda name: -far[name])[:LISTED],
    }  # fmt: skip


def feature_distances(features: Features, generated: Quantiles, names: tuple[str, ...]) -> dict[str, float]:
    """Kolmogorov-Smirnov distance of each feature between recorded and generated windows, at the stored quantiles."""
    found: dict[str, float] = {}
    for column, name in enumerate(names):
        values, edges = features[:, column], generated[:, column]
        values = values[np.isfinite(values)]
        if len(values) < FEWEST or np.isnan(edges).any():
            continue
        below = np.searchsorted(np.sort(values), edges, side="right") / len(values)
        under = np.searchsorted(np.sort(values), edges, side="left") / len(values)
        # where a value is frequent, any share between the two agrees
        found[name] = float(np.maximum(np.maximum(under - QUANTILES, QUANTILES - below), 0.0).max())
    return found


def warning(found: dict[str, Any]) -> str | None:
    """What to say where recordings lie outside what was generated; None where they do not."""
    if found["features_far"] > MOST_FAR or found["windows_outside"] > MOST_OUTSIDE:
        largest = ", ".join(found["largest"][:3])
        named = f" (most of all {largest})" if largest else ""
        features = f"{found['features_far']:.0%} of the features are far off{named} and " if found["features"] else ""
        return (
            f"the recordings lie outside what was generated: {features}"
            f"{found['windows_outside']:.0%} of the windows are unlike any; check radar,"
            " mount and sentences, or name the recordings as `unlabelled`; expect less than the score on generated"
            " people says"
        )
    return None
