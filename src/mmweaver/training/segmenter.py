"""Trains the built-in segmenter on procedural rooms, and scores it on kinds of rooms that it never saw.

python -m mmweaver.training.segmenter --out src/mmweaver/weights/segmenter.safetensors --log segmenter.json

Recipe: 8 kinds of rooms for training, 4 others for the test; depth with a stereo camera's errors, gravity as the
product finds it; flips, gains and tints; AdamW with one cosine, weighted cross-entropy. One thread, one seed.
"""

import argparse
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.geometry.rotations import level_from_camera
from mmweaver.scene.builtin_segmenter import (
    EVERY,
    GROUP_NAMES,
    grid_features,
    group_of_classes,
    groups_of_cells,
    make_network,
)
from mmweaver.scene.depth_grid import make_grid
from mmweaver.scene.gravity import find_gravity
from mmweaver.scene.procedural.lighting import LIGHTINGS
from mmweaver.scene.procedural.room import make_room

TRAIN_KINDS = ("office", "living_room", "lab", "kitchen", "library", "bedroom", "meeting_room", "corridor")
TEST_KINDS = ("dining_room", "classroom", "gym", "workshop")


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """What is trained, and for how long."""

    rooms_per_kind: int = 15
    test_rooms_per_kind: int = 6
    epochs: int = 24
    batch: int = 8
    learning_rate: float = 3e-3
    seed: int = 0


@dataclass(frozen=True, kw_only=True)
class Example:
    """One room: what the network sees of its cells, and their groups."""

    kind: str
    features: Float[Array, "7 row column"]
    groups: Int[Array, "row column"]


def make_example(kind: str, seed: int) -> Example:
    """A room of that kind as the product would see it. Raises InputError where the room cannot be arranged."""
    lighting = list(LIGHTINGS)[int(stream(seed, "segmenter", kind).integers(len(LIGHTINGS)))]
    photo = make_room(kind, 0, seed).photo(lighting, noise=True)
    assert photo.classes is not None
    grid = make_grid(photo)
    assert grid.class_index is not None
    gravity = find_gravity(grid)
    features = grid_features(grid, level_from_camera(gravity.up_camera), gravity.floor_z_m)
    groups = group_of_classes(photo.classes.names)[grid.class_index[::EVERY, ::EVERY]]
    return Example(kind=kind, features=features, groups=groups.astype(np.int64))


def make_examples(kinds: tuple[str, ...], per_kind: int, first_seed: int) -> list[Example]:
    """So many rooms of each kind; seeds that give no room are passed over."""
    found = []
    for kind in kinds:
        seed, own = first_seed, 0
        while own < per_kind and seed < first_seed + 3 * per_kind:
            try:
                found.append(make_example(kind, seed))
                own += 1
            except InputError:
                pass
            seed += 1
    return found


def train(examples: list[Example], recipe: Recipe) -> tuple[Any, list[float]]:
    """The trained network, and the loss of each epoch."""
    import torch

    torch.manual_seed(recipe.seed)
    network = make_network()
    weights = _class_weights(examples)
    loss_of = torch.nn.CrossEntropyLoss(weight=torch.tensor(weights, dtype=torch.float32))
    optimiser = torch.optim.AdamW(network.parameters(), lr=recipe.learning_rate, weight_decay=1e-2)
    steps = recipe.epochs * -(-len(examples) // recipe.batch)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, recipe.learning_rate, total_steps=steps)
    rng, losses = stream(recipe.seed, "segmenter", "training"), []
    for _ in range(recipe.epochs):
        order, total = rng.permutation(len(examples)), 0.0
        for first in range(0, len(order), recipe.batch):
            chosen = [_varied(examples[index], rng) for index in order[first : first + recipe.batch]]
            cells = torch.from_numpy(np.stack([features for features, _ in chosen]))
            truth = torch.from_numpy(np.stack([groups for _, groups in chosen]))
            loss = loss_of(network(cells), truth)
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            schedule.step()
            total += float(loss.detach()) * len(chosen)
        losses.append(total / len(examples))
        print(f"epoch {len(losses):3d}  loss {losses[-1]:.4f}", flush=True)  # noqa: T201 - the log of a command
    return network.eval(), losses


def _class_weights(examples: list[Example]) -> np.ndarray:
    counts = np.bincount(np.concatenate([example.groups.ravel() for example in examples]), minlength=len(GROUP_NAMES))
    share = np.maximum(counts / counts.sum(), 1e-4)
    return np.clip((1 / len(GROUP_NAMES) / share) ** 0.5, 0.3, 4.0)


def _varied(example: Example, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Mirrored, brighter or darker, tinted, at times without colour or as a camera that errs in height."""
    features, groups = example.features.copy(), example.groups
    features[:3] = np.clip(features[:3] ** rng.uniform(0.6, 1.6), 0, 1) * rng.uniform(0.7, 1.2, (3, 1, 1))
    if rng.random() < 0.15:
        features[:3] = features[:3].mean(axis=0)
    features[3] += rng.normal(0, 0.01) * features[6]
    if rng.random() < 0.5:
        features, groups = features[:, :, ::-1].copy(), groups[:, ::-1].copy()
    return features.astype(np.float32), groups


def confusion(examples: list[Example], guess: Any) -> Int[Array, "truth guess"]:
    """Cells by true and guessed group; `guess` maps features to groups."""
    total = np.zeros((len(GROUP_NAMES),) * 2, np.int64)
    for example in examples:
        pair = example.groups * len(GROUP_NAMES) + guess(example.features)
        total += np.bincount(pair.ravel(), minlength=total.size).reshape(total.shape)
    return total


def scores(table: Int[Array, "truth guess"]) -> dict[str, Any]:
    """Mean intersection over union of the named groups that occur, each of them, and the share of cells right."""
    inside = np.diag(table).astype(float)
    union = table.sum(axis=0) + table.sum(axis=1) - inside
    occurs = (table.sum(axis=1) > 0) & (np.arange(len(table)) > 0)
    each = {GROUP_NAMES[g]: round(float(inside[g] / union[g]), 4) for g in np.flatnonzero(occurs)}
    return {
        "miou": round(float(np.mean(list(each.values()))), 4),
        "right": round(float(inside.sum() / table.sum()), 4),
        "iou": each,
    }


def by_geometry(features: Float[Array, "7 row column"]) -> Int[Array, "row column"]:
    """What heights and slopes alone tell: floor, ceiling, the rest of the upright wall, tables and seats by height."""
    height_m, slope, measured = 2.5 * features[3], features[4], features[6] > 0
    guess = np.zeros(height_m.shape, np.int64)
    flat, upright = slope > 0.9, slope < 0.3
    guess[measured & upright] = GROUP_NAMES.index("wall-other")
    guess[measured & flat & (height_m > 0.6)] = GROUP_NAMES.index("table")
    guess[measured & flat & (height_m > 0.3) & (height_m <= 0.6)] = GROUP_NAMES.index("couch")
    guess[measured & flat & (height_m > 2.0)] = GROUP_NAMES.index("ceiling-other")
    guess[measured & (height_m < 0.08)] = GROUP_NAMES.index("floor-other")
    return guess


def save_weights(network: Any, path: Path) -> None:
    """All weights as float16 safetensors."""
    import torch
    from safetensors.torch import save_file

    state = {
        name: value.half().contiguous() for name, value in network.state_dict().items() if value.dtype == torch.float32
    }
    with atomic_file(path) as temporary:
        save_file(state, temporary)


def run(out: Path, recipe: Recipe) -> dict[str, Any]:
    """Makes the rooms, trains, scores on unseen kinds, writes the weights; returns the log."""
    import torch

    torch.set_num_threads(1)
    start = time.process_time()
    examples = make_examples(TRAIN_KINDS, recipe.rooms_per_kind, 1000)
    held_out = make_examples(TEST_KINDS, recipe.test_rooms_per_kind, 1000)
    made = time.process_time()
    network, losses = train(examples, recipe)
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
        "cpu_s": {"rooms": round(made - start, 1), "training": round(trained - made, 1)},
        "loss": [round(loss, 5) for loss in losses],
        "unseen_kinds": {name: scores(confusion(held_out, guess)) for name, guess in guesses.items()},
        "seen_kinds": {"network": scores(confusion(examples, guesses["network"]))},
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--log", type=Path, required=True)
    parser.add_argument("--rooms", type=int, default=Recipe().rooms_per_kind)
    parser.add_argument("--epochs", type=int, default=Recipe().epochs)
    arguments = parser.parse_args()
    log = run(arguments.out, Recipe(rooms_per_kind=arguments.rooms, epochs=arguments.epochs))
    arguments.log.write_text(json.dumps(log, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
