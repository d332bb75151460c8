"""Training of the activity network: recipe `activity`."""

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from mmweaver.core.tensor_files import read_tensors, write_tensors
from mmweaver.datasets.activity_store import SPLITS, ActivitySet, is_activity_set
from mmweaver.datasets.room_sequences import LabelledData, labels_of, plan_of, read_labelled
from mmweaver.models.activity_network import ActivityNetwork
from mmweaver.models.frame_motion import SPREAD_DB, LogMaps
from mmweaver.training.device import ComputeDevice, Share
from mmweaver.training.model_card import ACTIVITY, OWN, Figures
from mmweaver.training.trained_weights import write_recipe_weights
from mmweaver.training.trainer import BatchSampler, Learner, Listener, LoopRecipe, Trainer
from mmweaver.training.validation_sheet import draw_confusion

GAIN_SPREAD_DB, SHIFT_BINS, SHIFT_FRAMES = 2.0, 6, 3  # augmentation: standard deviation, maximum shifts


@dataclass(frozen=True, kw_only=True)
class ActivityExamples:
    """Sequences as log maps in half precision, about 0.25 MB each, with activity, room and person."""

    doppler: Tensor  # (sequence, frame, 1, range, doppler)
    angle: Tensor  # (sequence, frame, 2, range, azimuth)
    label: Tensor  # (sequence,) index into label_names
    label_names: tuple[str, ...]
    room: tuple[str, ...]
    person: tuple[int, ...]
    config: RadarConfig

    def __len__(self) -> int:
        return len(self.label)


def compute_log_maps(cubes: Iterable[RadarCube], config: RadarConfig) -> tuple[Tensor, Tensor]:
    """Computes the log maps of cubes.

    Args:
        cubes: Cubes in sqrt(mW), all of one shape.
        config: The radar.

    Returns:
        Range-Doppler (sequence, frame, 1, range, doppler) and range-angle (sequence, frame, 2, range, azimuth) maps in
        half precision.
    """
    maps, doppler, angle = LogMaps(config), [], []
    with torch.no_grad():
        for cube in cubes:
            one, other = maps(torch.from_numpy(cube.values))
            doppler.append(one.half())
            angle.append(other.half())
    return torch.stack(doppler), torch.stack(angle)


def activity_examples(
    folder: Path,
    splits: tuple[str, ...],
    cache: Path | None = None,
    *,
    keep: bool = True,
    device: str = "cpu",
    pick: Callable[[np.ndarray], np.ndarray] | None = None,
) -> ActivityExamples:
    """Loads the sequences of a data set in given splits as log maps.

    Args:
        folder: The data set.
        splits: Names of the splits.
        cache: File with the maps, used if it has the same sequences. Default: none.
        keep: Whether computed maps are saved in `cache`. Default: True.
        device: Device on which signals that are not stored are synthesised. Default: CPU.
        pick: Selects sequences by their labels and returns indices. Default: all.

    Returns:
        The sequences.

    Raises:
        InputError: If there are none.
    """
    data = read_labelled(folder, device=device)
    columns, config = data.columns, data.config
    chosen = np.flatnonzero(np.isin(columns["split"], splits))
    if not len(chosen):
        raise InputError(f"{folder} has no sequences of {' or '.join(splits)}; {_more(data)}")
    if pick is not None:
        chosen = chosen[pick(columns["label"][chosen])]
    mark = hashlib.sha256("\n".join([plan_of(folder), *map(str, chosen)]).encode()).hexdigest()
    maps = _stored_maps(cache, mark)
    if maps is None:
        maps = compute_log_maps((data.cube(int(index)) for index in chosen), config)
        if cache is not None and keep:
            write_tensors(cache, {"doppler": maps[0], "angle": maps[1]}, {"mark": mark})
    doppler, angle = maps
    return ActivityExamples(
        doppler=doppler,
        angle=angle,
        label=torch.from_numpy(columns["label"][chosen].astype(np.int64)),
        label_names=data.label_names,
        room=tuple(map(str, columns["room"][chosen])),
        person=tuple(map(int, columns["subject"][chosen])),
        config=config,
    )


def _more(data: LabelledData) -> str:
    """Advice on how to get sequences of every split."""
    if isinstance(data, ActivitySet):
        return "each split needs people of its own: make the set with three --subjects or more, or another --split"
    return "make more with: mmweaver dataset"


def _stored_maps(file: Path | None, mark: str) -> tuple[Tensor, Tensor] | None:
    """Maps from a file; None if it is missing, damaged or of other sequences."""
    try:
        tensors, header = read_tensors(file) if file is not None else ({}, {})
    except InputError:
        return None
    return (tensors["doppler"], tensors["angle"]) if header.get("mark") == mark else None


def augmented(doppler: Tensor, angle: Tensor, rng: np.random.Generator) -> tuple[Tensor, Tensor]:
    """Augments maps by random gain and cyclic shifts in time and range.

    Args:
        doppler: Range-Doppler maps, (sequence, frame, 1, range, doppler).
        angle: Range-angle maps, (sequence, frame, 2, range, azimuth).
        rng: Random generator.

    Returns:
        Augmented maps, float32.
    """
    gain = torch.from_numpy(rng.normal(0, GAIN_SPREAD_DB / SPREAD_DB, (len(doppler), 1, 1, 1, 1)).astype(np.float32))
    doppler, angle = doppler.float() + gain, angle.float() + gain
    for one, other in zip(doppler, angle, strict=True):
        steps = int(rng.integers(-SHIFT_FRAMES, SHIFT_FRAMES + 1)), int(rng.integers(-SHIFT_BINS, SHIFT_BINS + 1))
        one.copy_(torch.roll(one, steps, (0, 2)))
        other.copy_(torch.roll(other, steps, (0, 2)))
    return doppler, angle


# The recogniser learns all twelve activities, including those held out from the learned method.
TRAIN_SPLITS = ("train", "test_activity")
TRAIN_MAPS, VALIDATION_MAPS = "train_maps.safetensors", "validation_maps.safetensors"
SMOOTHING = 0.1
AT_ONCE = 32


@dataclass(frozen=True, kw_only=True)
class ActivityRecipe(LoopRecipe):
    """Hyperparameters of the activity network, chosen on split `validation`."""

    name: str = "activity"
    steps: int = 800
    batch_size: int = 16
    learning_rate: float = 2e-3
    warm_up_steps: int = 50
    weight_decay: float = 1e-2
    validate_every: int = 100
    validation_batches: int = 8  # together they contain all sequences of the split


@dataclass(frozen=True, kw_only=True)
class ActivityBatch:
    """Log maps of sequences and their labels."""

    doppler: Tensor  # (sequence, frame, 1, range, doppler)
    angle: Tensor  # (sequence, frame, 2, range, azimuth)
    label: Tensor  # (sequence,) index into the labels of the data


class ActivityLearner(Learner):
    """The activity network with its loss; its picture is the confusion matrix on `unseen`."""

    def __init__(self, network: ActivityNetwork, unseen: ActivityExamples | None = None):
        super().__init__()
        self.network, self.unseen = network, unseen

    def terms(self, batch: ActivityBatch) -> dict[str, Tensor]:
        """Cross entropy, with label smoothing during training."""
        scores = self.network(batch.doppler, batch.angle)
        smoothing = SMOOTHING if self.training else 0.0
        return {"cross_entropy": torch.nn.functional.cross_entropy(scores, batch.label, label_smoothing=smoothing)}

    def figures(self, batch: ActivityBatch) -> dict[str, Tensor]:
        """Share of wrong predictions."""
        answers = self.network(batch.doppler, batch.angle).argmax(dim=1)
        return {"wrong": (answers != batch.label).float().mean()}

    def picture(self) -> np.ndarray | None:
        """Confusion matrix on `unseen`, or None."""
        if self.unseen is None:
            return None
        answers = scores_of(self.network, self.unseen).argmax(dim=1).numpy()
        return draw_confusion(self.unseen.label.numpy(), answers, self.unseen.label_names)


def train_activity(
    data: Path,
    out: Path,
    recipe: ActivityRecipe,
    *,
    start: dict[str, Tensor] | None = None,
    listener: Listener | None = None,
    compute: ComputeDevice | None = None,
    **options: Any,
) -> Trainer[ActivityLearner]:
    """Trains on a data set of rooms or a labelled set, or resumes from `out`/checkpoint.pt.

    Log maps of all sequences are cached in `out`: if signals are synthesised, computing them costs more than the
    training.

    Args:
        data: Folder of the set.
        out: Folder of the run.
        recipe: Hyperparameters.
        start: Weights to fine-tune. Default: random.
        listener: Called with the progress of each step. Default: none.
        compute: Device, precision and process. Default: CPU in float32.
        **options: Further arguments of `Trainer`.

    Returns:
        The trainer with the best network on split `validation`.

    Raises:
        InputError: If the folder contains no data, or training diverges.
    """
    place = compute or ComputeDevice()
    cache: dict[str, Any] = {"keep": place.is_first, "device": str(place.device)}
    unseen = activity_examples(data, ("validation",), out / VALIDATION_MAPS, **cache)
    examples = activity_examples(data, TRAIN_SPLITS, out / TRAIN_MAPS, **cache)
    torch.manual_seed(recipe.seed)
    network = ActivityNetwork(examples.config, len(examples.label_names))
    if start is not None:
        network.load_state_dict(start)
    trainer = Trainer(
        ActivityLearner(network, unseen),
        recipe,
        out,
        compute=compute,
        is_tuning=start is not None,
        batches=(_batch_sampler(examples, recipe), _fixed_batches(unseen, recipe.validation_batches)),
        **options,
    )
    trainer.run(listener)
    return trainer


def _batch_sampler(examples: ActivityExamples, recipe: ActivityRecipe) -> BatchSampler:
    """Samples augmented sequences by step."""

    def draw(step: int, share: Share) -> ActivityBatch:
        rng = stream(recipe.seed, "activity batch", step)
        chosen = rng.choice(len(examples), size=recipe.batch_size, replace=len(examples) < recipe.batch_size)
        which = torch.from_numpy(chosen)
        doppler, angle = augmented(examples.doppler[which], examples.angle[which], rng)
        own = slice(share[0], None, share[1])
        return ActivityBatch(doppler=doppler[own], angle=angle[own], label=examples.label[which][own])

    return draw


def _fixed_batches(examples: ActivityExamples, count: int) -> Callable[[int, Share], ActivityBatch]:
    """All sequences without augmentation, distributed over `count` batches."""

    def draw(index: int, share: Share) -> ActivityBatch:
        own = slice(index % len(examples), None, count)
        return ActivityBatch(
            doppler=examples.doppler[own].float(), angle=examples.angle[own].float(), label=examples.label[own]
        )

    return draw


def scores_of(network: ActivityNetwork, examples: ActivityExamples) -> Tensor:
    """Evaluates a network.

    Args:
        network: The network.
        examples: Sequences.

    Returns:
        Logits, (sequence, label), on the CPU.
    """
    network.eval()
    device = next(network.parameters()).device
    with torch.no_grad():
        parts = zip(examples.doppler.split(AT_ONCE), examples.angle.split(AT_ONCE), strict=True)
        scores = [network(one.float().to(device), other.float().to(device)) for one, other in parts]
        return torch.cat(scores).cpu()


def write_activity_weights(
    out: Path, data: Path, trainer: Trainer[ActivityLearner], scores: Figures | None = None
) -> Path:
    """Writes the weights and model card of recipe `activity`.

    Args:
        out: Folder of the run.
        data: Folder of the set.
        trainer: The finished run.
        scores: Scores of the model card. Default: those of `activity_scores`.

    Returns:
        Path of the weights.
    """
    return write_recipe_weights(
        out,
        data,
        trainer,
        splits=TRAIN_SPLITS,
        page=ACTIVITY,
        figures=scores or activity_scores(data, trainer),
        label_names=list(labels_of(data)),
    )


def activity_scores(data: Path, trainer: Trainer[ActivityLearner]) -> Figures:
    """Accuracy of the best network and of chance, in validation and on the test split of a labelled set.

    Args:
        data: Folder of the set.
        trainer: The finished run.

    Returns:
        Scores by method.
    """
    own = {"accuracy": 1 - trainer.best.figures["wrong"]}
    if is_activity_set(data) and SPLITS[2] in read_labelled(data).columns["split"]:
        unseen = activity_examples(data, (SPLITS[2],))
        right = scores_of(trainer.learner.network, unseen).argmax(dim=1) == unseen.label
        own["test_accuracy"] = float(right.float().mean())
    return {OWN: own, "chance": dict.fromkeys(own, 1 / len(labels_of(data)))}
