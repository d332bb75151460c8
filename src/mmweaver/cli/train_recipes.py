"""mmweaver train activity and mmweaver train paper."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from mmweaver.training.recipe_loop import RecipeLoop, StepReport


def run(arguments: argparse.Namespace) -> int:
    """Trains recipe `activity` or `paper` and writes the weights. Raises InputError."""
    if arguments.start is not None or arguments.captures is not None:
        raise InputError(f"--from and --captures are for recipe weaver; recipe {arguments.recipe} begins from nothing")
    if arguments.data is None:
        raise InputError("what to train on? give --data, a data set of mmweaver dataset")
    unknown = {"--device": arguments.device not in ("auto", "cpu"), "--precision": arguments.precision == "bf16",
               "--tensorboard": arguments.tensorboard}  # fmt: skip
    if any(unknown.values()):
        named = ", ".join(name for name, is_asked in unknown.items() if is_asked)
        raise InputError(f"{named}: recipe {arguments.recipe} trains on the CPU in float32 and writes log.jsonl only")
    if arguments.recipe == "paper" and arguments.features is None:
        raise InputError(
            "recipe paper needs --features FILE, the weights of: mmweaver train activity (for its perceptual loss)"
        )
    from tqdm import tqdm

    from mmweaver.training.recipe_loop import write_recipe_weights

    with tqdm(unit="step", disable=arguments.quiet or None) as bar:

        def told(report: "StepReport") -> None:
            bar.total = report.steps
            bar.update(report.step - bar.n)
            if report.validation is not None:
                bar.set_postfix({name: f"{value:.3f}" for name, value in report.validation.items()})

        loop = _paper(arguments, told) if arguments.recipe == "paper" else _activity(arguments, told)
    file = write_recipe_weights(arguments.out, arguments.data, loop)
    if arguments.json:
        print(json.dumps({"weights": str(file), "steps": loop.step, "validation": loop.best.figures}))
    elif not arguments.quiet:
        figures = ", ".join(f"{name} {value:.3f}" for name, value in loop.best.figures.items())
        print(f"{file}: {loop.step} steps, in unseen rooms {figures}")
    return 0


def _activity(arguments: argparse.Namespace, told) -> "RecipeLoop":
    from mmweaver.training.activity_training import ActivityRecipe, train_activity

    return train_activity(arguments.data, arguments.out, ActivityRecipe(**_given(arguments)), told)


def _paper(arguments: argparse.Namespace, told) -> "RecipeLoop":
    from mmweaver.training.paper_training import PaperRecipe, train_paper

    features: Path = arguments.features
    return train_paper(
        arguments.data, arguments.out, PaperRecipe(**_given(arguments)), features=features, listener=told
    )


def _given(arguments: argparse.Namespace) -> dict:
    """What was asked for; the rest is the recipe's own."""
    asked = {
        "steps": arguments.steps, "batch_size": arguments.batch, "learning_rate": arguments.learning_rate,
        "seed": arguments.seed, "validate_every": arguments.validate_every,
    }  # fmt: skip
    return {name: value for name, value in asked.items() if value is not None}
