"""What recipes `activity` and `paper` leave: weights with what one must know about them, and their page."""

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
from mmweaver.training.model_card import Figures, model_card
from mmweaver.training.trainer import Trainer

CARD_FILE = "README.md"
SPLITS = {"activity": TRAIN_SPLITS, "paper": ("train",)}


def write_recipe_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes `out`/weights.safetensors and its README.md; gives the weights' path."""
    recipe, network = trainer.recipe, getattr(trainer.learner, "network", None)
    assert isinstance(network, nn.Module), "a learner of one network"
    card = WeightsCard(
        recipe=recipe.name, licence="MIT", dataset_sha256=hashlib.sha256(plan_text(data).encode()).hexdigest(),
        radar=read_radar(data).name, steps=trainer.step, seed=recipe.seed, validation_loss=trainer.best.value,
        mmweaver_version=__version__, settings=asdict(recipe) | {"precision": trainer.workplace.precision},
    )  # fmt: skip
    file = out / WEIGHTS_FILE
    save_weights(file, network, card)
    sequences, rooms = _counted(data, SPLITS[recipe.name])
    unseen, unseen_rooms = _counted(data, ("validation",))
    passes = trainer.step * recipe.batch_size / sequences
    told = f"Made up by `mmweaver dataset`: {sequences:,} sequences of {rooms} rooms, {passes:.1f} passes through them."
    judged = f"{unseen:,} sequences of {unseen_rooms} rooms of kinds not trained on, the weights that were best there."
    page = model_card(card, file, data=told, judged_on=judged, figures=_figures(trainer))
    with atomic_file(out / CARD_FILE) as partial:
        partial.write_text(page)
    return file


def _figures(trainer: Trainer) -> Figures:
    """The best validation beside its floor."""
    own = trainer.best.figures
    if trainer.recipe.name == "activity":
        floor = 1 / len(ACTIVITY_NAMES)
        return {"this network": {"accuracy": 1 - own["wrong"]}, "chance": {"accuracy": floor}}
    row = {"loss": trainer.best.value, "squared_error_over_energy": own["nmse"], "energy_over_true": own["energy"]}
    nothing = {"loss": own["zeros_loss"], "squared_error_over_energy": 1.0, "energy_over_true": 0.0}
    return {"this network": row, "all zeros": nothing}


def _counted(data: Path, splits: tuple[str, ...]) -> tuple[int, int]:
    """Sequences and rooms of some splits."""
    each = [sum(name in splits for name in room.split) for room in read_rooms(data)]
    return sum(each), sum(count > 0 for count in each)
