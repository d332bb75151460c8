"""The training loop of every network; learner and data are passed in.

    sample(step, share) -> batch -> learner.terms(batch) -> {name: term of the loss} -> step -> files in `out`

    checkpoint.pt        everything needed to resume exactly, every minute
    best.safetensors     weights with the lowest validation loss
    log.jsonl, tensorboard/, pictures/     logs

A recipe is a dataclass derived from `LoopRecipe`, a network a `Learner`.
Reference: docs/decisions/training-loop.md.
"""

import json
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.core.seeding import stream
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.training.device import ComputeDevice, Share
from mmweaver.training.resuming import Resumable
from mmweaver.training.run_log import RunLog

BEST_FILE = "best.safetensors"
WORST_SKIPS = 20  # consecutive steps with non-finite gradients after which training stops


@dataclass(frozen=True, kw_only=True)
class LoopRecipe:
    """Hyperparameters of a training. Batches depend on seed and step only, so a run can be interrupted at any time."""

    name: str
    steps: int = 6000
    batch_size: int = 3  # over all processes
    learning_rate: float = 1e-3
    warm_up_steps: int = 200
    is_cosine: bool = True  # cosine decay; otherwise a constant rate, and the run can be extended by more steps
    weight_decay: float = 1e-4
    largest_gradient: float | None = 5.0  # gradient norm is clipped to this; None: no clipping
    seed: int = 0
    validate_every: int = 250
    validation_batches: int = 8
    patience: int = 12  # validations without improvement before training stops early

    def rate(self, step: int) -> float:
        """Learning rate of a step: linear warm-up, then cosine decay or constant."""
        rate = self.learning_rate * min(1.0, (step + 1) / max(self.warm_up_steps, 1))
        return rate * (0.5 + 0.5 * math.cos(math.pi * step / self.steps)) if self.is_cosine else rate


class Learner(nn.Module):
    """A module that a `Trainer` trains, with the terms of its loss.

    Every trainable parameter must take part in every batch, or several processes deadlock.
    """

    def terms(self, batch: Any) -> dict[str, Tensor]:
        """Terms of the loss by name, averaged over the batch; their sum is minimised."""
        raise NotImplementedError

    def figures(self, batch: Any) -> dict[str, Tensor]:
        """Further scores of a validation batch, averaged over it."""
        return {}

    def picture(self) -> np.ndarray | None:
        """Predictions on fixed validation examples as an image (row, column, 3) uint8, or None."""
        return None

    def forward(self, batch: Any) -> dict[str, Tensor]:
        """Calls `terms`, so that wrappers for several processes apply."""
        return self.terms(batch)


@dataclass(frozen=True, kw_only=True)
class Progress:
    """State of a running training, reported at every step."""

    step: int
    steps: int
    loss: float
    terms: dict[str, float]
    validation: float | None
    figures: dict[str, float]  # further scores of the validation batches
    seconds: float
    learning_rate: float
    gradient_norm: float


BatchSampler = Callable[[int, Share], Any]
LearnerT = TypeVar("LearnerT", bound=Learner, covariant=True)
Listener = Callable[[Progress], object]


class Trainer(Generic[LearnerT]):
    """One training run.

    Args:
        learner: The network with its loss.
        recipe: Hyperparameters.
        out: Folder of checkpoint, log and weights; a checkpoint there is resumed.
        batches: `train(step, share)` samples the part of a step's batch that belongs to one of several processes;
            `validation(index, share)` is one of a few fixed batches.
        compute: Device, precision and process; default: the CPU in float32, alone.
        is_tuning: Whether the initial weights are validated first, as the ones to beat.
        tensorboard: Whether TensorBoard's files are written, too.
        save_every_s: Seconds between checkpoints; default 60.

    Raises:
        InputError: If the checkpoint has other settings, or processes cannot share a batch evenly.
    """

    def __init__(
        self,
        learner: LearnerT,
        recipe: LoopRecipe,
        out: Path,
        *,
        batches: tuple[BatchSampler, BatchSampler],
        compute: ComputeDevice | None = None,
        is_tuning: bool = False,
        tensorboard: bool = False,
        save_every_s: float | None = None,
    ):
        self.compute = compute or ComputeDevice()
        self.learner = learner.to(self.compute.device)
        self.recipe, self.out, (self._train, self._validation) = recipe, out, batches
        if recipe.batch_size % self.compute.share[1]:
            raise InputError(
                f"a batch of {recipe.batch_size} cannot be shared by {self.compute.share[1]} processes evenly;"
                " choose --batch as a multiple"
            )
        chosen = [parameter for parameter in learner.parameters() if parameter.requires_grad]
        self.optimiser = torch.optim.AdamW(chosen, lr=recipe.learning_rate, weight_decay=recipe.weight_decay)
        self.best = BestValidation({**asdict(recipe), "precision": self.compute.precision})
        self.skips, self.is_tuning = 0, is_tuning
        parts = {"network": learner, "optimiser": self.optimiser, "best": self.best}
        first = self.compute.is_first
        self.resumable = Resumable(out / "checkpoint.pt", parts, every_s=save_every_s, writes=first)
        self.log = RunLog(out, self.step, tensorboard=tensorboard) if first else None
        self._joined = self.compute.joined(self.learner)

    @property
    def step(self) -> int:
        """Number of completed steps."""
        return self.resumable.done

    def run(self, listener: Listener | None = None) -> None:
        """Resumes from the last checkpoint, trains to the end, and loads the best weights into `learner`.

        Args:
            listener: Called with the progress of each step. Default: none.

        Raises:
            InputError: If gradients stay non-finite.
        """
        began, recipe = time.monotonic(), self.recipe
        if self.is_tuning and self.step == 0:
            self._validate(0)
        if self.best.since >= recipe.patience:
            self.resumable.stop()
        for step in self.resumable.steps(recipe.steps):
            rate, loss, terms, norm = self._one_step(step)
            is_due = (step + 1) % recipe.validate_every == 0 or step + 1 == recipe.steps
            validation, figures = self._validate(step + 1) if is_due else (None, {})
            progress = Progress(
                step=step + 1,
                steps=recipe.steps,
                loss=loss,
                terms=terms,
                validation=validation,
                figures=figures,
                seconds=time.monotonic() - began,
                learning_rate=rate,
                gradient_norm=norm,
            )
            if self.log is not None:
                self.log.row(asdict(progress))
            if self.best.since >= recipe.patience:
                self.resumable.stop()
            if listener is not None:
                listener(progress)
        if self.log is not None:
            self.log.close()
        self.compute.wait()
        self._load_best()

    def _one_step(self, step: int) -> tuple[float, float, dict[str, float], float]:
        recipe, place = self.recipe, self.compute
        rate = recipe.rate(step)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        batch = place.moved(self._train(step, place.share))
        # seed dropout by step, so that a resumed run equals an uninterrupted one
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
                f"training diverged at step {step}: gradients are not finite; start over with a lower learning rate"
            )

    def _validate(self, step: int) -> tuple[float, dict[str, float]]:
        """Validates; saves the weights if they are the best so far, and a picture. Returns loss and scores."""
        value, figures = self._evaluate()
        is_better = self.best.improved_by(value, figures)
        if self.log is not None:
            if is_better:
                write_tensors(self.out / BEST_FILE, self.learner.state_dict())
            with torch.inference_mode():
                picture = self.learner.picture()
            if picture is not None:
                self.log.picture(step, picture)
        return value, figures

    def validation_batches(self) -> Iterator[Any]:
        """Iterates over the fixed batches, on the device of this process."""
        for index in range(self.recipe.validation_batches):
            yield self.compute.moved(self._validation(index, (0, 1)))

    def validation_loss(self) -> float:
        """Mean loss over the fixed batches, which are shared among the processes."""
        return self._evaluate()[0]

    def _evaluate(self) -> tuple[float, dict[str, float]]:
        """Means over the fixed batches, each of which is evaluated by one process."""
        place, count = self.compute, self.recipe.validation_batches
        self.learner.eval()
        rows: list[dict[str, float]] = []
        with torch.inference_mode(), place.arithmetic():
            # a process without a batch evaluates the first one with zero weight
            for index in range(place.share[0], count, place.share[1]) or (0,):
                batch = place.moved(self._validation(index, (0, 1)))
                loss = torch.stack(list(self.learner.terms(batch).values())).sum()
                figures = {"": loss, **self.learner.figures(batch)}
                rows.append({name: float(value) for name, value in figures.items()})
        counts = place.share[0] < count
        sums = torch.tensor([counts * sum(row[name] for row in rows) for name in rows[0]], dtype=torch.float64)
        # accelerate averages over processes; NCCL requires tensors on the device
        means = place.mean(sums.to(place.device)) * place.share[1] / count
        loss, *others = means.tolist()
        return loss, dict(zip(list(rows[0])[1:], others, strict=True))

    def _load_best(self) -> None:
        if (self.out / BEST_FILE).is_file():
            self.learner.load_state_dict(read_tensors(self.out / BEST_FILE)[0])
        self.learner.eval()


class BestValidation:
    """Best validation so far, and the recipe; part of the checkpoint."""

    def __init__(self, recipe: dict[str, Any]):
        # JSON round trip, to compare equal to a restored checkpoint
        self.recipe, self.value, self.since = parse_json(json.dumps(recipe), "the recipe"), math.inf, 0
        self.figures: dict[str, float] = {}

    def improved_by(self, value: float, figures: dict[str, float] | None = None) -> bool:
        """Records a validation.

        Args:
            value: Validation loss.
            figures: Further scores. Default: none.

        Returns:
            Whether it is the best so far.
        """
        is_better = value < self.value
        self.since = 0 if is_better else self.since + 1
        if is_better:
            self.value, self.figures = value, figures or {}
        return is_better

    def state_dict(self) -> dict[str, Any]:
        """State for the checkpoint."""
        return {"recipe": self.recipe, "value": self.value, "since": self.since, "figures": self.figures}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Restores the state.

        Args:
            state: Result of `state_dict`.

        Raises:
            InputError: If the recipe differs.
        """
        # settings unknown to the older version had today's defaults; runs with a constant rate may be extended
        before = {name: state["recipe"].get(name, value) for name, value in self.recipe.items()}
        if not self.recipe.get("is_cosine", True):
            before["steps"] = self.recipe["steps"]
        others = [name for name, value in before.items() if value != self.recipe[name]]
        if others:
            differing = ", ".join(f"{name} {before[name]}, not {self.recipe[name]}" for name in others)
            raise InputError(f"it has other settings: {differing[:200]}")
        self.value, self.since, self.figures = state["value"], state["since"], state.get("figures", {})
