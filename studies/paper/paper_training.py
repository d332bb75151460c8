"""Training of the paper's network as the paper describes it: recipe `paper`."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.models.activity_network import ActivityNetwork, load_activity
from mmweaver.models.precision import exactly
from mmweaver.propagation.mean_power import PowerMaps
from mmweaver.training.device import ComputeDevice
from mmweaver.training.network_examples import power_maps
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.validation_sheet import MAX_ROWS, draw_sheet
from studies.paper.paper_examples import PaperBatch, PaperRoom, paper_rooms, sample_paper_batch
from studies.paper.paper_loss import paper_loss
from studies.paper.paper_method import field_of_image, unit_sqrt_mw
from studies.paper.paper_network import PaperNetwork, evaluate_each

VALIDATION_SEED = 10_000  # added to the recipe's


@dataclass(frozen=True, kw_only=True)
class PaperRecipe(LoopRecipe):
    """Adam, 1e-4, no schedule. The paper's 1,000 epochs of 12,000 sequences are 3 million steps of four."""

    name: str = "paper"
    steps: int = 6000
    batch_size: int = 4
    learning_rate: float = 1e-4
    warm_up_steps: int = 0
    is_cosine: bool = False
    weight_decay: float = 0.0
    largest_gradient: float | None = None
    validate_every: int = 200
    patience: int = 1_000_000  # the paper does not stop early


class PaperLearner(Learner):
    """The network with the paper's loss; `shown` returns the rooms whose first sequences its picture shows."""

    def __init__(
        self,
        network: PaperNetwork,
        perceiver: ActivityNetwork,
        config: RadarConfig,
        shown: Callable[[], list[PaperRoom]] = list,
    ):
        super().__init__()
        self.network, self.config, self.shown = network, config, shown
        self._perceiver = (perceiver.requires_grad_(False),)  # no module of this one: its weights are not trained

    def _apply(self, fn: Any, recurse: bool = True) -> "PaperLearner":
        """Moves the feature network along with this one."""
        super()._apply(fn, recurse)
        self._perceiver[0].to(next(self.network.parameters()).device)
        return self

    def terms(self, batch: PaperBatch) -> dict[str, Tensor]:
        return self._cost(patches(self.network, batch), batch)

    def figures(self, batch: PaperBatch) -> dict[str, Tensor]:
        """The loss of all zeros, and error and energy over the energy of the ground truth: they reveal a collapse."""
        made, energy = patches(self.network, batch), batch.truth.abs().square().sum()
        nothing = torch.stack(list(self._cost(torch.zeros_like(made), batch).values())).sum()
        return {
            **{f"own_{name}": term for name, term in self._cost(made, batch).items()}, "zeros_loss": nothing,
            "nmse": (made - batch.truth).abs().square().sum() / energy, "energy": made.abs().square().sum() / energy,
        }  # fmt: skip

    def picture(self) -> np.ndarray | None:
        rooms = self.shown()
        if not rooms:
            return None
        true, made = [], []
        for one in rooms:
            index = one.indices[0]
            joints, velocity = one.room.joints_m[index], one.room.joint_velocity_mps[index]
            middle = np.array([len(joints) // 2])
            cube = field_of_image(self.network, one.image, self.config, joints, velocity).cube()
            true.append(power_maps(one.room.cube(index, middle).values, self.config))
            made.append(power_maps(cube.values[middle], self.config))
        return draw_sheet(PowerMaps.stack(true), PowerMaps.stack(made), self.config, made="network")

    def _cost(self, made: Tensor, batch: PaperBatch) -> dict[str, Tensor]:
        with exactly(made):
            return paper_loss(made, batch.truth, batch.span, self._perceiver[0], unit_sqrt_mw(self.config))


def train_paper(
    data: Path,
    out: Path,
    recipe: PaperRecipe,
    *,
    features: Path,
    start: dict[str, Tensor] | None = None,
    listener: Listener | None = None,
    compute: ComputeDevice | None = None,
    **options: Any,
) -> Trainer:
    """Trains on split `train`, or continues from `out`/checkpoint.pt; `features`: weights of recipe `activity`.

    Returns the trainer with the weights that were best on split `validation`. `start`: weights to fine-tune. `options`
    go to `Trainer`. Raises InputError for folders without data and foreign weights.
    """
    device = str((compute or ComputeDevice()).device)
    rooms, unseen = paper_rooms(data, "train", device), paper_rooms(data, "validation", device)
    config = rooms[0].room.config
    perceiver = load_activity(features, config)
    torch.manual_seed(recipe.seed)
    network = PaperNetwork()
    if start is not None:
        network.load_state_dict(start)
    trainer = Trainer(
        PaperLearner(network, perceiver, config, shown=lambda: unseen[:MAX_ROWS]), recipe, out, compute=compute,
        batches=(_drawing(rooms, recipe, recipe.seed), _drawing(unseen, recipe, VALIDATION_SEED + recipe.seed)),
        is_tuning=start is not None, **options,
    )  # fmt: skip
    trainer.run(listener)
    return trainer


def _drawing(rooms: list[PaperRoom], recipe: PaperRecipe, seed: int) -> BatchSampler:
    """Batches of rooms, by step."""
    return lambda step, share: sample_paper_batch(rooms, seed, step, size=recipe.batch_size, share=share)


def patches(network: PaperNetwork, batch: PaperBatch) -> Tensor:
    """The signal that the network writes at the coordinates of a batch, shaped as its ground truth (sequence, 2, range,
    doppler, antenna); weights in mixed precision, values of the field in float32."""
    theta, gamma, beta = network(batch.image, batch.motion)
    with exactly(theta):
        theta, gamma, beta = theta.float(), gamma.float(), beta.float()
        which = torch.arange(len(theta), device=theta.device)[:, None]
        encoded = batch.encoded[:, None].expand(-1, batch.frames.shape[1], -1, -1)
        shape = network.hypernetwork.shape
        pairs = evaluate_each(theta, gamma[which, batch.frames], beta[which, batch.frames], encoded, shape)
        return torch.view_as_complex(pairs.contiguous()).view(batch.truth.shape)
