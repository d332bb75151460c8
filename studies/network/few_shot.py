"""An activity that was withheld from training, after tuning on a few sequences of it.

    python -m studies run few_shot --data DATASET --runs RUNS --most 24

Jumping is withheld. The network is tuned on 0, 5 and 20 jumps in half of the rooms and evaluated on jumps in the other
half. `realization` (an oracle): the simulator in the true room with other micro-phases.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.training.network_examples import RoomExamples
from mmweaver.training.network_training import NetworkLearner, TrainingRecipe, batch_sampler
from mmweaver.training.trainer import Trainer
from studies.manifest import StudyRun
from studies.network.ablation import COLUMNS
from studies.network.learned_scores import OTHER, Case, Method, cases_of, interval, learned, simulated
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, Representations
from studies.study import Reads

ACTIVITY, SPLIT = "jumping", "test_activity"
SHOTS = (0, 5, 20)
RECIPE = TrainingRecipe(
    name="few_shot", steps=120, learning_rate=1e-4, warm_up_steps=20, validate_every=120, validation_batches=1
)


def halves(rooms: list[StoredRoom], seed: int) -> tuple[list[StoredRoom], list[StoredRoom]]:
    """Rooms with jumps: those to tune in and those to evaluate in."""
    there = [room for room in rooms if _jumps(room)]
    if len(there) < 2:
        raise InputError(f"the data set shows {ACTIVITY} in fewer than two rooms; make more with: mmweaver dataset")
    order = stream(seed, "few shot").permutation(len(there))
    middle = len(there) // 2
    return [there[index] for index in order[:middle]], [there[index] for index in order[middle:]]


def tuned(weights: Path, rooms: list[StoredRoom], shots: int, out: Path, seed: int) -> WeaverNetwork:
    """The network tuned on so many jumps, one or more a room, for all steps: nothing is left to validate on."""
    network = load_weights(weights)[0]
    if shots == 0:
        return network
    few: list[RoomExamples] = []
    for room in rooms:
        if sum(len(one.indices) for one in few) >= shots:
            break
        example = RoomExamples(room, SPLIT)
        example.indices = _jumps(room)[: shots - sum(len(one.indices) for one in few)]
        few.append(example)
    torch.manual_seed(seed)
    learner = NetworkLearner(network.train(), few[0].room.config)
    draw = batch_sampler(few, RECIPE, seed, True)
    Trainer(learner, RECIPE, out, batches=(draw, draw)).run()
    return network.eval()


def _jumps(room: StoredRoom) -> list[int]:
    pairs = zip(room.activity, room.split, strict=True)
    return [index for index, (activity, split) in enumerate(pairs) if activity == ACTIVITY and split == SPLIT]


def evaluated(method: Method, cases: list[Case]) -> dict[str, dict[str, Any]]:
    """{column: metric with mean and interval over rooms}."""
    values: dict[str, list[float]] = {name: [] for name in COLUMNS}
    for case in cases:
        truth, prediction = Representations(case.truth), Representations(method(case))
        for name in COLUMNS:
            values[name].append(METRICS[name].score(prediction, truth))
    rooms = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    out = {}
    for name, each in values.items():
        mean, low, high = interval(np.array(each), rooms)
        out[name] = {"value": mean, "interval_95": [low, high], "unit": METRICS[name].unit}
    return out


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument(
        "--weights",
        type=Path,
        action=Reads,
        default=shipped_weights(),
        help="of recipe weaver (default: those included)",
    )
    parser.add_argument("--runs", type=Path, required=True, help="folder for the checkpoints")
    parser.add_argument("--most", type=int, default=30, help="rooms to be evaluated in")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    own, others = halves(rooms, 0)
    known = {room.folder for room in others}
    every = [case for case in cases_of(rooms, SPLIT, 100, plan, 0) if case.room.folder in known]
    cases = [case for case in every if case.room.activity[case.index] == ACTIVITY][: options.most]
    rows: list[dict[str, Any]] = []
    for shots in SHOTS:
        network = tuned(options.weights, own, shots, options.runs / f"shots_{shots}", 0)
        metrics = evaluated(learned(network, lambda case: case.room), cases)
        rows.append({"method": f"{shots} jumps", "split": SPLIT, "n": len(cases), "metrics": metrics})
    realization = simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1)
    rows.append({"method": "realization", "split": SPLIT, "n": len(cases), "metrics": evaluated(realization, cases)})
    for row in rows:
        print(row["method"], *(f"{name} {metric['value']:.3f}" for name, metric in row["metrics"].items()), flush=True)
    rows = complete_rows(
        rows, dataset=dataset_of(options.data), seeds=[0], baselines=("0 jumps",), oracles=("realization",),
        unknown={"seconds": "see the manifest: all rows together"},
    )  # fmt: skip
    run.write(
        "few_shot", ACTIVITY,
        config={"data_plan": plan, "shots": list(SHOTS), "steps": RECIPE.steps}, rows=rows,
    )  # fmt: skip
