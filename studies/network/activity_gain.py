"""What generated data is worth to a recogniser of activities in a room that nobody has recorded.

    python -m studies run activity_gain --data DATASET --weights WEAVER --recogniser ACTIVITY/weights.safetensors \\
        --rooms 40 --runs RUNS

The recogniser (`mmweaver train activity`) was trained in other rooms. For each room of an unseen kind its head is
fine-tuned, once on recordings of the other rooms alone and once with generated ones of this room added, and evaluated
on the simulated ground truth of the room. All methods generate the same motions, placed in the room as its photo shows
it; they differ in the surroundings. `true_room`, the simulator in the true room, is the oracle. Convolutions are
frozen, and every head is trained for the same number of steps, with one seed per room. Recordings are the data set's,
with all paths, clutter and a typical board for each room; generated ones have another typical board, as `generate`
makes them, with a background recording what it shows of the room's own, and in `true_room` that one.

A second head begins anew and has `--recordings` recordings of other rooms, as somebody has who recorded few (results
`recordings_N`). Finished rooms are cached in `--runs`, and the same command continues. Maps of the other rooms are read
from the folder of the recogniser, where its training left them.
"""

import argparse
import copy
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.board import Board
from mmweaver.core.boards import IDEAL_BOARD, typical_board
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, PoseSequence, RadarCube, Scene
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_plan import ACTIVITIES, PEOPLE_HEIGHT_M, DatasetPlan, RoomSpec, SequenceSpec
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.datasets.room_generation import pose_of
from mmweaver.models.activity_network import ACTIVITY_NAMES, ActivityNetwork, TimeHead, load_activity
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.propagation.diffuse_clutter import seed_of_room
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import ALL_PATHS
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import radar_cube
from mmweaver.training.activity_training import TRAIN_MAPS, TRAIN_SPLITS, activity_examples, compute_log_maps
from studies.manifest import StudyRun
from studies.network.learned_scores import OTHER, board_seen_in, empty_room, interval
from studies.network.room_cache import RoomCache, digest
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

# chosen on rooms of the validation kind
STEPS, OTHERS, OWN, LEARNING_RATE = 200, 24, 8, 3e-4
ANEW_RATE = 2e-3  # of a head that begins anew
ALONE = "other_rooms"  # the head trained on without anything generated


@dataclass(frozen=True)
class UnseenRoom:
    """A room to recognise in, and a room of another kind whose photo is the wrong one."""

    room: StoredRoom
    other: StoredRoom
    generic: StoredRoom
    plan: dict[str, Any]  # of the data set

    @property
    def name(self) -> str:
        return f"{self.room.kind}_{self.room.layout}"

    @cached_property
    def photographed(self) -> Scene:
        return reconstruct(self.room.photo)

    def true_scene(self, room: StoredRoom) -> Scene:
        """The ground truth scene of a stored room."""
        return make_room(room.kind, room.layout, self.plan["seed"]).scene(room.lighting)

    @cached_property
    def own_board(self) -> Board:
        """The board that recorded in the room."""
        room, plan = self.room, self.plan
        spec = RoomSpec(kind=room.kind, layout=room.layout, seed=plan["seed"], lighting=room.lighting, sequences=())
        whole = DatasetPlan(
            kinds=(room.kind,), lightings=(room.lighting,), seed=plan["seed"], board=plan.get("board", "ideal")
        )
        return whole.board_of(spec, room.config)

    @cached_property
    def other_board(self) -> Board:
        """A board sampled by a seed, as signals are generated; ideal where recordings are."""
        if self.own_board.is_ideal:
            return IDEAL_BOARD
        number = int(stream(self.plan["seed"], "activity gain board", self.name).integers(2**31))
        return typical_board(self.room.config, number)


@dataclass(frozen=True, kw_only=True)
class Labelled:
    """Features of each frame of sequences (sequence, frame, feature), and the label of each sequence."""

    frames: Tensor  # (sequence, frame, feature)
    label: Tensor


Maker = Callable[[PoseSequence, int], RadarCube]  # a motion and a seed
Method = Callable[[UnseenRoom], Maker]


def motions_in(room: UnseenRoom, each: int, seed: int) -> list[tuple[str, PoseSequence]]:
    """`each` motions of every activity, placed in the room of the photo; motions without a place are omitted."""
    rng, motions = stream(seed, "activity gain", room.name), []
    withheld = set(read_plan(Path(room.room.folder.parent))["withheld"]["test_people"])
    people = [person for person in range(len(PEOPLE_HEIGHT_M)) if person not in withheld]
    for activity, sentences in ACTIVITIES.items():
        for number in range(each):
            spec = SequenceSpec(
                index=number, person=int(rng.choice(people)), activity=activity, text=str(rng.choice(sentences)),
                seed=int(rng.integers(2**31)), split="",
            )  # fmt: skip
            try:
                pose = pose_of(spec, room.photographed, room.room.config, room.room.joints_m.shape[1])
            except InputError:
                continue
            motions.append((activity, replace(pose, subject=OTHER + spec.person)))
    return motions


def simulated_in(
    scene_of: Callable[[UnseenRoom], Scene], *, micro_seed: int, board_of: Callable[[UnseenRoom], Board]
) -> Method:
    """The simulator in some room, with some board."""

    def method(room: UnseenRoom) -> Maker:
        scene = scene_of(room)
        simulator = Simulator(
            scene, room.room.config, micro_seed=seed_of_room(scene) + micro_seed, propagation=ALL_PATHS,
            board=board_of(room),
        )  # fmt: skip
        num_frames = room.room.joints_m.shape[1]

        def make(pose: PoseSequence, seed: int) -> RadarCube:
            chunks = simulator.chunks(pose, num_frames=num_frames, seed=seed)
            values = np.concatenate([radar_cube(chunk).values for chunk in chunks])
            grid = CubeGrid.of(simulator.config, num_frames)
            return RadarCube(values=values, grid=grid, config=simulator.config, scale=1.0)

        return make

    return method


def with_generated(
    network: WeaverNetwork, scene_of: Callable[[UnseenRoom], Scene], *, recorded: bool = False
) -> Method:
    """The network with a photo, and with `recorded` a background recording too."""

    def method(room: UnseenRoom) -> Maker:
        config, num_frames = room.room.config, room.room.joints_m.shape[1]
        empty, board = None, room.other_board
        if recorded:
            empty = empty_room(room.true_scene(room.room), config, num_frames, OTHER, room.own_board)
            board = board_seen_in(empty, room.own_board)
        learned = LearnedRoom(network, scene_of(room), config, room_seed=1, background=empty, board=board)
        return lambda pose, seed: learned.cube([FrameMotion.of(pose, config, num_frames)], seed=seed)

    return method


def unseen_rooms(
    rooms: list[StoredRoom], plan: dict[str, Any], most: int, split: str = "test_room"
) -> list[UnseenRoom]:
    """Rooms of unseen kinds, the kinds in turn, each with a wrong photo of another of these kinds."""
    chosen = sorted((room for room in rooms if split in room.split), key=lambda room: (room.layout, room.kind))
    if not chosen:
        raise InputError(f"the data set has no sequences of split {split!r}")
    generic = next(room for room in rooms if "train" in room.split)
    found = []
    for room in chosen[:most]:
        others = [other for other in chosen if other.kind != room.kind] or [generic]
        found.append(UnseenRoom(room, others[room.layout % len(others)], generic, plan))
    return found


def labelled(network: ActivityNetwork, cubes: Iterable[RadarCube], names: list[str]) -> Labelled:
    """Features of cubes by the convolutions of the network, with labels."""
    doppler, angle = compute_log_maps(cubes, network.config)
    return Labelled(frames=seen(network, doppler, angle), label=torch.tensor([ACTIVITY_NAMES.index(n) for n in names]))


def seen(network: ActivityNetwork, doppler: Tensor, angle: Tensor) -> Tensor:
    """Features (sequence, frame, feature), computed for a few sequences at a time."""
    with torch.no_grad():
        parts = zip(doppler.split(32), angle.split(32), strict=True)
        return torch.cat([network.frames(one.float(), other.float()) for one, other in parts])


@dataclass(frozen=True)
class GainStudy:
    """A recogniser, features of recordings of other rooms, and whether its head is initialised anew."""

    network: ActivityNetwork
    base: Labelled
    begins_anew: bool = False

    def head(self) -> TimeHead:
        """The head that is fine-tuned."""
        head = copy.deepcopy(self.network.head)
        if self.begins_anew:
            for part in head.modules():
                if isinstance(part, nn.Linear | nn.Conv1d):
                    part.reset_parameters()
        return head


def evaluated(study: GainStudy, own: Labelled | None, test: Labelled, seed: int) -> tuple[float, float]:
    """Accuracy and log loss on test sequences after fine-tuning the head; a quarter of each batch is of the room."""
    torch.manual_seed(seed)
    head, rng = study.head(), stream(seed, "activity gain head")
    rate = ANEW_RATE if study.begins_anew else LEARNING_RATE
    adam = torch.optim.AdamW(head.parameters(), lr=rate, weight_decay=1e-2)
    head.train()
    for _ in range(STEPS):
        parts = [_sampled(study.base, OTHERS, rng), _sampled(study.base if own is None else own, OWN, rng)]
        frames, label = (torch.cat(each) for each in zip(*parts, strict=True))
        loss = torch.nn.functional.cross_entropy(head(frames), label, label_smoothing=0.1)
        adam.zero_grad()
        loss.backward()
        adam.step()
    head.eval()
    with torch.no_grad():
        scores = head(test.frames)
    hits = (scores.argmax(dim=1) == test.label).float().mean()
    return float(hits), float(torch.nn.functional.cross_entropy(scores, test.label))


def _sampled(examples: Labelled, count: int, rng: np.random.Generator) -> tuple[Tensor, Tensor]:
    chosen = torch.from_numpy(rng.integers(len(examples.label), size=count))
    return examples.frames[chosen], examples.label[chosen]


Found = dict[str, dict[str, Any]]  # {study: {method: accuracy and log loss, of a room or of each room (room, 2)}}


def gained(
    studies: dict[str, GainStudy], room: UnseenRoom, methods: dict[str, Method], *, each: int, seed: int,
    split: str = "test_room",
) -> Found:  # fmt: skip
    """What the data of each method are worth in one room, and the head fine-tuned without generated data.

    The studies share their convolutions, so that signals are made and seen once.
    """
    network = next(iter(studies.values())).network
    indices = [index for index, name in enumerate(room.room.split) if name == split]
    names = [room.room.activity[index] for index in indices]
    test = labelled(network, (room.room.cube(index) for index in indices), names)
    motions = motions_in(room, each, seed=0)
    found: Found = {key: {ALONE: list(evaluated(study, None, test, seed))} for key, study in studies.items()}
    for name, method in methods.items():
        make = method(room)
        cubes = (make(pose, number) for number, (_, pose) in enumerate(motions))
        own = labelled(network, cubes, [activity for activity, _ in motions])
        for key, study in studies.items():
            found[key][name] = list(evaluated(study, own, test, seed))
    return found


def gains(
    studies: dict[str, GainStudy],
    rooms: list[UnseenRoom],
    methods: dict[str, Method],
    *,
    each: int,
    cache: RoomCache,
    split: str = "test_room",
    after: Callable[[Found], object] = lambda found: None,
) -> Found:
    """Accuracy and log loss in each room; `after` is called with the results so far after each room."""
    rows: list[Found] = []
    for seed, room in enumerate(rooms):
        rows.append(
            cache.figures(room.name, partial(gained, studies, room, methods, each=each, seed=seed, split=split))
        )
        after(_together(rows))
    return _together(rows)


def _together(rooms: list[Found]) -> Found:
    """Values of all rooms, (room, 2)."""
    return {
        key: {name: np.array([room[key][name] for room in rooms]) for name in methods}
        for key, methods in rooms[0].items()
    }


def rows_of(found: dict[str, np.ndarray], rooms: list[str]) -> list[dict[str, Any]]:
    """One row a method: accuracy and log loss of the named rooms, and the gain over training on other rooms alone."""
    names, rows = rooms[: len(found[ALONE])], []
    for method, values in found.items():
        better = values - found[ALONE]
        columns = {
            "accuracy": (values[:, 0], "1"), "gain": (better[:, 0], "1"),
            "log_loss": (values[:, 1], "nat"), "log_loss_gain": (-better[:, 1], "nat"),
        }  # fmt: skip
        metrics: dict[str, dict[str, Any]] = {}
        for metric, (each, unit) in columns.items():
            mean, low, high = interval(each, names)
            metrics[metric] = {"value": mean, "interval_95": [low, high], "unit": unit}
        metrics["accuracy"]["baseline"] = {"chance": 1 / len(ACTIVITY_NAMES)}
        rows.append({"method": method, "n": len(names), "num_rooms": len(names), "metrics": metrics})
    return rows


def gain_studies(recogniser_file: Path, data: Path, recordings: int) -> dict[str, GainStudy]:
    """By the name of its result: the recogniser with all recordings of other rooms that it was trained on, and with so
    many and a head that begins anew.
    """
    examples = activity_examples(data, TRAIN_SPLITS, recogniser_file.parent / TRAIN_MAPS, keep=False)
    recogniser = load_activity(recogniser_file, examples.config)
    whole = Labelled(frames=seen(recogniser, examples.doppler, examples.angle), label=examples.label)
    few = torch.from_numpy(few_of(examples.label.numpy(), recordings))
    part = Labelled(frames=whole.frames[few], label=whole.label[few])
    return {
        "test_room": GainStudy(recogniser, whole),
        f"recordings_{recordings}": GainStudy(recogniser, part, begins_anew=True),
    }


def few_of(label: np.ndarray, count: int) -> np.ndarray:
    """Indices of `count` sequences, alternating between activities."""
    rng = stream(0, "activity gain recordings")
    order = rng.permutation(len(label))
    place = np.zeros(len(label), int)  # how many of its activity come before
    for name in np.unique(label):
        own = order[label[order] == name]
        place[own] = np.arange(len(own))
    return order[np.argsort(place[order], kind="stable")][:count]


def methods_of(weaver: WeaverNetwork) -> dict[str, Method]:
    """The methods whose data is compared."""
    physics = partial(simulated_in, board_of=lambda room: room.other_board)
    return {
        "weaver": with_generated(weaver, lambda room: room.photographed),
        "weaver_with_background": with_generated(weaver, lambda room: room.photographed, recorded=True),
        "wrong_photo": with_generated(weaver, lambda room: reconstruct(room.other.photo)),
        "generic_room_physics": physics(lambda room: room.true_scene(room.generic), micro_seed=1),
        "physics_in_photographed_room": physics(lambda room: room.photographed, micro_seed=1),
        "true_room": simulated_in(
            lambda room: room.true_scene(room.room), micro_seed=0, board_of=lambda room: room.own_board
        ),
    }


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument("--weights", type=Path, action=Reads, help="of recipe weaver (default: those included)")
    parser.add_argument("--recogniser", type=Path, action=Reads, required=True, help="of recipe activity")
    parser.add_argument("--rooms", type=int, default=40)
    parser.add_argument("--each", type=int, default=2, help="generated motions of each activity")
    parser.add_argument("--recordings", type=int, default=60, help="of other rooms, for a head that begins anew")
    parser.add_argument("--runs", type=Path, help="folder for rooms that are done")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    plan, weights = read_plan(options.data), options.weights or shipped_weights()
    rooms = unseen_rooms(read_rooms(options.data), plan, options.rooms)
    weaver, card = load_weights(weights)
    studies = gain_studies(options.recogniser, options.data, options.recordings)
    methods = methods_of(weaver)
    about = {"weights": asdict(card), "data_plan": plan, "each": options.each, "steps": STEPS}
    files = [digest(file) for file in (weights, options.recogniser)]
    names = [room.name for room in rooms]
    cache = RoomCache(
        options.runs, {**about, "recordings": options.recordings, "files": files, "methods": list(methods)}
    )

    def write(found: Found) -> None:
        for key, values in found.items():
            rows = complete_rows(
                rows_of(values, names), dataset={**dataset_of(options.data), "split": "test_room"}, baselines=(ALONE,),
                oracles=("true_room",), seeds=list(range(len(values[ALONE]))),
                unknown={"seconds": "see the manifest: all rows together"},
            )  # fmt: skip
            recordings = len(studies[key].base.label)
            run.write("activity_gain", key, config={**about, "recordings": recordings}, rows=rows)
            room = names[len(values[ALONE]) - 1]
            print(f"{key} {room:18}", *(f"{name} {one[-1, 0]:.2f}" for name, one in values.items()), flush=True)

    for key, found in gains(studies, rooms, methods, each=options.each, cache=cache, after=write).items():
        for row in rows_of(found, names):
            values = (f"{name} {m['value']:.3f} {m['interval_95']}" for name, m in row["metrics"].items())
            print(f"{key} {row['method']:30}", *values)
