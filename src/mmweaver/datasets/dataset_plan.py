"""Plan of a data set: room, person, activity, seed and split of every sequence."""

import json
import re
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.boards import find_board
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.seeding import stream
from mmweaver.datasets.planned_sequences import (
    PlannedSequences,
    RoomWords,
    blocks_of_rooms,
    held_out_leaks,
    planned_sequences,
)

# 2: first-order paths, one reflection coefficient per wall, no clutter. 3: seeds of 31 bits, one after another; read
# and continued still. 4: seeds of 64 bits from counters (`planned_sequences`).
PLAN_VERSION, SEQUENTIAL_VERSION = 4, 3
RADAR_FILE = "radar.json"  # radar with range window, in the root of a data set
# Activities of the paper and three more, each phrased in several ways.
ACTIVITIES: dict[str, tuple[str, ...]] = {
    "walking": (
        "a person walks towards the radar",
        "a person walks to the left",
        "a person walks to the right",
        "someone walks away",
        "a person walks around",
    ),
    "jogging": ("a person jogs on the spot", "a person jogs"),
    "waving": (
        "a person waves with the right hand",
        "a person waves with the left hand",
        "someone waves with both hands",
    ),
    "clapping": ("a person claps", "someone claps quickly"),
    "jumping jacks": ("a person does jumping jacks",),
    "left-hand raise": ("a person raises the left hand",),
    "right-hand raise": ("a person raises the right hand",),
    "jumping": ("a person jumps", "someone jumps up and down"),
    "drinking seated": ("a person sits and drinks", "user seated on a chair drinking water"),
    "sitting down": ("a person sits down",),
    "squatting": ("a person squats", "someone squats"),
    "punching": ("a person punches", "a person punches quickly"),
}
# Six people by height; the index also selects the body surface.
PEOPLE_HEIGHT_M = (1.63, 1.70, 1.75, 1.80, 1.87, 1.96)
SPLITS = ("train", "validation", "test_room", "test_layout", "test_person", "test_activity")


_KIND = re.compile(r"\w[\w -]{0,99}")  # kind of room, part of a folder name
MOST = 100_000  # limit of layouts, sequences per room, and frames


@dataclass(frozen=True, kw_only=True)
class HeldOut:
    """Properties held out from training."""

    validation_kinds: tuple[str, ...] = ("dining_room",)
    test_kinds: tuple[str, ...] = ("living_room", "classroom", "workshop")
    test_people: tuple[int, ...] = (3,)
    test_activities: tuple[str, ...] = ("right-hand raise", "jumping")
    test_layouts: int = 2  # the last ones of each kind

    def split(self, *, kind: str, layouts_after: int, person: int, activity: str) -> str:
        """Assigns a sequence to a split.

        Args:
            kind: Kind of room.
            layouts_after: Number of later layouts of this kind.
            person: Index of the person.
            activity: Name of the activity.

        Returns:
            The split; "" if it combines two held-out properties and is not generated.

        >>> HeldOut().split(kind="office", layouts_after=9, person=0, activity="walking")
        'train'
        >>> HeldOut().split(kind="living_room", layouts_after=9, person=0, activity="walking")
        'test_room'
        >>> HeldOut().split(kind="living_room", layouts_after=9, person=3, activity="walking")
        ''
        """
        is_other_kind = kind in self.validation_kinds + self.test_kinds
        withheld = {
            "validation": kind in self.validation_kinds,
            "test_room": kind in self.test_kinds,
            "test_layout": layouts_after < self.test_layouts and not is_other_kind,
            "test_person": person in self.test_people,
            "test_activity": activity in self.test_activities,
        }
        reasons = [name for name, is_so in withheld.items() if is_so]
        return "train" if not reasons else reasons[0] if len(reasons) == 1 else ""


@dataclass(frozen=True, kw_only=True)
class SequenceSpec:
    """One sequence to be generated."""

    index: int  # within its room
    person: int
    activity: str
    text: str
    seed: int
    split: str


@dataclass(frozen=True, kw_only=True)
class RoomSpec:
    """One room to be generated: kind, layout, lighting and sequences."""

    kind: str
    layout: int
    seed: int
    lighting: str
    sequences: tuple[SequenceSpec, ...]

    @property
    def name(self) -> str:
        """Name of the room's folder."""
        return room_name(self.kind, self.layout)


@dataclass(frozen=True, kw_only=True)
class DatasetPlan:
    """Plan of an entire data set. Equal plans give identical data, however the work is distributed.

    Raises:
        InputError: If a value is out of range, or options contradict each other.
    """

    kinds: tuple[str, ...]
    lightings: tuple[str, ...]
    num_layouts: int = 10
    sequences_a_room: int = 120
    num_frames: int = 20
    radar: str = "awr1843"
    seed: int = 0
    withheld: HeldOut = field(default_factory=HeldOut)
    geometry_only: bool = False  # signals are synthesised during training from stored geometry
    board: str = "ideal"  # "typical": a different board per room
    packed: bool = False  # each room is one file instead of a folder
    plan_version: int = PLAN_VERSION

    def __post_init__(self) -> None:
        if self.plan_version not in (PLAN_VERSION, SEQUENTIAL_VERSION):
            raise InputError(f"plan version {self.plan_version} is not made here; known: 3 and {PLAN_VERSION}")
        for name in ("num_layouts", "sequences_a_room", "num_frames"):
            if not 1 <= getattr(self, name) <= MOST:
                raise InputError(f"{name} must be 1 to {MOST}, not {getattr(self, name)}")
        if self.geometry_only and self.board != "ideal":
            raise InputError("a set of geometry alone holds no signals, so it has no board; leave out one of them")
        if not self.kinds:
            raise InputError("a data set needs at least one kind of room")

    @property
    def num_rooms(self) -> int:
        """Number of rooms."""
        return len(self.kinds) * self.num_layouts

    def place_of(self, number: int) -> tuple[str, int]:
        """Kind and layout of a room.

        Args:
            number: Number of the room in the plan, from 0.
        """
        return self.kinds[number // self.num_layouts], number % self.num_layouts

    def name_of(self, number: int) -> str:
        """Name of a room by number."""
        return room_name(*self.place_of(number))

    def part(self, number: int, count: int) -> range:
        """Rooms of one of several machines: ranges of nearly the same length that cover the plan.

        Args:
            number: Number of the part, 1 to `count`.
            count: Number of parts.

        Returns:
            Numbers of the rooms.
        """
        return range(self.num_rooms * (number - 1) // count, self.num_rooms * number // count)

    def room(self, number: int) -> RoomSpec:
        """One room with its sequences, computed without those before it.

        Args:
            number: Number of the room in the plan, from 0.
        """
        kind, layout = self.place_of(number)
        if self.plan_version == SEQUENTIAL_VERSION:
            return self._sequential_room(kind, layout)
        (block,) = self.blocks(range(number, number + 1))
        columns = (getattr(block, name)[0].tolist() for name in ("person", "activity", "text", "seed", "split"))
        lighting = self.lightings[(self._words(number).choices >> 32) % len(self.lightings)]
        names = list(ACTIVITIES)
        specs = tuple(
            SequenceSpec(
                index=index,
                person=person,
                activity=names[activity],
                text=ACTIVITIES[names[activity]][text],
                seed=seed,
                split=SPLITS[split],
            )
            for index, (person, activity, text, seed, split) in enumerate(zip(*columns, strict=True))
        )
        return RoomSpec(kind=kind, layout=layout, seed=self.seed, lighting=lighting, sequences=specs)

    def rooms(self) -> list[RoomSpec]:
        """All rooms, sorted by kind; for large plans see `room` and `blocks`."""
        return [self.room(number) for number in range(self.num_rooms)]

    def blocks(self, numbers: range | None = None) -> Iterator[PlannedSequences]:
        """Sequences of a range of rooms, some 50,000 at a time.

        Args:
            numbers: Numbers of the rooms. Default: all.

        Yields:
            Columns of the sequences in consecutive rooms.
        """
        numbers = range(self.num_rooms) if numbers is None else numbers
        for block in blocks_of_rooms(numbers, self.sequences_a_room):
            if self.plan_version == SEQUENTIAL_VERSION:
                yield _columns_of(block.start, [self.room(number) for number in block])
                continue
            yield planned_sequences(
                block.start,
                [self._words(number) for number in block],
                np.stack([self._table(*self.place_of(number)) for number in block]),
                np.array([len(texts) for texts in ACTIVITIES.values()]),
                self.sequences_a_room,
            )

    def check(self) -> dict[str, int]:
        """Goes through the whole plan and looks for what leaks from training into a test.

        Returns:
            Number of sequences in each split that has any.

        Raises:
            InputError: If a held-out kind of room, layout, person or activity occurs in training, or a seed occurs
                twice in a room.
        """
        counts, leaks = held_out_leaks(self.blocks(), self.place_of, SPLITS)
        if leaks:
            raise InputError(f"leak: {leaks[0]}" + (f", and {len(leaks) - 1} more" if len(leaks) > 1 else ""))
        return {name: count for name, count in counts.items() if count}

    def _words(self, number: int) -> RoomWords:
        return RoomWords.of(self.seed, *self.place_of(number))

    def _table(self, kind: str, layout: int) -> np.ndarray:
        """Split by person and activity in a room, int8 (person, activity); -1: not generated."""
        key = (kind, self._layouts_after(layout) < self.withheld.test_layouts)
        if key not in self._tables:
            splits = [self._splits(kind, layout, person) for person in range(len(PEOPLE_HEIGHT_M))]
            self._tables[key] = np.array([[SPLITS.index(one) if one else -1 for one in row] for row in splits], np.int8)
        return self._tables[key]

    def _splits(self, kind: str, layout: int, person: int) -> list[str]:
        after = self._layouts_after(layout)
        return [
            self.withheld.split(kind=kind, layouts_after=after, person=person, activity=activity)
            for activity in ACTIVITIES
        ]

    @cached_property
    def _tables(self) -> dict[tuple[str, bool], np.ndarray]:
        return {}

    def board_of(self, room: RoomSpec, config: RadarConfig) -> Board:
        """Board whose hardware errors a room's signals have.

        Args:
            room: The room.
            config: The radar.

        Returns:
            The board, sampled per room for "typical".

        Raises:
            InputError: If the board is unknown or does not fit the radar.
        """
        if self.plan_version == SEQUENTIAL_VERSION:
            number = int(stream(self.seed, "dataset board", room.kind, room.layout).integers(2**31))
        else:
            number = RoomWords.of(self.seed, room.kind, room.layout).board
        return find_board(self.board, config, number)

    def _sequential_room(self, kind: str, layout: int) -> RoomSpec:
        """A room of version 3, whose seeds follow one another in a stream of the room."""
        rng = stream(self.seed, "dataset", kind, layout)
        lighting = str(rng.choice(self.lightings))
        room = RoomSpec(kind=kind, layout=layout, seed=self.seed, lighting=lighting, sequences=())
        names = list(ACTIVITIES)
        specs: list[SequenceSpec] = []
        number = int(rng.integers(len(names)))
        while len(specs) < self.sequences_a_room:
            activity = names[number % len(names)]
            number += 1
            spec = self._sequence(room, len(specs), activity, rng)
            if spec.split:
                specs.append(spec)
        return replace(room, sequences=tuple(specs))

    def _sequence(self, room: RoomSpec, index: int, activity: str, rng: np.random.Generator) -> SequenceSpec:
        person = int(rng.integers(len(PEOPLE_HEIGHT_M)))
        return SequenceSpec(
            index=index,
            person=person,
            activity=activity,
            text=str(rng.choice(ACTIVITIES[activity])),
            seed=int(rng.integers(2**31)),
            split=self.withheld.split(
                kind=room.kind, layouts_after=self._layouts_after(room.layout), person=person, activity=activity
            ),
        )

    def _layouts_after(self, layout: int) -> int:
        """Number of later layouts; with fewer than six layouts per kind, at most a third is held out."""
        spared = max(self.withheld.test_layouts - self.num_layouts // 3, 0)
        return self.num_layouts - 1 - layout + spared

    def to_json(self) -> str:
        """Serialises the plan; options unknown to older versions are written only if they are used."""
        values = asdict(self)
        values = {"plan_version": values.pop("plan_version"), **values}
        if not self.geometry_only:  # older data sets do not have it
            del values["geometry_only"]
        if self.board == "ideal":
            del values["board"]
        if not self.packed:
            del values["packed"]
        return json.dumps(values, indent=1)


def begun_version(folder: Path) -> int | None:
    """Version of the plan of an existing data set, so that it is continued as it was begun.

    Args:
        folder: The data set.

    Returns:
        The version if this mmweaver can continue it; otherwise None.
    """
    try:
        plan = read_json(folder / "plan.json")
        version = plan.get("plan_version") if isinstance(plan, dict) else None
    except InputError:
        return None
    return version if version in (PLAN_VERSION, SEQUENTIAL_VERSION) else None


FLAGS = {"geometry_only": "--geometry-only", "packed": "--packed"}


def command_of(plan: dict[str, Any], folder: Path) -> str:
    """Command line that generates, or repairs, the data set of a plan.

    Args:
        plan: Content of plan.json.
        folder: The data set.

    Returns:
        The command, each argument quoted.
    """
    own = folder / RADAR_FILE
    radar = str(own) if own.is_file() else plan["radar"]
    words = [
        "mmweaver dataset",
        shlex.quote(str(folder)),
        f"--rooms {shlex.quote(','.join(plan['kinds']))}",
        f"--layouts {plan['num_layouts']}",
        f"--sequences {plan['sequences_a_room']}",
        f"--frames {plan['num_frames']}",
        f"--radar {shlex.quote(radar)}",
        f"--seed {plan['seed']}",
    ]
    words += [flag for name, flag in FLAGS.items() if plan.get(name)]
    if not plan.get("geometry_only"):
        words.append(f"--board {shlex.quote(str(plan.get('board', 'ideal')))}")
    if plan.get("plan_version", SEQUENTIAL_VERSION) != PLAN_VERSION:
        words.append(f"--plan-version {SEQUENTIAL_VERSION}")
    return " ".join([*words, "--repair"])


def check_plan(plan: Any, place: Path) -> dict[str, Any]:
    """Checks the content of a plan.json.

    Args:
        plan: Decoded JSON.
        place: The file, for error messages.

    Returns:
        The plan, from which rooms can be listed.

    Raises:
        InputError: If it is damaged.
    """
    names = ("num_layouts", "sequences_a_room", "num_frames")
    is_plan = isinstance(plan, dict) and isinstance(plan.get("radar"), str) and type(plan.get("seed")) is int
    if not is_plan or not all(type(plan.get(name)) is int and 1 <= plan[name] <= MOST for name in names):
        raise InputError(f"{place} is damaged (its radar, seed or counts); make the data set anew")
    kinds = plan.get("kinds")
    if not isinstance(kinds, list) or not all(isinstance(kind, str) and _KIND.fullmatch(kind) for kind in kinds):
        raise InputError(f"{place} is damaged (its kinds of rooms); make the data set anew")
    return plan


def shell_words(command: Any) -> str:
    """Quotes each word of a stored command line again, so that pasting it into a shell runs that command only.

    Args:
        command: The stored command line.

    Returns:
        The quoted command line.

    Raises:
        ValueError: If it is not a command line.
    """
    return shlex.join(shlex.split(" ".join(str(command).split())))


def room_name(kind: str, layout: int) -> str:
    """Name of a room's folder."""
    return f"{kind.replace(' ', '_')}_{layout:03d}"


def _columns_of(first: int, rooms: Sequence[RoomSpec]) -> PlannedSequences:
    names = list(ACTIVITIES)

    def column(of: Any, kind: str) -> np.ndarray:
        return np.array([[of(one) for one in room.sequences] for room in rooms], kind)

    return PlannedSequences(
        first=first,
        person=column(lambda one: one.person, "u1"),
        activity=column(lambda one: names.index(one.activity), "u1"),
        text=column(lambda one: ACTIVITIES[one.activity].index(one.text), "u1"),
        seed=column(lambda one: one.seed, "u8"),
        split=column(lambda one: SPLITS.index(one.split), "u1"),
    )
