"""mmweaver train: the network's weights from a data set."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmweaver.cli.arguments import number, whole

if TYPE_CHECKING:
    from mmweaver.training.weaver_training import Progress

EXAMPLES = """examples:
  mmweaver dataset data/ --layouts 10 --sequences 20 --workers 4
  mmweaver train weaver --data data/ --out run/
  mmweaver train weaver --data mine/ --out tuned/ --start run/weights.safetensors --steps 300 --learning-rate 2e-4
  mmweaver train activity --data data/ --out judge/
  mmweaver train paper --data data/ --out paper/ --features judge/weights.safetensors
  mmweaver generate --demo --method weaver --weights run/weights.safetensors --out woven/
"""


def add_verb(verbs: Any) -> None:
    """Declares the verb and its options."""
    parser = verbs.add_parser(
        "train",
        help="train the network on a data set",
        epilog=EXAMPLES,
        description="Trains the network on a data set of mmweaver dataset and writes its weights. It may be stopped at "
        "any time: the same command goes on from its last checkpoint.",
    )
    parser.add_argument(
        "recipe", choices=("weaver", "activity", "paper"),
        help="what is trained: the network, a recogniser of twelve activities, or the paper's network",
    )  # fmt: skip
    parser.add_argument("--data", type=Path, required=True, metavar="DIR", help="a data set of mmweaver dataset")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for checkpoint, log and weights")
    parser.add_argument("--start", type=Path, metavar="FILE", help="weights to fine-tune (default: from nothing)")
    parser.add_argument("--features", type=Path, metavar="FILE", help="weights of recipe activity, for recipe paper")
    parser.add_argument("--steps", type=whole, help="steps in all (default 6000; activity 800)")
    parser.add_argument("--batch", type=whole, help="sequences a step (default 3; activity 16, paper 4)")
    parser.add_argument(
        "--learning-rate", type=number, help="of Adam, at its highest (default 1e-3; activity 2e-3, paper 1e-4)"
    )
    parser.add_argument("--seed", type=whole, default=0, help="of the first weights and of the batches (default 0)")
    parser.add_argument("--json", action="store_true", help="print a summary for machines on stdout")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Trains and writes the weights. Raises InputError."""
    if arguments.recipe != "weaver":
        from mmweaver.cli import train_recipes

        return train_recipes.run(arguments)
    for name, value in (("steps", 6000), ("batch", 3), ("learning_rate", 1e-3)):
        if getattr(arguments, name) is None:
            setattr(arguments, name, value)
    import json

    from tqdm import tqdm

    from mmweaver.models.weights import load_weights
    from mmweaver.training.weaver_training import TrainingRecipe, train, write_weights

    recipe = TrainingRecipe(
        steps=arguments.steps, batch_size=arguments.batch, learning_rate=arguments.learning_rate, seed=arguments.seed
    )
    start = None if arguments.start is None else load_weights(arguments.start)[0].state_dict()
    with tqdm(total=recipe.steps, unit="step", disable=arguments.quiet or None) as bar:

        def told(progress: "Progress") -> None:
            bar.update(progress.step - bar.n)
            if progress.validation is not None:
                bar.set_postfix(loss=f"{progress.loss:.3f}", validation=f"{progress.validation:.3f}")

        training = train(arguments.data, arguments.out, recipe, start=start, listener=told)
    file = write_weights(arguments.out, arguments.data, training)
    summary = {"weights": str(file), "steps": training.step, "validation_loss": training.best.value}
    if arguments.json:
        print(json.dumps(summary))
    elif not arguments.quiet:
        print(f"{file}: {training.step} steps, loss in unseen rooms {training.best.value:.3f}")
    return 0
