"""What each part of the network, of its loss and of its training is worth, in rooms of the validation kind.

    python -m mmweaver.experiments.weaver_ablation --data DATASET --runs RUNS --out results

Every variant is trained for the same short while from the same seed, and goes on where it was stopped. Test splits are
not looked at: this table is for choosing.
"""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.data.store import read_plan, read_rooms
from mmweaver.experiments.results import write_result
from mmweaver.experiments.weaver_table import Case, cases_of, interval, woven
from mmweaver.metrics.scorecard import METRICS, Views
from mmweaver.models.weaver_network import WeaverNetwork
from mmweaver.training.trainer import Trainer
from mmweaver.training.weaver_examples import Batch, examples
from mmweaver.training.weaver_training import VALIDATION_SEED, TrainingRecipe, WeaverLearner, drawing

COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db")


@dataclass(frozen=True)
class Variant:
    """Parts of the network that are left out, words in the names of terms that are, and changes of the recipe."""

    without: tuple[str, ...] = ()
    terms_without: tuple[str, ...] = ()
    recipe: tuple[tuple[str, Any], ...] = ()


VARIANTS = {
    "whole": Variant(),
    "before training": Variant(recipe=(("steps", 0),)),
    "no ghosts": Variant(without=("ghosts",)),
    "no learned faces": Variant(without=("faces",)),
    "no correction of surfaces": Variant(without=("correction",)),
    "picture without colour": Variant(without=("colour",)),
    "picture without depth": Variant(without=("depth",)),
    "picture without mask": Variant(without=("mask",)),
    "depth alone": Variant(without=("colour", "mask")),
    "colour alone": Variant(without=("depth", "mask")),
    "no target of the person alone": Variant(terms_without=("_person",)),
    "no pooled maps": Variant(terms_without=("_4x2", "_8x8")),
    "no mirrored rooms": Variant(recipe=(("mirror", False),)),
}


class _PartOfLoss(WeaverLearner):
    """A learner that leaves terms of the loss out."""

    def __init__(self, *arguments: Any, left_out: tuple[str, ...]):
        super().__init__(*arguments)
        self.left_out = left_out

    def terms(self, batch: Batch) -> dict[str, torch.Tensor]:
        terms = super().terms(batch)
        return {name: term for name, term in terms.items() if not any(word in name for word in self.left_out)}


def trained(variant: Variant, data: Path, out: Path, recipe: TrainingRecipe) -> WeaverNetwork:
    """The variant's network, best on validation by its own loss."""
    recipe = replace(recipe, **dict(variant.recipe))
    torch.manual_seed(recipe.seed)
    network = WeaverNetwork(without=variant.without)
    if recipe.steps == 0:
        return network.eval()
    rooms, unseen = examples(data, "train"), examples(data, "validation")
    learner = _PartOfLoss(network, rooms[0].room.config, left_out=variant.terms_without)
    trainer = Trainer(
        learner, recipe, out, train=drawing(rooms, recipe, recipe.seed, recipe.mirror),
        validation=drawing(unseen, recipe, VALIDATION_SEED + recipe.seed),
    )  # fmt: skip
    trainer.run()
    return network.eval()


def scores(network: WeaverNetwork, cases: list[Case]) -> dict[str, np.ndarray]:
    """{column: value of each case}."""
    method = woven(network, lambda case: case.room)
    values: dict[str, list[float]] = {name: [] for name in COLUMNS}
    for case in cases:
        truth, prediction = Views(case.room.cube(case.index)), Views(method(case))
        for name in COLUMNS:
            values[name].append(METRICS[name].score(prediction, truth))
    return {name: np.array(each) for name, each in values.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--runs", type=Path, required=True, help="folder for the variants' checkpoints")
    parser.add_argument("--steps", type=int, default=800)
    parser.add_argument("--only", nargs="*", default=list(VARIANTS), help="variants")
    parser.add_argument("--out", type=Path, default=Path("results"))
    arguments = parser.parse_args()
    recipe = TrainingRecipe(steps=arguments.steps, validate_every=max(arguments.steps // 4, 1))
    plan = read_plan(arguments.data)
    cases = cases_of(read_rooms(arguments.data), "validation", 1, plan, 0)
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    rows = []
    for name in arguments.only:
        folder = arguments.runs / name.replace(" ", "_")
        network = trained(VARIANTS[name], arguments.data, folder, recipe)
        metrics = {}
        for column, each in scores(network, cases).items():
            mean, low, high = interval(each, names)
            metrics[column] = {"value": mean, "low": low, "high": high, "unit": METRICS[column].unit}
        rows.append({"method": name, "split": "validation", "n": len(cases), "metrics": metrics})
        print(f"{name:32}", *(f"{column} {metric['value']:.3f}" for column, metric in metrics.items()), flush=True)  # noqa: T201
        write_result(
            arguments.out, experiment="weaver_ablation", method="parts",
            config={"data_plan": plan, "steps": arguments.steps, "seed": recipe.seed}, rows=rows,
        )  # fmt: skip


if __name__ == "__main__":
    main()
