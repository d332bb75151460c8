"""What a power cut would leave of a folder: a record of what os.fsync has brought to the disk, and of renames."""

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest import mock

from mmweaver.core.staging import COMMITTED, is_staged


class SyncedDisk:
    """Hears every fsync, rename and link of this process while `recorded`.

    A file counts as on the disk with the bytes that it had at its last fsync, a folder with the names that it had at
    its own; names of unfinished things do not count, nor files of the names `but`. `early` holds what got its final
    name with bytes or names that were not on the disk.
    """

    def __init__(self, *but: str) -> None:
        self.early: list[str] = []
        self._but = but
        self._synced: dict[int, str] = {}  # by inode

    @contextmanager
    def recorded(self) -> Iterator["SyncedDisk"]:
        fsync, changes = os.fsync, {name: getattr(os, name) for name in ("rename", "replace", "link")}

        def synced(handle: Any) -> None:
            fsync(handle)
            path = Path(f"/proc/self/fd/{handle if isinstance(handle, int) else handle.fileno()}").readlink()
            self._synced[path.stat().st_ino] = self._content(path)

        def checked(name: str, source: Any, target: Any, **more: Any) -> None:
            if not any(is_staged(part) for part in Path(target).parts):  # a part of what is unfinished itself
                self.early += [f"{target}: {path}" for path in self._unsynced(Path(source))]
            changes[name](source, target, **more)

        with mock.patch.object(os, "fsync", synced), mock.patch.multiple(
            os, **{name: _bound(checked, name) for name in changes}
        ):  # fmt: skip
            yield self

    def lost(self, folder: Path) -> list[str]:
        """What of a folder, itself included, would be missing or old after a power cut."""
        return [path.relative_to(folder).as_posix() for path in self._unsynced(folder)]

    def _unsynced(self, place: Path) -> list[Path]:
        paths = [place, *(path for path in place.rglob("*") if self._counts(path.name))]
        return [path for path in paths if self._synced.get(path.stat().st_ino) != self._content(path)]

    def _content(self, path: Path) -> str:
        if not path.is_dir():
            return hashlib.sha256(path.read_bytes()).hexdigest()
        return repr(sorted((one.name, one.inode()) for one in os.scandir(path) if self._counts(one.name)))

    def _counts(self, name: str) -> bool:
        return not is_staged(name) and name != COMMITTED and name not in self._but


def _bound(checked: Any, name: str) -> Any:
    return lambda source, target, **more: checked(name, source, target, **more)
