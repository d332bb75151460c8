"""Weights of a recipe other than `weaver`, with what one must know about them, and their page."""

import hashlib
from dataclasses import asdict
from pathlib import Path

from torch import nn

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.version import __version__
from mmweaver.datasets.dataset_store import plan_text, read_radar, read_rooms
from mmweaver.models.activity_network import ACTIVITY_NAMES
from mmweaver.models.weights import WEIGHTS_FILE, WeightsCard, save_weights
from mmweaver.training.activity_training import TRAIN_SPLITS
from mmweaver.training.model_card import ACTIVITY, Figures, Page, model_card
from mmweaver.training.trainer import Trainer

CARD_FILE = "README.md"


def write_activity_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes weights and page of recipe `activity`; returns the path of the weights."""
    accuracy, chance = 1 - trainer.best.figures["wrong"], 1 / len(ACTIVITY_NAMES)
    figures = {"this network": {"accuracy": accuracy}, "chance": {"accuracy": chance}}
    return write_recipe_weights(out, data, trainer, splits=TRAIN_SPLITS, page=ACTIVITY, figures=figures)


def write_recipe_weights(
    out: Path, data: Path, trainer: Trainer, *, splits: tuple[str, ...], page: Page, figures: Figures
) -> Path:
    """Writes `out`/weights.safetensors and its README.md; returns the path of the weights.

    `splits`: those of the data set that the network was trained on. `figures`: the best validation and its baselines.
    """
    recipe, network = trainer.recipe, getattr(trainer.learner, "network", None)
    assert isinstance(network, nn.Module), "a learner of one network"
    card = WeightsCard(
        recipe=recipe.name, licence="MIT", dataset_sha256=hashlib.sha256(plan_text(data).encode()).hexdigest(),
        radar=read_radar(data).name, steps=trainer.step, seed=recipe.seed, validation_loss=trainer.best.value,
        mmweaver_version=__version__, settings=asdict(recipe) | {"precision": trainer.workplace.precision},
    )  # fmt: skip
    file = out / WEIGHTS_FILE
    save_weights(file, network, card)
    sequences, rooms = _counted(data, splits)
    unseen, unseen_rooms = _counted(data, ("validation",))
    passes = trainer.step * recipe.batch_size / sequences
    told = f"Made up by `mmweaver dataset`: {sequences:,} sequences of {rooms} rooms, {passes:.1f} passes through them."
    judged = f"{unseen:,} sequences of {unseen_rooms} rooms of kinds not trained on, the weights that were best there."
    text = model_card(card, file, data=told, judged_on=judged, figures=figures, page=page)
    with atomic_file(out / CARD_FILE) as partial:
        partial.write_text(text, encoding="utf-8")
    return file


def _counted(data: Path, splits: tuple[str, ...]) -> tuple[int, int]:
    """Sequences and rooms of some splits."""
    each = [sum(name in splits for name in room.split) for room in read_rooms(data)]
    return sum(each), sum(count > 0 for count in each)
