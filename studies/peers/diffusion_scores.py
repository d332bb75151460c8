"""RF-Diffusion's kind of generator, small and trained here: does it make signals, or pass the truth on?

    python -m studies run diffusion_scores --data DATASET --runs build/diffusion
    python -m studies run diffusion_scores --data DATASET --runs scores/ --weights weights/signal_diffusion.safetensors

Trains `signal_diffusion` on the data set's training rooms (resumes where it was stopped), or takes --weights, and
scores it in rooms of unseen kinds, next to zeros, the training mean, the nearest training pose and the oracle.
`diffusion_from_noise` generates from joints and photo alone; `diffusion_truth_given` starts as the published evaluation
does, from the ground truth at weight 0.925. `truth_with_noise` is that start itself, before any network.
"""

import argparse
import math
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from studies.manifest import StudyRun
from studies.network.learned_scores import OTHER, Case, Method, cases_of, interval, nearest, simulated, training_mean
from studies.network.room_cache import RoomCache, digest
from studies.peers.diffusion_training import (
    DiffusionRecipe,
    DiffusionRoom,
    cube_of,
    load_diffusion,
    slow_time,
    train_diffusion,
    white,
)
from studies.peers.signal_diffusion import SignalDiffusion, mixed, sampled
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, scorecard
from studies.study import Reads

COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db", "cssim", "psnr_db")
TRUTH_WEIGHT = 0.925  # of the published evaluation


def generated(network: SignalDiffusion, *, is_truth_given: bool, is_restored: bool = True) -> Method:
    """The diffusion from noise, or from the ground truth with noise; `is_restored`: whether the network runs at all."""

    def method(case: Case) -> RadarCube:
        unit = network.unit
        one, truth = DiffusionRoom(case.room, case.spec.split), case.truth
        signal = slow_time(truth.values) / unit[:, None]
        # one noise for all frames, so that what stands still may stay the same
        noise = white(stream(case.index, "diffusion start"), signal.shape[1:])[None].expand_as(signal)
        begin = math.acos(TRUTH_WEIGHT) / (math.pi / 2) if is_truth_given else 1.0
        start = mixed(signal, noise, torch.full((len(signal),), begin)) if is_truth_given else noise
        if is_restored:
            picture = one.picture.expand(len(signal), -1)
            with torch.inference_mode():
                start = sampled(network, start, begin, one.motion(case.index), picture)
        return replace(truth, values=cube_of(start * unit[:, None]))

    return method


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="of mmweaver dataset --board ideal")
    parser.add_argument("--runs", type=Path, required=True, help="folder for checkpoint and scores, to go on from")
    parser.add_argument("--weights", type=Path, action=Reads, help="that were trained before (default: train now)")
    parser.add_argument("--steps", type=int, default=DiffusionRecipe().steps)
    parser.add_argument("--split", default="test_room")
    parser.add_argument("--most", type=int, default=16, help="rooms, sampled at random")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    weights = options.weights or train_diffusion(options.data, options.runs, DiffusionRecipe(steps=options.steps))
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    network = SignalDiffusion(rooms[0].config)
    card = load_diffusion(weights, network)
    methods: dict[str, Method] = {
        "diffusion_from_noise": generated(network, is_truth_given=False),
        "diffusion_truth_given": generated(network, is_truth_given=True),
        "truth_with_noise": generated(network, is_truth_given=True, is_restored=False),
        "training_mean": training_mean(rooms, plan["seed"]),
        "nearest_training_pose": nearest(rooms, plan["seed"]),
        "realization": simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1),
    }
    cases = cases_of(rooms, options.split, 1, plan, 0, options.most)
    cache = RoomCache(options.runs / "scores", {"data_plan": plan, "weights": digest(weights), "columns": COLUMNS})
    each = [cache.figures(case.room.folder.name, partial(scores_of, case, methods)) for case in cases]
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    size = sum(parameter.numel() for parameter in network.parameters())
    rows = complete_rows(
        [row_of(name, each, names) for name in each[0]], dataset={**dataset_of(options.data), "split": options.split},
        seeds=[card["seed"]], baselines=("zeros", "training_mean", "nearest_training_pose"), oracles=("realization",),
        unknown={"seconds": "see the manifest: training and all rows together"},
    )  # fmt: skip
    run.write(
        "diffusion_scores", options.split,
        config={"data_plan": plan, "weights": card, "parameters": size}, rows=rows,
    )  # fmt: skip
    for row in rows:
        print(f"{row['method']:24}", *(f"{name} {one['value']:.3f}" for name, one in row["metrics"].items()))


def scores_of(case: Case, methods: dict[str, Method]) -> dict[str, dict[str, float]]:
    """{row: {column: value}} of one case."""
    truth, scores = case.truth, {}
    for name, method in methods.items():
        card = scorecard(method(case), truth)
        scores.setdefault("zeros", {column: card.baselines["zeros"][column] for column in COLUMNS})
        scores[name] = {column: card.prediction[column] for column in COLUMNS}
    return scores


def row_of(method: str, each: list[dict[str, dict[str, float]]], rooms: list[str]) -> dict[str, Any]:
    """Means and intervals over rooms."""
    metrics = {}
    for column in COLUMNS:
        mean, low, high = interval(np.array([one[method][column] for one in each]), rooms)
        metrics[column] = {"value": mean, "interval_95": [low, high], "unit": METRICS[column].unit}
    return {"method": method, "n": len(rooms), "num_rooms": len(set(rooms)), "metrics": metrics}
