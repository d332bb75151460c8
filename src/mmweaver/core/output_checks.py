"""Checks before long work begins: output that cannot be written, or that would replace an input."""

import errno
import os
import re
import stat
from collections.abc import Iterable
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.staging import STAGED, finish_moving, is_staged, remove, staging_path, sweep

MAX_NAME_BYTES = 255  # if the file system does not report a limit
ADVICE = {
    errno.ENOSPC: "free some space or choose another --out",
    errno.EDQUOT: "free some space or choose another --out",
    errno.EFBIG: "files this large are not allowed here; choose another --out or raise the limit (ulimit -f)",
    errno.ENAMETOOLONG: "choose a shorter name",
    errno.EROFS: "choose an --out on another disk",
    errno.EACCES: "choose another --out or ask for permission",
    errno.EPERM: "choose another --out or ask for permission",
}


def cannot_write(path: Path, error: OSError) -> InputError:
    """Error for a failed write, with advice that depends on its cause.

    Args:
        path: What was to be written.
        error: Error of the operating system.

    Returns:
        The error to raise.
    """
    advice = ADVICE.get(error.errno or 0, "choose another --out")
    return InputError(f"cannot write {_short(path)}: {error.strerror or error}; {advice}")


def resolved(path: Path | str) -> Path:
    """Absolute path with all links resolved: output goes to the target of a link and does not replace the link."""
    return Path(os.path.realpath(path))


_named: set[Path] = set()  # output files that the user named
_new: set[Path] = set()  # those of them that must not exist yet
_roots: dict[Path, Path] = {}  # output folders as they were named, and where they are


def forget_outputs() -> None:
    """Forgets the outputs that were checked, before another command."""
    for known in (_named, _new, _roots):
        known.clear()


def place_of(path: Path | str, *, is_folder: bool = False) -> Path:
    """Where an output file or folder is written.

    A link is followed if it is the output that the user named or lies above it. Inside of an output folder, which may
    be a stranger's, no link leads out; one that has the name of a file is replaced.

    Args:
        path: The file or folder.
        is_folder: Whether it is a folder. Default: False.

    Returns:
        Absolute path without links above the last name.

    Raises:
        InputError: If a link inside of an output folder leads out of it.
    """
    full = Path(path).absolute()
    inside = [real for given, real in _roots.items() if given in full.parents]
    if not inside and (is_folder or full in _named or not full.name):
        return resolved(full)
    place = resolved(full.parent) / full.name
    leads_out = not all(place.is_relative_to(real) for real in inside)
    if inside and (leads_out or (is_folder and place.is_symlink() and place.is_dir())):
        raise InputError(f"{path} lies behind a link that leads out of its folder; remove the link")
    return place


def is_expected(target: Path) -> bool:
    """Whether an output file may be there, according to the check before the work."""
    return target not in _new


def _mode(target: Path, out: Path) -> int | None:
    """File type and permissions, or None if nothing exists. Raises InputError if they cannot be read."""
    try:
        return target.lstat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        raise cannot_write(out, error) from None


def check_output_file(out: Path, *, overwrite: bool, inputs: Iterable[Path | None] = (), is_named: bool = True) -> None:
    """Checks an output file before any work.

    Args:
        out: The file.
        overwrite: Whether it may exist.
        inputs: Files, or folders with recordings, that it must not replace; None is skipped.
        is_named: Whether the user named it, so that a link is followed. Default: True.

    Raises:
        InputError: If it cannot be written, exists, or belongs to an input.
    """
    if is_named:
        _named.add(Path(out).absolute())
    target = place_of(out)
    (_new.discard if overwrite else _new.add)(target)
    mode = _mode(target, out)
    if mode is not None:
        if stat.S_ISDIR(mode):
            raise InputError(f"{out} is a folder; name a file")
        if not stat.S_ISREG(mode):
            raise InputError(f"{out} is neither a file nor a folder; name a file")
        if not overwrite:
            raise InputError(f"{out} exists; choose another name or allow it with --overwrite")
    for given in inputs:
        if given is not None and _is_input(target, resolved(given)):
            raise InputError(f"{out} belongs to the input {given}, which it would replace; name another file")
    _check_place(target.parent, out)


def check_output_folder(
    out: Path, *, overwrite: bool, files: Iterable[str] = (), inputs: Iterable[Path | None] = ()
) -> None:
    """Checks an output folder before any work.

    Args:
        out: The folder.
        overwrite: Whether it may contain files.
        files: Names that will be written into it; none of them may be a folder or one of `inputs`.
        inputs: Files that must not be replaced; None is skipped.

    Raises:
        InputError: If it cannot be written, is not empty without `overwrite`, or would replace an input.
    """
    target = place_of(out, is_folder=True)
    if not any(given in target.parents for given in _roots):
        _roots.update({Path(out).absolute(): target, target: target})
    check_folder(out, target, overwrite=overwrite)
    given = [resolved(path) for path in inputs if path is not None]
    for name in files:
        if (target / name).is_dir():
            raise InputError(f"{out / name} is a folder where a file is to be written; choose another --out")
        if any(_is_input(target / name, one) for one in given):
            raise InputError(f"{out / name} belongs to the input and would be replaced; choose another --out")
    _check_place(target, out)


def check_folder(out: Path, target: Path, *, overwrite: bool) -> None:
    """Checks that a folder may be filled now, after finishing what was interrupted there.

    Args:
        out: The folder, for messages.
        target: Where it is.
        overwrite: Whether it may contain files.

    Raises:
        InputError: If it is something else, or is not empty without `overwrite`.
    """
    mode = _mode(target, out)
    if mode is not None and not stat.S_ISDIR(mode):
        what = "a link that leads nowhere" if stat.S_ISLNK(mode) else "a file, not a folder"
        raise InputError(f"{out} is {what}; choose another --out")
    try:
        finish_moving(target)
    except OSError as error:
        raise cannot_write(out, error) from None
    if mode is not None and not overwrite and not is_empty(target):
        raise InputError(f"{out} exists and is not empty; choose another --out or allow it with --overwrite")


def is_empty(folder: Path) -> bool:
    """Whether a folder contains nothing but leftovers of unfinished writes.

    Args:
        folder: The folder.

    Raises:
        InputError: If it cannot be read.
    """
    try:
        with os.scandir(folder) as entries:
            return all(is_staged(entry.name) for entry in entries)
    except OSError as error:
        raise cannot_write(folder, error) from None


def _is_input(target: Path, given: Path) -> bool:
    if given.is_dir():
        return given in target.parents and target.exists() and target.suffix != ".mmw"
    return target == given


def _check_place(folder: Path, out: Path) -> None:
    """Raises InputError if no entry can be created in `folder` or its nearest existing parent."""
    try:
        nearest = next(place for place in (folder, *folder.parents) if os.path.lexists(place))
    except OSError as error:
        raise cannot_write(out, error) from None
    if not nearest.is_dir():
        raise InputError(f"{out} cannot be written, for {nearest} is not a folder; choose another --out")
    sweep(nearest)
    probe = staging_path(nearest / "probe")
    try:
        longest = os.pathconf(nearest, "PC_NAME_MAX") if hasattr(os, "pathconf") else MAX_NAME_BYTES
        if any(len(os.fsencode(name)) > longest for name in (*folder.parts[len(nearest.parts) :], resolved(out).name)):
            raise OSError(errno.ENAMETOOLONG, os.strerror(errno.ENAMETOOLONG))
        probe.mkdir()
    except OSError as error:
        raise cannot_write(out, error) from None
    finally:
        remove(probe)


def _short(path: Path) -> str:
    """Abbreviates a long path for a one-line message; an unfinished file has its final name."""
    text = str(Path(*(STAGED.sub(_final_name, part) for part in Path(path).parts)))
    return text if len(text) <= 200 else f"{text[:90]} ... {text[-90:]}"


def _final_name(staged: re.Match[str]) -> str:
    name = staged[0][1:].partition(".mmweaver-")[0]
    return name + (staged[4] or "")
