"""Can a classifier distinguish generated cubes from simulated ground truth? Accuracy in unseen rooms; 0.5 is chance.

    python -m studies run real_or_simulated --data DATASET --weights WEAVER --recogniser ACTIVITY
    python -m studies run real_or_simulated --data DATASET --weights WEAVER --recogniser ACTIVITY --boards ideal

Ground truth and generated cubes share rooms and joints (cases of `learned_scores`, unseen kinds of rooms). For each
method, trees learn the difference from `cube_statistics` of four fifths of the rooms and are evaluated in the last
fifth, in turn. `realization`, the simulator with other micro-phases, is the oracle: it should be indistinguishable.
`generic_room_physics` is the baseline. Ground truth has all paths, clutter and the errors of a typical board, another
one in each case; generated cubes have those of another typical board, as `generate` makes them, with a background
recording those that it shows. With `--boards ideal` neither has any: the stricter question of paths alone.
"""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmweaver.core.board import Board
from mmweaver.core.boards import IDEAL_BOARD, typical_board
from mmweaver.core.records import Scene
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.models.activity_network import load_activity
from mmweaver.models.scatterer_network import ScattererNetwork
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.network.cube_statistics import cube_statistics
from studies.network.learned_scores import (
    OTHER,
    BoardOf,
    Case,
    Method,
    cases_of,
    interval,
    learned,
    simulated,
    true_cube,
)
from studies.network.room_cache import RoomCache, digest
from studies.paper.paper_method import paper_method
from studies.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

FOLDS = 5
SETTINGS = ClassifierSettings(num_trees=300, boosting_rounds=80, leaf_size=2)
TRUE, GENERATED = "true", "generated"
BOARDS = ("typical", "ideal")


def folds_of(rooms: list[str], seed: int = 0) -> list[set[str]]:
    """Rooms divided into five folds."""
    names = np.array(sorted(set(rooms)))
    order = stream(seed, "real or generated").permutation(len(names))
    return [set(names[order[fold::FOLDS]].tolist()) for fold in range(min(FOLDS, len(names)))]


def real_or_simulated_scores(true: np.ndarray, made: np.ndarray, rooms: list[str]) -> np.ndarray:
    """Share of right answers for each case, its ground truth and its generated cube: 0, 0.5 or 1.

    Statistics (case, number), both in the same order, and the room of each case; no room is both in training and test.
    """
    right = np.zeros(len(rooms))
    for held in folds_of(rooms):
        is_held = np.array([room in held for room in rooms])
        learned = np.concatenate([true[~is_held], made[~is_held]])
        labels = np.repeat([TRUE, GENERATED], int((~is_held).sum()))
        recogniser = ActivityClassifier(SETTINGS).fit(learned, labels)
        hits = [recogniser.predict(true[is_held]) == TRUE, recogniser.predict(made[is_held]) == GENERATED]
        right[is_held] = np.mean(hits, axis=0)
    return right


def rows_of(
    cases: list[Case],
    truth: Method,
    methods: dict[str, Method],
    statistics: Callable[..., np.ndarray],
    cache: RoomCache,
    report: Callable[[str], object] = lambda line: None,
) -> list[dict[str, Any]]:
    """One row a method: accuracy over rooms with its interval."""
    rooms = [f"{case.room.kind}_{case.room.layout}" for case in cases]

    def measured(case: Case) -> dict[str, list[float]]:
        made = {name: statistics(method(case)).tolist() for name, method in methods.items()}
        return {TRUE: statistics(truth(case)).tolist(), **made}

    each = [cache.figures(f"{case.room.folder.name}_{case.index}", partial(measured, case)) for case in cases]
    true, rows = np.array([one[TRUE] for one in each]), []
    for name in methods:
        made = np.array([one[name] for one in each])
        mean, low, high = interval(real_or_simulated_scores(true, made, rooms), rooms)
        metric = {"value": mean, "interval_95": [low, high], "unit": "1", "oracle": {"indistinguishable": 0.5}}
        rows.append({"method": name, "n": len(cases), "num_rooms": len(set(rooms)), "metrics": {"accuracy": metric}})
        report(f"{name:30} {mean:.3f} ({low:.3f} to {high:.3f})")
    return rows


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument("--weights", type=Path, action=Reads, help="of recipe weaver (default: those included)")
    parser.add_argument("--recogniser", type=Path, action=Reads, required=True, help="of recipe activity")
    parser.add_argument("--paper", type=Path, action=Reads, help="of recipe paper")
    parser.add_argument("--split", default="test_room")
    parser.add_argument("--each", type=int, default=4, help="sequences of each room")
    parser.add_argument("--boards", choices=BOARDS, default=BOARDS[0])
    parser.add_argument("--most", type=int, help="rooms, sampled at random (default: all that have the split)")
    parser.add_argument("--runs", type=Path, help="folder for what is done, to go on from")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    weights = options.weights or shipped_weights()
    network, card = load_weights(weights)
    recogniser = load_activity(options.recogniser, rooms[0].config)
    cases = cases_of(rooms, options.split, options.each, plan, 0, options.most)
    generic = next(room for room in rooms if "train" in room.split)
    generic_scene = make_room(generic.kind, generic.layout, plan["seed"]).scene(generic.lighting)
    recorded_by, generated_by = (board_by(options.boards, whose) for whose in (TRUE, GENERATED))
    methods = methods_of(network, generic_scene, recorded_by, generated_by)
    if options.paper is not None:
        methods["paper"] = paper_method(options.paper)
    files = [digest(file) for file in (weights, options.recogniser, options.paper) if file is not None]
    about = {"data_plan": plan, "files": files, "methods": list(methods), "boards": options.boards}
    cache = RoomCache(options.runs, about)
    truth = true_by(recorded_by)
    rows = rows_of(cases, truth, methods, lambda cube: cube_statistics(cube, recogniser), cache, _print_row)
    rows = complete_rows(
        [{**row, "boards": options.boards} for row in rows],
        dataset={**dataset_of(options.data), "split": options.split}, seeds=[0],
        baselines=("generic_room_physics",), unknown={"seconds": "see the manifest: all rows together"},
    )  # fmt: skip
    run.write(
        "real_or_simulated", options.split if options.boards == BOARDS[0] else f"{options.split}_{options.boards}",
        config={"weights": card.__dict__, "data_plan": plan, "each": options.each}, rows=rows,
    )  # fmt: skip


def board_by(name: str, whose: str) -> BoardOf:
    """Ideal boards, or a typical one of its own for each case and side."""

    def board_of(case: Case) -> Board:
        if name == "ideal":
            return IDEAL_BOARD
        number = int(stream(case.index, "real or simulated board", case.room.folder.name, whose).integers(2**31))
        return typical_board(case.room.config, number)

    return board_of


def true_by(board_of: BoardOf) -> Method:
    """The ground truth, as a board records it."""
    return lambda case: true_cube(case.room, case.index, case.seed_of_plan, board_of(case))


def methods_of(
    network: ScattererNetwork, generic: Scene, recorded_by: BoardOf, generated_by: BoardOf
) -> dict[str, Method]:
    """What is to be distinguished from the ground truth."""
    physics = partial(simulated, skin=OTHER, micro_seed=1, board_of=generated_by)
    return {
        "weaver": learned(network, _own_room, board_of=generated_by),
        "weaver_with_background": learned(network, _own_room, recorded=True, board_of=recorded_by),
        "generic_room_physics": physics(lambda case: generic),
        "physics_in_photographed_room": physics(lambda case: reconstruct(case.room.photo)),
        "realization": physics(lambda case: case.true_scene),
    }


def _print_row(line: str) -> None:
    print(line, flush=True)


def _own_room(case: Case) -> StoredRoom:
    return case.room
