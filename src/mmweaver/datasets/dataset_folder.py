"""Which rooms of a data set are on disk: a folder each, or one file each if the plan says packed."""

import os
from collections.abc import Iterable
from pathlib import Path

from mmweaver.core.safe_files.packed_folder import PackedPath
from mmweaver.core.safe_files.regular_files import Place

PLAN_FILE = "plan.json"
PACKED = ".zip"


def is_done(folder: Path, name: str) -> bool:
    """Whether a room is complete; it is renamed into place only then."""
    room = folder / name
    return (room.is_dir() and any(room.iterdir())) or (folder / f"{name}{PACKED}").is_file()


def finished(folder: Path, names: Iterable[str]) -> set[str]:
    """Complete rooms among many, from one listing of the folder.

    Args:
        folder: The data set; need not exist.
        names: Names of the rooms to look for.
    """
    try:
        with os.scandir(folder) as entries:
            there = {entry.name for entry in entries}
    except OSError:
        return set()
    return {name for name in names if (name in there or f"{name}{PACKED}" in there) and is_done(folder, name)}


def room_place(folder: Path, name: str) -> Place:
    """Where the files of a room are: its folder, or the root of its zip.

    Args:
        folder: The data set.
        name: Name of the room.
    """
    packed = folder / f"{name}{PACKED}"
    return PackedPath(packed) if packed.is_file() else folder / name
