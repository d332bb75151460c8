"""Trains the paper's hypernetwork with fields of power as its target, and writes its weights with their model card.

python -m studies run train_power --data light/ --out power/

`light/` is of `mmweaver dataset --geometry-only`. The same command continues from the last checkpoint.
"""

import argparse
import json
from pathlib import Path

from mmweaver.training.device import ComputeDevice
from studies.manifest import StudyRun
from studies.paper.power_method import load_power
from studies.paper.power_training import PowerRecipe, train_power, write_power_weights
from studies.paper.train_paper import progress_bar


def add_options(parser: argparse.ArgumentParser) -> None:
    recipe = PowerRecipe()
    parser.add_argument("--data", type=Path, required=True, metavar="DIR", help="a data set of mmweaver dataset")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for checkpoint, log and weights")
    parser.add_argument("--from", dest="start", type=Path, metavar="FILE", help="weights of this recipe to go on from")
    parser.add_argument("--steps", type=int, default=recipe.steps, help="steps in all (default %(default)s)")
    parser.add_argument("--batch", type=int, default=recipe.batch_size, help="sequences per step (default %(default)s)")
    parser.add_argument("--learning-rate", type=float, default=recipe.learning_rate, help="(default %(default)s)")
    parser.add_argument(
        "--validate-every", type=int, default=recipe.validate_every, metavar="STEPS", help="(default %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=0, help="of the first weights and of the batches (default 0)")
    parser.add_argument("--device", default="auto", help="cpu, cuda, cuda:1 ... (default auto: a GPU if there is one)")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    place = ComputeDevice.chosen(options.device)
    start = None if options.start is None else load_power(options.start)[0].state_dict()
    recipe = PowerRecipe(
        steps=options.steps, batch_size=options.batch, learning_rate=options.learning_rate, seed=options.seed,
        validate_every=options.validate_every,
    )  # fmt: skip
    with progress_bar(recipe.steps, not place.is_first) as listener:
        trainer = train_power(options.data, options.out, recipe, start=start, listener=listener, compute=place)
    if place.is_first:
        file = write_power_weights(options.out, options.data, trainer)
        print(json.dumps({"weights": str(file), "steps": trainer.step, "validation_loss": trainer.best.value}))
