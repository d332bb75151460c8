"""Does the network, trained with level radars at the camera, hold for radars elsewhere?

    python -m studies run radar_poses --data DATASET --most 8 --runs build/radar_poses

Rooms of unseen kinds, one sequence each, exact joints, seen by radars of several poses (`POSES`); ground truth is the
simulator in the true room at that pose. Network and physics see the photo of the camera; the oracle is the true room
with other phases, the baseline physics in some other room. Intervals: bootstrap over rooms.
"""

import argparse
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import CubeGrid, PoseSequence, RadarCube, Scene
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from mmweaver.datasets.room_generation import pose_of
from mmweaver.dsp.cube import radar_cube
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scatterer_network import ScattererNetwork
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.paths.diffuse_clutter import seed_of_room
from mmweaver.paths.ray_traced import Simulator
from mmweaver.paths.static_paths import ALL_PATHS
from mmweaver.scene.moved_radar import people_seen_from, scene_seen_from
from mmweaver.scene.reconstruction import reconstruct
from studies.manifest import StudyRun
from studies.network.learned_scores import OTHER, Case, cases_of, generic_scene_of, interval
from studies.network.room_cache import RoomCache, digest
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, scorecard
from studies.study import Reads

POSES = {
    "camera": RadarPose(),
    "turned": RadarPose(yaw_deg=-25.0),
    "tilted": RadarPose(pitch_deg=-15.0),
    "aside": RadarPose(x_m=0.5, z_m=0.3, yaw_deg=-20.0, pitch_deg=-10.0),
    "across": RadarPose(x_m=1.0, y_m=0.8, yaw_deg=-45.0),
    "on_its_side": RadarPose(roll_deg=90.0),
}
COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db", "chamfer_m")
SPLIT = "test_room"
METHODS = ("zeros", "generic_room_physics", "weaver", "physics_in_photographed_room", "realization", "difference")
Scores = dict[str, dict[str, dict[str, float]]]


def motion_of(case: Case, pose: RadarPose, *, skin: int) -> PoseSequence:
    """The case's motion in the frame of a radar, of a person with other skin."""
    frames = len(case.joints[0])
    moved = people_seen_from((pose_of(case.spec, case.true_scene, case.room.config, frames),), pose)[0]
    return replace(moved, subject=case.spec.person + skin)


def simulated(scene: Scene, case: Case, pose: RadarPose, *, other: int = OTHER) -> RadarCube:
    """The simulator at a pose; with `other`, with other phases, skin and noise than the ground truth."""
    config, frames = case.room.config, len(case.joints[0])
    micro_seed = seed_of_room(scene) + (1 if other else 0)
    simulator = Simulator(scene_seen_from(scene, pose), config, micro_seed=micro_seed, propagation=ALL_PATHS)
    chunks = simulator.chunks(motion_of(case, pose, skin=other), num_frames=frames, seed=case.spec.seed + other)
    values = np.concatenate([radar_cube(chunk).values for chunk in chunks])
    return RadarCube(values=values, grid=CubeGrid.of(config, frames), config=config, scale=1.0)


def learned(network: ScattererNetwork, scene: Scene, case: Case, pose: RadarPose) -> RadarCube:
    """The network at a pose."""
    config = case.room.config
    room = LearnedRoom(network, scene_seen_from(scene, pose), config, room_seed=1)
    motion = FrameMotion.of(motion_of(case, pose, skin=OTHER), config, len(case.joints[0]))
    return room.cube([motion], seed=case.index)


def scores_of(case: Case, network: ScattererNetwork, generic: Scene) -> Scores:
    """{pose: {method: {column: value}}} of one room; `difference`: of the network less physics."""
    photographed = reconstruct(case.room.photo)
    return {name: _scores_at(pose, case, network, photographed, generic) for name, pose in POSES.items()}


def _scores_at(
    pose: RadarPose, case: Case, network: ScattererNetwork, photographed: Scene, generic: Scene
) -> dict[str, dict[str, float]]:
    truth, found = simulated(case.true_scene, case, pose, other=0), {}
    made = {
        "weaver": learned(network, photographed, case, pose),
        "physics_in_photographed_room": simulated(photographed, case, pose),
        "generic_room_physics": simulated(generic, case, pose),
        "realization": simulated(case.true_scene, case, pose),
    }
    for method, cube in made.items():
        card = scorecard(cube, truth)
        found[method] = {column: card.prediction[column] for column in COLUMNS}
        found["zeros"] = {column: card.baselines["zeros"][column] for column in COLUMNS}
    pair = found["weaver"], found["physics_in_photographed_room"]
    return {**found, "difference": {column: pair[0][column] - pair[1][column] for column in COLUMNS}}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="of mmweaver dataset --board ideal")
    parser.add_argument("--weights", type=Path, action=Reads, help="of recipe weaver (default: those included)")
    parser.add_argument("--most", type=int, default=12, help="rooms, sampled at random")
    parser.add_argument("--runs", type=Path, help="folder for what is done, to go on from")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    weights = options.weights or shipped_weights()
    network, card = load_weights(weights)
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    cases = cases_of(rooms, SPLIT, 1, plan, 0, options.most)
    generic_scene = generic_scene_of(rooms, plan)
    poses = {name: pose.words for name, pose in POSES.items()}
    cache = RoomCache(options.runs, {"data_plan": plan, "weights": digest(weights), "poses": poses})
    each = [cache.figures(case.room.folder.name, partial(scores_of, case, network, generic_scene)) for case in cases]
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    rows = [row for name in POSES for row in _rows(name, [one[name] for one in each], names, options.data)]
    run.write("radar_poses", SPLIT, config={"weights": card.__dict__, "data_plan": plan, "poses": poses}, rows=rows)
    for row in rows:
        shown = (f"{name} {one['value']:.3f}" for name, one in row["metrics"].items())
        print(f"{row['pose']:12} {row['method']:30}", *shown)


def _rows(pose: str, each: list[dict[str, dict[str, float]]], rooms: list[str], data: Path) -> list[dict[str, Any]]:
    """Rows of one pose: means and intervals over rooms."""
    rows = []
    for method in METHODS:
        metrics = {}
        for column in COLUMNS:
            mean, low, high = interval(np.array([one[method][column] for one in each]), rooms)
            metrics[column] = {"value": mean, "interval_95": [low, high], "unit": METRICS[column].unit}
        rows.append(
            {
                "method": method,
                "pose": pose,
                "words": POSES[pose].words,
                "n": len(rooms),
                "num_rooms": len(set(rooms)),
                "metrics": metrics,
            }
        )
    return complete_rows(
        rows, dataset={**dataset_of(data), "split": SPLIT}, seeds=[0], baselines=METHODS[:2], oracles=("realization",),
        unknown={"seconds": "see the manifest: all rows together"},
    )  # fmt: skip
