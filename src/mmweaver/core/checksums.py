"""SHA256SUMS: the sha256 of every file of a folder, as `sha256sum` writes it, so that damage is noticed.

    # mmweaver; check with: mmweaver verify DIR, or sha256sum -c SHA256SUMS
    9f86d081...  radar.npz

A file named there is checked before it is used (`check_file`), once a process unless it has changed since. Folders of
other origin, and files that are not named, are read as they are. Reference: docs/decisions/writing-files.md.
"""

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import foreign_errors, open_regular, read_bytes

SUMS_FILE = "SHA256SUMS"
FIRST_LINE = "# mmweaver; check with: mmweaver verify DIR, or sha256sum -c SHA256SUMS"
MAX_SUMS_BYTES = 64 * 2**20  # bytes
_checked: dict[str, tuple[int, int, int]] = {}  # by path: inode, size and time of change when it was right


@dataclass(frozen=True, kw_only=True)
class Damage:
    """A file that is not as it was written."""

    file: Path
    what: str  # "is missing" or "is not as it was written"

    def __str__(self) -> str:
        return f"{self.file} {self.what}"


def sha256_of_file(path: Path) -> str:
    """The sha256 of a regular file, hexadecimal. Raises InputError where it cannot be read."""
    with open_regular(path) as stream, foreign_errors(path, "unreadable ({reason})"):
        return hashlib.file_digest(stream, "sha256").hexdigest()


def write_sums(folder: Path, *, names: tuple[str, ...] | None = None, target: Path | None = None) -> None:
    """Writes SHA256SUMS of a folder.

    Args:
        folder: The folder.
        names: Entries that are listed, with all files below them. Default: all.
        target: File that is written. Default: SHA256SUMS of the folder.
    """
    roots = [folder / name for name in names] if names is not None else [folder]
    files = [root for root in roots if root.is_file()]
    files += [file for root in roots if root.is_dir() for file in root.rglob("*") if file.is_file()]
    listed = sorted(file.relative_to(folder).as_posix() for file in files if file != folder / SUMS_FILE)
    text = sums_text({name: sha256_of_file(folder / name) for name in listed})
    (target or folder / SUMS_FILE).write_text(text, encoding="utf-8")


def sums_text(sums: dict[str, str]) -> str:
    """The content of SHA256SUMS."""
    return "".join(f"{line}\n" for line in (FIRST_LINE, *(f"{digest}  {name}" for name, digest in sums.items())))


def read_sums(folder: Path) -> dict[str, str] | None:
    """The checksums of a folder.

    Args:
        folder: The folder.

    Returns:
        {name: sha256}; None where it has none of ours.

    Raises:
        InputError: where SHA256SUMS is damaged.
    """
    file = folder / SUMS_FILE
    try:
        if not file.is_file():
            return None
        data = read_bytes(file, max_bytes=MAX_SUMS_BYTES)
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror or error}") from None
    first, *lines = data.decode("utf-8", errors="replace").split("\n")
    if first != FIRST_LINE:
        # nearly ours is ours with a flipped bit
        return _damaged(file) if any(word in data[:100] for word in (b"# mmweaver", b"mmweaver verify")) else None
    if lines[-1:] != [""]:
        return _damaged(file)
    sums: dict[str, str] = {}
    for line in lines[:-1]:
        digest, gap, name = line[:64], line[64:66], line[66:]
        if (
            gap != "  "
            or not name
            or not set(digest) <= set("0123456789abcdef")
            or name.startswith("/")
            or ".." in name.split("/")
        ):
            return _damaged(file)
        sums[name] = digest
    return sums


def _damaged(file: Path) -> dict[str, str]:
    raise InputError(f"{file} is damaged; find out what else is with: mmweaver verify {file.parent}")


def check_file(path: Path, *, folder: Path | None = None) -> None:
    """Checks a file against the SHA256SUMS of its folder; files that are not listed pass.

    Args:
        path: The file.
        folder: Folder above it that has the checksums. Default: its own.

    Raises:
        InputError: where the file has changed or is missing.
    """
    folder = path.parent if folder is None else folder
    sums = read_sums(folder)
    name = path.relative_to(folder).as_posix()
    if sums is None or name not in sums:
        return
    found = damage_of_file(folder, name, sums[name])
    if found is not None:
        raise InputError(
            f"{found}; make it anew (mmweaver verify {folder} says how), or delete {folder / SUMS_FILE} to use it as"
            " it is"
        )


def damage_of_file(folder: Path, name: str, expected: str, *, use_cache: bool = True) -> Damage | None:
    """Compares a file with its checksum.

    Args:
        folder: Folder of the checksums.
        name: The file's name there.
        expected: Its sha256, hexadecimal.
        use_cache: Whether a file is not read again that was right before and has not changed since.

    Returns:
        What is wrong with it; None where nothing is.
    """
    file = folder / name
    try:
        if not file.exists():
            return Damage(file=file, what="is missing")
        with open_regular(file) as stream:
            about = os.fstat(stream.fileno())
            state = (about.st_ino, about.st_size, about.st_mtime_ns)
            if use_cache and _checked.get(f"{file}\n{expected}") == state:
                return None
            if hashlib.file_digest(stream, "sha256").hexdigest() == expected:
                _checked[f"{file}\n{expected}"] = state
                return None
    except InputError:
        return Damage(file=file, what="is missing or no regular file")
    except OSError as error:
        return Damage(file=file, what=f"cannot be read ({error.strerror or error})")
    return Damage(file=file, what="is not as it was written")


def damages(folder: Path) -> list[Damage]:
    """All files of a folder that are not as they were written; without SHA256SUMS none is known."""
    sums = read_sums(folder) or {}
    found = (damage_of_file(folder, name, expected, use_cache=False) for name, expected in sums.items())
    return [damage for damage in found if damage is not None]
