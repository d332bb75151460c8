"""The network in rooms it has never seen, compared with baselines, the simulator and an oracle.

    python -m studies run learned_scores --data DATASET --weights FILE
    python -m studies run learned_scores --data DATASET --weights FILE --split test_person --most 40
    python -m studies run learned_scores --data DATASET --power weights/paper_power.safetensors --called paper_power
    python -m studies run learned_scores --data OF_ANOTHER_RADAR --other-radar hupr

Ground truth is the simulator in the true room, with all paths and clutter, and every method is given the exact joints.
`realization` is the same simulator with other surface micro-phases of room and person: the oracle for methods that
cannot know them. `realization_skin` knows those of the room, and `weaver_with_background` was given a recording of the
room without the person. `static_mean` is that of the ground truth itself, `training_mean` and `nearest_training_pose`
those of the rooms trained on. `paper_power` is the idea of the paper's network with power as its target, also shown
another room's photo, and before training; `energy_db`, the energy of a cube over that of the ground truth,
shows whether it has collapsed. Intervals: bootstrap over rooms.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.boards import IDEAL_BOARD
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube, Scene
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_plan import SequenceSpec
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.datasets.room_generation import generate_sequence, pose_of
from mmweaver.evaluation.background_board import BackgroundBoard
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.hypernetwork_rooms import FieldRoom, load_hypernetwork
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.power_network import PowerNetwork
from mmweaver.models.scatterer_network import ScattererNetwork
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.propagation.diffuse_clutter import seed_of_room
from mmweaver.propagation.paths import FrameClock
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import ALL_PATHS, Propagation
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import radar_cube
from mmweaver.training.hypernetwork_training import HypernetworkRecipe, initial_power_network
from studies.manifest import StudyRun
from studies.network.room_cache import RoomCache, digest
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, scorecard
from studies.study import Reads

COLUMNS = (
    "rd_ssim", "ra_ssim", "rd_ssim_all_cells", "ra_ssim_all_cells", "rd_difference_db", "ra_difference_db",
    "magnitude_nmse_db", "antenna_phase_error_rad", "chamfer_m", "hausdorff_m",
)  # fmt: skip
BASELINES, ORACLES = ("zeros", "generic_room_physics"), ("realization",)
WEAVER_ROWS = ("weaver", "weaver_with_background", "wrong_photo")
POWER_ROWS = ("paper_power", "paper_power_wrong_photo", "paper_power_untrained")
SAME_M = 1e-4
OTHER = 1000  # added to a person's number for other skin


@dataclass(frozen=True)
class Case:
    """One sequence of an unseen room, with everything a method may use."""

    room: StoredRoom
    index: int
    other: StoredRoom  # the room of the wrong photo
    seed_of_plan: int
    lighting: str

    @cached_property
    def spec(self) -> SequenceSpec:
        room = self.room
        return SequenceSpec(
            index=self.index, person=int(room.person[self.index]), activity=room.activity[self.index],
            text=room.text[self.index], seed=int(room.seed[self.index]), split=room.split[self.index],
        )  # fmt: skip

    @cached_property
    def true_scene(self) -> Scene:
        return make_room(self.room.kind, self.room.layout, self.seed_of_plan).scene(self.lighting)

    @cached_property
    def truth(self) -> RadarCube:
        """The ground truth, with all paths."""
        return true_cube(self.room, self.index, self.seed_of_plan)

    @property
    def joints(self) -> tuple[np.ndarray, np.ndarray]:
        return self.room.joints_m[self.index], self.room.joint_velocity_mps[self.index]

    @property
    def motion(self) -> FrameMotion:
        """Of the person with other skin: the joints that the data set keeps, in long frames those of every segment."""
        (joints_m, velocity_mps), subject, config = self.joints, OTHER + self.spec.person, self.room.config
        if len(FrameClock(config).segments) == 1:
            return FrameMotion(joints_m=joints_m, velocity_mps=velocity_mps, subject=subject)
        pose = pose_of(self.spec, self.true_scene, config, len(joints_m))
        return FrameMotion.of(replace(pose, subject=subject), config, len(joints_m))


Method = Callable[[Case], RadarCube]
BoardOf = Callable[[Case], Board]


def ideal_board(case: Case) -> Board:
    """The board of all scores: errors of an unknown one would add to what is asked of the paths."""
    return IDEAL_BOARD


def true_cube(room: StoredRoom, index: int, seed_of_plan: int, board: Board = IDEAL_BOARD) -> RadarCube:
    """One sequence simulated anew, with all paths: what the data set keeps may be geometry of first order."""
    case = Case(room, index, room, seed_of_plan, room.lighting)
    return _simulated(case, case.true_scene, 0, ALL_PATHS, board, subject=None, noise_seed=None)[1]


def simulated(
    scene_of: Callable[[Case], Scene], *, skin: int = 0, micro_seed: int = 0, propagation: Propagation = ALL_PATHS,
    board_of: BoardOf = ideal_board,
) -> Method:  # fmt: skip
    """The simulator in some room, always with another noise seed than the ground truth."""

    def method(case: Case) -> RadarCube:
        spec = case.spec
        joints_m, cube = _simulated(
            case, scene_of(case), micro_seed, propagation, board_of(case), subject=spec.person + skin,
            noise_seed=spec.seed + OTHER,
        )  # fmt: skip
        if np.abs(joints_m - case.joints[0]).max() > SAME_M:
            raise InputError("the data set's people move otherwise in this version; make it again")
        return cube

    return method


def _simulated(
    case: Case, scene: Scene, micro_seed: int, propagation: Propagation, board: Board, *, subject: int | None,
    noise_seed: int | None,
) -> tuple[np.ndarray, RadarCube]:  # fmt: skip
    """Joints at the frames, and the cube."""
    config, frames = case.room.config, len(case.joints[0])
    seed = seed_of_room(scene) + micro_seed
    simulator = Simulator(scene, config, micro_seed=seed, propagation=propagation, board=board)
    made = generate_sequence(case.spec, case.true_scene, simulator, frames, subject=subject, noise_seed=noise_seed)
    assert made.cube is not None
    return made.joints_m, made.cube


def learned(
    network: ScattererNetwork, room_of: Callable[[Case], StoredRoom], *, recorded: bool = False,
    board_of: BoardOf = ideal_board,
) -> Method:  # fmt: skip
    """The network with a photo, and with `recorded` as many frames of background recording as the sequence has.

    `board_of`: the board whose errors the signal has; with `recorded` that of the recording, as far as it shows it.
    """

    def method(case: Case) -> RadarCube:
        config, board, empty = case.room.config, board_of(case), None
        if recorded:
            empty = empty_room(case.true_scene, config, len(case.joints[0]), case.spec.seed + OTHER, board)
            board = board_seen_in(empty, board)
        room = reconstruct(room_of(case).photo)
        room_type = FieldRoom if isinstance(network, PowerNetwork) else LearnedRoom
        learned_room = room_type(network, room, config, room_seed=1, background=empty, board=board)
        return learned_room.cube([case.motion], seed=case.index)

    return method


def empty_room(scene: Scene, config: RadarConfig, num_frames: int, seed: int, board: Board = IDEAL_BOARD) -> RadarCube:
    """The radar's recording of a room with nobody in it, with noise."""
    simulator = Simulator(scene, config, micro_seed=seed_of_room(scene), propagation=ALL_PATHS, board=board)
    return radar_cube(simulator.run((), num_frames=num_frames, seed=seed).adc)


def board_seen_in(background: RadarCube, recorded_by: Board) -> Board:
    """What `generate` takes for the board of a background recording; an ideal one is taken to be known."""
    return recorded_by if recorded_by.is_ideal else BackgroundBoard().of(background)


def nearest(train: list[StoredRoom], seed_of_plan: int) -> Method:
    """The recorded training sequence whose joints are nearest in the frame of the radar."""
    pool = [(room, index) for room in train for index, split in enumerate(room.split) if split == "train"]
    joints = np.stack([room.joints_m[index] for room, index in pool])

    def method(case: Case) -> RadarCube:
        gap = np.linalg.norm(joints - case.joints[0][None], axis=-1).mean(axis=(1, 2))
        room, index = pool[int(gap.argmin())]
        return true_cube(room, index, seed_of_plan)

    return method


def training_mean(train: list[StoredRoom], seed_of_plan: int, most: int = 60) -> Method:
    """The mean of one sequence of each training room over frames and rooms: a static mean without the ground truth."""
    found = [(room, room.split.index("train")) for room in train if "train" in room.split][:most]

    @lru_cache(maxsize=1)
    def mean() -> np.ndarray:
        each = np.stack([true_cube(room, index, seed_of_plan).values.mean(axis=0) for room, index in found])
        return each.mean(axis=0, dtype=np.complex128).astype(np.complex64)

    def method(case: Case) -> RadarCube:
        like = case.truth
        return replace(like, values=np.repeat(mean()[None], len(like.values), axis=0))

    return method


def scored(
    cases: list[Case], methods: dict[str, Method], caches: dict[str, RoomCache] | None = None
) -> dict[str, dict[str, np.ndarray]]:
    """{method: {column: value of each case}}, with baselines and CPU seconds. `caches`: of each method's scores."""
    rows: dict[str, dict[str, list[float]]] = {}
    for case in cases:
        for number, (name, method) in enumerate(methods.items()):
            cache = (caches or {}).get(name, RoomCache(None, {}))
            each = cache.figures(f"{case.room.folder.name}_{case.index}", partial(_scores, case, method))
            for row, values in {**(each["baselines"] if number == 0 else {}), name: each["own"]}.items():
                for column, value in values.items():
                    rows.setdefault(row, {}).setdefault(column, []).append(value)
    return {name: {column: np.array(values) for column, values in row.items()} for name, row in rows.items()}


def _scores(case: Case, method: Method) -> dict[str, Any]:
    """Scores of a method and of the baselines in one case."""
    truth = case.truth
    began = time.process_time()
    cube = method(case)
    seconds = time.process_time() - began
    card = scorecard(cube, truth)
    floors = {
        name: {
            **_columns(values), "magnitude_nmse_db": _magnitude_nmse_db(_floor_cube(name, truth), truth), "cpu_s": 0.0,
        }
        for name, values in card.baselines.items()
    }  # fmt: skip
    own = {
        "magnitude_nmse_db": _magnitude_nmse_db(cube, truth), "energy_db": energy_db(cube, truth), "cpu_s": seconds,
    }  # fmt: skip
    return {"own": {**_columns(card.prediction), **own}, "baselines": floors}


def _columns(values: dict[str, float]) -> dict[str, float]:
    return {name: values[name] for name in COLUMNS if name in values}


def _floor_cube(name: str, truth: RadarCube) -> RadarCube:
    from studies.scores.cube_scores import BASELINES

    return BASELINES[name](truth)


def _magnitude_nmse_db(cube: RadarCube, truth: RadarCube) -> float:
    """Squared error of |cube| over the energy of the ground truth: independent of phases."""
    error = np.abs(cube.values) - np.abs(truth.values)
    return float(10 * np.log10((error**2).sum() / (np.abs(truth.values) ** 2).sum()))


def energy_db(cube: RadarCube, truth: RadarCube) -> float:
    """The energy of a cube over that of the ground truth; very low for a method that has collapsed to zeros."""
    energy = [float((np.abs(each.values).astype(np.float64) ** 2).sum()) for each in (cube, truth)]
    return float(10 * np.log10(max(energy[0], 1e-30) / energy[1]))


def interval(values: np.ndarray, rooms: list[str], seed: int = 0) -> tuple[float, float, float]:
    """Mean and 95 % bootstrap interval over rooms."""
    names = sorted(set(rooms))
    means = np.array([np.nanmean(values[[room == name for room in rooms]]) for name in names])
    rng = stream(seed, "bootstrap")
    draws = np.nanmean(means[rng.integers(len(names), size=(2000, len(names)))], axis=1)
    return float(np.nanmean(means)), float(np.percentile(draws, 2.5)), float(np.percentile(draws, 97.5))


def generic_scene_of(rooms: list[StoredRoom], plan: dict[str, Any]) -> Scene:
    """The scene of some other room, the same for all: the first office."""
    generic = next(room for room in rooms if room.kind == "office" and room.layout == 0)
    return make_room(generic.kind, generic.layout, plan["seed"]).scene(generic.lighting)


def cases_of(
    rooms: list[StoredRoom], split: str, each: int, plan: dict[str, Any], seed: int, most: int | None = None
) -> list[Case]:
    """`each` sequences of every room that has the split, or of at most `most` rooms.

    The wrong photo is that of a room of another kind.
    """
    rng = stream(seed, "cases", split)
    chosen = [room for room in rooms if split in room.split]
    if most is not None and most < len(chosen):
        chosen = [chosen[int(index)] for index in np.sort(rng.choice(len(chosen), size=most, replace=False))]
    cases = []
    for room in chosen:
        others = [other for other in chosen if other.kind != room.kind] or [o for o in rooms if o.kind != room.kind]
        indices = [index for index, name in enumerate(room.split) if name == split]
        for index in rng.choice(indices, size=min(each, len(indices)), replace=False):
            other = others[int(rng.integers(len(others)))]
            cases.append(Case(room, int(index), other, plan["seed"], room.lighting))
    return cases


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument("--weights", type=Path, action=Reads, help="of recipe weaver (default: those included)")
    parser.add_argument("--power", type=Path, action=Reads, help="of target power, for a row of its own")
    parser.add_argument("--split", default="test_room")
    parser.add_argument("--each", type=int, default=1, help="sequences of each room")
    parser.add_argument("--most", type=int, help="rooms, sampled at random (default: all that have the split)")
    parser.add_argument("--runs", type=Path, help="folder for what is done, to go on from")
    parser.add_argument("--called", metavar="NAME", help="the result's name (default: the split)")
    parser.add_argument("--other-radar", metavar="NAME", help="data of another radar or length: a result of this name")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    weights = options.weights or shipped_weights()
    network, card = load_weights(weights)
    rooms, plan = read_rooms(options.data), read_plan(options.data)
    cases = cases_of(rooms, options.split, options.each, plan, 0, options.most)
    generic_scene = generic_scene_of(rooms, plan)
    methods: dict[str, Method] = {
        "weaver": learned(network, lambda case: case.room),
        "weaver_with_background": learned(network, lambda case: case.room, recorded=True),
        "wrong_photo": learned(network, lambda case: case.other),
        "training_mean": training_mean(rooms, plan["seed"]),
        "nearest_training_pose": nearest(rooms, plan["seed"]),
        "generic_room_physics": simulated(lambda case: generic_scene, skin=OTHER, micro_seed=1),
        "physics_in_photographed_room": simulated(lambda case: reconstruct(case.room.photo), skin=OTHER, micro_seed=1),
        "realization_skin": simulated(lambda case: case.true_scene, skin=OTHER),
        "realization": simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1),
    }
    about = {"weights": card.__dict__, "data_plan": plan, "each": options.each}
    if options.power is not None:
        power, power_card = load_hypernetwork(options.power)
        assert isinstance(power, PowerNetwork), "weights of target power"
        methods["paper_power"] = learned(power, lambda case: case.room)
        methods["paper_power_wrong_photo"] = learned(power, lambda case: case.other)
        recipe = HypernetworkRecipe()
        methods["paper_power_untrained"] = learned(initial_power_network(recipe).eval(), lambda case: case.room)
        about["paper_power"] = power_card.__dict__
    names = [f"{case.room.kind}_{case.room.layout}" for case in cases]
    of = dict.fromkeys(WEAVER_ROWS, weights) | dict.fromkeys(POWER_ROWS, options.power)
    made_by = {name: digest(of[name]) if name in of else None for name in methods}
    caches = {
        name: RoomCache(options.runs, {"data_plan": plan, "row": name, "weights": made_by[name]}) for name in methods
    }
    table = scored(cases, methods, caches)
    rows = [_row(name, values, names, options.split) for name, values in table.items()]
    rows = complete_rows(
        rows, dataset=dataset_of(options.data), seeds=[0], baselines=BASELINES, oracles=ORACLES,
        unknown={"seconds": "metric cpu_s has those of each method"},
    )  # fmt: skip
    folder = "other_radars" if options.other_radar else "learned_scores"
    run.write(folder, options.other_radar or options.called or options.split, config=about, rows=rows)
    for row in rows:
        values = (f"{name} {metric['value']:.3f}" for name, metric in row["metrics"].items())
        print(f"{row['method']:30}", *values, flush=True)


def _row(name: str, values: dict[str, np.ndarray], rooms: list[str], split: str) -> dict[str, Any]:
    metrics = {}
    for column, each in values.items():
        mean, low, high = interval(each, rooms)
        known = METRICS.get(column)
        metrics[column] = {
            "value": _number(mean), "interval_95": [_number(low), _number(high)],
            "unit": known.unit if known else {"cpu_s": "s"}.get(column, "dB"),
        }  # fmt: skip
    return {"method": name, "split": split, "n": len(rooms), "num_rooms": len(set(rooms)), "metrics": metrics}


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None
