"""Sequences of a data set of rooms with the interface of a labelled set, so that one reader serves both."""

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
    """All sequences of a set of rooms, sorted by room; the label is the activity."""

    folder: Path
    rooms: Sequence[StoredRoom]

    label_names = tuple(ACTIVITIES)

    @property
    def config(self) -> RadarConfig:
        """Radar of all sequences."""
        return self.rooms[0].config

    @cached_property
    def _places(self) -> list[tuple[StoredRoom, int]]:
        return [(room, index) for room in self.rooms for index in range(len(room.text))]

    def __len__(self) -> int:
        return len(self._places)

    @cached_property
    def columns(self) -> dict[str, np.ndarray]:
        """Label, label_name, text, split, subject, height, room (a name) and seed, (sequence,) each.

        Raises:
            InputError: If the set has an unknown activity.
        """
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
        """Joints in metres in the radar's frame, (sequence, frame, 22, 3)."""
        return np.concatenate([room.joints_m for room in self.rooms])

    def cube(self, index: int) -> RadarCube:
        """Reads or synthesises the cube of one sequence in sqrt(mW).

        Raises:
            InputError: If its file is damaged.
        """
        room, own = self._places[index]
        return room.cube(own)

    def cloud(self, index: int) -> PointCloud:
        """Detects the point cloud of one sequence, since such sets store none."""
        return point_cloud(self.cube(index))


def is_set(folder: Path) -> bool:
    """Whether a folder contains a labelled set or a data set of rooms, complete or not."""
    return is_activity_set(folder) or (folder / PLAN_FILE).is_file()


LabelledData = ActivitySet | RoomSequences


def read_labelled(folder: Path, *, device: str = "cpu") -> LabelledData:
    """Opens a labelled set or a data set of rooms.

    Args:
        folder: The set.
        device: Device on which signals that are not stored are synthesised. Default: CPU.

    Returns:
        The set.

    Raises:
        InputError: If the folder is neither, is incomplete, or damaged.
    """
    if is_activity_set(folder):
        return read_activity_set(folder)
    return RoomSequences(folder=folder, rooms=read_rooms(folder, device=device))


def plan_of(folder: Path) -> str:
    """Text that determines a set: plan.json, or set.json of a labelled set.

    Args:
        folder: The set.

    Raises:
        InputError: If the folder is not a set, or damaged.
    """
    if is_activity_set(folder):
        read_activity_set(folder)  # checks all files
        return read_text(folder / SET_FILE)
    return plan_text(folder)


def radar_of(folder: Path) -> RadarConfig:
    """Radar of either kind of set. Raises InputError if the folder is not a set, or damaged."""
    return read_activity_set(folder).config if is_activity_set(folder) else read_radar(folder)


def labels_of(folder: Path) -> tuple[str, ...]:
    """Names of the labels of either kind of set, by number. Raises InputError if it is not a set, or damaged."""
    return read_activity_set(folder).label_names if is_activity_set(folder) else RoomSequences.label_names
