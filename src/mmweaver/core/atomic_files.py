"""Files and folders that are written completely or not at all: under a temporary name, synced to disk, then renamed.

A kill at any instant leaves the old state or the new one; the temporary names of a dead process are removed by the next
that writes there (`core.staging`). Nothing is renamed before its bytes are on the disk.
Reference: docs/decisions/writing-files.md.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mmweaver.core.checksums import SUMS_FILE, read_sums, sums_text, write_sums
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import cannot_write, check_output_folder, is_empty, resolved
from mmweaver.core.staging import COMMITTED, finish_moving, is_staged, remove, staging_path, sweep, sync, sync_tree

_written: list[Path] = []


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """A file that is written completely or not at all.

    Args:
        path: The file; missing folders are made.

    Yields:
        A temporary path in the same folder; on success it is renamed to `path`, on any error it is removed.

    Raises:
        InputError: where it cannot be written.
    """
    with atomic_files(path) as (temporary,):
        yield temporary


@contextmanager
def atomic_files(*paths: Path) -> Iterator[list[Path]]:
    """Several files that belong together: all are on the disk before the first is renamed.

    Args:
        *paths: The files; missing folders are made, and removed again on an error.

    Yields:
        A temporary path of each, as `atomic_file` yields one.

    Raises:
        InputError: where one of them cannot be written.
    """
    targets = [resolved(path) for path in paths]
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
        _rename_all(staged, targets)
    except OSError as error:
        raise cannot_write(Path(paths[0]), error) from error
    finally:
        for temporary in staged:
            remove(temporary)
        _remove_empty(made)


def _forget_sum(path: Path) -> None:
    """Takes a file out of its folder's SHA256SUMS, before it is replaced by a file of another origin."""
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
    """Renames one after the other; where one cannot be, those that were new are taken back."""
    new: list[Path] = []
    try:
        for temporary, target in zip(staged, targets, strict=True):
            is_new = not target.exists()
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
    """A folder that is written completely or not at all, with the sha256 of its files.

    An `out` that exists is filled, so that it may be a mount point or a working directory: the complete files are moved
    into it, and if that is interrupted, the next to write there moves the rest.

    Args:
        out: The folder.
        overwrite: Whether files may be replaced; those of other names stay.
        keep_existing: Whether a folder that is there by then is kept, for content that is the same whoever writes it.

    Yields:
        A temporary folder; on success it becomes `out`, on any error it is removed.

    Raises:
        InputError: where `check_output_folder` does, and where nothing can be written.
    """
    target = resolved(out)
    if not keep_existing:
        check_output_folder(out, overwrite=overwrite)
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
        if not is_new:
            _keep_sums(target, stage)
        sync_tree(stage)
        _sync_names(made)
        if is_new:
            _rename_new(stage, target, keep_existing=keep_existing)
        else:
            _move_into(stage, target)
        _written.append(Path(out))
    except OSError as error:
        raise cannot_write(Path(out), error) from error
    finally:
        if stage is not None:
            remove(stage)
        _remove_empty(made)


def _keep_sums(folder: Path, stage: Path) -> None:
    """Adds the checksums of files of a folder that stay to those of new files."""
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
            target.rename(stage)  # what is not on the disk is not reported as written, and not left either
        raise


def _move_into(stage: Path, folder: Path) -> None:
    if not is_empty(folder):
        for file in stage.iterdir():
            if (folder / file.name).is_dir() and not file.is_dir():
                raise IsADirectoryError(21, f"{file.name} is a folder there")
    stage.rename(folder / COMMITTED)
    try:
        sync(folder)
        finish_moving(folder)
    except KeyboardInterrupt:
        finish_moving(folder)
        _written.append(folder)
        raise


def create_once(path: Path, text: str) -> str:
    """Writes a file unless there is one: of several processes the first decides.

    Args:
        path: The file.
        text: Its content, if it is new.

    Returns:
        What the file holds afterwards.

    Raises:
        InputError: where it cannot be written or read.
    """
    with_others = path.parent
    try:
        made = _make_folders(with_others)
        sweep(with_others)
        if not path.exists():
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
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise cannot_write(path, error) from error


def _link(temporary: Path, path: Path) -> None:
    """Gives a file its name unless another has it."""
    try:
        os.link(temporary, path)
    except FileExistsError:
        pass
    except (PermissionError, NotImplementedError, AttributeError):  # a file system without links, as FAT
        if not path.exists():
            temporary.replace(path)


def append_line(path: Path, line: str) -> None:
    """Adds a line to a log. A kill or a full disk may leave half a line, which its reader must skip."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("a", encoding="utf-8") as file:
            file.write(f"{line}\n")
    except OSError as error:
        raise cannot_write(path, error) from error


def written() -> list[Path]:
    """What this process has written completely, since `forget_written`; not what lies in a folder yet unfinished."""
    return [path for path in _written if not any(is_staged(part) for part in path.parts)]


def forget_written() -> None:
    """Begins the list of `written` anew."""
    _written.clear()


def _make_folders(folder: Path) -> list[Path]:
    """Makes a folder and those above it; returns the new ones, the innermost first."""
    missing = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def _sync_names(folders: list[Path]) -> None:
    """Brings the names of new folders to the disk, without which what is in them would be lost with them."""
    for folder in folders:
        sync(folder.parent)


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
