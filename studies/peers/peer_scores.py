"""How near do other generators come to the ground truth in unseen rooms?

    mmweaver dataset rooms/ --rooms living_room,classroom,workshop --layouts 24 --sequences 16 --geometry-only
    python -m studies run peer_scores --data rooms/ --runs build/peers

The deciding comparison of `learned_scores`, on its 48 rooms and sequences, with RF-Genesis on the same joints: ground
truth is the simulator in the true room, SSIM of range-azimuth and range-Doppler maps in decibels over cells that show
something. RF-Genesis has no scale, so each of its sequences is given the gain that fits the ground truth best, an
oracle's. Rows: as released, repaired with the body alone, with a generic room, with our photographed room. `zeros` and
`generic_room_physics` are the baselines, `realization`, the true room with other phases, the oracle. Each row of a room
is cached, so a stopped run goes on, and another row costs its own time alone.
"""

import argparse
import functools
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.records import RadarCube, Scene
from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from mmweaver.datasets.room_generation import pose_of
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.network.learned_scores import OTHER, Case, Method, cases_of, interval, learned, simulated
from studies.network.room_cache import RoomCache, digest
from studies.peers.rf_genesis import RfGenesis, Triangles
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, Representations
from studies.study import Reads

COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db", "cssim", "psnr_db", "chamfer_m", "hausdorff_m")
BASELINES, ORACLES = ("zeros", "generic_room_physics"), ("realization",)
ROOM_PIXELS = 64  # of RF-Genesis with a room: every pixel of it is an echo
ROOMS = 48  # sampled as those of learned_scores
Scores = dict[str, dict[str, float]]


def with_best_gain(cube: RadarCube, truth: RadarCube) -> RadarCube:
    """The cube times the one factor with which its magnitudes are nearest to those of the truth."""
    own, true = (np.abs(one.values).astype(float).ravel() for one in (cube, truth))
    gain = (own @ true) / max(own @ own, 1e-300)
    return replace(cube, values=(cube.values * gain).astype(np.complex64), scale=truth.scale)


def peer(settings: RfGenesis, case: Case, room: Scene | None = None) -> RadarCube:
    """RF-Genesis with the motion of a case."""
    spec, frames = case.spec, len(case.joints[0])
    pose = replace(pose_of(spec, case.true_scene, case.room.config, frames), height_m=PEOPLE_HEIGHT_M[spec.person])
    traced = settings if room is None else replace(settings, room=triangles(room), pixels=ROOM_PIXELS)
    return traced.cube(pose, case.room.config, frames)


def triangles(scene: Scene) -> Triangles:
    """A scene's mesh."""
    return np.asarray(scene.vertices_m, np.float32), np.asarray(scene.faces, np.uint32)


def methods_of(network: Any, generic: Scene) -> dict[str, Method]:
    """Every row by name."""
    repaired = RfGenesis(repaired=True, has_environment=False)
    return {
        "zeros": all_zeros,
        "weaver": learned(network, lambda case: case.room),
        "physics_in_photographed_room": simulated(lambda case: reconstruct(case.room.photo), skin=OTHER, micro_seed=1),
        "generic_room_physics": simulated(lambda case: generic, skin=OTHER, micro_seed=1),
        "realization": simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1),
        "rf_genesis_as_released": lambda case: peer(RfGenesis(), case),
        "rf_genesis_repaired_body": lambda case: peer(repaired, case),
        "rf_genesis_repaired_generic_room": lambda case: peer(repaired, case, generic),
        "rf_genesis_repaired_photographed_room": lambda case: peer(repaired, case, reconstruct(case.room.photo)),
    }  # fmt: skip


def all_zeros(case: Case) -> RadarCube:
    """The baseline that hears nothing."""
    truth = case.truth
    return replace(truth, values=np.zeros_like(truth.values))


def scores_of(case: Case, truth: Callable[[], Representations], name: str, method: Method) -> dict[str, float]:
    """{column: value} of one row in one room, with its CPU seconds."""
    began = time.process_time()
    cube = method(case)
    seconds = time.process_time() - began
    reference = truth()
    prediction = Representations(with_best_gain(cube, reference.cube) if name.startswith("rf_genesis") else cube)
    return {**{column: METRICS[column].score(prediction, reference) for column in COLUMNS}, "cpu_s": seconds}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="of mmweaver dataset, with signals")
    parser.add_argument("--split", default="test_room")
    parser.add_argument("--runs", type=Path, help="folder for what is done, to go on from")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    plan = read_plan(options.data)
    cases = cases_of(read_rooms(options.data), options.split, 1, plan, 0, ROOMS)
    network, card = load_weights(shipped_weights())
    methods = methods_of(network, make_room("office", 0, plan["seed"]).scene("day"))
    about = {"data_plan": plan, "weights": digest(shipped_weights()), "columns": COLUMNS}
    cache = RoomCache(options.runs, about)
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    each: list[Scores] = []
    for name, case in zip(names, cases, strict=True):
        truth = functools.cache(lambda case=case: Representations(case.truth))
        each.append(
            {
                row: cache.figures(f"{name}_{row}", partial(scores_of, case, truth, row, method))
                for row, method in methods.items()
            }
        )
        print(name, {row: round(values["ra_ssim"], 2) for row, values in each[-1].items()}, flush=True)
    rows = [_row(name, each, names) for name in each[0]]
    rows = complete_rows(
        rows, dataset=dataset_of(options.data), seeds=[0], baselines=BASELINES, oracles=ORACLES,
        unknown={"seconds": "metric cpu_s has those of each method"},
    )  # fmt: skip
    run.write("peer_scores", options.split, config={"weights": card.__dict__, "data_plan": plan}, rows=rows)


def _row(method: str, each: list[Scores], rooms: list[str]) -> dict[str, Any]:
    metrics = {}
    for column in (*COLUMNS, "cpu_s"):
        mean, low, high = interval(np.array([one[method][column] for one in each]), rooms)
        unit = METRICS[column].unit if column in METRICS else "s"
        metrics[column] = {"value": mean, "interval_95": [low, high], "unit": unit}
    return {"method": method, "n": len(rooms), "num_rooms": len(set(rooms)), "metrics": metrics}
