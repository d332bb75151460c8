"""mmweaver train activity and pose: what differs from mmweaver train weaver."""

import argparse
from typing import TYPE_CHECKING, Any

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.training.activity_training import ActivityLearner
    from mmweaver.training.device import ComputeDevice
    from mmweaver.training.trainer import Listener, Trainer


def check(arguments: argparse.Namespace) -> None:
    """Raises InputError for what a recipe cannot do."""
    is_pose = arguments.recipe == "pose"
    if is_pose and arguments.task is None:
        raise InputError("train pose needs a task: mmweaver train pose TASK.toml --out model/")
    if not is_pose and (arguments.task is not None or arguments.sequences is not None):
        raise InputError(f"a task and --sequences are for recipe pose; recipe {arguments.recipe} is trained on --data")
    if is_pose and any(one is not None for one in (arguments.data, arguments.captures, arguments.start)):
        raise InputError("recipe pose is trained on the sentences of its task: without --data, --captures and --from")
    if arguments.recipe != "weaver" and arguments.captures is not None:
        raise InputError(f"--captures is for recipe weaver; recipe {arguments.recipe} is trained on --data")


def pose_steps() -> int:
    """Steps of recipe `pose`."""
    from mmweaver.training.pose_training import PoseRecipe

    return PoseRecipe().steps


def train_on_task(
    arguments: argparse.Namespace, given: dict[str, Any], listener: "Listener", place: "ComputeDevice",
    options: dict[str, Any],
) -> dict[str, Any]:  # fmt: skip
    """Trains recipe `pose` and writes its weights; a summary. Raises InputError."""
    from mmweaver.recognition.train_pose import SEQUENCES, PoseTraining, train_pose_of_task
    from mmweaver.training.pose_training import PoseRecipe

    sequences = SEQUENCES if arguments.sequences is None else arguments.sequences
    training = PoseTraining(sequences=sequences, recipe=PoseRecipe(**given))
    files, trainers = train_pose_of_task(
        arguments.task, arguments.out, training, listener=listener, compute=place, **options
    )
    return {
        "weights": [str(file) for file in files], "steps": trainers[0].step,
        "validation_loss": sum(one.best.value for one in trainers) / len(trainers),
        "evaluated_on": "generated people held out",
    }  # fmt: skip


def train_on_data(
    arguments: argparse.Namespace, given: dict[str, Any], listener: "Listener", place: "ComputeDevice",
    options: dict[str, Any],
) -> "Trainer[ActivityLearner]":  # fmt: skip
    """Trains recipe `activity`; `given` are the settings of the recipe that the user gave. Raises InputError."""
    from mmweaver.datasets.room_sequences import labels_of, radar_of
    from mmweaver.models.activity_network import label_names_of, load_activity
    from mmweaver.models.hub import find_weights
    from mmweaver.training.activity_training import ActivityRecipe, train_activity

    start = None
    if arguments.start is not None:
        weights = find_weights(arguments.start)
        start = load_activity(weights, radar_of(arguments.data)).state_dict()
        if label_names_of(weights) != labels_of(arguments.data):
            raise InputError(f"{weights} tells other labels apart than {arguments.data} has; train without --from")
    recipe = ActivityRecipe(**given)
    return train_activity(
        arguments.data, arguments.out, recipe, start=start, listener=listener, compute=place, **options
    )
