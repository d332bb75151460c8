"""What a classifier knows without looking at the radar signal: leaks.json.

One-nearest-neighbour classifiers see one circumstance each (start place, person, duration ...) and are tested on people
that they have not seen. With matched draws they are at chance. What cannot be equal between activities, such as energy,
posture or where a walk ends, is reported separately: it is part of what the radar sees.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.shapes import Array
from mmweaver.core.skeleton import joint

Z_99 = 2.576
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

    @property
    def leaks(self) -> bool:
        """Whether the accuracy is above chance beyond the interval."""
        return self.low > self.chance


def leak_report(
    circumstances: dict[str, Float[Array, "sequence column"]],
    label: Int[Array, " sequence"],
    group: Int[Array, " sequence"],
) -> dict[str, Any]:
    """The report as JSON types: each circumstance with its accuracy, interval and chance, and a verdict.

    `group`: the person (or draw) of each sequence; a classifier is never tested on a group that it has seen.
    """
    found = {name: _score(values, label, group) for name, values in circumstances.items()}
    avoidable = [name for name, leak in found.items() if leak.leaks and name not in INHERENT]
    rows = {
        name: {
            "accuracy": round(leak.accuracy, 4), "interval_99": [round(leak.low, 4), round(leak.high, 4)],
            "chance": round(leak.chance, 4), "sequences": leak.number, "leaks": leak.leaks,
            **({"cannot_be_avoided": INHERENT[name]} if name in INHERENT else {}),
        }
        for name, leak in found.items()
    }  # fmt: skip
    verdict = f"leaks: {', '.join(avoidable)}" if avoidable else "leaks: none found"
    shown = [f"{name} {leak.accuracy:.2f}" for name, leak in found.items() if leak.leaks and name in INHERENT]
    chance = next(iter(found.values())).chance
    part = f"part of the activities themselves: {', '.join(shown)} (chance {chance:.2f})" if shown else ""
    return {
        "schema_version": 2, "verdict": verdict, "inherent": part, "classifier": "1-nearest neighbour, unseen groups",
        "of": rows,
    }  # fmt: skip


def said(report: dict[str, Any]) -> str:
    """The verdict with what belongs to the activities, for people."""
    return "; ".join(filter(None, (report["verdict"], report["inherent"])))


def circumstances(
    joints_m: Sequence[Float[Array, "frame 22 3"]], label: Int[Array, " sequence"], **more: Sequence[Any]
) -> dict[str, Float[Array, "sequence column"]]:
    """What is known of sequences from their joints and their place in the set; `more`: further rows by name."""
    first_m, order = np.stack([one[0] for one in joints_m]), np.arange(len(joints_m))
    facing = np.stack([_facing(one) for one in first_m])
    body = first_m - first_m[:, :1]
    ahead = np.stack([-facing[:, 1], facing[:, 0]], axis=1)
    right_m, ahead_m = (np.sum(direction[:, None] * body[..., :2], axis=-1) for direction in (facing, ahead))
    posture = np.stack([right_m, ahead_m, body[..., 2]], axis=-1)
    rows = {
        "start_place": first_m[:, joint("pelvis"), :2], "heading": facing, "duration": [len(one) for one in joints_m],
        "order": order, "order_in_cycle": order % len(set(label.tolist())), **more,
        "start_posture": posture.reshape(len(posture), -1),
        "end_place": [one[-1, joint("pelvis"), :2] for one in joints_m],
    }  # fmt: skip
    return {name: np.asarray(values, np.float64).reshape(len(joints_m), -1) for name, values in rows.items()}


def _facing(joints_m: Float[Array, "22 3"]) -> Float[Array, "2"]:
    """The direction from the left to the right hip."""
    across = joints_m[joint("right_hip"), :2] - joints_m[joint("left_hip"), :2]
    return across / max(float(np.linalg.norm(across)), 1e-9)


def _score(values: Float[Array, "sequence column"], label: Array, group: Array) -> Leak:
    spread = values.std(axis=0)
    scaled = np.asarray(values / np.where(spread > 0, spread, 1.0), np.float64)
    right = np.zeros(len(label))
    for one in np.unique(group):
        test = group == one
        if (~test).any():
            right[test] = _right(scaled[~test], label[~test], scaled[test], label[test])
    number = len(label)
    accuracy = float(right.mean())
    chance = float(np.bincount(label).max() / number)
    low, high = _wilson(accuracy, number)
    return Leak(accuracy=accuracy, low=low, high=high, chance=chance, number=number)


def _right(train: Array, train_label: Array, test: Array, test_label: Array) -> Float[Array, " sequence"]:
    """The expected share of right answers of the nearest neighbour; equally near ones are asked in equal parts."""
    distance = np.linalg.norm(test[:, None] - train[None], axis=-1)
    nearest: Bool[Array, "test train"] = distance <= distance.min(axis=1, keepdims=True) + 1e-12
    same = train_label[None, :] == test_label[:, None]
    return (nearest & same).sum(axis=1) / nearest.sum(axis=1)


def _wilson(share: float, number: int) -> tuple[float, float]:
    """Wilson's score interval."""
    z2 = Z_99**2
    centre = (share + z2 / (2 * number)) / (1 + z2 / number)
    half = Z_99 / (1 + z2 / number) * np.sqrt(share * (1 - share) / number + z2 / (4 * number**2))
    return float(max(centre - half, 0.0)), float(min(centre + half, 1.0))
