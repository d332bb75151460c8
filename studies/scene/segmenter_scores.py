"""Scores of a segmenter, and a geometric baseline from heights and slopes."""

from collections.abc import Callable
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.shapes import Array
from mmweaver.scene.segmentation.builtin_segmenter import GROUP_NAMES, HEIGHT, HEIGHT_UNIT_M, MEASURED, SLOPE
from studies.scene.segmenter_data import SegmenterExample


def confusion(examples: list[SegmenterExample], guess: Callable[[np.ndarray], np.ndarray]) -> Int[Array, "truth guess"]:
    """Cells by true and predicted group; `guess` maps features (13, row, column) to groups (row, column)."""
    total = np.zeros((len(GROUP_NAMES),) * 2, np.int64)
    for example in examples:
        pair = example.groups * len(GROUP_NAMES) + guess(example.features)
        total += np.bincount(pair.ravel(), minlength=total.size).reshape(total.shape)
    return total


def scores(table: Int[Array, "truth guess"]) -> dict[str, Any]:
    """Mean intersection over union of the named groups that occur, that of each, and the accuracy over cells."""
    inside = np.diag(table).astype(float)
    union = table.sum(axis=0) + table.sum(axis=1) - inside
    occurs = (table.sum(axis=1) > 0) & (np.arange(len(table)) > 0)
    each = {GROUP_NAMES[g]: round(float(inside[g] / union[g]), 4) for g in np.flatnonzero(occurs)}
    return {
        "miou": round(float(np.mean(list(each.values()))), 4),
        "right": round(float(inside.sum() / table.sum()), 4),
        "iou": each,
    }


def by_geometry(features: Float[Array, "13 row column"]) -> Int[Array, "row column"]:
    """Baseline from heights and slopes: floor, ceiling, upright cells as wall, tables and seats by height."""
    height_m, slope, measured = HEIGHT_UNIT_M * features[HEIGHT], features[SLOPE], features[MEASURED] > 0
    guess = np.zeros(height_m.shape, np.int64)
    flat, upright = np.abs(slope) > 0.9, np.abs(slope) < 0.3
    guess[measured & upright] = GROUP_NAMES.index("wall-other")
    guess[measured & flat & (height_m > 0.6)] = GROUP_NAMES.index("table")
    guess[measured & flat & (height_m > 0.3) & (height_m <= 0.6)] = GROUP_NAMES.index("couch")
    guess[measured & flat & (height_m > 2.0)] = GROUP_NAMES.index("ceiling-other")
    guess[measured & (height_m < 0.08)] = GROUP_NAMES.index("floor-other")
    return guess
