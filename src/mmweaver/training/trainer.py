"""The training loop of every network; learner and data are passed in.

    sample(step, share) -> batch -> learner.terms(batch) -> {name: term of the loss} -> step -> files in `out`

    checkpoint.pt        everything needed to resume exactly, every minute
    best.safetensors     weights with the lowest validation loss
    log.jsonl, tensorboard/, pictures/     logs

A recipe is a dataclass derived from `LoopRecipe`, a network a `Learner`.
Reference: docs/decisions/training-loop.md.

Log of a training run: rows of figures, pictures, and TensorBoard files.

Interruptible training: state is saved regularly, and training resumes from it.
"""

import io
import json
import logging
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.atomic_files import append_line, atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.safe_files.safe_tensors import read_checkpoint
from mmweaver.core.safe_files.safe_text import parse_json, read_text
from mmweaver.core.seeding import stream
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.training.device import ComputeDevice, Share

SAVE_EVERY_S = 60.0
log = logging.getLogger(__name__)


class Resumable:
    """Counts steps, saves the state of a run regularly, and resumes a saved run.

    Of several processes all load and one saves. A run resumes with its original number of threads, since sums over
    another number of threads differ in their last bits.

    Attributes:
        done: Number of completed steps.
        history: Rows of figures, saved with the state.
    """

    def __init__(self, file: Path | None, parts: dict[str, Any], *, every_s: float | None = None, writes: bool = True):
        """Loads the state if the file exists.

        Args:
            file: Checkpoint; None to save nothing.
            parts: Objects with `state_dict` and `load_state_dict`, by name.
            every_s: Seconds between checkpoints. Default: 60.
            writes: Whether this process saves. Default: True.

        Raises:
            InputError: If the checkpoint is damaged or has other settings.
        """
        self.file, self.parts, self.every_s, self.writes = file, parts, every_s, writes
        self.done = 0
        self.history: list[dict[str, float]] = []
        self._is_last = False
        if file is not None and file.is_file():
            self._load(file)

    def steps(self, most: int) -> Iterator[int]:
        """Iterates over the remaining steps and saves the state in between.

        Args:
            most: Total number of steps.

        Yields:
            Number of completed steps.
        """
        every_s = SAVE_EVERY_S if self.every_s is None else self.every_s
        saved = time.monotonic()
        while self.done < most and not self._is_last:
            yield self.done
            self.done += 1
            if time.monotonic() - saved > every_s or self.done == most or self._is_last:
                self._save()
                saved = time.monotonic()

    def stop(self) -> None:
        """Makes the current step the last one."""
        self._is_last = True

    def _save(self) -> None:
        if self.file is None or not self.writes:
            return
        states = {name: part.state_dict() for name, part in self.parts.items()}
        state = {"done": self.done, "history": self.history, "parts": states}
        packed = io.BytesIO()  # torch.save to a full disk raises errors of many types
        torch.save(state | {"threads": torch.get_num_threads()}, packed)
        with atomic_file(self.file) as temporary:
            temporary.write_bytes(packed.getbuffer())

    def _load(self, file: Path) -> None:
        saved = read_checkpoint(file, what="no checkpoint ({reason}); delete it to start over")
        try:
            for name, part in self.parts.items():
                part.load_state_dict(saved["parts"][name])
        except Exception as error:
            raise InputError(
                f"{file} cannot be resumed ({str(error).splitlines()[0][:80]}); delete it to start over"
            ) from None
        self.done, self.history = saved["done"], saved["history"]
        _use_threads(int(saved.get("threads", torch.get_num_threads())), file)  # missing in older files


def _use_threads(threads: int, file: Path) -> None:
    if threads != torch.get_num_threads():
        log.warning("%s was written with %d threads; training resumes with %d", file, threads, threads)
        torch.set_num_threads(threads)


ROW_EVERY = 50  # steps
LOG, PICTURES, BOARD = "log.jsonl", "pictures", "tensorboard"


class RunLog:
    """log.jsonl, pictures/ and, if requested, tensorboard/ in the folder of a run."""

    def __init__(self, out: Path, done: int, *, tensorboard: bool = False):
        """Opens the log and drops entries of an interrupted run after its checkpoint.

        Args:
            out: Folder of the run.
            done: Number of completed steps.
            tensorboard: Whether to write TensorBoard files. Default: False.

        Raises:
            InputError: If TensorBoard is requested but not installed.
        """
        self.out, self.file = out, out / LOG
        self.board = _writer(out / BOARD, done) if tensorboard else None
        if self.file.is_file():
            kept = [line for line in read_text(self.file).splitlines() if _step_of(line) <= done]
            with atomic_file(self.file) as temporary:
                temporary.write_text("".join(f"{line}\n" for line in kept), encoding="utf-8")

    def row(self, figures: dict[str, Any]) -> None:
        """Logs the figures of a step if it is a multiple of 50 or has a validation.

        Args:
            figures: Fields of `Progress`.
        """
        step = figures["step"]
        if step % ROW_EVERY and figures["validation"] is None:
            return
        append_line(self.file, json.dumps(figures))
        if self.board is not None:
            for name, value in _scalars(figures).items():
                self.board.add_scalar(name, value, step)
            self.board.flush()

    def picture(self, step: int, image: np.ndarray) -> None:
        """Saves a picture.

        Args:
            step: Number of completed steps.
            image: Picture, (row, column, 3) uint8.
        """
        from PIL import Image

        with atomic_file(self.out / PICTURES / f"step_{step:06d}.png") as temporary:
            Image.fromarray(image).save(temporary, "PNG")
        if self.board is not None:
            self.board.add_image("validation", image, step, dataformats="HWC")

    def close(self) -> None:
        """Closes the TensorBoard files."""
        if self.board is not None:
            self.board.close()


def _scalars(figures: dict[str, Any]) -> dict[str, float]:
    """{"loss": 1, "terms": {"a": 1}} -> {"loss": 1, "terms/a": 1}; None is dropped."""
    flat: dict[str, float] = {}
    for name, value in figures.items():
        if isinstance(value, dict):
            flat |= {f"{name}/{part}": own for part, own in value.items()}
        elif value is not None and name not in ("step", "steps"):
            flat[name] = value
    return flat


def _step_of(line: str) -> float:
    try:
        return float(parse_json(line, "a line of the log")["step"])
    except (ValueError, KeyError, TypeError):
        return float("inf")  # an incomplete line of a killed process


def _writer(folder: Path, done: int) -> Any:
    need("training", "--tensorboard", "tensorboard")
    from torch.utils.tensorboard import SummaryWriter

    return SummaryWriter(str(folder), purge_step=done + 1 if done else None)


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
