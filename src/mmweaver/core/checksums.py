"""SHA256SUMS: the SHA-256 of every file of a folder in the format of `sha256sum`, to detect damage.

    # mmweaver; check with: mmweaver verify DIR, or sha256sum -c SHA256SUMS
    9f86d081...  radar.npz

A listed file is checked before use (`check_file`), once per process unless it has changed since. Folders of other
origin and unlisted files are read unchecked. Reference: docs/decisions/writing-files.md.
"""

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError, one_line
from mmweaver.core.safe_files.packed_folder import PackedPath
from mmweaver.core.safe_files.regular_files import Place, foreign_errors, open_regular, read_bytes

SUMS_FILE = "SHA256SUMS"
FIRST_LINE = "# mmweaver; check with: mmweaver verify DIR, or sha256sum -c SHA256SUMS"
MAX_SUMS_BYTES = 64 * 2**20  # bytes
_checked: dict[str, tuple[int, int, int]] = {}  # by path and digest: inode, size and modification time when checked


@dataclass(frozen=True, kw_only=True)
class Damage:
    """A file whose content does not match its checksum."""

    file: Place
    what: str  # "is missing" or "is not as it was written"

    def __str__(self) -> str:
        return f"{one_line(str(self.file))} {self.what}"


def sha256_of_file(path: Path) -> str:
    """SHA-256 of a regular file.

    Args:
        path: The file.

    Returns:
        Hexadecimal digest.

    Raises:
        InputError: If it cannot be read.
    """
    with open_regular(path) as stream, foreign_errors(path, "unreadable ({reason})"):
        return hashlib.file_digest(stream, "sha256").hexdigest()


def write_sums(folder: Path, *, names: tuple[str, ...] | None = None, target: Path | None = None) -> None:
    """Writes the SHA256SUMS of a folder.

    Args:
        folder: The folder.
        names: Entries to list, including all files below them. Default: all.
        target: Output file. Default: SHA256SUMS in `folder`.
    """
    roots = [folder / name for name in names] if names is not None else [folder]
    files = [root for root in roots if root.is_file()]
    files += [file for root in roots if root.is_dir() for file in root.rglob("*") if file.is_file()]
    listed = sorted(file.relative_to(folder).as_posix() for file in files if file != folder / SUMS_FILE)
    text = sums_text({name: sha256_of_file(folder / name) for name in listed})
    (target or folder / SUMS_FILE).write_text(text, encoding="utf-8")


def sums_text(sums: dict[str, str]) -> str:
    """Formats checksums as the content of SHA256SUMS.

    Args:
        sums: Hexadecimal SHA-256 by file name.

    Returns:
        Text with the header line.
    """
    return "".join(f"{line}\n" for line in (FIRST_LINE, *(f"{digest}  {name}" for name, digest in sums.items())))


def read_sums(folder: Place) -> dict[str, str] | None:
    """Reads the checksums of a folder.

    Args:
        folder: The folder.

    Returns:
        Hexadecimal SHA-256 by file name; None if the folder has no SHA256SUMS written by mmWeaver.

    Raises:
        InputError: If SHA256SUMS is damaged.
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
        # a first line that nearly matches is ours with a flipped bit
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


def _damaged(file: Place) -> dict[str, str]:
    raise InputError(f"{file} is damaged; find out what else is with: mmweaver verify {file.parent}")


def check_file(path: Path, *, folder: Path | None = None) -> None:
    """Checks a file against the SHA256SUMS of its folder; unlisted files pass.

    Args:
        path: The file.
        folder: Parent folder that has the checksums. Default: the file's own folder.

    Raises:
        InputError: If the file has changed or is missing.
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


def damage_of_file(folder: Place, name: str, expected: str, *, use_cache: bool = True) -> Damage | None:
    """Compares a file with its checksum.

    Args:
        folder: Folder of the checksums.
        name: Name of the file relative to `folder`.
        expected: SHA-256, hexadecimal.
        use_cache: Whether a file that was intact and has not changed since is not read again. Default: True.

    Returns:
        The damage, or None if the file is intact.
    """
    file = folder / name
    try:
        if not file.exists():
            return Damage(file=file, what="is missing")
        with open_regular(file) as stream:
            about = file.file.stat() if isinstance(file, PackedPath) else os.fstat(stream.fileno())
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


def damages(folder: Place) -> list[Damage]:
    """Checks all files listed in a folder's SHA256SUMS.

    Args:
        folder: The folder.

    Returns:
        Damaged or missing files; empty without SHA256SUMS.

    Raises:
        InputError: If SHA256SUMS itself is damaged.
    """
    sums = read_sums(folder) or {}
    found = (damage_of_file(folder, name, expected, use_cache=False) for name, expected in sums.items())
    return [damage for damage in found if damage is not None]
