"""The loop that trains every network of the project; what is trained, and on what, comes from outside.

    draw(step, share) -> batch -> learner.terms(batch) -> {name: term of the loss} -> step -> files in `out`

    checkpoint.pt        all that is needed to go on exactly, every minute
    best.safetensors     the weights that were best on validation
    log.jsonl, tensorboard/, pictures/     what to look at

A recipe is a dataclass that derives from `LoopRecipe`, a network a `Learner`. Reference: decision 94.
"""

import json
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.training.device import ComputeDevice, Share
from mmweaver.training.resuming import Resumable
from mmweaver.training.run_log import RunLog

BEST_FILE = "best.safetensors"
WORST_SKIPS = 20  # steps in a row whose gradients are no numbers before training gives up


@dataclass(frozen=True, kw_only=True)
class LoopRecipe:
    """How long and how fast anything is trained. Batches follow from seed and step: it may stop and go on anywhere."""

    name: str
    steps: int = 6000
    batch_size: int = 3  # of all processes together
    learning_rate: float = 1e-3
    warm_up_steps: int = 200
    is_cosine: bool = True  # else the rate stays, and a run may go on for more steps than were first asked for
    weight_decay: float = 1e-4
    largest_gradient: float | None = 5.0  # None: gradients are not bounded
    seed: int = 0
    validate_every: int = 250
    validation_batches: int = 8
    patience: int = 12  # validations without a better one before training stops early

    def rate(self, step: int) -> float:
        """Learning rate of a step."""
        rate = self.learning_rate * min(1.0, (step + 1) / max(self.warm_up_steps, 1))
        return rate * (0.5 + 0.5 * math.cos(math.pi * step / self.steps)) if self.is_cosine else rate


class Learner(nn.Module):
    """What a `Trainer` trains: any module that says what its loss consists of.

    Every parameter that can be trained must take part in every batch, or several processes wait for each other.
    """

    def terms(self, batch: Any) -> dict[str, Tensor]:
        """Terms of the loss by name, means over the batch; their sum is what is minimised."""
        raise NotImplementedError

    def figures(self, batch: Any) -> dict[str, Tensor]:
        """What else is told of a validation batch; means over it."""
        return {}

    def picture(self) -> np.ndarray | None:
        """What it has learned of fixed validation examples, (row, column, 3) uint8; None for nothing to look at."""
        return None

    def forward(self, batch: Any) -> dict[str, Tensor]:
        return self.terms(batch)


@dataclass(frozen=True, kw_only=True)
class Progress:
    """What is told while training goes on."""

    step: int
    steps: int
    loss: float
    terms: dict[str, float]
    validation: float | None
    figures: dict[str, float]  # what else the learner tells of the validation batches
    seconds: float
    learning_rate: float
    gradient_norm: float


Draw = Callable[[int, Share], Any]
Listener = Callable[[Progress], object]


class Trainer:
    """One run: its learner, its recipe, how far it is.

    `train(step, share)` draws the part of a step's batch that belongs to one of several processes, `validation(index,
    share)` one of a few fixed batches. With `is_tuning` the weights it begins with are the ones to beat. Raises
    InputError for a checkpoint of other settings.
    """

    def __init__(
        self,
        learner: Learner,
        recipe: LoopRecipe,
        out: Path,
        *,
        train: Draw,
        validation: Draw,
        workplace: ComputeDevice | None = None,
        is_tuning: bool = False,
        tensorboard: bool = False,
        save_every_s: float | None = None,
    ):
        self.workplace = workplace or ComputeDevice()
        self.learner = learner.to(self.workplace.device)
        self.recipe, self.out, self._train, self._validation = recipe, out, train, validation
        if recipe.batch_size % self.workplace.share[1]:
            raise InputError(
                f"a batch of {recipe.batch_size} cannot be shared by {self.workplace.share[1]} processes evenly;"
                " give --batch a multiple of them"
            )
        chosen = [parameter for parameter in learner.parameters() if parameter.requires_grad]
        self.optimiser = torch.optim.AdamW(chosen, lr=recipe.learning_rate, weight_decay=recipe.weight_decay)
        self.best = Best({**asdict(recipe), "precision": self.workplace.precision})
        self.skips, self.is_tuning = 0, is_tuning
        out.mkdir(parents=True, exist_ok=True)
        parts = {"network": learner, "optimiser": self.optimiser, "best": self.best}
        first = self.workplace.is_first
        self.resumable = Resumable(out / "checkpoint.pt", parts, every_s=save_every_s, writes=first)
        self.log = RunLog(out, self.step, tensorboard=tensorboard) if first else None
        self._joined = self.workplace.joined(self.learner)

    @property
    def step(self) -> int:
        """Steps that are done."""
        return self.resumable.done

    def run(self, listener: Listener | None = None) -> None:
        """Goes on from the last checkpoint to the end, and leaves the best weights in `learner`."""
        began, recipe = time.monotonic(), self.recipe
        if self.is_tuning and self.step == 0:
            self._validated(0)
        if self.best.since >= recipe.patience:
            self.resumable.stop()
        for step in self.resumable.steps(recipe.steps):
            rate, loss, terms, norm = self._one_step(step)
            is_due = (step + 1) % recipe.validate_every == 0 or step + 1 == recipe.steps
            validation, figures = self._validated(step + 1) if is_due else (None, {})
            progress = Progress(
                step=step + 1, steps=recipe.steps, loss=loss, terms=terms, validation=validation, figures=figures,
                seconds=time.monotonic() - began, learning_rate=rate, gradient_norm=norm,
            )  # fmt: skip
            if self.log is not None:
                self.log.row(asdict(progress))
            if self.best.since >= recipe.patience:
                self.resumable.stop()
            if listener is not None:
                listener(progress)
        if self.log is not None:
            self.log.close()
        self.workplace.wait()
        self._take_best()

    def _one_step(self, step: int) -> tuple[float, float, dict[str, float], float]:
        recipe, place = self.recipe, self.workplace
        rate = recipe.rate(step)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        batch = place.moved(self._train(step, place.share))
        # whole blocks are dropped by chance; a step's chance follows from its number, wherever training began
        own = () if place.is_first else (place.share[0],)
        torch.manual_seed(int(stream(recipe.seed, "dropout", step, *own).integers(2**31)))
        self.learner.train()
        with place.arithmetic():
            terms = self._joined(batch)
        loss = torch.stack(list(terms.values())).sum()
        self.optimiser.zero_grad()
        loss.backward()
        largest = math.inf if recipe.largest_gradient is None else recipe.largest_gradient
        norm = float(torch.nn.utils.clip_grad_norm_(self.learner.parameters(), largest))
        self._take_step(math.isfinite(norm), step)
        means = place.mean(torch.stack([term.detach().float() for term in terms.values()])).tolist()
        return rate, sum(means), dict(zip(terms, means, strict=True)), norm

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

    def _validated(self, step: int) -> tuple[float, dict[str, float]]:
        """Mean loss over the fixed batches, and what else is told of them; keeps the weights where it is the best so
        far, and draws the picture."""
        value, figures = self._judged()
        is_better = self.best.improved_by(value, figures)
        if self.log is not None:
            if is_better:
                save_tensors(self.learner.state_dict(), self.out / BEST_FILE)
            with torch.inference_mode():
                picture = self.learner.picture()
            if picture is not None:
                self.log.picture(step, picture)
        return value, figures

    def validation_batches(self) -> Iterator[Any]:
        """The fixed batches, one after the other, on this process's device."""
        for index in range(self.recipe.validation_batches):
            yield self.workplace.moved(self._validation(index, (0, 1)))

    def validation_loss(self) -> float:
        """Mean loss over the fixed batches, shared among the processes."""
        return self._judged()[0]

    def _judged(self) -> tuple[float, dict[str, float]]:
        """Means over the fixed batches, each judged by one of the processes."""
        place, count = self.workplace, self.recipe.validation_batches
        self.learner.eval()
        rows: list[dict[str, float]] = []
        with torch.inference_mode(), place.arithmetic():
            # a process without a batch of its own looks at the first, which then counts for nothing
            for index in range(place.share[0], count, place.share[1]) or (0,):
                batch = place.moved(self._validation(index, (0, 1)))
                loss = torch.stack(list(self.learner.terms(batch).values())).sum()
                figures = {"": loss, **self.learner.figures(batch)}
                rows.append({name: float(value) for name, value in figures.items()})
        counts = place.share[0] < count
        sums = torch.tensor([counts * sum(row[name] for row in rows) for name in rows[0]], dtype=torch.float64)
        # accelerate averages; on the device, for NCCL knows no others
        means = place.mean(sums.to(place.device)) * place.share[1] / count
        loss, *others = means.tolist()
        return loss, dict(zip(list(rows[0])[1:], others, strict=True))

    def _take_best(self) -> None:
        from safetensors.torch import load_file

        if (self.out / BEST_FILE).is_file():
            self.learner.load_state_dict(load_file(self.out / BEST_FILE))
        self.learner.eval()


class Best:
    """The best validation so far, and the recipe it belongs to; kept in the checkpoint."""

    def __init__(self, recipe: dict[str, Any]):
        # as a checkpoint gives it back
        self.recipe, self.value, self.since = json.loads(json.dumps(recipe)), math.inf, 0
        self.figures: dict[str, float] = {}

    def improved_by(self, value: float, figures: dict[str, float] | None = None) -> bool:
        """Takes note of a new validation; True where it is the best."""
        is_better = value < self.value
        self.since = 0 if is_better else self.since + 1
        if is_better:
            self.value, self.figures = value, figures or {}
        return is_better

    def state_dict(self) -> dict[str, Any]:
        return {"recipe": self.recipe, "value": self.value, "since": self.since, "figures": self.figures}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        # what an earlier version did not name was as it is here; a constant rate may go on for longer
        before = {**self.recipe, **state["recipe"]}
        if not self.recipe.get("is_cosine", True):
            before["steps"] = self.recipe["steps"]
        if before != self.recipe:
            raise InputError("it was made with other settings")
        self.value, self.since, self.figures = state["value"], state["since"], state.get("figures", {})


def save_tensors(tensors: dict[str, Tensor], file: Path) -> None:
    """Writes tensors as safetensors, whole or not at all."""
    from safetensors.torch import save_file

    with atomic_file(file) as temporary:
        save_file({name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}, temporary)
