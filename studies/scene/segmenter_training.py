"""Trains the built-in segmenter on procedural rooms, and evaluates it on unseen kinds of rooms.

Recipe: 8 kinds of rooms for training, 4 others for the test; depth with the errors of a stereo camera, estimated
gravity; crops, flips, other colours, light, holes (`segmenter_data`); AdamW with one-cycle schedule, weighted
cross-entropy. One thread, one seed.

    python -m studies run segmenter_training --out segmenter.safetensors --log segmenter.json --work work/

`--work` keeps the rooms and the state of the training: a run that was stopped continues from there.
"""

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.core.tensor_files import write_tensors
from mmweaver.scene.segmentation.builtin_segmenter import (
    GROUP_NAMES,
    HEIGHT,
    HEIGHT_UNIT_M,
    MEASURED,
    SLOPE,
    groups_of_cells,
    make_network,
)
from mmweaver.training.trainer import Resumable
from studies.manifest import StudyRun
from studies.scene.segmenter_data import SegmenterExample, augmented, make_examples

TRAIN_KINDS = ("office", "living_room", "lab", "kitchen", "library", "bedroom", "meeting_room", "corridor")
TEST_KINDS = ("dining_room", "classroom", "gym", "workshop")
TRAIN_SEED, TEST_SEED = 1000, 900_000


@dataclass(frozen=True, kw_only=True)
class SegmenterRecipe:
    """Hyperparameters of the segmenter."""

    rooms_per_kind: int = 80
    test_rooms_per_kind: int = 12
    epochs: int = 60
    batch: int = 8
    learning_rate: float = 3e-3
    seed: int = 0


def train(
    examples: list[SegmenterExample],
    recipe: SegmenterRecipe,
    work: Path | None = None,
    say: Callable[[str], None] = print,
) -> tuple[Any, list[float]]:
    """The trained network, and the loss of each epoch. Resumes from the state of this recipe in `work`, if any."""
    import torch

    torch.manual_seed(recipe.seed)
    network = make_network()
    weights = torch.tensor(_class_weights(examples), dtype=torch.float32)
    loss_of = torch.nn.CrossEntropyLoss(weight=weights, label_smoothing=0.03)
    optimiser = torch.optim.AdamW(network.parameters(), lr=recipe.learning_rate, weight_decay=2e-2)
    steps = recipe.epochs * -(-len(examples) // recipe.batch)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, recipe.learning_rate, total_steps=steps)
    parts = {"network": network, "optimiser": optimiser, "schedule": schedule}
    state = work / f"state-{len(examples)}-{recipe.epochs}-{recipe.seed}.pt" if work is not None else None
    progress = Resumable(state, parts)
    for epoch in progress.steps(recipe.epochs):
        # random numbers follow from the epoch, so that a resumed run equals an uninterrupted one
        rng, total = stream(recipe.seed, "segmenter", f"epoch {epoch}"), 0.0
        order = rng.permutation(len(examples))
        for first in range(0, len(order), recipe.batch):
            chosen = [augmented(examples[index], rng) for index in order[first : first + recipe.batch]]
            cells = torch.from_numpy(np.stack([features for features, _ in chosen]))
            loss = loss_of(network(cells), torch.from_numpy(np.stack([groups for _, groups in chosen])))
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            schedule.step()
            total += float(loss.detach()) * len(chosen)
        progress.history.append({"epoch": epoch, "loss": total / len(examples)})
        say(f"epoch {epoch + 1:3d}  loss {total / len(examples):.4f}")
    return network.eval(), [row["loss"] for row in progress.history]


def _class_weights(examples: list[SegmenterExample]) -> np.ndarray:
    counts = np.bincount(np.concatenate([example.groups.ravel() for example in examples]), minlength=len(GROUP_NAMES))
    share = np.maximum(counts / counts.sum(), 1e-4)
    return np.clip((1 / len(GROUP_NAMES) / share) ** 0.5, 0.3, 4.0)


def save_weights(network: Any, path: Path) -> None:
    """All weights as float16 safetensors."""
    state = {name: value.half() for name, value in network.state_dict().items() if value.is_floating_point()}
    write_tensors(path, state)


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


def train_and_score(out: Path, recipe: SegmenterRecipe, work: Path | None = None) -> dict[str, Any]:
    """Generates rooms, trains, evaluates on unseen kinds, writes the weights; returns the log."""
    import torch

    torch.set_num_threads(1)
    start = time.process_time()
    rooms = None if work is None else work / "rooms"
    examples = make_examples(TRAIN_KINDS, recipe.rooms_per_kind, TRAIN_SEED, rooms)
    held_out = make_examples(TEST_KINDS, recipe.test_rooms_per_kind, TEST_SEED, rooms)
    generated = time.process_time()
    network, losses = train(examples, recipe, work)
    trained = time.process_time()
    counts = np.bincount(np.concatenate([example.groups.ravel() for example in examples]), minlength=len(GROUP_NAMES))
    majority = int(np.argmax(counts))
    guesses = {
        "network": lambda features: groups_of_cells(features, network),
        "majority": lambda features: np.full(features.shape[1:], majority),
        "geometry": by_geometry,
    }
    save_weights(network, out)
    return {
        "recipe": asdict(recipe), "train_kinds": TRAIN_KINDS, "test_kinds": TEST_KINDS,
        "rooms": {"train": len(examples), "test": len(held_out)},
        "parameters": sum(value.numel() for value in network.parameters()), "bytes": out.stat().st_size,
        "cpu_s": {"rooms": round(generated - start, 1), "training": round(trained - generated, 1)},
        "loss": [round(loss, 5) for loss in losses],
        "unseen_kinds": {name: scores(confusion(held_out, guess)) for name, guess in guesses.items()},
        "seen_kinds": {"network": scores(confusion(examples[:: max(len(examples) // 100, 1)], guesses["network"]))},
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    recipe = SegmenterRecipe()
    parser.add_argument("--out", type=Path, required=True, help="file of the weights")
    parser.add_argument("--log", type=Path, required=True, help="file of recipe, losses and scores, JSON")
    parser.add_argument("--work", type=Path, default=None, help="folder of rooms and state, to continue a stopped run")
    parser.add_argument("--rooms", type=int, default=recipe.rooms_per_kind, help="rooms of each kind")
    parser.add_argument("--epochs", type=int, default=recipe.epochs)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    log = train_and_score(
        options.out, SegmenterRecipe(rooms_per_kind=options.rooms, epochs=options.epochs), options.work
    )
    options.log.write_text(json.dumps(log, indent=1) + "\n", encoding="utf-8")
