"""Training the weaver: one loop, its recipe, and what it writes."""

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
from mmweaver.models.mean_power import MeanPower
from mmweaver.models.weaver_network import WeaverNetwork
from mmweaver.training.checkpoints import load_checkpoint, save_checkpoint
from mmweaver.training.weaver_examples import Batch, RoomExamples, draw_batch, examples
from mmweaver.training.weaver_loss import weaver_loss

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
    save_every_s: float = 120.0


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
) -> WeaverNetwork:
    """Trains on split `train` of a data set and returns the network that was best on `validation`.

    Goes on from `out`/checkpoint where there is one. `start`: weights to fine-tune. Raises InputError for folders that
    hold no data, and where gradients stay without meaning.
    """
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    config = rooms[0].room.config
    torch.manual_seed(recipe.seed)
    network = WeaverNetwork()
    if start is not None:
        network.load_state_dict(start)
    loop = _Loop(network, rooms, unseen, config, recipe, out)
    return loop.run(listener)


class _Loop:
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
        self.step, self.best, self.since_best, self.skips = 0, math.inf, 0, 0
        self.spent_s = 0.0

    def run(self, listener: Callable[[Progress], object] | None) -> WeaverNetwork:
        self.out.mkdir(parents=True, exist_ok=True)
        self._resume()
        recipe, began, saved, before_s = self.recipe, time.monotonic(), time.monotonic(), self.spent_s
        while self.step < recipe.steps and self.since_best < recipe.patience:
            loss, terms = self._one_step()
            self.step += 1
            validation = None
            if self.step % recipe.validate_every == 0 or self.step == recipe.steps:
                validation = self._validate()
            self.spent_s = before_s + time.monotonic() - began
            progress = Progress(
                step=self.step, steps=recipe.steps, loss=loss, terms=terms, validation=validation, seconds=self.spent_s
            )
            self._log(progress)
            if listener is not None:
                listener(progress)
            if time.monotonic() - saved > recipe.save_every_s or self.step == recipe.steps:
                self._save()
                saved = time.monotonic()
        self._save()
        return self._best_network()

    def _one_step(self) -> tuple[float, dict[str, float]]:
        recipe = self.recipe
        rate = recipe.learning_rate * min(1.0, (self.step + 1) / recipe.warm_up_steps)
        rate *= 0.5 + 0.5 * math.cos(math.pi * self.step / recipe.steps)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        batch = draw_batch(self.rooms, recipe.seed, self.step, size=recipe.batch_size, frames=recipe.frames)
        self.network.train()
        terms = self._terms(batch)
        loss = torch.stack(list(terms.values())).sum()
        self.optimiser.zero_grad()
        loss.backward()
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), recipe.largest_gradient)
        if bool(torch.isfinite(norm)):
            self.optimiser.step()
            self.skips = 0
        else:
            self.skips += 1
            if self.skips > WORST_SKIPS:
                raise InputError(
                    f"training broke at step {self.step}: gradients are no numbers; go on with a lower learning rate"
                )
        return float(loss.detach()), {name: float(term.detach()) for name, term in terms.items()}

    def _terms(self, batch: Batch) -> dict[str, torch.Tensor]:
        code = self.network.encode_room(batch.view)
        moving = self.network.moving(code, batch.joints_m, batch.velocity_mps, batch.frames)
        return weaver_loss(self.radar, code.resting, moving, batch.targets, self.network.noise_level.exp())

    def _validate(self) -> float:
        """Mean loss over fixed batches of unseen kinds of rooms; keeps the weights where it is the best so far."""
        recipe = self.recipe
        self.network.eval()
        total = 0.0
        with torch.inference_mode():
            for index in range(recipe.validation_batches):
                batch = draw_batch(
                    self.unseen, 10_000 + recipe.seed, index, size=recipe.batch_size, frames=recipe.frames
                )
                total += float(torch.stack(list(self._terms(batch).values())).sum())
        value = total / recipe.validation_batches
        if value < self.best:
            self.best, self.since_best = value, 0
            _save_tensors(self.network, self.out / "best.safetensors")
        else:
            self.since_best += 1
        return value

    def _log(self, progress: Progress) -> None:
        if progress.step % 50 == 0 or progress.validation is not None:
            line: dict[str, Any] = asdict(progress)
            with (self.out / "log.jsonl").open("a") as log:
                log.write(json.dumps(line) + "\n")

    def _save(self) -> None:
        state = {
            "step": self.step, "best": self.best if math.isfinite(self.best) else None, "since_best": self.since_best,
            "spent_s": self.spent_s, "recipe": asdict(self.recipe),
        }  # fmt: skip
        save_checkpoint(self.out / "checkpoint", self.network, self.optimiser, state)

    def _resume(self) -> None:
        state = load_checkpoint(self.out / "checkpoint", self.network, self.optimiser)
        if state is None:
            return
        if state["recipe"] != asdict(self.recipe):
            raise InputError(
                f"{self.out} was trained by another recipe; go on with the same settings or choose another folder"
            )
        self.step, self.since_best, self.spent_s = state["step"], state["since_best"], state["spent_s"]
        self.best = math.inf if state["best"] is None else state["best"]

    def _best_network(self) -> WeaverNetwork:
        from safetensors.torch import load_file

        best = self.out / "best.safetensors"
        if best.is_file():
            self.network.load_state_dict(load_file(best))
        self.network.eval()
        return self.network


def _save_tensors(network: WeaverNetwork, file: Path) -> None:
    from safetensors.torch import save_file

    partial = file.with_name("." + file.name)
    save_file({name: tensor.contiguous() for name, tensor in network.state_dict().items()}, partial)
    partial.rename(file)
