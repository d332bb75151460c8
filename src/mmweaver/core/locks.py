"""Locks between processes that write to the same file or folder.

The lock is an advisory one of the operating system on the file or folder itself: there is no lock file that could be
left behind, found or planted, and the lock ends with the process that holds it, however that ends. Within a process a
lock may be taken again. Where a file system has no such locks, nothing is locked.
"""

import os
import stat
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mmweaver.core.errors import InputError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

WAIT_S = 600.0
_PAUSE_S = 0.05
_held: Counter[str] = Counter()
_guard = threading.Lock()


@contextmanager
def locked(place: Path, *, wait_s: float = WAIT_S) -> Iterator[None]:
    """Holds the lock of a file or folder, which must exist.

    Args:
        place: Regular file or folder; links are resolved.
        wait_s: Longest time to wait for another process, seconds; 0 refuses at once.

    Yields:
        Nothing.

    Raises:
        InputError: If another process still holds it after that time.
    """
    key = os.path.realpath(place)
    with _guard:
        is_nested = _held[key] > 0
        _held[key] += 1
    handle = None
    try:
        if not is_nested:
            handle = _acquired(Path(key), place, time.monotonic() + wait_s)
        yield
    finally:
        if handle is not None:
            os.close(handle)
        with _guard:
            _held[key] -= 1


def _acquired(real: Path, place: Path, until: float) -> int | None:
    """An open handle that holds the lock of the file or folder that has this name now; None without locks."""
    if fcntl is None:
        return None
    while True:
        try:
            handle = os.open(real, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOFOLLOW)
        except OSError:
            return None  # missing or unreadable: what follows reports it
        try:
            if _is_taken(handle):
                if _is_current(handle, real):
                    return handle
            elif time.monotonic() > until:
                raise InputError(f"another mmweaver command is writing {place}; wait until it has ended")
            else:
                time.sleep(_PAUSE_S)
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)


def _is_taken(handle: int) -> bool:
    """Takes the lock unless another process holds it."""
    try:
        if stat.S_ISREG(os.fstat(handle).st_mode) or stat.S_ISDIR(os.fstat(handle).st_mode):
            assert fcntl is not None
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass  # no locks on this file system
    return True


def _is_current(handle: int, real: Path) -> bool:
    """Whether the file was not replaced while the lock was waited for."""
    try:
        now = real.lstat()
    except OSError:
        return True
    return os.path.samestat(os.fstat(handle), now)
