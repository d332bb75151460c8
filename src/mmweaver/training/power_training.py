"""Training of recipe `paper_power`: fields of log power by a hypernetwork."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.datasets.dataset_store import read_rooms
from mmweaver.models.power_network import RECIPE, PowerNetwork, chosen_frames, pelvis_of
from mmweaver.models.precision import exactly
from mmweaver.paths.mean_power import PowerMaps
from mmweaver.training.device import ComputeDevice
from mmweaver.training.model_card import POWER, Figures
from mmweaver.training.network_examples import examples, sample_batch
from mmweaver.training.network_loss import LIKELIHOOD, speckle_divergence
from mmweaver.training.network_training import VALIDATION_SEED, NetworkLearner
from mmweaver.training.power_examples import FieldTargets, PowerBatch, PowerExamples, sample_power_batch
from mmweaver.training.recipe_weights import write_recipe_weights
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.validation_sheet import differences_db

OF_PERSON = 2.0  # weight of the person's field


@dataclass(frozen=True, kw_only=True)
class PowerRecipe(LoopRecipe):
    """Hyperparameters of recipe `paper_power`."""

    name: str = RECIPE
    batch_size: int = 3  # sequences, each of a different room
    frames: int = 6  # sampled from each sequence
    mirror: bool = True  # reflect every second batch left-right
    is_anchored: bool = True  # coordinates are counted from photographed surfaces and from the pelvis, too


class PowerLearner(Learner):
    """The network with its loss: logarithms of power at places of its fields."""

    def __init__(self, network: PowerNetwork, config: RadarConfig):
        super().__init__()
        self.network, self.config = network, config

    def terms(self, batch: PowerBatch) -> dict[str, Tensor]:
        network = self.network
        code = network.code_of(batch.scene)
        room = network.room_level(code, batch.room.at)
        written = network.write_person(code, batch.joints_m, batch.velocity_mps)
        pelvis = pelvis_of(batch.joints_m, batch.velocity_mps)
        written, pelvis = (chosen_frames(part, batch.frames).flatten(0, 1) for part in (written, pelvis))
        person = network.person_level(written, pelvis, batch.person.at.flatten(0, 1))
        with exactly(room):
            return {
                "room": difference_of_levels(room.float(), batch.room),
                "person": OF_PERSON * difference_of_levels(person.float().view_as(batch.person.weight), batch.person),
            }


def difference_of_levels(level: Tensor, targets: FieldTargets) -> Tensor:
    """Weighted mean of |log p/m| and a fifth of their divergence (decision 91); `level`: log of cross sections (m2)."""
    mean = (level + targets.gain_mw.clamp(min=1e-30).log()).exp()
    ratio = (targets.power_mw + targets.least_mw).log() - (mean + targets.least_mw).log()
    each = ratio.abs() + LIKELIHOOD * speckle_divergence(ratio)
    return (targets.weight * each).sum() / targets.weight.sum()


def train_power(
    data: Path, out: Path, recipe: PowerRecipe, *, start: dict[str, Tensor] | None = None,
    listener: Listener | None = None, compute: ComputeDevice | None = None, **options: Any,
) -> Trainer:  # fmt: skip
    """Trains on split `train`, or continues from `out`/checkpoint.pt; the trainer holds what was best on `validation`.

    `start`: weights to fine-tune. `options` go to `Trainer`. Raises InputError for folders without data, and for data
    with signals instead of geometry.
    """
    rooms, unseen = power_examples(data, "train"), power_examples(data, "validation")
    torch.manual_seed(recipe.seed)
    network = PowerNetwork(is_anchored=recipe.is_anchored)
    if start is not None:
        network.load_state_dict(start)
    trainer = Trainer(
        PowerLearner(network, rooms[0].room.config), recipe, out, compute=compute,
        train=_sampler(rooms, recipe, recipe.seed, recipe.mirror),
        validation=_sampler(unseen, recipe, VALIDATION_SEED + recipe.seed), is_tuning=start is not None, **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def power_examples(folder: Path, split: str) -> list[PowerExamples]:
    """The rooms of a data set that have sequences of a split. Raises InputError where there are none."""
    rooms = [PowerExamples(room, split) for room in read_rooms(folder) if split in room.split]
    if not rooms:
        raise InputError(f"{folder} has no sequences of split {split!r}; make more with: mmweaver dataset")
    return rooms


def _sampler(rooms: list[PowerExamples], recipe: PowerRecipe, seed: int, mirror: bool = False) -> BatchSampler:
    size, frames = recipe.batch_size, recipe.frames
    return lambda step, share: sample_power_batch(
        rooms, seed, step, size=size, frames=frames, share=share, mirror=mirror
    )


def write_power_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes `out`/weights.safetensors and its model card; returns the path of the weights."""
    figures = map_differences(data, trainer)
    return write_recipe_weights(out, data, trainer, splits=("train",), page=POWER, figures=figures)


def map_differences(data: Path, trainer: Trainer) -> Figures:
    """Mean differences of expected power maps in dB, as for recipe `weaver`: of the network and of empty maps."""
    recipe, rooms = trainer.recipe, examples(data, "validation")
    assert isinstance(recipe, PowerRecipe)
    assert isinstance(trainer.learner, PowerLearner)
    judge = NetworkLearner(trainer.learner.network, trainer.learner.config).eval()
    rows: dict[str, list[dict[str, float]]] = {}
    with torch.inference_mode():
        for index in range(recipe.validation_batches):
            batch = sample_batch(
                rooms, VALIDATION_SEED + recipe.seed, index, size=recipe.batch_size, frames=recipe.frames
            )
            truth = batch.targets.maps
            nothing = PowerMaps(**{name: 0 * value for name, value in vars(truth).items()})
            for who, maps in (("this network", judge.predict(batch)), ("empty maps", nothing)):
                rows.setdefault(who, []).append(differences_db(truth, maps))
    return {who: {name: sum(row[name] for row in each) / len(each) for name in each[0]} for who, each in rows.items()}
