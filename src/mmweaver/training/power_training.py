"""Training of recipe `paper_power`: fields of log power by a hypernetwork, with the loss of recipe `weaver`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mmweaver.models.power_network import RECIPE, PowerNetwork
from mmweaver.training.device import ComputeDevice
from mmweaver.training.model_card import POWER
from mmweaver.training.network_examples import RoomExamples, examples, sample_batch
from mmweaver.training.network_training import VALIDATION_SEED, NetworkLearner, compare_with_start
from mmweaver.training.recipe_weights import write_recipe_weights
from mmweaver.training.trainer import BatchSampler, Listener, LoopRecipe, Trainer


@dataclass(frozen=True, kw_only=True)
class PowerRecipe(LoopRecipe):
    """Hyperparameters of recipe `paper_power`."""

    name: str = RECIPE
    steps: int = 3000
    batch_size: int = 3  # sequences, each of a different room
    frames: int = 3  # sampled from each sequence
    warm_up_steps: int = 30
    mirror: bool = True  # reflect every second batch left-right
    is_anchored: bool = True  # coordinates are counted from photographed surfaces and from the body, too


def train_power(
    data: Path, out: Path, recipe: PowerRecipe, *, start: dict[str, Tensor] | None = None,
    listener: Listener | None = None, compute: ComputeDevice | None = None, **options: Any,
) -> Trainer:  # fmt: skip
    """Trains on split `train`, or continues from `out`/checkpoint.pt; the trainer holds what was best on `validation`.

    `start`: weights to fine-tune. `options` go to `Trainer`. Raises InputError for folders without data.
    """
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    validation = _sampler(unseen, recipe, VALIDATION_SEED + recipe.seed)
    network = initial_power_network(recipe)
    if start is not None:
        network.load_state_dict(start)
    learner = NetworkLearner(network, rooms[0].room.config, shown=lambda: validation(0, (0, 1)))
    trainer = Trainer(
        learner, recipe, out, compute=compute, train=_sampler(rooms, recipe, recipe.seed, recipe.mirror),
        validation=validation, is_tuning=start is not None, **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def initial_power_network(recipe: PowerRecipe) -> PowerNetwork:
    """The network that training starts from."""
    torch.manual_seed(recipe.seed)
    return PowerNetwork(is_anchored=recipe.is_anchored)


def _sampler(rooms: list[RoomExamples], recipe: PowerRecipe, seed: int, mirror: bool = False) -> BatchSampler:
    size, frames = recipe.batch_size, recipe.frames
    return lambda step, share: sample_batch(rooms, seed, step, size=size, frames=frames, share=share, mirror=mirror)


def write_power_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes `out`/weights.safetensors and its model card; returns the path of the weights."""
    assert isinstance(trainer.recipe, PowerRecipe)
    figures = compare_with_start(trainer, initial_power_network(trainer.recipe))
    return write_recipe_weights(out, data, trainer, splits=("train",), page=POWER, figures=figures)
