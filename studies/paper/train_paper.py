"""Trains the paper's own network on a data set and writes its weights with their model card.

python -m studies run train_paper --data data/ --out paper/ --features activity/weights.safetensors

The weights of `mmweaver train activity` are the features of its perceptual loss. The same command continues from the
last checkpoint of a run that was stopped. `torchrun --nproc-per-node 2 -m studies run train_paper ...` uses two
processes.
"""

import argparse
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mmweaver.models.hub import find_weights
from mmweaver.training.device import ComputeDevice
from mmweaver.training.model_card import Figures, Page
from mmweaver.training.trained_weights import write_recipe_weights
from mmweaver.training.trainer import Listener, Progress, Trainer
from studies.manifest import StudyRun
from studies.paper.paper_method import load_paper
from studies.paper.paper_training import PaperRecipe, train_paper

SETTINGS = ("steps", "batch_size", "learning_rate", "seed", "validate_every")
SPLITS = ("train",)
PAGE = Page(
    unit="",
    about="""The paper's own network as the paper trains it, kept for comparison: a photo of a room with depth and a
person's joints in, the weights of an implicit representation of the complex signal out. For use take recipe weaver.

    python -m studies run paper_scores --data data/ --weights weights.safetensors""",
    limits="- Where its loss is that of all zeros it has collapsed: its signals hold hardly any energy.\n"
    "- One radar ({radar}).",
)


def add_options(parser: argparse.ArgumentParser) -> None:
    recipe = PaperRecipe()
    parser.add_argument("--data", type=Path, required=True, metavar="DIR", help="a data set of mmweaver dataset")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for checkpoint, log and weights")
    parser.add_argument("--features", type=Path, required=True, metavar="FILE", help="weights of recipe activity")
    parser.add_argument("--from", dest="start", metavar="FILE|DIR|HUB", help="weights of this recipe to go on from")
    parser.add_argument("--steps", type=int, default=recipe.steps, help="steps in all (default %(default)s)")
    parser.add_argument(
        "--batch", dest="batch_size", type=int, default=recipe.batch_size,
        help="sequences a step, of all processes together (default %(default)s)",
    )  # fmt: skip
    parser.add_argument("--learning-rate", type=float, default=recipe.learning_rate, help="(default %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of the first weights and of the batches (default 0)")
    parser.add_argument(
        "--validate-every", type=int, default=recipe.validate_every, metavar="STEPS", help="(default %(default)s)"
    )
    parser.add_argument("--validation-batches", type=int, default=recipe.validation_batches, help="(%(default)s)")
    parser.add_argument("--save-every", type=float, default=60.0, metavar="S", help="seconds between checkpoints (60)")
    parser.add_argument("--device", default="auto", help="cpu, cuda, cuda:1 ... (default auto: a GPU if there is one)")
    parser.add_argument("--precision", choices=("auto", "float32", "bf16"), default="auto")
    parser.add_argument("--tensorboard", action="store_true", help="also write TensorBoard's files")
    parser.add_argument("--quiet", action="store_true", help="print no progress")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    place = ComputeDevice.chosen(options.device, options.precision)
    settings = {name: getattr(options, name) for name in (*SETTINGS, "validation_batches")}
    start = None if options.start is None else load_paper(find_weights(options.start)).state_dict()
    with progress_bar(options.steps, options.quiet or not place.is_first) as listener:
        trainer = train_paper(
            options.data, options.out, PaperRecipe(**settings), features=options.features, start=start,
            listener=listener, compute=place, tensorboard=options.tensorboard, save_every_s=options.save_every,
        )  # fmt: skip
    if place.is_first:
        file = write_paper_weights(options.out, options.data, trainer)
        summary = {"weights": str(file), "steps": trainer.step, "validation_loss": trainer.best.value}
        print(json.dumps({**summary, "validation": trainer.best.figures}))


def write_paper_weights(out: Path, data: Path, trainer: Trainer) -> Path:
    """Writes weights and page; returns the path of the weights."""
    return write_recipe_weights(out, data, trainer, splits=SPLITS, page=PAGE, figures=validation_figures(trainer))


def validation_figures(trainer: Trainer) -> Figures:
    """The best validation, and what all zeros score there."""
    own = trainer.best.figures
    network = {"loss": trainer.best.value, "squared_error_over_energy": own["nmse"], "energy_over_true": own["energy"]}
    zeros = {"loss": own["zeros_loss"], "squared_error_over_energy": 1.0, "energy_over_true": 0.0}
    return {"this network": network, "all zeros": zeros}


@contextmanager
def progress_bar(steps: int, is_quiet: bool) -> Iterator[Listener]:
    """A listener that shows the loss of each step."""
    from tqdm import tqdm

    with tqdm(total=steps, unit="step", disable=is_quiet or None) as bar:

        def show(progress: Progress) -> None:
            bar.update(progress.step - bar.n)
            if progress.validation is not None:
                bar.set_postfix(loss=f"{progress.loss:.3f}", validation=f"{progress.validation:.3f}")

        yield show
