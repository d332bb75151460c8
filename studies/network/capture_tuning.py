"""What fine-tuning on a few captures of one's own room gains, on other sequences of that room.

    python -m studies run capture_tuning --data DATASET --work DIR --rooms 8

Rooms are of kinds that the weights never saw. Of each, a few sequences are written as capture folders, as a user would
have them, and fine-tuned on as by `mmweaver train weaver --captures`; other sequences of the room are scored.
`captures_as_background` uses the same captures, with people in them, as `--background`, and tunes nothing.
`captures_mean` repeats the mean of the captures: the room with its phases, and nobody in it. `realization`, where the
data set is of this version's motion library, is the simulator in the true room with other phases (an oracle).
Intervals: bootstrap over rooms. A stopped run continues where it was.
"""

import argparse
import json
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.checksums import sha256_of_file
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, PoseSequence, RadarCube, RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.io.npz_files import write_pose_npz, write_radar_npz
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.weights import WeightsCard, load_weights, shipped_weights
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.training.capture_training import recipe_for, tune
from mmweaver.training.captures import read_capture
from studies.manifest import StudyRun
from studies.network.learned_scores import OTHER, Case, simulated, true_cube
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, scorecard
from studies.study import Reads

COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db", "chamfer_m")
REALIZATION = "realization"  # the simulator in the true room with other phases
Method = Callable[[int], RadarCube]


def write_capture(folder: Path, room: StoredRoom, index: int, cube: RadarCube, *, joints: bool) -> Path:
    """One sequence as a capture folder of a user; the photo is in the parent folder."""
    folder.mkdir(parents=True, exist_ok=True)
    write_radar_npz(folder / "radar.npz", cube)
    (folder / "radar.json").write_text(room.config.to_json(), encoding="utf-8")
    if joints:
        time_s = cube.grid.frame_time_s + room.config.active_time_s / 2
        height_m = PEOPLE_HEIGHT_M[int(room.person[index])]
        write_pose_npz(
            folder / "pose.npz",
            PoseSequence(time_s=time_s, joints_m=room.joints_m[index].astype(float), height_m=height_m, subject=0),
        )
    return folder


def write_photo(folder: Path, photo: RgbdPhoto) -> None:
    """rgb.png, depth.npy and camera.json."""
    folder.mkdir(parents=True, exist_ok=True)
    rgb = photo.rgb if photo.rgb.dtype == np.uint8 else np.round(255 * photo.rgb).astype(np.uint8)
    Image.fromarray(rgb).save(folder / "rgb.png")
    np.save(folder / "depth.npy", photo.depth_m)
    camera = asdict(photo.intrinsics)
    (folder / "camera.json").write_text(
        json.dumps({name: camera[name] for name in ("fx", "fy", "cx", "cy")}), encoding="utf-8"
    )


def scores_of(room: StoredRoom, arguments: argparse.Namespace, plan_seed: int) -> dict[str, list[dict[str, float]]]:
    """`one_room`, or what an earlier run of the same settings has kept of it in the work folder."""
    settings = {
        "weights": sha256_of_file(arguments.weights), "captures": arguments.captures,
        "each": arguments.each, "steps": arguments.steps, "plan_seed": plan_seed,
    }  # fmt: skip
    file = arguments.work / room.folder.name / "scores.json"
    kept = read_json(file) if file.is_file() else {}
    if kept.get("settings") == settings:
        return kept["scores"]
    scores = one_room(room, arguments, plan_seed)
    with atomic_file(file) as staged:
        staged.write_text(json.dumps({"settings": settings, "scores": scores}), encoding="utf-8")
    return scores


def one_room(room: StoredRoom, arguments: argparse.Namespace, plan_seed: int) -> dict[str, list[dict[str, float]]]:
    """Scores of all methods on held-out sequences of one room."""
    order = stream(0, "capture tuning", room.folder.name).permutation(
        [index for index, split in enumerate(room.split) if split == "test_room"]
    )
    given, asked = order[: arguments.captures], order[arguments.captures : arguments.captures + arguments.each]
    work = arguments.work / room.folder.name
    write_photo(work, room.photo)
    start = load_weights(arguments.weights)[0]
    truths = {int(index): true_cube(room, int(index), plan_seed) for index in (*given, *asked)}
    networks = {"untuned": start}
    for name, joints in (("tuned_with_joints", True), ("tuned_without_joints", False)):
        folders = [write_capture(work / name / f"take{k}", room, int(index), truths[int(index)], joints=joints)
                   for k, index in enumerate(given)]  # fmt: skip
        for folder in folders:
            for file in ("rgb.png", "depth.npy", "camera.json"):
                (folder / file).write_bytes((work / file).read_bytes())
        captures = [read_capture(folder) for folder in folders]
        recipe = recipe_for(captures, **({} if arguments.steps is None else {"steps": arguments.steps}))
        tuned = tune(captures, work / name / "run", recipe, start=start.state_dict())
        networks[name] = getattr(tuned.trainer.learner, "network")  # noqa: B009 - any learner of this recipe has one
        print(f"{work.name} {name}: {tuned.loss_before:.3f} -> {tuned.trainer.best.value:.3f}", flush=True)
    scene = reconstruct(read_capture(work / "tuned_with_joints" / "take0").photo)
    methods: dict[str, Method] = {name: _learned(LearnedRoom(network, scene, room.config, room_seed=1), room)
                                  for name, network in networks.items()}  # fmt: skip
    takes = _together([read_capture(work / "tuned_with_joints" / f"take{k}").cube for k in range(len(given))])
    methods["captures_as_background"] = _learned(LearnedRoom(start, scene, room.config, background=takes), room)
    methods["captures_mean"] = _mean([truths[int(index)] for index in given])
    realization = _realization(room, plan_seed)
    try:
        realization(int(asked[0]))
        methods[REALIZATION] = realization
    except InputError as error:
        print(f"{work.name}: no other realization, {error}", flush=True)
    scores: dict[str, list[dict[str, float]]] = {}
    for index in asked:
        truth = truths[int(index)]
        for name, method in methods.items():
            card = scorecard(method(int(index)), truth)
            scores.setdefault(name, []).append({column: card.prediction[column] for column in COLUMNS})
            if name == "untuned":
                zeros = {column: card.baselines["zeros"][column] for column in COLUMNS}
                scores.setdefault("zeros", []).append(zeros)
    return scores


def _learned(learned: LearnedRoom, room: StoredRoom) -> Method:
    def method(index: int) -> RadarCube:
        motion = FrameMotion(
            joints_m=room.joints_m[index], velocity_mps=room.joint_velocity_mps[index],
            subject=OTHER + int(room.person[index]),
        )  # fmt: skip
        return learned.cube([motion], seed=index)

    return method


def _together(cubes: list[RadarCube]) -> RadarCube:
    """Recordings concatenated in time."""
    values = np.concatenate([cube.values for cube in cubes])
    config = cubes[0].config
    return RadarCube(values=values, grid=CubeGrid.of(config, len(values)), config=config, scale=cubes[0].scale)


def _mean(captures: list[RadarCube]) -> Method:
    mean = np.mean([cube.values.mean(axis=0) for cube in captures], axis=0)
    still = np.repeat(mean[None], len(captures[0].values), axis=0).astype(np.complex64)
    cube = replace(captures[0], values=still)
    return lambda index: cube


def _realization(room: StoredRoom, plan_seed: int) -> Method:
    made = simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1)
    return lambda index: made(Case(room, index, room, plan_seed, room.lighting))


def rows_of(scores: list[dict[str, list[dict[str, float]]]]) -> list[dict[str, Any]]:
    """A row a method: mean over rooms and its 95 % bootstrap interval."""
    rng = stream(0, "bootstrap")
    draw = rng.integers(len(scores), size=(2000, len(scores)))
    rows = []
    for name in scores[0]:
        metrics = {}
        for column in COLUMNS:
            each = np.array([np.nanmean([case[column] for case in room[name]]) for room in scores])
            means = each[draw].mean(axis=1)
            metrics[column] = {
                "value": float(each.mean()), "unit": METRICS[column].unit,
                "interval_95": np.percentile(means, (2.5, 97.5)).tolist(),
            }  # fmt: skip
        n = sum(len(room[name]) for room in scores)
        rows.append({"method": name, "n": n, "num_rooms": len(scores), "metrics": metrics})
    return rows


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument(
        "--weights",
        type=Path,
        action=Reads,
        default=shipped_weights(),
        help="of recipe weaver (default: those included)",
    )
    parser.add_argument("--work", type=Path, required=True, help="an empty folder for captures and runs")
    parser.add_argument("--rooms", type=int, default=6)
    parser.add_argument("--captures", type=int, default=4, help="of each room; the last is held out")
    parser.add_argument("--each", type=int, default=4, help="other sequences that are scored")
    parser.add_argument("--steps", type=int)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    plan = read_plan(options.data)
    rooms = [room for room in read_rooms(options.data) if "test_room" in room.split]
    order = stream(0, "capture tuning").permutation(len(rooms))[: options.rooms]
    scores = [scores_of(rooms[int(which)], options, plan["seed"]) for which in order]
    rows = rows_of(scores)
    card: WeightsCard = load_weights(options.weights)[1]
    complete = complete_rows(
        rows, dataset={**dataset_of(options.data), "split": "test_room"}, seeds=[0], baselines=("zeros",),
        oracles=(REALIZATION,), unknown={"seconds": "see the manifest: all rows together"},
    )  # fmt: skip
    run.write(
        "capture_tuning", "test_room",
        config={
            "weights": asdict(card), "data_plan": plan, "captures": options.captures, "each": options.each,
            "rooms": [rooms[int(which)].folder.name for which in order], "steps": options.steps,
        },
        rows=complete,
    )  # fmt: skip
    for row in rows:
        values = (f"{name} {metric['value']:.3f}" for name, metric in row["metrics"].items())
        print(f"{row['method']:22}", *values, flush=True)
