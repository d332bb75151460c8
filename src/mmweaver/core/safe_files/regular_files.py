"""Opening of regular files only, and conversion of library errors for damaged files to one-line InputErrors."""

import contextlib
import os
import stat
import warnings
from collections.abc import Iterator
from io import BufferedReader
from pathlib import Path

from mmweaver.core.errors import InputError, one_line
from mmweaver.core.safe_files.packed_folder import PackedPath

MEGABYTE = 2**20
Place = Path | PackedPath  # a path on disk or in a packed folder


def check_exists(path: Path, what: str) -> None:
    """Checks that a path exists.

    Args:
        path: The path.
        what: What to give instead, for the error message.

    Raises:
        InputError: If it does not exist.
    """
    if not path.exists():
        raise InputError(f"{path} does not exist; give {what}")


def check_regular(path: Place | str) -> int:
    """Checks that a path is a regular file.

    Args:
        path: The path.

    Returns:
        Size in bytes.

    Raises:
        InputError: If it is missing, or a folder, FIFO, device or socket.
    """
    if isinstance(path, PackedPath):
        return len(path.data())
    try:
        found = Path(path).stat()
    except (OSError, ValueError) as error:
        raise InputError(cannot_read(path, error)) from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError(f"cannot read {path}: it is a folder; give a file")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(f"cannot read {path}: it is no regular file but {_kind(found.st_mode)}; give a file")
    return found.st_size


def open_regular(path: Place | str) -> BufferedReader:
    """Opens a regular file for reading bytes; never blocks, as opening a FIFO would.

    Args:
        path: The path.

    Returns:
        The open file.

    Raises:
        InputError: If it is not a regular file or cannot be opened.
    """
    check_regular(path)
    if isinstance(path, PackedPath):
        return path.open()
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
    try:
        handle = os.open(path, flags)
        if stat.S_ISREG(os.fstat(handle).st_mode):  # may have been replaced since the check
            return os.fdopen(handle, "rb")
        os.close(handle)
    except OSError as error:
        raise InputError(cannot_read(path, error)) from None
    raise InputError(f"cannot read {path}: it is no regular file; give a file")


def read_bytes(path: Place | str, *, max_bytes: int) -> bytes:
    """Reads an entire regular file.

    Args:
        path: The file.
        max_bytes: Size limit in bytes.

    Returns:
        Its content.

    Raises:
        InputError: If it is larger, or not a regular file.
    """
    pieces, held = [], 0
    with open_regular(path) as file:
        try:
            while piece := file.read(MEGABYTE):  # a larger read would allocate memory before the bytes arrive
                pieces.append(piece)
                held += len(piece)
                if held > max_bytes:
                    raise InputError(f"{path} is larger than {max_bytes / MEGABYTE:g} MB; is it the right file?")
        except OSError as error:
            raise InputError(cannot_read(path, error)) from None
    return b"".join(pieces)


@contextlib.contextmanager
def foreign_errors(path: Place | str, what: str) -> Iterator[None]:
    """Context that converts any exception of a decoding library to an InputError "PATH is `what`".

    Only library calls belong inside.

    Args:
        path: The file, or words that name it.
        what: What is wrong and what to do, with "{reason}" as placeholder for the library's message, for example "no
            .npy array ({reason}); save it with numpy.save".

    Raises:
        InputError: In place of any other exception.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except InputError:
        raise
    except MemoryError:
        raise InputError(f"{path} needs more memory than there is; is it the right file?") from None
    except OSError as error:
        if error.errno is not None:
            raise InputError(cannot_read(path, error)) from None
        raise InputError(f"{path} is {what.format(reason=_reason(error))}") from None
    except Exception as error:
        raise InputError(f"{path} is {what.format(reason=_reason(error))}") from None


def cannot_read(path: Place | str, error: Exception) -> str:
    """Message for a file that the operating system does not open."""
    reason = error.strerror if isinstance(error, OSError) and error.strerror else error
    return f"cannot read {path}: {reason}"


def _reason(error: Exception) -> str:
    """Message of a library, shortened; hides the advice of numpy and torch to allow pickles."""
    text = one_line(str(error) or type(error).__name__, 160)
    if "max_header_size" in text:
        return "its header is too large"
    if "pickle" in text.lower() or "weights_only" in text:
        return "it holds pickled objects, which could run code and are not opened"
    return text


def _kind(mode: int) -> str:
    kinds = {
        stat.S_IFIFO: "a FIFO",
        stat.S_IFSOCK: "a socket",
        stat.S_IFCHR: "a device",
        stat.S_IFBLK: "a device",
    }
    return kinds.get(stat.S_IFMT(mode), "something else")
