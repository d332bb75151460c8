"""Training the activity network: recipe `activity`."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import torch

from mmweaver.core.seeding import stream
from mmweaver.models.activity_network import ActivityNetwork
from mmweaver.training.activity_examples import ActivityExamples, activity_examples, varied
from mmweaver.training.recipe_loop import LoopSettings, RecipeLoop, StepReport

# The two activities that are withheld from the weaver are no test here, and the network shall know all twelve.
TRAIN_SPLITS = ("train", "test_activity")
SMOOTHING = 0.1
AT_ONCE = 32


@dataclass(frozen=True, kw_only=True)
class ActivityRecipe(LoopSettings):
    """Sixteen times through 743 sequences; chosen by what kinds of rooms of split `validation` show."""

    name: str = "activity"
    steps: int = 800
    batch_size: int = 16
    learning_rate: float = 2e-3
    warm_up_steps: int = 50
    is_cosine: bool = True
    weight_decay: float = 1e-2
    largest_gradient: float = 5.0
    validate_every: int = 100


def train_activity(
    data: Path, out: Path, recipe: ActivityRecipe, listener: Callable[[StepReport], object] | None = None
) -> RecipeLoop:
    """Trains on a data set, or goes on from `out`/checkpoint.pt. Raises InputError for a folder without data."""
    examples, unseen = activity_examples(data, TRAIN_SPLITS), activity_examples(data, ("validation",))
    torch.manual_seed(recipe.seed)
    network = ActivityNetwork(examples.config)

    def terms(step: int) -> dict[str, torch.Tensor]:
        rng = stream(recipe.seed, "activity batch", step)
        size = min(recipe.batch_size, len(examples))
        chosen = torch.from_numpy(rng.choice(len(examples), size=size, replace=False))
        scores = network(*varied(examples.doppler[chosen], examples.angle[chosen], rng))
        loss = torch.nn.functional.cross_entropy(scores, examples.label[chosen], label_smoothing=SMOOTHING)
        return {"cross_entropy": loss}

    def validate() -> dict[str, float]:
        scores = scores_of(network, unseen)
        wrong = float((scores.argmax(dim=1) != unseen.label).float().mean())
        return {"cross_entropy": float(torch.nn.functional.cross_entropy(scores, unseen.label)), "wrong": wrong}

    loop = RecipeLoop(network, recipe, out, terms=terms, validate=validate)
    loop.run(listener)
    return loop


def scores_of(network: ActivityNetwork, examples: ActivityExamples) -> torch.Tensor:
    """Scores (sequence, 12) before the softmax."""
    network.eval()
    with torch.no_grad():
        parts = zip(examples.doppler.split(AT_ONCE), examples.angle.split(AT_ONCE), strict=True)
        return torch.cat([network(one.float(), other.float()) for one, other in parts])
