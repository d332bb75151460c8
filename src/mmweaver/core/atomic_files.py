"""Atomic output: files and folders are written under a temporary name, synced to disk, then renamed.

A kill at any instant leaves either the old or the new state; temporary files of a dead process are removed by the next
process that writes to the folder (`core.staging`). Nothing is renamed before its bytes are on disk.
Reference: docs/decisions/writing-files.md.
"""

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from mmweaver.core.checksums import SUMS_FILE, read_sums, sums_text, write_sums
from mmweaver.core.errors import InputError
from mmweaver.core.locks import locked
from mmweaver.core.output_checks import cannot_write, check_folder, is_empty, is_expected, place_of
from mmweaver.core.safe_files.regular_files import MEGABYTE, read_bytes
from mmweaver.core.staging import (
    COMMITTED,
    is_staged,
    move_committed,
    remove,
    staging_path,
    sweep,
    sync,
    sync_tree,
)

MAX_ONCE_BYTES = 64 * MEGABYTE  # of a file that is created once

_written: list[Path] = []


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """Writes a file completely or not at all.

    Args:
        path: The file; missing parent folders are created.

    Yields:
        A temporary path in the same folder; renamed to `path` on success, removed on any error.

    Raises:
        InputError: If it cannot be written.
    """
    with atomic_files(path) as (temporary,):
        yield temporary


@contextmanager
def atomic_files(*paths: Path) -> Iterator[list[Path]]:
    """Writes several related files: all are on disk before the first is renamed.

    Args:
        *paths: The files; missing parent folders are created, and removed again on an error.

    Yields:
        One temporary path per file, as in `atomic_file`.

    Raises:
        InputError: If one of them cannot be written.
    """
    targets = [place_of(path) for path in paths]
    made: list[Path] = []
    staged: list[Path] = []
    try:
        for target in targets:
            made += _make_folders(target.parent)
            sweep(target.parent)
            staged.append(_new_file(target))
        yield staged
        for temporary in staged:
            sync(temporary)
        _sync_names(made)
        if targets:
            with locked(targets[0].parent):
                _rename_all(staged, targets)
    except OSError as error:
        raise cannot_write(Path(paths[0]), error) from error
    finally:
        for temporary in staged:
            remove(temporary)
        _remove_empty(made)


def _forget_sum(path: Path) -> None:
    """Removes a file from its folder's SHA256SUMS before it is replaced by one of another origin."""
    try:
        known = read_sums(path.parent)
    except InputError:
        return
    if known is not None and known.pop(path.name, None) is not None:
        with atomic_file(path.parent / SUMS_FILE) as temporary:
            temporary.write_text(sums_text(known), encoding="utf-8")


def _new_file(target: Path) -> Path:
    temporary = staging_path(target)
    os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    return temporary


def _rename_all(staged: list[Path], targets: list[Path]) -> None:
    """Renames one file after another; on failure, removes those that did not exist before."""
    new: list[Path] = []
    try:
        for temporary, target in zip(staged, targets, strict=True):
            is_new = not os.path.lexists(target)
            if not (is_new or is_expected(target)):
                raise InputError(f"{target} was written by another command meanwhile; choose another name")
            if not is_new:
                _forget_sum(target)
            new += [target] if is_new else []
            temporary.replace(target)
            _written.append(target)
        for folder in {target.parent for target in targets}:
            sync(folder)
    except BaseException:  # an interruption, too, leaves all or none
        for target in new:
            remove(target)
        _written[:] = [path for path in _written if path not in new]
        raise


@contextmanager
def staged_folder(out: Path, *, overwrite: bool = False, keep_existing: bool = False) -> Iterator[Path]:
    """Writes a folder with the SHA-256 sums of its files, completely or not at all.

    An existing `out` is filled in place, since it may be a mount point or a working directory: the complete files are
    moved into it. If that is interrupted, the next process that writes there moves the remaining files.

    Args:
        out: The folder.
        overwrite: Whether existing files may be replaced; files with other names are kept.
        keep_existing: Whether a folder that another process created meanwhile is kept, for content that does not depend
            on who writes it.

    Yields:
        A temporary folder; becomes `out` on success, removed on any error.

    Raises:
        InputError: If `out` is a file, or not empty without `overwrite`, or it cannot be written.
    """
    target = place_of(out, is_folder=True)
    if not keep_existing:
        check_folder(out, target, overwrite=overwrite)
    made: list[Path] = []
    stage: Path | None = None
    try:
        made = _make_folders(target.parent)
        sweep(target.parent)
        is_new = keep_existing or not target.is_dir()
        if not is_new:
            sweep(target)
        stage = staging_path(target if is_new else target / target.name)
        stage.mkdir()
        yield stage
        write_sums(stage)
        if is_new:
            sync_tree(stage)
            _sync_names(made)
            _rename_new(stage, target, keep_existing=keep_existing)
        else:
            with locked(target):
                check_folder(out, target, overwrite=overwrite)  # another command may have written there meanwhile
                _keep_sums(target, stage)
                sync_tree(stage)
                _sync_names(made)
                _move_into(stage, target)
        _written.append(Path(out))
    except OSError as error:
        raise cannot_write(Path(out), error) from error
    finally:
        if stage is not None:
            remove(stage)
        _remove_empty(made)


def _keep_sums(folder: Path, stage: Path) -> None:
    """Carries over the checksums of files that are kept in the folder."""
    try:
        known = read_sums(folder) or {}
    except InputError:
        return
    new = read_sums(stage) or {}
    stay = {name: digest for name, digest in known.items() if name not in new and (folder / name).is_file()}
    if stay:
        (stage / SUMS_FILE).write_text(sums_text({**stay, **new}), encoding="utf-8")


def _rename_new(stage: Path, target: Path, *, keep_existing: bool) -> None:
    try:
        stage.rename(target)
    except OSError:
        if not (keep_existing and target.is_dir()):
            raise
    try:
        sync(target.parent)
    except BaseException:
        if stage.parent.is_dir() and not stage.exists():
            target.rename(stage)  # not synced to disk: neither reported as written nor left behind
        raise


def _move_into(stage: Path, folder: Path) -> None:
    if not is_empty(folder):
        for file in stage.iterdir():
            if (folder / file.name).is_dir() and not file.is_dir():
                raise IsADirectoryError(21, f"{file.name} is a folder there")
    stage.rename(folder / COMMITTED)
    try:
        sync(folder)
        move_committed(folder)
    except KeyboardInterrupt:
        move_committed(folder)
        _written.append(folder)
        raise


def create_once(path: Path, text: str) -> str:
    """Writes a file unless it exists; among several processes the first one wins.

    Args:
        path: The file.
        text: Content if the file does not exist yet.

    Returns:
        Content of the file afterwards.

    Raises:
        InputError: If it cannot be written or read.
    """
    path = place_of(path)
    with_others = path.parent
    try:
        made = _make_folders(with_others)
        sweep(with_others)
        if not os.path.lexists(path):
            temporary = _new_file(path)
            try:
                temporary.write_text(text, encoding="utf-8")
                sync(temporary)
                _sync_names(made)
                _link(temporary, path)
                sync(with_others)
            except OSError:
                remove(temporary)
                _remove_empty(made)
                raise
            remove(temporary)
            _written.append(path)
        return read_bytes(path, max_bytes=MAX_ONCE_BYTES).decode("utf-8", "replace")
    except OSError as error:
        raise cannot_write(path, error) from error


def _link(temporary: Path, path: Path) -> None:
    """Links a temporary file to its final name unless that name is taken."""
    try:
        os.link(temporary, path)
    except FileExistsError:
        pass
    except (PermissionError, NotImplementedError, AttributeError):  # file systems without hard links, such as FAT
        if not path.exists():
            temporary.replace(path)


def append_line(path: Path, line: str) -> None:
    """Appends a line to a log.

    Args:
        path: The file; missing parent folders are created.
        line: Text without a line break. A kill or a full disk may leave half a line, which readers must skip.

    Raises:
        InputError: If it cannot be written.
    """
    try:
        with opened_to_append(path) as file:
            file.write(f"{line}\n".encode())
    except OSError as error:
        raise cannot_write(path, error) from error


@contextmanager
def opened_to_append(path: Path) -> Iterator[BinaryIO]:
    """Opens a file of an output folder to append to it; a link or a FIFO is refused.

    Args:
        path: The file; missing parent folders are created.

    Yields:
        The open file.

    Raises:
        InputError: If it is not a regular file of that folder.
        OSError: If it cannot be written.
    """
    place = place_of(path)
    place.parent.mkdir(parents=True, exist_ok=True)
    if os.path.lexists(place) and not stat.S_ISREG(place.lstat().st_mode):
        raise InputError(f"{path} is no regular file; remove it or choose another --out")
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    with os.fdopen(os.open(place, flags | getattr(os, "O_BINARY", 0), 0o666), "ab") as file:
        yield file


@contextmanager
def claimed_folder(out: Path) -> Iterator[None]:
    """Holds an output folder that a command fills part by part; a second command is refused.

    Args:
        out: The folder; created, and removed again if it is still empty at the end.

    Raises:
        InputError: If another command holds it.
    """
    target = place_of(out, is_folder=True)
    try:
        made = _make_folders(target)
    except OSError as error:
        raise cannot_write(out, error) from error
    try:
        with locked(target, wait_s=0.0):
            yield
    finally:
        _remove_empty(made)


def written() -> list[Path]:
    """Paths that this process has completely written since `forget_written`, without those in unfinished folders."""
    return [path for path in _written if not any(is_staged(part) for part in path.parts)]


def forget_written() -> None:
    """Clears the list that `written` returns."""
    _written.clear()


def _make_folders(folder: Path) -> list[Path]:
    """Creates a folder and its parents; returns the new ones, innermost first."""
    missing = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def _sync_names(folders: list[Path]) -> None:
    """Syncs the directory entries of new folders; without them a crash would lose the folders' content."""
    for folder in folders:
        sync(folder.parent)


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
