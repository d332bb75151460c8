"""Scores of single rooms of a long study, cached one file a room, so that a stopped run continues."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_file


class RoomCache:
    """A folder of JSON files, one a room, for one setting of a study.

    `about` is everything the scores depend on: with other settings, weights or data nothing is found again. Without a
    folder nothing is cached.
    """

    def __init__(self, folder: Path | None, about: dict[str, Any]):
        mark = hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()[:16]
        self.folder = None if folder is None else folder / mark

    def figures(self, name: str, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """The cached scores of a room, or those that `make` returns, which are then cached."""
        if self.folder is None:
            return make()
        file = self.folder / f"{name}.json"
        if file.is_file():
            return json.loads(file.read_text(encoding="utf-8"))
        figures = make()
        with atomic_file(file) as temporary:
            temporary.write_text(json.dumps(figures) + "\n", encoding="utf-8")
        return figures


def digest(file: Path) -> str:
    """The sha256 of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
