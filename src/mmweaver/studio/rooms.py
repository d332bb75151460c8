"""The rooms that a studio offers: the bundled one, folders named on the command line, and what a session brought."""

from pathlib import Path
from threading import Lock

from mmweaver.core.errors import InputError
from mmweaver.generate import Weaver
from mmweaver.generation import Room
from mmweaver.scene.photo_files import RoomFiles

DEMO = "demo"


class OfferedRooms:
    """Rooms that every session may use, each read at its first use."""

    def __init__(self, folders: list[Path]):
        self._files: dict[str, RoomFiles] = {}
        for folder in folders:
            name = folder.resolve().name
            while name in self._files or name == DEMO:
                name += "-2"
            self._files[name] = RoomFiles.find(folder)
        self._read: dict[str, Room] = {}
        self._lock = Lock()

    @property
    def names(self) -> list[str]:
        """All names, those of the command line first."""
        return [*self._files, DEMO]

    def get(self, name: str) -> Room:
        """A room by its name. Raises InputError where there is none."""
        with self._lock:
            if name not in self._read:
                if name == DEMO:
                    self._read[name] = Weaver(method="physics").sample_room()
                elif name in self._files:
                    self._read[name] = read_room(self._files[name])
                else:
                    raise InputError("this room is not known here; choose another one")
            return self._read[name]

    def options(self, name: str) -> list[str]:
        """A room's options of `mmweaver generate`."""
        return self._files[name].options if name in self._files else ["--demo"]

    def call(self, name: str) -> str:
        """The call of `Weaver` that reads a room."""
        return self._files[name].call if name in self._files else "sample_room()"


def read_room(files: RoomFiles) -> Room:
    """A room, reconstructed from its files. Raises InputError."""
    return Weaver(method="physics").read_room(files.rgb, files.depth, files.camera)
