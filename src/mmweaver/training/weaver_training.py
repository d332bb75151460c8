"""Training the weaver: its recipe, its learner, and what it writes."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.version import __version__
from mmweaver.data.store import plan_text
from mmweaver.models.mean_power import MeanPower
from mmweaver.models.precision import exactly
from mmweaver.models.weaver_network import WeaverNetwork
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.training.trainer import Draw, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.weaver_examples import Batch, RoomExamples, draw_batch, examples
from mmweaver.training.weaver_loss import weaver_loss
from mmweaver.training.workplace import Workplace

VALIDATION_SEED = 10_000  # added to the recipe's


@dataclass(frozen=True, kw_only=True)
class TrainingRecipe(LoopRecipe):
    """How the weaver is trained."""

    name: str = "weaver"
    batch_size: int = 3  # sequences, each of another room
    frames: int = 8  # looked at in each


class WeaverLearner(Learner):
    """The network beside the radar that turns its echoes into maps."""

    def __init__(self, network: WeaverNetwork, config: RadarConfig):
        super().__init__()
        self.network = network
        self.radar = MeanPower(config)

    def _apply(self, fn: Any, recurse: bool = True) -> "WeaverLearner":
        """The radar's tensors go where the network goes."""
        super()._apply(fn, recurse)
        self.radar.to(next(self.network.parameters()).device)
        return self

    def terms(self, batch: Batch) -> dict[str, torch.Tensor]:
        code = self.network.encode_room(batch.view)
        moving = self.network.moving(code, batch.joints_m, batch.velocity_mps, batch.frames)
        with exactly(batch.joints_m):
            return weaver_loss(self.radar, code.resting, moving, batch.targets)


def train(
    data: Path,
    out: Path,
    recipe: TrainingRecipe,
    *,
    start: dict[str, torch.Tensor] | None = None,
    listener: Listener | None = None,
    workplace: Workplace | None = None,
    **options: Any,
) -> Trainer:
    """Trains on split `train` of a data set; what comes back holds the network that was best on `validation`.

    Goes on from `out`/checkpoint.pt where there is one. `start`: weights to fine-tune. `options` go to `Trainer`.
    Raises InputError for folders that hold no data, and where gradients stay without meaning.
    """
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    torch.manual_seed(recipe.seed)
    network = WeaverNetwork()
    if start is not None:
        network.load_state_dict(start)
    trainer = Trainer(
        WeaverLearner(network, rooms[0].room.config), recipe, out, workplace=workplace,
        train=_drawing(rooms, recipe, recipe.seed), validation=_drawing(unseen, recipe, VALIDATION_SEED + recipe.seed),
        **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def _drawing(rooms: list[RoomExamples], recipe: TrainingRecipe, seed: int) -> Draw:
    size, frames = recipe.batch_size, recipe.frames
    return lambda step, share: draw_batch(rooms, seed, step, size=size, frames=frames, share=share)


def write_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes `out`/weights.safetensors with its card, and gives its path."""
    learner = trainer.learner
    assert isinstance(learner, WeaverLearner)
    card = WeightsCard(
        recipe=trainer.recipe.name, licence="MIT", dataset_sha256=hashlib.sha256(plan_text(data).encode()).hexdigest(),
        radar=learner.radar.config.name, steps=trainer.step, seed=trainer.recipe.seed,
        validation_loss=trainer.best.value, mmweaver_version=__version__,
    )  # fmt: skip
    file = out / "weights.safetensors"
    save_weights(file, learner.network, card)
    return file
