"""mmweaver train: the network's weights from a data set, or from recordings of one's own room."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import number, whole
from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.training.trainer import Progress

EXAMPLES = """examples:
  mmweaver dataset data/ --layouts 10 --sequences 20 --workers 4
  mmweaver train weaver --data data/ --out run/ --tensorboard
  mmweaver train weaver --data mine/ --out tuned/ --from run/ --steps 300 --learning-rate 2e-4
  torchrun --nproc-per-node 4 -m mmweaver train weaver --data data/ --out run/ --batch 12
  mmweaver generate --demo --method weaver --weights run/ --out woven/
"""


def add_verb(verbs: Any) -> None:
    """Declares the verb and its options."""
    parser = verbs.add_parser(
        "train",
        help="train the network on a data set",
        epilog=EXAMPLES,
        description="Trains the network on a data set of mmweaver dataset and writes its weights with their model "
        "card. It may be stopped or killed at any time: the same command goes on from its last checkpoint. What it has "
        "learned is drawn beside the truth in OUT/pictures at every validation.",
    )
    parser.add_argument("recipe", choices=("weaver",), help="what is trained")
    parser.add_argument("--data", type=Path, required=True, metavar="DIR", help="a data set of mmweaver dataset")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for checkpoint, log and weights")
    parser.add_argument(
        "--from", "--start", dest="start", metavar="FILE|DIR|HUB", help="weights to fine-tune (default: from nothing)"
    )
    loop = parser.add_argument_group("the loop")
    loop.add_argument("--steps", type=whole, default=6000, help="steps in all (default 6000)")
    loop.add_argument(
        "--batch", type=whole, default=3, help="sequences a step, each of another room, of all processes (default 3)"
    )
    loop.add_argument("--learning-rate", type=number, default=1e-3, help="of Adam, at its highest (default 1e-3)")
    loop.add_argument("--seed", type=whole, default=0, help="of the first weights and of the batches (default 0)")
    loop.add_argument("--validate-every", type=whole, default=250, metavar="STEPS", help="(default 250)")
    loop.add_argument("--save-every", type=number, default=60.0, metavar="S", help="seconds between checkpoints (60)")
    place = parser.add_argument_group("where")
    place.add_argument("--device", default="auto", help="cpu, cuda, cuda:1 ... (default auto: a GPU if there is one)")
    place.add_argument(
        "--precision", choices=("auto", "float32", "bf16"), default="auto", help="(default auto: bf16 on a GPU)"
    )
    output = parser.add_argument_group("output")
    output.add_argument("--tensorboard", action="store_true", help="also write TensorBoard's files to OUT/tensorboard")
    output.add_argument("--json", action="store_true", help="print a summary for machines on stdout")
    output.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Trains and writes the weights. Raises InputError."""
    import json

    from tqdm import tqdm

    from mmweaver.training.weaver_training import TrainingRecipe, train, write_weights
    from mmweaver.training.workplace import Workplace

    if not arguments.save_every >= 0:
        raise InputError(f"--save-every must be 0 or more seconds, not {arguments.save_every:g}")
    start = _start(arguments.start)
    place = Workplace.chosen(arguments.device, arguments.precision)
    quiet = arguments.quiet or not place.is_first
    recipe = TrainingRecipe(
        steps=arguments.steps, batch_size=arguments.batch, learning_rate=arguments.learning_rate, seed=arguments.seed,
        validate_every=arguments.validate_every,
    )  # fmt: skip
    with tqdm(total=recipe.steps, unit="step", disable=quiet or None) as bar:

        def told(progress: "Progress") -> None:
            bar.update(progress.step - bar.n)
            if progress.validation is not None:
                bar.set_postfix(loss=f"{progress.loss:.3f}", validation=f"{progress.validation:.3f}")

        trainer = train(
            arguments.data, arguments.out, recipe, start=start, listener=told, workplace=place,
            tensorboard=arguments.tensorboard, save_every_s=arguments.save_every,
        )  # fmt: skip
    if not place.is_first:
        return 0
    file = write_weights(arguments.out, arguments.data, trainer, start=start)
    summary = {"weights": str(file), "steps": trainer.step, "validation_loss": trainer.best.value}
    if arguments.json:
        print(json.dumps(summary))
    elif not arguments.quiet:
        print(f"{file}: {trainer.step} steps, loss in unseen rooms {trainer.best.value:.3f}")
    return 0


def _start(source: str | None) -> Any:
    from mmweaver.models.find_weights import find_weights
    from mmweaver.models.weights import load_weights

    return None if source is None else load_weights(find_weights(source))[0].state_dict()
