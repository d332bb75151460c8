"""mmweaver train activity and mmweaver train paper: what differs from mmweaver train weaver."""

import argparse
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.training.device import ComputeDevice
    from mmweaver.training.trainer import Listener, Trainer


def check(arguments: argparse.Namespace) -> None:
    """Raises InputError for what recipes `activity` and `paper` cannot do."""
    if arguments.captures is not None:
        raise InputError(f"--captures is for recipe weaver; recipe {arguments.recipe} is trained on --data")
    if arguments.recipe == "paper" and arguments.features is None:
        raise InputError(
            "recipe paper needs --features FILE, the weights of: mmweaver train activity (for its perceptual loss)"
        )


def recipe_of(name: str, given: dict[str, Any]) -> Any:
    """The recipe with what was said of it."""
    from mmweaver.training.activity_training import ActivityRecipe
    from mmweaver.training.paper_training import PaperRecipe

    return (PaperRecipe if name == "paper" else ActivityRecipe)(**given)


def on_data(
    arguments: argparse.Namespace, recipe: Any, told: "Listener", place: "ComputeDevice", options: dict[str, Any]
) -> "Trainer":
    """Trains recipe `activity` or `paper`. Raises InputError."""
    from mmweaver.training.activity_training import train_activity
    from mmweaver.training.paper_training import train_paper

    start = None if arguments.start is None else _start(arguments)
    options = {"start": start, "listener": told, "workplace": place, **options}
    if arguments.recipe == "paper":
        return train_paper(arguments.data, arguments.out, recipe, features=arguments.features, **options)
    return train_activity(arguments.data, arguments.out, recipe, **options)


def _start(arguments: argparse.Namespace) -> Any:
    """Weights to begin with, of the same recipe."""
    from mmweaver.datasets.dataset_store import read_radar
    from mmweaver.models.activity_network import load_activity
    from mmweaver.models.find_weights import find_weights
    from mmweaver.models.paper_method import load_paper

    file = find_weights(arguments.start)
    network = load_paper(file) if arguments.recipe == "paper" else load_activity(file, read_radar(arguments.data))
    return network.state_dict()
