"""Temporary names of unfinished files and folders, and cleanup after killed processes.

    .walk.mmweaver-1f3a09c2-4711-88342-3.png     place, process id, process start, running number

A process is identified by id and start time, since ids are reused. The place is the host and its PID namespace: on a
shared disk, leftovers of another host are removed once nothing in them has changed for an hour.
"""

import contextlib
import errno
import hashlib
import itertools
import os
import platform
import re
import shutil
import stat
import time
from functools import cache
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.locks import locked

ABANDONED_S = 3600.0
COMMITTED = ".mmweaver-committed"  # subfolder of complete new files that are being moved into place
MAX_NAME = 60  # characters of the name that are kept; file systems allow 255 bytes in total
STAGED = re.compile(r"\..*\.mmweaver-(?P<place>[0-9a-f]{8})-(?P<process>\d+)-(?P<start>\d+)-\d+(\.[^.]{1,16})?")
_PAUSES_S = (0.0, 0.02, 0.05, 0.1, 0.5, 1.0)  # Zarr threads may still add files after a write has failed
_number = itertools.count()
_swept: set[tuple[int, str]] = set()


def staging_path(path: Path) -> Path:
    """Creates a new temporary name in the same folder, with the same suffix.

    Args:
        path: Final path.

    Returns:
        Temporary path; nothing is created.
    """
    suffix = path.suffix if len(path.suffix) <= 16 else ""
    stem = path.name.removesuffix(suffix).lstrip(".")[:MAX_NAME]
    while len(stem.encode()) > 2 * MAX_NAME:
        stem = stem[:-1]
    process = os.getpid()
    return path.with_name(f".{stem}.mmweaver-{_place()}-{process}-{_start_of(process)}-{next(_number)}{suffix}")


def is_staged(name: str) -> bool:
    """Whether a file name is that of an unfinished file or folder."""
    return STAGED.fullmatch(name) is not None


def is_being_written(staged: Path) -> bool:
    """Whether an unfinished file belongs to a running process.

    Args:
        staged: The unfinished file or folder.

    Returns:
        True if its process runs on this host, or if it belongs to another host and changed within the last hour.
    """
    found = STAGED.fullmatch(staged.name)
    if found is None:
        return False
    if found["place"] != _place() or os.name == "nt":  # on Windows os.kill would end the process instead of asking
        return _age_s(staged) < ABANDONED_S
    process = int(found["process"])
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass
    return _start_of(process) == int(found["start"])


def sweep(folder: Path, *, again: bool = False) -> None:
    """Removes leftovers of killed processes from a folder.

    Args:
        folder: The folder.
        again: Whether to repeat it for a folder that this process has already swept. Default: False.
    """
    key = (os.getpid(), str(folder))
    if key in _swept and not again:
        return
    _swept.add(key)
    try:
        with os.scandir(folder) as entries:
            staged = [Path(entry.path) for entry in entries if is_staged(entry.name)]
    except OSError:
        return
    for leftover in staged:
        if _is_mine(leftover) and not is_being_written(leftover):
            remove(leftover)


def remove(path: Path) -> None:
    """Removes a file or folder as far as possible; a keyboard interrupt takes effect only afterwards."""
    try:
        _remove(path)
    except KeyboardInterrupt:
        _remove(path)
        raise


def _remove(path: Path) -> None:
    if is_own_folder(path):
        for pause_s in _PAUSES_S:
            shutil.rmtree(path, ignore_errors=True)
            if not path.exists():
                return
            time.sleep(pause_s)
        return
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)


def is_own_folder(path: Path) -> bool:
    """Whether a path is a folder itself and no link to one."""
    try:
        return stat.S_ISDIR(path.lstat().st_mode)
    except OSError:
        return False


def _is_mine(path: Path) -> bool:
    """Whether this user made a file or folder."""
    try:
        return not hasattr(os, "geteuid") or path.lstat().st_uid == os.geteuid()
    except OSError:
        return False


def finish_moving(folder: Path) -> None:
    """Completes an interrupted move of new files into place.

    Args:
        folder: The folder that is being filled.

    Raises:
        InputError: If something else has the name of the subfolder of new files, such as a link.
        OSError: If a file cannot be moved.
    """
    committed = folder / COMMITTED
    if not os.path.lexists(committed):
        return
    with locked(folder):  # another process may be moving them
        if not os.path.lexists(committed):
            return
        if not (is_own_folder(committed) and _is_mine(committed)):
            raise InputError(f"{committed} is not a folder that mmweaver has left; remove it")
        move_committed(folder)


def move_committed(folder: Path) -> None:
    """Moves the new files of a folder into place.

    Args:
        folder: The folder that is being filled.

    Raises:
        OSError: If a file cannot be moved.
    """
    committed = folder / COMMITTED
    with locked(folder):
        # checksums first: until all files are in place, missing or old ones do not match
        for file in sorted(committed.iterdir(), key=lambda file: file.name != "SHA256SUMS"):
            place = folder / file.name
            if is_own_folder(place) and is_own_folder(file):
                shutil.rmtree(place)
            file.replace(place)
        sync(folder)
        committed.rmdir()


def sync_tree(folder: Path) -> None:
    """Syncs all files and folders below a folder to disk."""
    for place, _, files in os.walk(folder, topdown=False):
        for name in files:
            sync(Path(place) / name)
        sync(Path(place))


def sync(path: Path) -> None:
    """Syncs a file's bytes, or a folder's entries, to disk.

    Args:
        path: File or folder.

    Raises:
        OSError: If the file system reports a failure.
    """
    is_folder = path.is_dir()
    if is_folder and os.name == "nt":
        return  # Windows has no such call for folders
    handle = os.open(path, os.O_RDWR if os.name == "nt" else os.O_RDONLY)
    try:
        os.fsync(handle)
    except OSError as error:
        if not (is_folder and error.errno == errno.EINVAL):  # some network file systems cannot sync a folder
            raise
    finally:
        os.close(handle)


def _age_s(path: Path) -> float:
    """Seconds since the last change in a file or folder; 0 if it no longer exists."""
    newest = 0.0
    for place in (path, *(path.rglob("*") if is_own_folder(path) else ())):
        try:
            newest = max(newest, place.lstat().st_mtime)
        except OSError:
            return 0.0
    return time.time() - newest


@cache
def _place() -> str:
    try:
        namespace = str(Path("/proc/self/ns/pid").readlink())
    except OSError:
        namespace = ""
    return hashlib.sha256(f"{platform.node()} {namespace}".encode()).hexdigest()[:8]


def _start_of(process: int) -> int:
    """Start of a process in clock ticks since boot; 0 if unknown, -1 if it has ended."""
    try:
        state, *fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:
        return -1 if Path("/proc/self/stat").exists() else 0
    return -1 if state == "Z" else int(fields[18])  # a zombie has ended and waits for its parent
