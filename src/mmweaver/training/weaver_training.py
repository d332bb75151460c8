"""Training the weaver: one loop, its recipe, and what it writes."""

import hashlib
import json
import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import torch

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.core.version import __version__
from mmweaver.data.store import plan_text
from mmweaver.models.mean_power import MeanPower
from mmweaver.models.weaver_network import WeaverNetwork
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.training.resuming import Resumable
from mmweaver.training.weaver_examples import Batch, RoomExamples, draw_batch, examples
from mmweaver.training.weaver_loss import weaver_loss

BEST_FILE = "best.safetensors"
VALIDATION_SEED = 10_000  # added to the recipe's
WORST_SKIPS = 20  # steps in a row whose gradients are no numbers before training gives up


@dataclass(frozen=True, kw_only=True)
class TrainingRecipe:
    """How the weaver is trained. Batches follow from seed and step, so training can stop and go on anywhere."""

    name: str = "weaver"
    steps: int = 6000
    batch_size: int = 3  # sequences, each of another room
    frames: int = 8  # looked at in each
    learning_rate: float = 1e-3
    warm_up_steps: int = 200
    weight_decay: float = 1e-4
    largest_gradient: float = 5.0
    seed: int = 0
    validate_every: int = 250
    validation_batches: int = 8
    patience: int = 12  # validations without a better one before training stops early


@dataclass(frozen=True, kw_only=True)
class Progress:
    """What is told while training goes on."""

    step: int
    steps: int
    loss: float
    terms: dict[str, float]
    validation: float | None
    seconds: float


def train(
    data: Path,
    out: Path,
    recipe: TrainingRecipe,
    *,
    start: dict[str, torch.Tensor] | None = None,
    listener: Callable[[Progress], object] | None = None,
) -> "Training":
    """Trains on split `train` of a data set; what comes back holds the network that was best on `validation`.

    Goes on from `out`/checkpoint.pt where there is one. `start`: weights to fine-tune. Raises InputError for folders
    that hold no data, and where gradients stay without meaning.
    """
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    config = rooms[0].room.config
    torch.manual_seed(recipe.seed)
    network = WeaverNetwork()
    if start is not None:
        network.load_state_dict(start)
    training = Training(network, rooms, unseen, config, recipe, out)
    training.run(listener)
    return training


def write_weights(out: Path, data: Path, training: "Training") -> Path:
    """Writes `out`/weights.safetensors with its card, and gives its path."""
    card = WeightsCard(
        recipe=training.recipe.name, licence="MIT", dataset_sha256=hashlib.sha256(plan_text(data).encode()).hexdigest(),
        radar=training.radar.config.name, steps=training.step, seed=training.recipe.seed,
        validation_loss=training.best.value, mmweaver_version=__version__,
    )  # fmt: skip
    file = out / "weights.safetensors"
    save_weights(file, training.network, card)
    return file


class Training:
    """One run: its network, its recipe, how far it is."""

    def __init__(
        self,
        network: WeaverNetwork,
        rooms: list[RoomExamples],
        unseen: list[RoomExamples],
        config: RadarConfig,
        recipe: TrainingRecipe,
        out: Path,
    ):
        self.network, self.rooms, self.unseen, self.recipe, self.out = network, rooms, unseen, recipe, out
        self.radar = MeanPower(config)
        self.optimiser = torch.optim.AdamW(
            network.parameters(), lr=recipe.learning_rate, weight_decay=recipe.weight_decay
        )
        self.best = _Best(asdict(recipe))
        self.skips = 0
        out.mkdir(parents=True, exist_ok=True)
        parts = {"network": network, "optimiser": self.optimiser, "best": self.best}
        self.resumable = Resumable(out / "checkpoint.pt", parts)

    @property
    def step(self) -> int:
        """Steps that are done."""
        return self.resumable.done

    def run(self, listener: Callable[[Progress], object] | None) -> None:
        """Goes on from the last checkpoint to the end, and leaves the best network in `network`."""
        began = time.monotonic()
        for step in self.resumable.steps(self.recipe.steps):
            loss, terms = self._one_step(step)
            last = step + 1 == self.recipe.steps
            validation = self._validate() if (step + 1) % self.recipe.validate_every == 0 or last else None
            progress = Progress(
                step=step + 1, steps=self.recipe.steps, loss=loss, terms=terms, validation=validation,
                seconds=time.monotonic() - began,
            )  # fmt: skip
            self._log(progress)
            if listener is not None:
                listener(progress)
            if self.best.since >= self.recipe.patience:
                break
        self._take_best()

    def _one_step(self, step: int) -> tuple[float, dict[str, float]]:
        recipe = self.recipe
        rate = recipe.learning_rate * min(1.0, (step + 1) / recipe.warm_up_steps)
        rate *= 0.5 + 0.5 * math.cos(math.pi * step / recipe.steps)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        batch = draw_batch(self.rooms, recipe.seed, step, size=recipe.batch_size, frames=recipe.frames)
        # the encoder drops whole blocks by chance; a step's chance follows from its number, wherever training began
        torch.manual_seed(int(stream(recipe.seed, "dropout", step).integers(2**31)))
        self.network.train()
        terms = self._terms(batch)
        loss = torch.stack(list(terms.values())).sum()
        self.optimiser.zero_grad()
        loss.backward()
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), recipe.largest_gradient)
        self._take_step(bool(torch.isfinite(norm)), step)
        return float(loss.detach()), {name: float(term.detach()) for name, term in terms.items()}

    def _take_step(self, is_sound: bool, step: int) -> None:
        if is_sound:
            self.optimiser.step()
            self.skips = 0
            return
        self.skips += 1
        if self.skips > WORST_SKIPS:
            raise InputError(
                f"training broke at step {step}: gradients are no numbers; start anew with a lower learning rate"
            )

    def _terms(self, batch: Batch) -> dict[str, torch.Tensor]:
        code = self.network.encode_room(batch.view)
        moving = self.network.moving(code, batch.joints_m, batch.velocity_mps, batch.frames)
        return weaver_loss(self.radar, code.resting, moving, batch.targets)

    def _validate(self) -> float:
        """Mean loss over fixed batches of unseen kinds of rooms; keeps the weights where it is the best so far."""
        recipe = self.recipe
        self.network.eval()
        total = 0.0
        with torch.inference_mode():
            for index in range(recipe.validation_batches):
                batch = draw_batch(
                    self.unseen, VALIDATION_SEED + recipe.seed, index, size=recipe.batch_size, frames=recipe.frames
                )
                total += float(torch.stack(list(self._terms(batch).values())).sum())
        value = total / recipe.validation_batches
        if self.best.improved_by(value):
            _save_tensors(self.network, self.out / BEST_FILE)
        return value

    def _log(self, progress: Progress) -> None:
        if progress.step % 50 == 0 or progress.validation is not None:
            with (self.out / "log.jsonl").open("a") as log:
                log.write(json.dumps(asdict(progress)) + "\n")

    def _take_best(self) -> None:
        from safetensors.torch import load_file

        if (self.out / BEST_FILE).is_file():
            self.network.load_state_dict(load_file(self.out / BEST_FILE))
        self.network.eval()


class _Best:
    """The best validation so far, and the recipe it belongs to; kept in the checkpoint."""

    def __init__(self, recipe: dict[str, Any]):
        self.recipe, self.value, self.since = recipe, math.inf, 0

    def improved_by(self, value: float) -> bool:
        """Takes note of a new validation; True where it is the best."""
        is_better = value < self.value
        self.value, self.since = (value, 0) if is_better else (self.value, self.since + 1)
        return is_better

    def state_dict(self) -> dict[str, Any]:
        return {"recipe": self.recipe, "value": self.value, "since": self.since}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        if state["recipe"] != self.recipe:
            raise InputError("it was made with other settings")
        self.value, self.since = state["value"], state["since"]


def _save_tensors(network: WeaverNetwork, file: Path) -> None:
    from safetensors.torch import save_file

    partial = file.with_name("." + file.name)
    save_file({name: tensor.contiguous() for name, tensor in network.state_dict().items()}, partial)
    partial.rename(file)
