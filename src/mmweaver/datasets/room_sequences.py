"""The sequences of a data set of rooms as those of a labelled set: one reader for both."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud, RadarCube
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.datasets.activity_store import SET_FILE, ActivitySet, is_activity_set, read_activity_set
from mmweaver.datasets.dataset_plan import ACTIVITIES, PEOPLE_HEIGHT_M
from mmweaver.datasets.dataset_store import PLAN_FILE, StoredRoom, plan_text, read_radar, read_rooms
from mmweaver.signal.points import point_cloud


@dataclass(frozen=True, kw_only=True)
class RoomSequences:
    """All sequences of a set of rooms, in the order of the rooms' names; the label is the activity."""

    folder: Path
    rooms: Sequence[StoredRoom]

    label_names = tuple(ACTIVITIES)

    @property
    def config(self) -> RadarConfig:
        """The radar of all sequences."""
        return self.rooms[0].config

    @cached_property
    def _places(self) -> list[tuple[StoredRoom, int]]:
        return [(room, index) for room in self.rooms for index in range(len(room.text))]

    def __len__(self) -> int:
        return len(self._places)

    @cached_property
    def columns(self) -> dict[str, np.ndarray]:
        """Along the sequences: label, label_name, text, split, subject, height, room (a name) and seed."""
        rows = self._places

        def column(name: str) -> np.ndarray:
            return np.array([getattr(room, name)[index] for room, index in rows])

        activity, person = column("activity"), column("person").astype(int)
        if unknown := set(activity.tolist()) - set(self.label_names):
            raise InputError(
                f"{self.folder} has activities that this version does not know: {', '.join(sorted(unknown))}"
            )
        return {
            "label": np.array([self.label_names.index(name) for name in activity.tolist()]),
            "label_name": activity,
            "text": column("text"),
            "split": column("split"),
            "subject": person,
            "height": np.array(PEOPLE_HEIGHT_M)[person],
            "room": np.array([f"{room.kind}_{room.layout}" for room, _ in rows]),
            "seed": column("seed").astype(int),
        }

    @cached_property
    def joints_m(self) -> np.ndarray:
        """(sequence, frame, 22, 3) in the radar's frame."""
        return np.concatenate([room.joints_m for room in self.rooms])

    def cube(self, index: int) -> RadarCube:
        """The cube of one sequence in sqrt(mW), read or synthesised. Raises InputError where its file is damaged."""
        room, own = self._places[index]
        return room.cube(own)

    def cloud(self, index: int) -> PointCloud:
        """The point cloud of one sequence, detected now: such a set stores none."""
        return point_cloud(self.cube(index))


def is_set(folder: Path) -> bool:
    """Whether a folder holds a labelled set or a data set of rooms, complete or not."""
    return is_activity_set(folder) or (folder / PLAN_FILE).is_file()


LabelledData = ActivitySet | RoomSequences


def read_labelled(folder: Path, *, device: str = "cpu") -> LabelledData:
    """Opens a labelled set or a data set of rooms, whose signals may be synthesised on `device`.

    Raises InputError for a folder that is neither, is not complete, or is damaged.
    """
    if is_activity_set(folder):
        return read_activity_set(folder)
    return RoomSequences(folder=folder, rooms=read_rooms(folder, device=device))


def plan_of(folder: Path) -> str:
    """The text that a set follows from: plan.json, or set.json of a labelled set. Raises InputError."""
    if is_activity_set(folder):
        read_activity_set(folder)  # checks all files
        return read_text(folder / SET_FILE)
    return plan_text(folder)


def radar_of(folder: Path) -> RadarConfig:
    """The radar of either kind of set. Raises InputError."""
    return read_activity_set(folder).config if is_activity_set(folder) else read_radar(folder)


def labels_of(folder: Path) -> tuple[str, ...]:
    """The words of the labels of either kind of set, by number. Raises InputError."""
    return read_activity_set(folder).label_names if is_activity_set(folder) else RoomSequences.label_names
