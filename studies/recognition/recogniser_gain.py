"""What do generated recordings add to a CNN-LSTM on range-angle images, and to our recogniser?

    mmweaver dataset train/ --rooms office,lab,kitchen,library,bedroom,meeting_room,corridor,gym --layouts 4 \\
        --sequences 24 --geometry-only
    mmweaver dataset rooms/ --rooms living_room,classroom,workshop --layouts 24 --sequences 16 --geometry-only
    python -m studies run recogniser_gain --data train/ --unseen rooms/ --runs build/recognisers

Recordings are the simulator's in the true rooms: some of `--data` to learn from, and to test others of the same rooms
and people (`seen`), rooms of unseen kinds (`unseen_room`), and a person never seen in the rooms seen (`unseen_user`).
A quarter of each batch is generated, in the rooms tested from their photos (`weaver`), in one room of the training set
(`generic_room`), by RF-Genesis repaired, body alone, with its best loudness and the receiver's noise, and for the user
test of the new person's height (`new_person`) or of people known (`known_people`). Baseline: recordings alone, the same
number of steps. Oracle: recordings of the tested rooms or person instead of generated ones. Result `clutter` has the
same answers in unseen rooms, by thirds of the rooms from little to much furniture.

Networks: `cnn_lstm` (T x 32 x 32 range-angle images, as the paper's), trained anew each time; `ours`, range-Doppler and
range-angle maps, convolutions trained on the recordings and a new head each time (as study `activity_gain`).
"""

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M
from mmweaver.datasets.dataset_store import StoredRoom, read_plan, read_rooms
from mmweaver.models.activity_network import ACTIVITY_NAMES, ActivityNetwork, TimeHead
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.training.activity_training import (
    TRAIN_SPLITS,
    ActivityExamples,
    ActivityRecipe,
    activity_examples,
    augmented,
)
from studies.manifest import StudyRun
from studies.network.activity_gain import few_of, seen
from studies.network.clutter import CLUTTER, clutter_of, third_of
from studies.network.learned_scores import interval
from studies.network.room_cache import RoomCache, digest
from studies.recognition.cnn_lstm import CnnLstm, range_angle_images, trained
from studies.recognition.generated_recordings import (
    Motion,
    PhotographedRoom,
    Recordings,
    as_loud_with_noise,
    by_network,
    made_by,
    motions,
    recorded,
)
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

RECORDINGS, SEEN, UNSEEN, OF_ROOMS, OF_PERSON = 60, 36, 96, 48, 60  # to learn from, to test, and of what is tested
GENERATED, TRACED = 72, 24  # by the network; by RF-Genesis, whose cost bounds it
BATCH, ADDED = 24, 8
STEPS, BASE_STEPS, HEAD_STEPS = 200, 120, 200
SEEDS = (0,)
ALONE = "recordings_alone"
NETWORKS = ("cnn_lstm", "ours")
ORACLES = {"unseen_room": "recordings_of_the_rooms", "unseen_user": "recordings_of_the_person"}
CLUTTER_ROWS = (ALONE, "weaver", "generic_room", f"rf_genesis_{TRACED}", ORACLES["unseen_room"])


@dataclass(frozen=True)
class GainData:
    """Recordings to learn from and to test, and everything generated, computed when asked for."""

    data: Path
    unseen: Path
    runs: Path

    def _examples(self, folder: Path, splits: tuple[str, ...], most: int, name: str) -> ActivityExamples:
        return activity_examples(folder, splits, self.runs / f"{name}.safetensors", pick=partial(few_of, count=most))

    @cached_property
    def _known(self) -> ActivityExamples:
        return self._examples(self.data, TRAIN_SPLITS, RECORDINGS + SEEN, "known")

    @cached_property
    def _rooms(self) -> ActivityExamples:
        return self._examples(self.unseen, ("test_room",), UNSEEN + OF_ROOMS, "rooms")

    @cached_property
    def _person(self) -> ActivityExamples:
        return self._examples(self.data, ("test_person",), OF_PERSON, "person")

    @cached_property
    def recordings(self) -> Recordings:
        return part_of(self._known, slice(0, RECORDINGS))

    def tests(self) -> dict[str, tuple[Recordings, list[str]]]:
        """{test: recordings, and what the interval is over: rooms, or for one person the sequences}."""
        seen_part, room_part = slice(RECORDINGS, None), slice(0, UNSEEN)
        person = slice(0, None, 2)
        return {
            "seen": (part_of(self._known, seen_part), list(self._known.room[seen_part])),
            "unseen_room": (part_of(self._rooms, room_part), list(self._rooms.room[room_part])),
            "unseen_user": (part_of(self._person, person), list(self._person.room[person])),
        }

    def clutter(self) -> dict[str, float]:
        """{room: share of its floor that furniture covers} of the rooms of test `unseen_room`."""
        seed, tested = read_plan(self.unseen)["seed"], set(self.tests()["unseen_room"][1])
        rooms = {f"{room.kind}_{room.layout}": room for room in read_rooms(self.unseen)}
        return {
            name: clutter_of(make_room(room.kind, room.layout, seed).scene(room.lighting), room.config)
            for name, room in rooms.items()
            if name in tested
        }

    def added(self) -> dict[str, Callable[[], Recordings | None]]:
        """What is added to the recordings, by name."""
        network, _ = load_weights(shipped_weights())
        rooms, own = (photographed(read_rooms(folder))[::3] for folder in (self.unseen, self.data))
        withheld = list(read_plan(self.data)["withheld"]["test_people"])
        people = [person for person in range(len(PEOPLE_HEIGHT_M)) if person not in withheld]
        found = cache(lambda: list(motions(rooms, people, GENERATED, "rooms")))
        with_photo, generic = by_network(network, lambda room: room), by_network(network, lambda _: own[0])
        return {
            ALONE: lambda: None,
            "weaver": lambda: made_by(with_photo, found()),
            "generic_room": lambda: made_by(generic, found()),
            "recordings_of_the_rooms": lambda: part_of(self._rooms, slice(UNSEEN, None)),
            "new_person": lambda: made_by(with_photo, list(motions(own, withheld, GENERATED, "person"))),
            "recordings_of_the_person": lambda: part_of(self._person, slice(1, None, 2)),
            "known_people": lambda: made_by(with_photo, list(motions(own, people, GENERATED, "person"))),
            f"weaver_{TRACED}": lambda: made_by(with_photo, found()[:TRACED]),
            f"rf_genesis_{TRACED}": lambda: traced(found()[:TRACED], self.recordings),
        }


def photographed(rooms: list[StoredRoom]) -> list[PhotographedRoom]:
    return [PhotographedRoom(room) for room in rooms]


def part_of(examples: ActivityExamples, part: slice) -> Recordings:
    """Some sequences of a data set."""
    return Recordings(doppler=examples.doppler[part], angle=examples.angle[part], label=examples.label[part])


def traced(found: list[Motion], like: Recordings) -> Recordings:
    """RF-Genesis' recordings of motions, repaired, body alone."""
    from studies.peers.rf_genesis import RfGenesis  # needs mitsuba

    tracer = RfGenesis(repaired=True, has_environment=False)
    cubes = [tracer.cube(pose, room.config, room.num_frames) for _, pose, room in found]
    return recorded(as_loud_with_noise(cubes, like), found)


# networks -----------------------------------------------------------------------------------------------------------
def drawn(recordings: Recordings, added: Recordings | None, rng: np.random.Generator) -> tuple[Tensor, Tensor, Tensor]:
    """An augmented batch of maps, a quarter of it of what is added."""
    parts = [recordings.part(rng.integers(len(recordings), size=BATCH))]
    other = recordings if added is None else added
    parts.append(other.part(rng.integers(len(other), size=ADDED)))
    doppler, angle, label = (torch.cat([getattr(one, name) for one in parts]) for name in ("doppler", "angle", "label"))
    return *augmented(doppler, angle, rng), label


def cnn_lstm_answers(data: GainData, added: Recordings | None, tests: list[Recordings], seed: int) -> list[Tensor]:
    """Answers of a CNN-LSTM trained anew."""

    def draw(rng: np.random.Generator) -> tuple[Tensor, ...]:
        _, angle, label = drawn(data.recordings, added, rng)
        return range_angle_images(angle), label

    torch.manual_seed(seed)
    network = CnnLstm(len(ACTIVITY_NAMES))
    with torch.no_grad():
        network(range_angle_images(data.recordings.angle[:1]))  # sizes its lazy layer
    trained(network, draw, STEPS, seed)
    with torch.no_grad():
        return [network(range_angle_images(test.angle)).argmax(dim=1) for test in tests]


def base_network(data: GainData) -> ActivityNetwork:
    """Our recogniser trained on the recordings alone, kept in the folder of runs."""
    torch.manual_seed(0)
    network = ActivityNetwork(data._known.config)
    half = ActivityRecipe().batch_size

    def draw(rng: np.random.Generator) -> tuple[Tensor, ...]:
        chosen = data.recordings.part(rng.integers(len(data.recordings), size=half))
        return *augmented(chosen.doppler, chosen.angle, rng), chosen.label

    trained(network, draw, BASE_STEPS, 0)
    return network


def our_answers(
    network: ActivityNetwork, data: GainData, added: Recordings | None, tests: list[Recordings], seed: int
) -> list[Tensor]:
    """Answers of our recogniser with a new head."""
    recordings = data.recordings
    features = [seen(network, one.doppler, one.angle) for one in (recordings, added or recordings)]
    labels = [one.label for one in (recordings, added or recordings)]
    torch.manual_seed(seed)
    head = TimeHead(features[0].shape[-1])

    def draw(rng: np.random.Generator) -> tuple[Tensor, ...]:
        sizes = zip(labels, (BATCH, ADDED), strict=True)
        chosen = [torch.from_numpy(rng.integers(len(label), size=size)) for label, size in sizes]
        pairs = zip(features, labels, chosen, strict=True)
        parts = [(one[index], label[index]) for one, label, index in pairs]
        return torch.cat([one for one, _ in parts]), torch.cat([label for _, label in parts])

    trained(head, draw, HEAD_STEPS, seed)
    with torch.no_grad():
        return [head(seen(network, test.doppler, test.angle)).argmax(dim=1) for test in tests]


# the study ----------------------------------------------------------------------------------------------------------
Hits = dict[str, dict[str, list[float]]]  # {network: {test: share of seeds that are right, of each sequence}}


def hits_of(data: GainData, base: Callable[[], ActivityNetwork], added: Recordings | None, networks: list[str]) -> Hits:
    """Which test sequences are recognised, with something added to the recordings."""
    tests = data.tests()
    parts = [recordings for recordings, _ in tests.values()]
    answers: dict[str, Callable[[int], list[Tensor]]] = {
        "cnn_lstm": lambda seed: cnn_lstm_answers(data, added, parts, seed),
        "ours": lambda seed: our_answers(base(), data, added, parts, seed),
    }
    found: Hits = {}
    for network in networks:
        each = [answers[network](seed) for seed in SEEDS]
        found[network] = {
            name: torch.stack([one[index] == part.label for one in each]).double().mean(dim=0).tolist()
            for index, (name, part) in enumerate(zip(tests, parts, strict=True))
        }
    return found


def rows_of(
    found: dict[str, Hits], groups: dict[str, list[str]], oracles: Mapping[str, str] = ORACLES
) -> list[dict[str, Any]]:
    """A row for each network, test, and what was added; all are compared with the recordings alone."""
    rows = []
    for network in found[ALONE]:
        for test, rooms in groups.items():
            alone = np.array(found[ALONE][network][test])
            oracle = oracles.get(test) if oracles.get(test) in found else None
            for name, hits in found.items():
                if name in oracles.values() and name != oracle:
                    continue
                own = np.array(hits[network][test])
                metrics: dict[str, dict[str, Any]] = {}
                for metric, values in (("accuracy", own), ("gain", own - alone)):
                    mean, low, high = interval(values, rooms)
                    metrics[metric] = {"value": mean, "interval_95": [low, high], "unit": "1"}
                metrics["accuracy"]["baseline"] = {"chance": 1 / len(ACTIVITY_NAMES), ALONE: interval(alone, rooms)[0]}
                if oracle:
                    best = np.array(found[oracle][network][test])
                    metrics["accuracy"]["oracle"] = {oracle: interval(best, rooms)[0]}
                rows.append({"method": name, "network": network, "test": test, "n": len(own),
                             "num_rooms": len(set(rooms)), "metrics": metrics})  # fmt: skip
    return rows


def clutter_rows(found: dict[str, Hits], rooms: list[str], clutter: dict[str, float]) -> list[dict[str, Any]]:
    """The rows of test `unseen_room`, whose sequences are of `rooms`, for each third of the rooms by clutter."""
    rows = []
    for level in CLUTTER:
        third = [list(clutter)[index] for index in third_of(list(clutter.values()), level)]
        chosen = [index for index, room in enumerate(rooms) if room in third]
        part = {
            name: {network: {level: [hits["unseen_room"][index] for index in chosen]} for network, hits in each.items()}
            for name, each in found.items()
            if name in CLUTTER_ROWS
        }
        covered = [clutter[name] for name in third]
        about = {"clutter": level, "share_of_floor_covered": [min(covered), max(covered)]}
        own = rows_of(part, {level: [rooms[index] for index in chosen]}, {level: ORACLES["unseen_room"]})
        rows += [{**row, **about} for row in own]
    return rows


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="rooms and people to learn from")
    parser.add_argument("--unseen", type=Path, action=Reads, required=True, help="rooms of other kinds")
    parser.add_argument("--runs", type=Path, required=True, help="folder for what is done, to go on from")
    parser.add_argument("--networks", nargs="+", choices=NETWORKS, default=list(NETWORKS))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    options.runs.mkdir(parents=True, exist_ok=True)
    data = GainData(options.data, options.unseen, options.runs)
    sizes = {
        "recordings": RECORDINGS,
        "generated": GENERATED,
        "traced": TRACED,
        "steps": STEPS,
        "head_steps": HEAD_STEPS,
    }
    plans = {"data_plan": read_plan(options.data), "unseen_plan": read_plan(options.unseen)}
    stored = RoomCache(
        options.runs, {**sizes, "networks": options.networks, **plans, "weights": digest(shipped_weights())}
    )
    base: list[ActivityNetwork] = []

    def our_base() -> ActivityNetwork:
        if not base:
            base.append(base_network(data))
        return base[0]

    found: dict[str, Hits] = {}
    groups = {name: rooms for name, (_, rooms) in data.tests().items()}
    for name, make in data.added().items():
        found[name] = stored.figures(name, lambda make=make: hits_of(data, our_base, make(), options.networks))
        for network, tests in found[name].items():
            print(
                f"{name:26} {network}",
                {test: round(float(np.mean(hits)), 3) for test, hits in tests.items()},
                flush=True,
            )
        _write(run, "few_recordings", rows_of(found, groups), options.unseen, {**sizes, **plans})
    rows = clutter_rows(found, groups["unseen_room"], data.clutter())
    _write(run, "clutter", rows, options.unseen, {**sizes, **plans})


def _write(run: StudyRun, name: str, rows: list[dict[str, Any]], unseen: Path, config: dict[str, Any]) -> None:
    unknown = {
        "seconds": "see the manifest: all rows together", "metrics.gain.baseline": "it is a difference to one",
    }  # fmt: skip
    complete = complete_rows(rows, dataset=dataset_of(unseen), seeds=list(SEEDS), unknown=unknown)
    run.write("recogniser_gain", name, config=config, rows=complete)
