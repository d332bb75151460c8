"""Scores of a hypernetwork of target signal in rooms it has never seen; baselines are all zeros and the static mean.

    python -m studies run paper_scores --data DATASET --weights PAPER

Exact joints, simulated ground truth. cSSIM and PSNR, which the paper reports, are given with what all zeros score. A
learning curve that lies in the folder of the weights (`log.jsonl`) becomes part of the result.
"""

import argparse
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.records import RadarCube
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from mmweaver.models.hypernetwork import HyperNetwork
from mmweaver.models.hypernetwork_rooms import load_hypernetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.network.learned_scores import Case, cases_of, energy_db, interval
from studies.network.room_cache import RoomCache, digest
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, scorecard
from studies.study import Reads

COLUMNS = ("cssim", "psnr_db", "nmse_db", "nmse_active_db", "nmse_moving_db", "rd_ssim", "ra_ssim")
PAPER, LOG = "paper", "log.jsonl"


Scores = dict[str, dict[str, float]]  # {row: {column: value}} of one case


def paper_method(weights: Path) -> Callable[[Any], RadarCube]:
    """The cube of a `Case`, from room.photo, room.config and joints."""
    network, _ = load_hypernetwork(weights)
    assert isinstance(network, HyperNetwork), "weights of target signal"

    def method(case: Any) -> RadarCube:
        image = SceneTensors.of(reconstruct(case.room.photo), case.room.config).image
        return network.field(image, case.room.config, *case.joints).cube()

    return method


def scores_of(
    cases: list[Case], method: Callable[[Case], RadarCube], cache: RoomCache
) -> dict[str, dict[str, np.ndarray]]:
    """{row: {column: value of each case}}: zeros, static_mean and the method.

    `energy_db` is the energy of the cube over that of the ground truth, which reveals a collapse.
    """
    each: list[Scores] = [cache.figures(_name(case), partial(_scores, case, method)) for case in cases]
    return {row: {name: np.array([one[row][name] for one in each]) for name in each[0][row]} for row in each[0]}


def _name(case: Case) -> str:
    return f"{case.room.folder.name}_{case.index}"


def _scores(case: Case, method: Callable[[Case], RadarCube]) -> Scores:
    truth, cube = case.truth, method(case)
    card = scorecard(cube, truth)
    rows = {**card.baselines, PAPER: card.prediction}
    scores = {name: {column: values[column] for column in COLUMNS} for name, values in rows.items()}
    scores[PAPER]["energy_db"] = energy_db(cube, truth)
    return scores


def rows_of(scores: dict[str, dict[str, np.ndarray]], cases: list[Case]) -> list[dict[str, Any]]:
    """One row each, means and intervals over rooms."""
    rooms = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    rows = []
    for name, columns in scores.items():
        metrics = {}
        for column, values in columns.items():
            mean, low, high = interval(values, rooms)
            unit = METRICS[column].unit if column in METRICS else "dB"
            metrics[column] = {"value": mean, "interval_95": [low, high], "unit": unit}
        rows.append({"method": name, "n": len(cases), "num_rooms": len(set(rooms)), "metrics": metrics})
    return rows


def learning_curve(folder: Path) -> list[dict[str, Any]]:
    """Validations of a training run in a folder: step, loss and its terms; empty without a log."""
    file = folder / LOG
    if not file.is_file():
        return []
    lines = (json.loads(line) for line in file.read_text(encoding="utf-8").splitlines())
    reported = (line for line in lines if line["validation"] is not None)
    return [{"step": line["step"], "loss": line["validation"], **line["figures"]} for line in reported]


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument(
        "--weights", type=Path, action=Reads, required=True, help="of mmweaver train hypernetwork --target signal"
    )
    parser.add_argument("--split", default="test_room")
    parser.add_argument("--each", type=int, default=3, help="sequences of each room")
    parser.add_argument("--most", type=int, help="rooms, sampled at random (default: all that have the split)")
    parser.add_argument("--runs", type=Path, help="folder for what is done, to go on from")
    parser.add_argument("--called", help="the result's name (default: the split)")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    plan = read_plan(options.data)
    cases = cases_of(read_rooms(options.data), options.split, options.each, plan, 0, options.most)
    cache = RoomCache(options.runs, {"data_plan": plan, "weights": digest(options.weights)})
    rows = rows_of(scores_of(cases, paper_method(options.weights), cache), cases)
    _, card = load_hypernetwork(options.weights)
    complete = complete_rows(
        rows, dataset={**dataset_of(options.data), "split": options.split}, seeds=[0],
        baselines=("zeros", "static_mean"),
        unknown={"seconds": "see the manifest: all rows together"},
    )  # fmt: skip
    run.write(
        "paper_scores", options.called or options.split,
        config={"weights": card.__dict__, "data_plan": plan, "each": options.each,
                "learning_curve": learning_curve(options.weights.parent)}, rows=complete,
    )  # fmt: skip
    for row in rows:
        values = (f"{name} {metric['value']:.3f}" for name, metric in row["metrics"].items())
        print(f"{row['method']:12}", *values)
