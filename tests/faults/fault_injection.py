"""Runs commands in forked children that die, or find the disk full, at the n-th event of the file system.

Events are those of Python's audit hooks (PEP 578) that change something below a folder, and os.fsync.
"""

import contextlib
import errno
import functools
import hashlib
import io
import json
import mmap
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

CHANGING = {"os.rename", "os.mkdir", "os.rmdir", "os.remove", "os.truncate", "os.link", "os.chmod", "os.fsync"}
REMOVING = {"os.rmdir", "os.remove"}  # work on a full disk
KILLED = 99
LOGS = ("log.jsonl",)
STAGED_BY = re.compile(r"\.mmweaver-[0-9a-f]{8}-\d+-\d+-\d+")
HIDDEN_COMMITTED = ".mmweaver-committed"


@dataclass(frozen=True, kw_only=True)
class Fault:
    """What happens to a command.

    "kill": the process ends at event `number`. "full": from that event on the disk takes nothing more. "once": that
    event alone fails for want of room. "large": no file may grow beyond `number` bytes (RLIMIT_FSIZE), so that writing
    fails half-way, in native libraries too. "interrupt": Ctrl-C comes at event `number`. "disk": the file system has
    room for so many pages (`small_disk`).
    """

    kind: str
    number: int


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """How a command ended: its exit status, None where it was killed, or the exception that it should have caught."""

    status: int | str | None
    events: int
    stderr: str


def run_in_child(action: Callable[[], int], root: Path, fault: Fault | None = None) -> Outcome:
    """Runs a command line's function in a forked child, with a fault in what it does below `root`."""
    receiver, sender = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(receiver)
        outcome = _faulted(action, os.path.realpath(root), fault)
        with os.fdopen(sender, "w") as pipe:
            json.dump(outcome, pipe)
        os._exit(0)
    os.close(sender)
    with os.fdopen(receiver) as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    if not text:
        ended = os.waitstatus_to_exitcode(status)
        return Outcome(status=None if ended == KILLED else f"died of signal {-ended}", events=0, stderr="")
    status, events, stderr = json.loads(text)
    return Outcome(status=status, events=events, stderr=stderr)


def _faulted(action: Callable[[], int], root: str, fault: Fault | None) -> tuple[Any, int, str]:
    injector = _Injector(root, fault)
    out, err = io.StringIO(), io.StringIO()
    status: Any
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), injector:
            status = action()
    except BaseException as error:
        status = f"{type(error).__name__}: {error}"[:300]
    return status, injector.count, err.getvalue()[-3000:]


class _Injector:
    """Counts events below a folder and makes one of them fail."""

    def __init__(self, root: str, fault: Fault | None):
        self.root, self.fault, self.count, self.is_on = root, fault, 0, False

    def __enter__(self) -> None:
        real_fsync = os.fsync

        def fsync(fd: Any) -> None:
            sys.audit("os.fsync", str(Path(f"/proc/self/fd/{fd}").readlink()))
            real_fsync(fd)

        mock.patch.object(os, "fsync", fsync).start()
        sys.addaudithook(self._hear)
        if self.fault is not None and self.fault.kind == "large":
            resource.setrlimit(resource.RLIMIT_FSIZE, (self.fault.number, resource.RLIM_INFINITY))
        self.is_on = True

    def __exit__(self, *_: object) -> None:
        self.is_on = False
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))

    def _hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self.is_on or (event != "open" and event not in CHANGING):
            return
        path = _path_of(event, arguments)
        if path is None or not os.path.realpath(path).startswith(self.root):
            return
        self.count += 1
        fault = self.fault
        if fault is None or fault.kind == "large" or self.count < fault.number:
            return
        if fault.kind == "kill":
            os._exit(KILLED)
        if fault.kind == "interrupt" and self.count == fault.number:
            raise KeyboardInterrupt
        if event not in REMOVING and (fault.kind == "full" or (fault.kind, self.count) == ("once", fault.number)):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), path)


def _path_of(event: str, arguments: tuple[Any, ...]) -> str | None:
    """The path that an event is about, None for files that are opened for reading alone."""
    place = arguments[0] if arguments else None
    if event == "open" and not (
        isinstance(arguments[2], int) and arguments[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
    ):
        return None
    if not isinstance(place, (str, bytes, os.PathLike)):
        return None
    return os.fsdecode(place)


def tree(folder: Path, but: tuple[str, ...] = ()) -> dict[str, str]:
    """{path: sha256, or "folder"} of everything below a folder, hidden things too, without files of some names."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.name in but:
            continue
        name = path.relative_to(folder).as_posix()
        found[name] = "folder" if path.is_dir() else hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def what_a_run_finds(folder: Path) -> frozenset[tuple[str, str]]:
    """What is below a folder, as far as a later run can tell: not who left it, and not how long lines of a log took."""
    found = tree(folder, LOGS)
    for log in (path for name in LOGS for path in folder.rglob(name)):
        found[log.relative_to(folder).as_posix()] = re.sub(r"\d+", "0", log.read_text(encoding="utf-8"))
    return frozenset((STAGED_BY.sub(".mmweaver-", name), content) for name, content in found.items())


@contextlib.contextmanager
def small_disk(place: Path, pages: int) -> Iterator[Callable[[], None]]:
    """A file system (tmpfs) with so many pages at a folder; gives the function that makes space there.

    Raises PermissionError without the right to mount.
    """
    if not may_mount():
        raise PermissionError("a small file system can only be mounted by root")

    def mount(*options: str) -> None:
        subprocess.run(["mount", *options, str(place)], check=True)

    mount("-t", "tmpfs", "-o", f"size={pages * mmap.PAGESIZE}", "mmweaver-faults")
    try:
        yield lambda: mount("-o", "remount,size=1g")
    finally:
        subprocess.run(["umount", str(place)], check=True)


@functools.cache
def may_mount() -> bool:
    """Whether this process may mount a file system."""
    with tempfile.TemporaryDirectory() as place:
        command = ["mount", "-t", "tmpfs", "-o", "size=64k", "mmweaver-faults", place]
        try:
            if subprocess.run(command, check=False, capture_output=True).returncode:
                return False
        except OSError:
            return False
        subprocess.run(["umount", place], check=True)
        return True
