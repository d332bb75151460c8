"""mmweaver train: weights from a data set, from recordings of one's own room, or from the sentences of a task."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli import train_recipes
from mmweaver.cli.arguments import Rare, number, source, whole
from mmweaver.cli.config_file import REQUEST_FILE, write_request
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need

if TYPE_CHECKING:
    from torch import Tensor

    from mmweaver.models.weights import WeightsCard
    from mmweaver.training.device import ComputeDevice
    from mmweaver.training.trainer import Listener, Progress

# what a run writes: none may be a folder, or the weights that it starts from
RUN_FILES = ("weights.safetensors", "best.safetensors", "checkpoint.pt", "log.jsonl", "README.md", REQUEST_FILE)
MOST_LEARNING_RATE = 1.0  # far above what Adam learns with
EXAMPLES = """examples:
  mmweaver dataset data/ --layouts 10 --sequences 20 --workers 4
  mmweaver train weaver --data data/ --out run/ --tensorboard
  mmweaver train weaver --from run/ --captures take1/ take2/ take3/ --out tuned/
  torchrun --nproc-per-node 4 -m mmweaver train weaver --data data/ --out run/ --batch 12
  mmweaver train activity --data data/ --out activity/
  mmweaver train activity --data my_set/ --out recogniser/          # of mmweaver dataset --activities
  mmweaver train pose examples/tasks/mars_poses.toml --out model/   # then: mmweaver pose model/ --points log.dat
  mmweaver generate --demo --weights run/ --out woven/
"""


def add_command(commands: Any) -> argparse.ArgumentParser:
    """Declares the command and its options."""
    parser = commands.add_parser(
        "train",
        help="train the network on a data set",
        epilog=EXAMPLES,
        description="Trains the network on a data set of mmweaver dataset and writes its weights with their model "
        "card. It may be stopped or killed at any time: the same command resumes from its last checkpoint. At "
        "every validation OUT/pictures compares what it has learned with the ground truth.",
    )
    parser.add_argument(
        "recipe", choices=("weaver", "activity", "pose"),
        help="what is trained: the network; a recogniser of the activities of the data; or poses from points",
    )  # fmt: skip
    parser.add_argument("task", type=Path, nargs="?", metavar="TASK.toml", help="of recipe pose: docs/pose.md")
    parser.add_argument(
        "--data", type=Path, metavar="DIR",
        help="a data set of mmweaver dataset; for recipe activity also a labelled set of your own room",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for checkpoint, log and weights")
    parser.add_argument(
        "--from",
        "--start",
        dest="start",
        type=source,
        metavar="FILE|DIR|HUB",
        help="weights of the same recipe to start from (default: random)",
    )
    own = parser.add_argument_group("your own recordings instead of --data (needs --from)")
    own.add_argument(
        "--captures", type=Path, nargs="+", metavar="DIR",
        help="folders of mmweaver process or generate (radar.npz), or of mmwave-capture-std; with pose.npz where the "
        "joints are known, else only the static room is tuned; the last one is held out for validation",
    )  # fmt: skip
    own.add_argument("--rgb", type=Path, metavar="PNG", help="photo of the room, where the folders hold none")
    own.add_argument("--depth", type=Path, metavar="FILE", help="its depth")
    own.add_argument("--camera", type=Path, metavar="JSON", help="its fx, fy, cx, cy")
    loop = parser.add_argument_group("optimisation")
    loop.add_argument("--sequences", type=whole, metavar="N", help="recipe pose: people an activity (default 40)")
    loop.add_argument("--steps", type=whole, help="steps in all (default 6000; activity 800, pose 2000, captures 300)")
    loop.add_argument(
        "--batch",
        type=whole,
        help="sequences a step, of all processes together (default 3; activity and pose 16, captures 2)",
    )
    loop.add_argument(
        "--learning-rate",
        type=number,
        help="of Adam, at its highest (default 1e-3; activity and pose 2e-3, captures 2e-4, without joints 5e-3)",
    )
    loop.add_argument("--seed", type=whole, default=0, help="of the first weights and of the batches (default 0)")
    loop.add_argument("--validate-every", type=whole, metavar="STEPS", help="(default 250; activity 100, captures 25)")
    loop.add_argument(
        "--encoder", metavar="NAME", help=Rare("recipe weaver's environment encoder (default efficientnet)")
    )
    loop.add_argument("--save-every", type=number, default=60.0, metavar="S", help="seconds between checkpoints (60)")
    place = parser.add_argument_group("device")
    place.add_argument("--device", default="auto", help="cpu, cuda, cuda:1 ... (default auto: a GPU if there is one)")
    place.add_argument(
        "--precision", choices=("auto", "float32", "bf16"), default="auto", help="(default auto: bf16 on a GPU)"
    )
    output = parser.add_argument_group("output")
    output.add_argument("--tensorboard", action="store_true", help="also write TensorBoard's files to OUT/tensorboard")
    output.add_argument("--json", action="store_true", help="print a summary for machines on stdout")
    output.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Trains and writes the weights. Raises InputError."""
    import json

    _check(arguments)
    from mmweaver.core.output_checks import check_output_folder
    from mmweaver.training.device import ComputeDevice

    place = ComputeDevice.chosen(arguments.device, arguments.precision)
    is_quiet = arguments.quiet or not place.is_first
    check_output_folder(arguments.out, overwrite=True, files=RUN_FILES, inputs=[_file(arguments.start)])
    try:
        summary = _trained(arguments, place, is_quiet)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(_kept(arguments.out)) from None
    if not place.is_first:
        return 0
    if arguments.json:
        print(json.dumps(summary))
    elif not is_quiet:
        where = summary.get("evaluated_on", "unseen rooms")
        weights = summary["weights"]
        files = weights if isinstance(weights, str) else ", ".join(weights)
        print(f"{files}: {summary['steps']} steps, loss in {where} {summary['validation_loss']:.3f}")
        for who, of_data in summary.get("scores", {}).items():
            print(f"{who}: " + ", ".join(f"{name.replace('_', ' ')} {score:.2f}" for name, score in of_data.items()))
    return 0


def _trained(arguments: argparse.Namespace, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    if arguments.recipe == "pose":
        with _bar(arguments.steps or train_recipes.pose_steps(), is_quiet) as listener:
            summary = train_recipes.train_on_task(arguments, _given(arguments), listener, place, _options(arguments))
    elif arguments.captures:
        summary = _on_captures(arguments, place, is_quiet)
    else:
        summary = _on_data(arguments, place, is_quiet)
    if place.is_first:
        write_request(arguments.out, arguments)
    return summary


def _file(start: str | None) -> Path | None:
    return Path(start) if start is not None and Path(start).is_file() else None


def _kept(out: Path) -> str:
    """What an interrupted training leaves; the empty message is that of a command which has written nothing."""
    if not (out / "checkpoint.pt").is_file():
        return ""
    return f"{out / 'checkpoint.pt'} is kept: the same command resumes from it"


def _check(arguments: argparse.Namespace) -> None:
    train_recipes.check(arguments)
    if arguments.tensorboard:
        need("training", "--tensorboard", "tensorboard")
    for name in ("steps", "batch", "sequences", "validate_every"):
        count = getattr(arguments, name)
        if count is not None and count < 1:
            raise InputError(f"--{name.replace('_', '-')} must be 1 or more, not {count}")
    if arguments.learning_rate is not None and not 0 < arguments.learning_rate <= MOST_LEARNING_RATE:
        raise InputError(
            f"--learning-rate must be above 0 and at most {MOST_LEARNING_RATE:g}, not {arguments.learning_rate:g}"
        )
    if arguments.recipe != "pose" and (arguments.data is None) == (arguments.captures is None):
        raise InputError(
            "what to train on? give --data, a data set of mmweaver dataset, or --captures, your recordings"
        )
    if arguments.captures is not None and arguments.start is None:
        raise InputError("--captures fine-tunes existing weights; give them with --from")
    if arguments.encoder is not None and (arguments.recipe != "weaver" or arguments.data is None):
        raise InputError("--encoder is for recipe weaver on --data; fine-tuning keeps the encoder of its weights")
    photo = (arguments.rgb, arguments.depth, arguments.camera)
    if arguments.captures is None and any(given is not None for given in photo):
        raise InputError("--rgb, --depth and --camera are the photo of --captures; a data set has its own")
    if (arguments.rgb is None) != (arguments.depth is None):
        raise InputError("--rgb and --depth belong together: the photo of the room and its distances")
    if not arguments.save_every >= 0:
        raise InputError(f"--save-every must be 0 or more seconds, not {arguments.save_every:g}")


def _on_data(arguments: argparse.Namespace, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    if arguments.recipe == "activity":
        return _activity_on_data(arguments, place, is_quiet)
    from mmweaver.training.network_training import TrainingRecipe, train, write_weights

    start, card = (None, None) if arguments.start is None else _start(arguments.start)
    recipe = TrainingRecipe(**{**({} if card is None else _encoder_of(card)), **_given(arguments)})
    with _bar(recipe.steps, is_quiet) as listener:
        trainer = train(
            arguments.data, arguments.out, recipe, start=start, listener=listener, compute=place, **_options(arguments)
        )
    file = write_weights(arguments.out, arguments.data, trainer, start=start) if place.is_first else None
    return {"weights": str(file), "steps": trainer.step, "validation_loss": trainer.best.value}


def _activity_on_data(arguments: argparse.Namespace, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.training.activity_training import ActivityRecipe, activity_scores, write_activity_weights

    given = _given(arguments)
    with _bar(ActivityRecipe(**given).steps, is_quiet) as listener:
        trainer = train_recipes.train_on_data(arguments, given, listener, place, _options(arguments))
    summary = {"steps": trainer.step, "validation_loss": trainer.best.value, "validation": trainer.best.figures}
    if not place.is_first:
        return summary
    scores = activity_scores(arguments.data, trainer)
    file = write_activity_weights(arguments.out, arguments.data, trainer, scores)
    return {"weights": str(file), **summary, "scores": scores}


def _on_captures(arguments: argparse.Namespace, place: "ComputeDevice", is_quiet: bool) -> dict[str, Any]:
    from mmweaver.training.capture_training import recipe_for, tune, write_tuned
    from mmweaver.training.captures import read_capture

    start, card = _start(arguments.start)
    photo = {"rgb": arguments.rgb, "depth": arguments.depth, "camera": arguments.camera}
    captures = [read_capture(folder, **photo) for folder in arguments.captures]
    recipe = recipe_for(captures, **{**_given(arguments), **_encoder_of(card)})
    with _bar(recipe.steps, is_quiet) as listener:
        tuned = tune(
            captures, arguments.out, recipe, start=start, listener=listener, compute=place, **_options(arguments)
        )
    file = write_tuned(arguments.out, tuned, start=start, licence_of_start=card.licence) if place.is_first else None
    held_out = tuned.held_out
    return {
        "weights": str(file), "steps": tuned.trainer.step, "validation_loss": tuned.trainer.best.value,
        "loss_before": tuned.loss_before, "with_joints": sum(room.has_joints for room in tuned.rooms),
        "captures": len(tuned.rooms), "gain": tuned.gain,
        "evaluated_on": "the captures themselves" if held_out is None else f"{held_out.folder.name}, held out,",
    }  # fmt: skip


def _given(arguments: argparse.Namespace) -> dict[str, Any]:
    """The settings of the recipe that the user gave."""
    given = {
        "steps": arguments.steps, "batch_size": arguments.batch, "learning_rate": arguments.learning_rate,
        "seed": arguments.seed, "validate_every": arguments.validate_every, "encoder": arguments.encoder,
    }  # fmt: skip
    return {name: value for name, value in given.items() if value is not None}


def _options(arguments: argparse.Namespace) -> dict[str, Any]:
    return {"tensorboard": arguments.tensorboard, "save_every_s": arguments.save_every}


@contextmanager
def _bar(steps: int, is_quiet: bool) -> "Iterator[Listener]":
    """A listener for the trainer that shows each step."""
    from tqdm import tqdm

    with tqdm(total=steps, unit="step", disable=is_quiet or None) as bar:

        def show(progress: "Progress") -> None:
            bar.update(progress.step - bar.n)
            if progress.validation is not None:
                bar.set_postfix(loss=f"{progress.loss:.3f}", validation=f"{progress.validation:.3f}")

        yield show


def _start(source: str) -> "tuple[dict[str, Tensor], WeightsCard]":
    """The weights to start from, and what their file says of them."""
    from mmweaver.models.hub import find_weights
    from mmweaver.models.weights import load_weights

    network, card = load_weights(find_weights(source))
    return network.state_dict(), card


def _encoder_of(card: "WeightsCard") -> dict[str, Any]:
    return {"encoder": card.settings["encoder"]} if "encoder" in card.settings else {}
