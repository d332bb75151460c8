"""The loop of recipes `activity` and `paper`: steps, checkpoints, validation, the best weights, a log.

checkpoint.pt       all that is needed to go on exactly
best.safetensors    weights that were best on validation
log.jsonl           a line now and then
"""

import hashlib
import json
import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.core.version import __version__
from mmweaver.data.store import plan_text, read_radar
from mmweaver.models.weights import WeightsCard, save_weights
from mmweaver.training.resuming import Resumable
from mmweaver.training.trainer import BEST_FILE, WORST_SKIPS, save_tensors

LOG_EVERY = 20


@dataclass(frozen=True, kw_only=True)
class LoopSettings:
    """How long and how fast. A step's batch and chance follow from seed and step, so a run can stop and go on."""

    name: str
    steps: int
    batch_size: int
    learning_rate: float
    warm_up_steps: int = 0
    is_cosine: bool = False
    weight_decay: float = 0.0
    largest_gradient: float = math.inf
    seed: int = 0
    validate_every: int = 100
    patience: int = 1_000_000  # validations without a better one before training stops early

    def rate(self, step: int) -> float:
        """Learning rate of a step."""
        rate = self.learning_rate * min(1.0, (step + 1) / max(self.warm_up_steps, 1))
        return rate * (0.5 + 0.5 * math.cos(math.pi * step / self.steps)) if self.is_cosine else rate


@dataclass(frozen=True, kw_only=True)
class StepReport:
    """What is told after each step."""

    step: int
    steps: int
    loss: float
    terms: dict[str, float]
    validation: dict[str, float] | None  # the first of them is what the best weights are chosen by
    seconds: float


class RecipeLoop:
    """Trains a network: `terms(step)` gives the parts of a step's loss, `validate()` figures of which the first is to
    become small. Raises InputError for a checkpoint of other settings, and where gradients stay without meaning."""

    def __init__(
        self,
        network: nn.Module,
        settings: LoopSettings,
        out: Path,
        *,
        terms: Callable[[int], dict[str, Tensor]],
        validate: Callable[[], dict[str, float]],
    ):
        self.network, self.settings, self.out, self.terms, self.validate = network, settings, out, terms, validate
        self.optimiser = torch.optim.AdamW(
            network.parameters(), lr=settings.learning_rate, weight_decay=settings.weight_decay
        )
        self.best = _Best(asdict(settings))
        self.skips = 0
        out.mkdir(parents=True, exist_ok=True)
        parts = {"network": network, "optimiser": self.optimiser, "best": self.best}
        self.resumable = Resumable(out / "checkpoint.pt", parts)

    @property
    def step(self) -> int:
        """Steps that are done."""
        return self.resumable.done

    def run(self, listener: Callable[[StepReport], object] | None = None) -> None:
        """Goes on from the last checkpoint to the end, and leaves the best weights in `network`."""
        began = time.monotonic()
        for step in self.resumable.steps(self.settings.steps):
            loss, terms = self._one_step(step)
            is_due = (step + 1) % self.settings.validate_every == 0 or step + 1 == self.settings.steps
            report = StepReport(
                step=step + 1, steps=self.settings.steps, loss=loss, terms=terms,
                validation=self._validated() if is_due else None, seconds=time.monotonic() - began,
            )  # fmt: skip
            self._log(report)
            if listener is not None:
                listener(report)
            if self.best.since >= self.settings.patience:
                break
        self._take_best()

    def _one_step(self, step: int) -> tuple[float, dict[str, float]]:
        for group in self.optimiser.param_groups:
            group["lr"] = self.settings.rate(step)
        # what is dropped in a step follows from its number, wherever training began
        torch.manual_seed(int(stream(self.settings.seed, "dropout", step).integers(2**31)))
        self.network.train()
        terms = self.terms(step)
        loss = torch.stack(list(terms.values())).sum()
        self.optimiser.zero_grad()
        loss.backward()
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), self.settings.largest_gradient)
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

    def _validated(self) -> dict[str, float]:
        self.network.eval()
        with torch.no_grad():
            figures = self.validate()
        if self.best.improved_by(figures):
            save_tensors(self.network.state_dict(), self.out / BEST_FILE)
        return figures

    def _log(self, report: StepReport) -> None:
        if report.step % LOG_EVERY == 0 or report.validation is not None:
            with (self.out / "log.jsonl").open("a") as log:
                log.write(json.dumps(asdict(report)) + "\n")

    def _take_best(self) -> None:
        from safetensors.torch import load_file

        if (self.out / BEST_FILE).is_file():
            self.network.load_state_dict(load_file(self.out / BEST_FILE))
        self.network.eval()


class _Best:
    """The best validation so far, and the settings it belongs to; kept in the checkpoint."""

    def __init__(self, settings: dict[str, Any]):
        self.settings, self.figures, self.since = settings, {}, 0

    @property
    def value(self) -> float:
        return next(iter(self.figures.values()), math.inf)

    def improved_by(self, figures: dict[str, float]) -> bool:
        """Takes note of a new validation; True where it is the best."""
        is_better = next(iter(figures.values())) < self.value
        self.figures, self.since = (figures, 0) if is_better else (self.figures, self.since + 1)
        return is_better

    def state_dict(self) -> dict[str, Any]:
        return {"settings": self.settings, "figures": self.figures, "since": self.since}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        free = () if self.settings["is_cosine"] else ("steps",)  # a constant rate may go on for longer
        before, now = ({k: v for k, v in each.items() if k not in free} for each in (state["settings"], self.settings))
        if before != now:
            raise InputError("it was made with other settings")
        self.figures, self.since = state["figures"], state["since"]


def write_recipe_weights(out: Path, data: Path, loop: RecipeLoop) -> Path:
    """Writes `out`/weights.safetensors with its card, and gives its path."""
    card = WeightsCard(
        recipe=loop.settings.name, licence="MIT", dataset_sha256=hashlib.sha256(plan_text(data).encode()).hexdigest(),
        radar=read_radar(data).name, steps=loop.step, seed=loop.settings.seed, validation_loss=loop.best.value,
        mmweaver_version=__version__,
    )  # fmt: skip
    file = out / "weights.safetensors"
    save_weights(file, loop.network, card)
    return file
