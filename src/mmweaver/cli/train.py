"""mmweaver train: weights from a data set, from recordings of one's own room, or from the sentences of a task."""

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from mmweaver.cli.arguments import REQUEST_FILE, check_mode, write_request
from mmweaver.cli.option_groups import Printed
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.options import MISSING, Source, option, options

if TYPE_CHECKING:
    from mmweaver.models.weights import WeightsCard
    from mmweaver.training.device import ComputeDevice
    from mmweaver.training.trainer import Listener, Progress, Trainer

# what a run writes: none may be a folder, or the weights that it starts from
RUN_FILES = ("weights.safetensors", "best.safetensors", "checkpoint.pt", "log.jsonl", "README.md", REQUEST_FILE)
# options of some recipes; fine-tuning is recipe weaver on recordings
USES = {
    "weaver": "data start encoder",
    "hypernetwork": "data start target",
    "activity": "data start",
    "pose": "task sequences",
    "fine-tuning": "recordings start rgb depth camera",
}
NEEDS = {"weaver": "data", "hypernetwork": "data", "activity": "data", "pose": "task", "fine-tuning": "start"}
MAX_LEARNING_RATE = 1.0  # far above what Adam learns with
EXAMPLES = """examples:
  mmweaver dataset data/ --layouts 10 --sequences 20 --workers 4
  mmweaver train weaver --data data/ --out run/ --tensorboard
  mmweaver train weaver --weights run/ --recordings take1/ take2/ take3/ --out tuned/
  torchrun --nproc-per-node 4 -m mmweaver train weaver --data data/ --out run/ --batch 12
  mmweaver train hypernetwork --data data/ --target signal --out paper/      # the paper as written
  mmweaver train hypernetwork --data data/ --target power --out power/       # what can be learned
  mmweaver train activity --data data/ --out activity/
  mmweaver train activity --data my_set/ --out recogniser/          # of mmweaver dataset --activities
  mmweaver train pose examples/tasks/mars_poses.toml --out model/   # then: mmweaver pose model/ --points log.dat
  mmweaver generate --demo --weights run/ --out woven/
"""


@options
class Options(Printed):
    """Trains the network on a data set of mmweaver dataset and writes its weights with their model card. It may be
    stopped or killed at any time: the same command resumes from its last checkpoint. At every validation OUT/pictures
    compares what it has learned with the ground truth.
    """

    recipe: Literal["weaver", "hypernetwork", "activity", "pose"] = option(
        "what is trained: the network; the paper's hypernetwork; a recogniser of the activities of the data; or poses"
        " from points",
        default=MISSING,
        positional=True,
    )
    task: Any = option("of recipe pose: docs/pose.md", "TASK.toml", positional=True, kind=Path)
    data: Any = option(
        "a data set of mmweaver dataset; for recipe activity also a labelled set of your own room", "DIR", kind=Path
    )
    out: Path = option("folder for checkpoint, log and weights", "DIR", default=MISSING, is_setting=False)
    start: Source | None = option(
        "weights of the same recipe to start from (default: random)", "FILE|DIR|HUB", name="weights"
    )
    target: Literal["signal", "power"] | None = option(
        "recipe hypernetwork: complex signals, as the paper has it, or fields of power (default power)",
        group="the paper's hypernetwork",
    )
    recordings: Any = option(
        "folders of mmweaver process or generate (radar.npz), or of mmwave-capture-std; with pose.npz where the joints"
        " are known, else only the static room is tuned; the last one is held out for validation",
        "DIR",
        nargs="+",
        group="your own recordings instead of --data (needs --weights)",
        kind=Path,
        many=True,
    )
    rgb: Path | None = option("photo of the room, where the folders hold none", "PNG")
    depth: Path | None = option("its depth: 16-bit PNG (mm), .npy or float TIFF in metres", "FILE")
    camera: Path | None = option("its camera: fx, fy, cx, cy in pixels", "JSON")
    sequences: int | None = option("recipe pose: people per activity (default 40)", "N", group="optimisation")
    steps: int | None = option(
        "total number of steps (default 6000; target power 3000, activity 800, pose 2000, recordings 300)", "N"
    )
    batch: int | None = option(
        "sequences per step, over all processes (default 3; target signal 4, activity and pose 16, recordings 2)", "N"
    )
    learning_rate: float | None = option(
        "peak learning rate of AdamW (default 1e-3; target signal 1e-4, activity and pose 2e-3, recordings 2e-4,"
        " without joints 5e-3)",
        "RATE",
    )
    seed: int = option("seed of the initial weights and of the batches", "N", default=0)
    validate_every: int | None = option(
        "steps between validations (default 250; target signal 200, activity 100, recordings 25)", "STEPS"
    )
    encoder: str | None = option("recipe weaver's environment encoder (default efficientnet)", "NAME", rare=True)
    save_every: float = option("seconds between checkpoints", "S", default=60.0)
    device: str = option(
        "cpu (float32), cuda (bf16), cuda:1 ..., or auto: a GPU if there is one", "NAME", default="auto", group="device"
    )
    tensorboard: bool = option("also write TensorBoard's files to OUT/tensorboard", default=False, group="output")

    @property
    def mode(self) -> str:
        """The recipe, or "fine-tuning" of recipe weaver on recordings."""
        return "fine-tuning" if self.recordings and self.recipe == "weaver" else self.recipe

    @property
    def settings(self) -> dict[str, Any]:
        """The given settings of the recipe."""
        names = {"batch": "batch_size"}
        given = {
            names.get(name, name): getattr(self, name)
            for name in ("steps", "batch", "learning_rate", "seed", "validate_every", "encoder")
        }
        return {name: value for name, value in given.items() if value is not None}


def run(asked: Options) -> int:
    """Trains a network and writes its weights.

    Raises:
        InputError: For options or data that cannot be used.
    """
    _check(asked)
    from mmweaver.core.atomic_files import claimed_folder
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.training.device import ComputeDevice

    place = ComputeDevice.chosen(asked.device)
    is_quiet = asked.quiet or not place.is_first
    start = None if asked.start is None or not Path(asked.start).is_file() else Path(asked.start)
    check_output_folder(asked.out, overwrite=True, files=RUN_FILES, inputs=[start])
    recipe = asked.mode
    try:
        with claimed_folder(asked.out) if place.is_first else nullcontext():
            summary = _RECIPES[recipe](asked, place, is_quiet)
            if place.is_first:
                write_request(asked.out, asked)
    except KeyboardInterrupt:
        file = asked.out / "checkpoint.pt"
        kept = f"{file} is kept: the same command resumes from it" if file.is_file() else ""
        raise KeyboardInterrupt(kept) from None
    if not place.is_first:
        return 0
    weights = summary["weights"]
    files = weights if isinstance(weights, str) else ", ".join(weights)
    where = summary.get("evaluated_on", "unseen rooms")
    scores = [
        f"{who}: " + ", ".join(f"{name.replace('_', ' ')} {score:.2f}" for name, score in of_data.items())
        for who, of_data in summary.get("scores", {}).items()
    ]
    text = f"{files}: {summary['steps']} steps, loss in {where} {summary['validation_loss']:.3f}"
    return asked.report(summary, text, *scores)


def _check(asked: Options) -> None:
    """Checks the options; InputError for those that a recipe does not support, and for values outside their limits."""
    recipe = asked.mode
    check_mode(asked, recipe, USES)
    missing = next((name for name in NEEDS[recipe].split() if getattr(asked, name) is None), None)
    if missing:
        shown = {"task": "a task, TASK.toml", "start": "--weights to start from", "data": "--data, or --recordings"}
        raise InputError(f"{recipe} needs {shown[missing]}")
    if asked.tensorboard:
        need("training", "--tensorboard", "tensorboard")
    for name in ("steps", "batch", "sequences", "validate_every"):
        count = getattr(asked, name)
        if count is not None and count < 1:
            raise InputError(f"--{name.replace('_', '-')} must be 1 or more, not {count}")
    rate = asked.learning_rate
    if rate is not None and not 0 < rate <= MAX_LEARNING_RATE:
        raise InputError(f"--learning-rate must be above 0 and at most {MAX_LEARNING_RATE:g}, not {rate:g}")
    if not asked.save_every >= 0:
        raise InputError(f"--save-every must be 0 or more seconds, not {asked.save_every:g}")
    if (asked.rgb is None) != (asked.depth is None):
        raise InputError("--rgb and --depth belong together: the photo of the room and its distances")


def _train_weaver(asked: Options, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.training.network_training import TrainingRecipe, train, write_weights

    start, card = (None, None) if asked.start is None else _start(asked.start)
    recipe = TrainingRecipe(**{**({} if card is None else _encoder_of(card)), **asked.settings})
    with _listening(asked, place, recipe.steps, is_quiet) as how:
        trainer = train(asked.data, asked.out, recipe, start=start, **how)
    file = write_weights(asked.out, asked.data, trainer, start=start) if place.is_first else None
    return _summary(file, trainer)


def _train_hypernetwork(asked: Options, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.models.hub import find_weights
    from mmweaver.models.hypernetwork_rooms import load_hypernetwork
    from mmweaver.training.hypernetwork_training import (
        HypernetworkRecipe,
        train_hypernetwork,
        write_hypernetwork_weights,
    )

    target, start = asked.target or "power", None
    if asked.start is not None:
        weights = find_weights(asked.start)
        network, card = load_hypernetwork(weights)
        if card.target != target:
            raise InputError(f"{weights} has target {card.target}, not {target}; give --target {card.target}")
        start = network.state_dict()
    recipe = HypernetworkRecipe.for_target(target, **asked.settings)
    with _listening(asked, place, recipe.steps, is_quiet) as how:
        trainer = train_hypernetwork(asked.data, asked.out, recipe, start=start, **how)
    file = write_hypernetwork_weights(asked.out, asked.data, trainer) if place.is_first else None
    return {**_summary(file, trainer), "target": target, "validation": trainer.best.figures}


def _train_activity(asked: Options, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.datasets.room_sequences import labels_of, radar_of
    from mmweaver.models.activity_network import label_names_of, load_activity
    from mmweaver.models.hub import find_weights
    from mmweaver.training.activity_training import (
        ActivityRecipe,
        activity_scores,
        train_activity,
        write_activity_weights,
    )

    recipe, start = ActivityRecipe(**asked.settings), None
    if asked.start is not None:
        weights = find_weights(asked.start)
        start = load_activity(weights, radar_of(asked.data)).state_dict()
        if label_names_of(weights) != labels_of(asked.data):
            raise InputError(f"{weights} tells other labels apart than {asked.data} has; train without --weights")
    with _listening(asked, place, recipe.steps, is_quiet) as how:
        trainer = train_activity(asked.data, asked.out, recipe, start=start, **how)
    if not place.is_first:
        return {}
    scores = activity_scores(asked.data, trainer)
    file = write_activity_weights(asked.out, asked.data, trainer, scores)
    return {**_summary(file, trainer), "validation": trainer.best.figures, "scores": scores}


def _train_pose(asked: Options, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.recognition.train_pose import SEQUENCES, PoseTraining, train_pose_of_task
    from mmweaver.training.pose_training import PoseRecipe

    training = PoseTraining(sequences=asked.sequences or SEQUENCES, recipe=PoseRecipe(**asked.settings))
    with _listening(asked, place, training.recipe.steps, is_quiet) as how:
        files, trainers = train_pose_of_task(asked.task, asked.out, training, **how)
    return {
        "weights": [str(file) for file in files],
        "steps": trainers[0].step,
        "validation_loss": sum(one.best.value for one in trainers) / len(trainers),
        "evaluated_on": "generated people held out",
    }


def _tune(asked: Options, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.training.capture_training import recipe_for, tune, write_tuned
    from mmweaver.training.captures import read_capture

    assert asked.start is not None
    start, card = _start(asked.start)
    photo = {"rgb": asked.rgb, "depth": asked.depth, "camera": asked.camera}
    captures = [read_capture(folder, **photo) for folder in asked.recordings or ()]
    recipe = recipe_for(captures, **{**asked.settings, **_encoder_of(card)})
    with _listening(asked, place, recipe.steps, is_quiet) as how:
        tuned = tune(captures, asked.out, recipe, start=start, **how)
    file = write_tuned(asked.out, tuned, start=start, licence_of_start=card.licence) if place.is_first else None
    held_out = tuned.held_out
    return {
        **_summary(file, tuned.trainer),
        "loss_before": tuned.loss_before,
        "fine-tuning": len(tuned.rooms),
        "with_joints": sum(room.has_joints for room in tuned.rooms),
        "gain": tuned.gain,
        "evaluated_on": "the captures themselves" if held_out is None else f"{held_out.folder.name}, held out,",
    }


_RECIPES = {
    "weaver": _train_weaver,
    "hypernetwork": _train_hypernetwork,
    "activity": _train_activity,
    "pose": _train_pose,
    "fine-tuning": _tune,
}


def _summary(file: Path | None, trainer: "Trainer") -> dict[str, Any]:
    return {"weights": str(file), "steps": trainer.step, "validation_loss": trainer.best.value}


@contextmanager
def _listening(asked: Options, place: "ComputeDevice", steps: int, is_quiet: bool) -> "Iterator[dict[str, Any]]":
    """Arguments common to all trainings, with a listener that shows each step in a bar."""
    from tqdm import tqdm

    with tqdm(total=steps, unit="step", disable=is_quiet or None) as bar:

        def show(progress: "Progress") -> None:
            bar.update(progress.step - bar.n)
            if progress.validation is not None:
                bar.set_postfix(loss=f"{progress.loss:.3f}", validation=f"{progress.validation:.3f}")

        listener: Listener = show
        yield {
            "listener": listener,
            "compute": place,
            "tensorboard": asked.tensorboard,
            "save_every_s": asked.save_every,
        }


def _start(source: str) -> "tuple[dict[str, Any], WeightsCard]":
    """Weights to start from, and their card."""
    from mmweaver.models.hub import find_weights
    from mmweaver.models.weights import load_weights

    network, card = load_weights(find_weights(source))
    return network.state_dict(), card


def _encoder_of(card: "WeightsCard") -> dict[str, Any]:
    return {"encoder": card.settings["encoder"]} if "encoder" in card.settings else {}
