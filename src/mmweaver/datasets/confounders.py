"""Confounders: how well the label is predicted without the radar signal; leaks.json.

One-nearest-neighbour classifiers see one circumstance each (start place, person, duration ...) and are tested on unseen
people, over all labels and on each label. With paired draws they are at chance. Circumstances that necessarily differ
between activities, such as energy, posture or the end of a walk, are reported separately: they are part of what the
radar sees.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.shapes import Array
from mmweaver.core.skeleton import joint

Z_99 = 2.576
Z_LABELS = 4.2  # 99 % over about a hundred comparisons: every circumstance with every label
INHERENT = {
    "start_posture": "a sequence shows the activity from its first frame on, so its first posture is part of it",
    "end_place": "where a person ends is part of what is done: a walk leads elsewhere",
    "energy": "how much a body moves is part of what is done",
}


@dataclass(frozen=True, kw_only=True)
class Leak:
    """How well one circumstance predicts the label."""

    accuracy: float
    low: float  # 99 % interval (Wilson)
    high: float
    chance: float
    number: int
    of_labels: dict[int, float]  # accuracy on single labels above chance, by label number

    @property
    def leaks(self) -> bool:
        """Whether the accuracy, overall or on one label, is significantly above chance."""
        return self.low > self.chance or bool(self.of_labels)


def leak_report(
    circumstances: dict[str, Float[Array, "sequence column"]],
    label: Int[Array, " sequence"],
    group: Int[Array, " sequence"],
    label_names: Sequence[str],
    reasons: dict[str, str] | None = None,
) -> dict[str, Any]:
    """Tests every circumstance as a predictor of the label.

    Args:
        circumstances: Circumstances by name, (sequence, column).
        label: Label number of each sequence.
        group: Person (or draw) of each sequence; classifiers are tested on unseen groups only.
        label_names: Names of the labels by number.
        reasons: Why a circumstance cannot be equal for all labels, in addition to `INHERENT`. Default: none.

    Returns:
        JSON types: a verdict, and for each circumstance accuracy, interval, chance, and the labels it predicts on their
        own, i.e. significantly more often right than by chance and than others are mistaken for them.
    """
    found = {name: _score(values, label, group) for name, values in circumstances.items()}
    avoidable = [name for name, leak in found.items() if leak.leaks and name not in INHERENT]
    reasons = INHERENT | (reasons or {})
    rows = {
        name: {
            "accuracy": round(leak.accuracy, 4),
            "interval_99": [round(leak.low, 4), round(leak.high, 4)],
            "chance": round(leak.chance, 4),
            "sequences": leak.number,
            "leaks": leak.leaks,
            "labels": {label_names[one]: round(accuracy, 4) for one, accuracy in leak.of_labels.items()},
            **({"cannot_be_avoided": reasons[name]} if name in reasons else {}),
        }
        for name, leak in found.items()
    }
    verdict = f"leaks: {', '.join(avoidable)}" if avoidable else "leaks: none found"
    if why := list(dict.fromkeys(reasons[name] for name in avoidable if name in reasons)):
        verdict += f" ({'; '.join(why)})"
    shown = [f"{name} {leak.accuracy:.2f}" for name, leak in found.items() if leak.leaks and name in INHERENT]
    chance = next(iter(found.values())).chance
    part = f"part of the activities themselves: {', '.join(shown)} (chance {chance:.2f})" if shown else ""
    return {
        "schema_version": 4,
        "verdict": verdict,
        "inherent": part,
        "classifier": "1-nearest neighbour, unseen groups",
        "of": rows,
    }


def verdict_of(report: dict[str, Any]) -> str:
    """Verdict of a report, with the circumstances that are part of the activities."""
    return "; ".join(filter(None, (report["verdict"], report["inherent"])))


def circumstances(
    joints_m: Sequence[Float[Array, "frame 22 3"]], label: Int[Array, " sequence"], **more: Sequence[Any]
) -> dict[str, Float[Array, "sequence column"]]:
    """Collects the circumstances of sequences that are known without the signal.

    Args:
        joints_m: Joints in metres of each sequence, (frame, 22, 3).
        label: Label number of each sequence.
        **more: Further circumstances, one value or row per sequence.

    Returns:
        Circumstances by name, (sequence, column).
    """
    first_m, order = np.stack([one[0] for one in joints_m]), np.arange(len(joints_m))
    facing = np.stack([_facing(one) for one in first_m])
    body = first_m - first_m[:, :1]
    ahead = np.stack([-facing[:, 1], facing[:, 0]], axis=1)
    right_m, ahead_m = (np.sum(direction[:, None] * body[..., :2], axis=-1) for direction in (facing, ahead))
    posture = np.stack([right_m, ahead_m, body[..., 2]], axis=-1)
    rows = {
        "start_place": first_m[:, joint("pelvis"), :2],
        "heading": facing,
        "duration": [len(one) for one in joints_m],
        "order": order,
        "order_in_cycle": order % len(set(label.tolist())),
        **more,
        "start_posture": posture.reshape(len(posture), -1),
        "end_place": [one[-1, joint("pelvis"), :2] for one in joints_m],
    }
    return {name: np.asarray(values, np.float64).reshape(len(joints_m), -1) for name, values in rows.items()}


def _facing(joints_m: Float[Array, "22 3"]) -> Float[Array, "2"]:
    """Direction from the left to the right hip."""
    across = joints_m[joint("right_hip"), :2] - joints_m[joint("left_hip"), :2]
    return across / max(float(np.linalg.norm(across)), 1e-9)


def _score(values: Float[Array, "sequence column"], label: Array, group: Array) -> Leak:
    spread = values.std(axis=0)
    scaled = np.asarray(values / np.where(spread > 0, spread, 1.0), np.float64)
    labels = np.unique(label)
    answered = np.zeros((len(label), len(labels)))
    for one in np.unique(group):
        test = group == one
        if (~test).any():
            answered[test] = _answers(scaled[~test], label[~test], scaled[test], labels)
    is_own = label[:, None] == labels
    number, accuracy = len(label), float(answered[is_own].mean())
    chance = float(np.bincount(label).max() / number)
    low, high = _wilson(accuracy, number)
    alone = {}
    for one, answer, own in zip(labels.tolist(), answered.T, is_own.T, strict=True):
        # a label predicted equally often for other labels is not recognised
        if own.all():
            continue
        recall, others = float(answer[own].mean()), float(answer[~own].mean())
        if _wilson(recall, int(own.sum()), Z_LABELS)[0] > max(chance, _wilson(others, int((~own).sum()), Z_LABELS)[1]):
            alone[one] = recall
    return Leak(accuracy=accuracy, low=low, high=high, chance=chance, number=number, of_labels=alone)


def _answers(train: Array, train_label: Array, test: Array, labels: Array) -> Float[Array, "sequence label"]:
    """Votes of the nearest neighbour for each label; ties are shared equally."""
    distance = np.linalg.norm(test[:, None] - train[None], axis=-1)
    nearest: Bool[Array, "test train"] = distance <= distance.min(axis=1, keepdims=True) + 1e-12
    return (nearest @ (train_label[:, None] == labels).astype(float)) / nearest.sum(axis=1, keepdims=True)


def _wilson(share: float, number: int, z: float = Z_99) -> tuple[float, float]:
    """Wilson score interval."""
    z2 = z**2
    centre = (share + z2 / (2 * number)) / (1 + z2 / number)
    half = z / (1 + z2 / number) * np.sqrt(share * (1 - share) / number + z2 / (4 * number**2))
    return float(max(centre - half, 0.0)), float(min(centre + half, 1.0))
