"""How accurately the activity network recognises in rooms, layouts and people it has not seen.

    python -m studies run activity_accuracy --data DATASET --weights ACTIVITY

Twelve classes; intervals are over rooms. Baselines: chance, and always the most frequent activity of the split.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_store import read_plan, read_radar
from mmweaver.models.activity_network import ACTIVITY_NAMES, ActivityNetwork
from mmweaver.models.weights import load_into
from mmweaver.training.activity_training import ActivityExamples, activity_examples, scores_of
from studies.manifest import StudyRun
from studies.network.learned_scores import interval
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

SPLITS = ("test_room", "test_layout", "test_person")


def row_of(network: ActivityNetwork, examples: ActivityExamples, split: str) -> dict[str, Any]:
    """Accuracy in a split, its baselines, and the confusion matrix."""
    answers, label = scores_of(network, examples).argmax(dim=1).numpy(), examples.label.numpy()
    mean, low, high = interval((answers == label).astype(np.float64), list(examples.room))
    counts = np.bincount(label, minlength=len(ACTIVITY_NAMES))
    confusion = np.zeros((len(ACTIVITY_NAMES), len(ACTIVITY_NAMES)), int)
    np.add.at(confusion, (label, answers), 1)
    baseline = {"chance": 1 / len(ACTIVITY_NAMES), "commonest": float(counts.max() / counts.sum())}
    return {
        "split": split, "n": len(label), "num_rooms": len(set(examples.room)), "num_people": len(set(examples.person)),
        "num_activities": int((counts > 0).sum()), "confusion": confusion.tolist(),
        "metrics": {"accuracy": {"value": mean, "interval_95": [low, high], "unit": "1", "baseline": baseline}},
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument("--weights", type=Path, action=Reads, required=True, help="of recipe activity")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    network = ActivityNetwork(read_radar(options.data))
    card = load_into(network, options.weights, recipe="activity")
    rows = []
    for split in SPLITS:
        try:
            rows.append(row_of(network, activity_examples(options.data, (split,)), split))
        except InputError:
            continue
        metric = rows[-1]["metrics"]["accuracy"]
        print(f"{split:12} {metric['value']:.3f} {metric['interval_95']}")
    rows = complete_rows(
        rows, dataset=dataset_of(options.data), seeds=[0], unknown={"seconds": "see the manifest: all rows together"}
    )
    run.write(
        "activity_accuracy", "activity",
        config={"weights": card.__dict__, "data_plan": read_plan(options.data), "activities": ACTIVITY_NAMES},
        rows=rows,
    )  # fmt: skip
