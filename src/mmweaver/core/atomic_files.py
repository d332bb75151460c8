"""Files and folders that are written completely or not at all: under a temporary name, then renamed."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mmweaver.core.errors import InputError


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """Yields a temporary path in the same folder; on success it is renamed to `path`, on any error it is removed."""
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    except OSError as error:
        raise InputError(_cannot_write(path, error)) from error
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as error:
        raise InputError(_cannot_write(path, error)) from error
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def staged_folder(out: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Yields a temporary folder next to `out`; on success it is renamed to `out`, on any error it is removed.

    Raises InputError where `out` exists and is not an empty folder, unless `overwrite` allows its files to be
    replaced one by one (files of other names in it stay), or where nothing can be written.
    """
    out = Path(out)
    check_output_folder(out, overwrite=overwrite)
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        stage = Path(tempfile.mkdtemp(prefix=f".{out.name}.", dir=out.parent))
    except OSError as error:
        raise InputError(_cannot_write(out, error)) from error
    try:
        yield stage
        stage.chmod(0o777 & ~_umask())
        _move_into_place(stage, out)
    except OSError as error:
        raise InputError(_cannot_write(out, error)) from error
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def check_output_folder(out: Path, *, overwrite: bool) -> None:
    """Raises InputError where `staged_folder` would; cheap, so that it can be called before long work."""
    out = Path(out)
    if out.exists() and not out.is_dir():
        raise InputError(f"{out} is a file, not a folder; choose another --out")
    if out.is_dir() and any(out.iterdir()) and not overwrite:
        raise InputError(f"{out} exists and is not empty; choose another --out or allow it with --overwrite")
    nearest = next(folder for folder in (out.absolute(), *out.absolute().parents) if folder.exists())
    if not nearest.is_dir():
        raise InputError(f"{out} cannot be a folder, for {nearest} is a file; choose another --out")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise InputError(f"{out} cannot be written: no permission in {nearest}; choose another --out")


def _move_into_place(stage: Path, out: Path) -> None:
    if out.is_dir() and any(out.iterdir()):
        for file in stage.iterdir():
            file.replace(out / file.name)
        return
    if out.is_dir():
        out.rmdir()
    stage.rename(out)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _cannot_write(path: Path, error: OSError) -> str:
    return f"cannot write {path}: {error.strerror or error}; free some space or choose another --out"
