"""Output of mmweaver recognise: what was trained, and its scores."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.recognition.guard_report import removed_lines

if TYPE_CHECKING:
    from mmweaver.recognition.recogniser import Recogniser

LEAST_CONFUSED, MOST_LISTED = 0.1, 3  # minimum share of the windows of a label; number of confusions


def training_lines(model: "Recogniser", out: Path) -> list[str]:
    """Summary of a training, with the expected accuracy."""
    meta, expected = model.meta, model.meta["generated_on_generated"]
    text = [
        f"wrote {out}: {len(model.labels)} activities, {meta['generated_windows']} generated windows,"
        f" {meta['cpu_seconds']:.0f} CPU-s",
        f"generated people held out: balanced accuracy {expected['balanced_accuracy']:.2f} (chance"
        f" {expected['chance']:.2f}); recordings of people are harder: mmweaver recognise score tells",
        *confused_lines(model.labels, expected["confusion"]),
        "moving points per frame: "
        + ", ".join(f"{label} {count:g}" for label, count in meta["moving_points_a_frame"].items()),
    ]
    if "labelled_windows" in meta:
        text.append(f"with {meta['labelled_windows']} windows of labelled recordings")
    if "unlabelled_windows" in meta:
        done = meta["self_training"]
        why = "" if done["used"] else f", without self-training: {done['why']}"
        text.append(f"adapted to {meta['unlabelled_windows']} unlabelled windows{why}")
    text += contradiction_lines(meta.get("contradictions", [])) + [f"  {one}" for one in meta.get("left_out", [])]
    return text + [f"  {one}" for one in removed_lines(meta.get("removed", []))]


def confused_lines(labels: Sequence[str], confusion: list[list[int]]) -> list[str]:
    """The most frequent confusions between labels, if they concern at least a tenth of the windows."""
    shares = [
        (row[other] / max(sum(row), 1), label, labels[other])
        for label, row in zip(labels, confusion, strict=True)
        for other in range(len(labels))
        if labels[other] != label
    ]
    worst = [one for one in sorted(shares, reverse=True) if one[0] >= LEAST_CONFUSED][:MOST_LISTED]
    if not worst:
        return []
    return ["most often mistaken: " + ", ".join(f"{label} for {other} ({share:.0%})" for share, label, other in worst)]


def contradiction_lines(found: list[str]) -> list[str]:
    """Contradictions between recordings and the task."""
    return [f"  the recordings contradict the task: {one}" for one in found]


def score_lines(scores: dict[str, Any]) -> list[str]:
    """Scores with baseline, confusion matrix, and distance of the recordings from generated ones."""
    text = [f"{scores['recordings']} recordings", *accuracy_lines(scores)]
    expected = scores["generated_on_generated"]
    if expected:
        text.append(f"  on generated people who were held out: {expected['balanced_accuracy']:.3f}")
    text += confusion_lines(scores)
    far = scores["distance"]
    compared = f"{far['features_far']:.0%} of {far['features']} features are far off, " if far["features"] else ""
    text.append(f"  from generated windows: {compared}{far['windows_outside']:.0%} of windows are unlike any")
    count = far["moving_points_a_frame"]
    if count["generated"] is not None:
        text.append(f"  moving points per frame: {count['recorded']:g} recorded, {count['generated']:g} generated")
    text += [f"  {line}" for line in scores["hardly_distinct"]] + contradiction_lines(scores["contradictions"])
    text += [f"  {one}; name `background` or `unlabelled`, so that run does so, too" for one in scores["left_out"]]
    text += [f"  {one}" for one in removed_lines(scores["removed"])]
    if scores.get("pictures"):
        text.append(f"  {len(scores['pictures'])} pictures of what guards removed")
    return text + ([f"  warning: {scores['warning']}"] if scores["warning"] else [])


def accuracy_lines(scores: dict[str, Any]) -> list[str]:
    """Balanced accuracy with interval and chance: per window, per three windows, per recording."""
    text = []
    for name, words in (("window", "windows"), ("three_windows", "three windows"), ("recording", "recordings")):
        row = scores[name]
        low, high = row["interval_95"]
        text.append(
            f"  {words:14} balanced accuracy {row['balanced_accuracy']:.3f} ({low:.3f} to {high:.3f}), chance"
            f" {row['baseline']['chance']:.3f}, n {row['n']}"
        )
    return text


def confusion_lines(scores: dict[str, Any]) -> list[str]:
    """The confusion matrix of windows."""
    width = max(len(name) for name in scores["classes"]) + 2
    text = ["  windows, true in rows, recognised in columns"]
    text.append(" " * (width + 2) + "".join(f"{name:>{width}}" for name in scores["classes"]))
    for name, row in zip(scores["classes"], scores["window"]["confusion"], strict=True):
        text.append(f"  {name:{width}}" + "".join(f"{count:>{width}}" for count in row))
    return text
