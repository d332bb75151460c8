"""What generated data is worth to a pose network in simulated rooms: overall, in unseen rooms, of unseen people.

    python -m studies run pose_gain --data DATASET --runs RUNS

The network of `mmweaver train pose` on the point clouds of a data set of `mmweaver dataset`, whose signals physics made
in furnished rooms: the ground truth. `--recorded` sequences of its training split stand for recordings; to them come
as many steps on signals that the shipped network generated from the photos of rooms (half of them the unseen ones),
with sentences of all activities and other people. Equal steps with and without. `overall`: held-out sequences of the
rooms and people recorded. Next to both the mean pose of the recorded training sequences.
"""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import read_plan
from mmweaver.datasets.room_sequences import RoomSequences, read_labelled
from mmweaver.evaluation.pose_errors import joint_errors_cm
from mmweaver.models.point_frames import point_frames
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.recognition.generated_sequences import joints_at
from mmweaver.recognition.task_file import RecordingSettings
from mmweaver.recognition.train_pose import PoseEstimator
from mmweaver.signal.points import point_cloud
from mmweaver.training.pose_training import PosedFrames, PoseRecipe, PoseWindows, mean_pose_m, train_pose
from studies.manifest import StudyRun
from studies.network.activity_gain import UnseenRoom, motions_in, with_generated
from studies.result_rows import dataset_of
from studies.schema import metric

SEEDS = 2
PLACES = {"overall": "train", "unseen_room": "test_room", "unseen_person": "test_person"}
ALIGNMENTS = {"root": "both pelvises at the origin", "centroid": "the means of the joints at the origin"}


def chosen(data: RoomSequences, recorded: int, tested: int) -> dict[str, np.ndarray]:
    """Which sequences are recorded, and which test: `overall` is what is left of the training split."""
    rng, split = stream(0, "pose gain"), data.columns["split"]
    train = rng.permutation(np.flatnonzero(split == PLACES["overall"]))
    found = {"recorded": train[:recorded], "overall": train[recorded : recorded + tested]}
    for name in ("unseen_room", "unseen_person"):
        found[name] = rng.permutation(np.flatnonzero(split == PLACES[name]))[:tested]
    return found


def kept(file: Path, cloud: PointCloud, joints_m: np.ndarray) -> PosedFrames:
    """Writes points and joints of a sequence, which cost more than the training, and gives them."""
    names = ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
    np.savez(file, joints_m=joints_m, **{name: getattr(cloud, name) for name in names})
    return PosedFrames(frames=point_frames(cloud, len(joints_m)), joints_m=joints_m)


def read_kept(file: Path) -> PosedFrames:
    """Points and joints of `kept`."""
    with np.load(file) as held:
        joints_m = held["joints_m"]
        cloud = PointCloud(**{name: held[name] for name in held.files if name != "joints_m"})
    return PosedFrames(frames=point_frames(cloud, len(joints_m)), joints_m=joints_m)


def simulated(data: RoomSequences, which: np.ndarray, runs: Path) -> list[PosedFrames]:
    """Sequences of the data set as points with joints."""
    found = []
    for index in map(int, which):
        file = runs / f"simulated_{index}.npz"
        joints_m = np.asarray(data.joints_m[index], float)
        found.append(read_kept(file) if file.is_file() else kept(file, data.cloud(index), joints_m))
    return found


def generated(data: RoomSequences, rooms: Sequence[int], runs: Path) -> list[PosedFrames]:
    """One sequence of every activity in each room, from its photo, by the shipped network."""
    network, _ = load_weights(shipped_weights())
    plan, found = read_plan(data.folder), []
    for number in rooms:
        stored = data.rooms[number]
        room = UnseenRoom(stored, stored, stored, plan)
        files = sorted(runs.glob(f"generated_{room.name}_*.npz"))
        if (runs / f"generated_{room.name}.done").is_file():
            found += [read_kept(file) for file in files]
            continue
        make = with_generated(network, lambda one: one.photographed)(room)
        for index, (_, pose) in enumerate(motions_in(room, 1, 0)):
            frames = stored.joints_m.shape[1]
            joints_m = joints_at(pose, np.arange(frames) * stored.config.frame_period_s)
            file = runs / f"generated_{room.name}_{index:02d}.npz"
            found.append(kept(file, point_cloud(make(pose, index)), joints_m))
        (runs / f"generated_{room.name}.done").touch()
    return found


def network_errors(
    windows: PoseWindows, tests: dict[str, list[PosedFrames]], folder: Path, steps: int, seed: int
) -> dict[str, dict[str, float]]:
    """Of each test and alignment, after so many steps; the last weights, nothing is held out to choose by."""
    recipe = PoseRecipe(steps=steps, seed=seed, validate_every=steps, validation_batches=1)
    trainer = train_pose(windows, windows, folder, recipe)
    settings = RecordingSettings(labels=(), window_s=float(windows.window_frames), frame_rate_hz=1.0)
    estimator = PoseEstimator(networks=[trainer.learner.network], settings=settings)
    return {
        name: errors_of([estimator.joints_m(one.frames) for one in people], people) for name, people in tests.items()
    }


def errors_of(predicted: Sequence[np.ndarray], people: Sequence[PosedFrames]) -> dict[str, float]:
    """Mean error over all frames, in cm, by alignment."""
    true_m = np.concatenate([one.joints_m for one in people])
    return {name: joint_errors_cm(np.concatenate(predicted), true_m, name)["all"] for name in ALIGNMENTS}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, required=True, help="data set of mmweaver dataset, --geometry-only or not")
    parser.add_argument("--runs", type=Path, required=True, help="folder of point clouds and trainings; resumed")
    parser.add_argument("--recorded", type=int, default=36, help="sequences that stand for recordings")
    parser.add_argument("--tested", type=int, default=16, help="sequences of each test")
    parser.add_argument("--rooms", type=int, default=4, help="photographed rooms, trained-on ones and as many unseen")
    parser.add_argument("--steps", type=int, default=150)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    began = time.process_time()
    options.runs.mkdir(parents=True, exist_ok=True)
    data = read_labelled(options.data)
    assert isinstance(data, RoomSequences), "a data set of rooms"
    parts = {
        name: simulated(data, which, options.runs)
        for name, which in chosen(data, options.recorded, options.tested).items()
    }
    recorded, tests = parts["recorded"], {name: parts[name] for name in PLACES}
    rooms_of = {split: _rooms(data, split) for split in ("train", "test_room")}
    made = [number for numbers in rooms_of.values() for number in numbers[: options.rooms]]
    more = generated(data, made, options.runs)
    length = len(recorded[0])
    windows = {
        "without": PoseWindows(recordings=recorded, window_frames=length),
        "with": PoseWindows(recordings=[*recorded, *more], window_frames=length),
    }
    found = {
        how: [network_errors(one, tests, options.runs / f"{how}_{seed}", options.steps, seed) for seed in range(SEEDS)]
        for how, one in windows.items()
    }
    mean_m, seconds, rows = mean_pose_m(windows["without"]), time.process_time() - began, []
    for name, people in tests.items():
        mean = errors_of([np.repeat(mean_m[None], len(one), axis=0) for one in people], people)
        metrics = {}
        for alignment, words in ALIGNMENTS.items():
            values = {how: [one[name][alignment] for one in of_seeds] for how, of_seeds in found.items()}
            metrics[alignment] = metric(
                round(float(np.mean(values["with"])), 2), "cm", f"mean distance of 18 joints, {words}",
                baseline={"mean_pose": round(mean[alignment], 2),
                          "without_generated": round(float(np.mean(values["without"])), 2)},
                values={how: [round(value, 2) for value in of] for how, of in values.items()},
            )  # fmt: skip
        rows.append({"dataset": dataset_of(options.data) | {"split": PLACES[name]}, "test": name, "n": len(people),
                     "seeds": list(range(SEEDS)), "seconds": {"all": round(seconds, 1)}, "metrics": metrics,
                     "recorded": len(recorded), "generated": len(more)})  # fmt: skip
    config = {"steps": options.steps, "rooms": options.rooms, "recorded": options.recorded, "tested": options.tested}
    run.write("pose_gain", "simulated_rooms", config=config, rows=rows)


def _rooms(data: RoomSequences, split: str) -> list[int]:
    """Numbers of rooms with sequences of a split, spread over all of them."""
    rng = stream(0, "pose gain", split)
    own = [number for number, room in enumerate(data.rooms) if split in {str(one) for one in room.split}]
    return [int(number) for number in rng.permutation(own)]
