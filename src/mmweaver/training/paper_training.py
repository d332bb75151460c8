"""Training the paper's network as the paper says: recipe `paper`."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import Tensor

from mmweaver.models.activity_network import load_activity
from mmweaver.models.paper_method import unit_sqrt_mw
from mmweaver.models.paper_network import PaperNetwork, evaluate_each
from mmweaver.training.paper_examples import PaperBatch, draw_paper_batch, paper_rooms
from mmweaver.training.paper_loss import paper_loss
from mmweaver.training.recipe_loop import LoopSettings, RecipeLoop, StepReport

VALIDATION_SEED, VALIDATION_BATCHES = 10_000, 8


@dataclass(frozen=True, kw_only=True)
class PaperRecipe(LoopSettings):
    """Adam, 1e-4, no schedule. The paper's 1,000 epochs of 12,000 sequences are 3 million steps of four."""

    name: str = "paper"
    steps: int = 6000
    batch_size: int = 4
    learning_rate: float = 1e-4
    validate_every: int = 200


def train_paper(
    data: Path,
    out: Path,
    recipe: PaperRecipe,
    *,
    features: Path,
    listener: Callable[[StepReport], object] | None = None,
) -> RecipeLoop:
    """Trains on split `train`, or goes on from `out`/checkpoint.pt; `features`: weights of recipe `activity`.

    Keeps what is best on split `validation`. Raises InputError for folders without data and foreign weights.
    """
    rooms, unseen = paper_rooms(data, "train"), paper_rooms(data, "validation")
    config = rooms[0].room.config
    perceiver = load_activity(features, config).requires_grad_(False)
    torch.manual_seed(recipe.seed)
    network = PaperNetwork()

    def cost(made: Tensor, batch: PaperBatch) -> dict[str, Tensor]:
        return paper_loss(made, batch.truth, batch.span, perceiver, unit_sqrt_mw(config))

    def terms(step: int) -> dict[str, Tensor]:
        batch = draw_paper_batch(rooms, recipe.seed, step, size=recipe.batch_size)
        return cost(patches(network, batch), batch)

    def validate() -> dict[str, float]:
        seed, size = VALIDATION_SEED + recipe.seed, recipe.batch_size
        batches = (draw_paper_batch(unseen, seed, index, size=size) for index in range(VALIDATION_BATCHES))
        return _validation(network, cost, batches)

    loop = RecipeLoop(network, recipe, out, terms=terms, validate=validate)
    loop.run(listener)
    return loop


def patches(network: PaperNetwork, batch: PaperBatch) -> Tensor:
    """What the network writes at a batch's coordinates, shaped as its truth."""
    theta, gamma, beta = network(batch.image, batch.motion)
    which = torch.arange(len(theta))[:, None]
    encoded = batch.encoded[:, None].expand(-1, batch.frames.shape[1], -1, -1)
    shape = network.hypernetwork.shape
    pairs = evaluate_each(theta, gamma[which, batch.frames], beta[which, batch.frames], encoded, shape)
    return torch.view_as_complex(pairs.contiguous()).view(batch.truth.shape)


def _validation(
    network: PaperNetwork, cost: Callable[[Tensor, PaperBatch], dict[str, Tensor]], batches: Iterable[PaperBatch]
) -> dict[str, float]:
    """Mean loss and its terms, beside the loss of all zeros and how much of the truth's energy there is: both tell a
    collapse."""
    sums: dict[str, float] = defaultdict(float)
    energy: dict[str, float] = defaultdict(float)
    for batch in batches:
        made = patches(network, batch)
        terms = {name: float(term) for name, term in cost(made, batch).items()}
        nothing = sum(float(term) for term in cost(torch.zeros_like(made), batch).values())
        for name, value in (("loss", sum(terms.values())), ("zeros_loss", nothing), *terms.items()):
            sums[name] += value / VALIDATION_BATCHES
        for name, value in (("made", made), ("truth", batch.truth), ("error", made - batch.truth)):
            energy[name] += float(value.abs().square().sum())
    return {
        **sums,
        "nmse_db": 10 * math.log10(energy["error"] / energy["truth"]),
        "energy_db": 10 * math.log10(max(energy["made"], 1e-30) / energy["truth"]),
    }
