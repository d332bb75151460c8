"""A folder packed into one uncompressed zip, read in place: files are slices of the mapped zip.

Written once a folder is complete, so that a data set of many rooms needs one file per room and one sync. Any zip reader
opens it, zarr by `zarr.storage.ZipStore`. Entries are stored, not compressed: chunks of arrays are packed already.
"""

import io
import mmap
import struct
import zipfile
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path, PurePosixPath

from mmweaver.core.errors import InputError

MAX_OPEN = 32  # zips mapped at a time
MAX_ENTRIES = 100_000
LOCAL_HEADER = struct.Struct("<4s22xHH")  # signature, lengths of name and extra field
FIXED_TIME = (1980, 1, 1, 0, 0, 0)  # equal content gives equal bytes


class PackedPath:
    """A file or folder in a packed folder, with the few methods of `Path` that readers need.

    Args:
        file: The zip.
        inner: Path inside it; empty for its root.
    """

    def __init__(self, file: Path, inner: str = ""):
        self.file, self.inner = file, inner

    def __str__(self) -> str:
        return f"{self.file}/{self.inner}" if self.inner else str(self.file)

    def __repr__(self) -> str:
        return f"PackedPath({str(self)!r})"

    def __fspath__(self) -> str:
        return str(self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PackedPath) and (self.file, self.inner) == (other.file, other.inner)

    def __hash__(self) -> int:
        return hash((self.file, self.inner))

    def __lt__(self, other: "PackedPath") -> bool:
        return (self.file, self.inner) < (other.file, other.inner)

    def __truediv__(self, name: str) -> "PackedPath":
        return PackedPath(self.file, f"{self.inner}/{name}" if self.inner else name)

    @property
    def name(self) -> str:
        """Last part of the path."""
        return PurePosixPath(self.inner).name if self.inner else self.file.name

    @property
    def parent(self) -> "PackedPath | Path":
        """The folder that contains it; of the root, that of the zip."""
        if not self.inner:
            return self.file.parent
        return PackedPath(self.file, str(PurePosixPath(self.inner).parent).removeprefix("."))

    def relative_to(self, other: "Path | PackedPath") -> PurePosixPath:
        """Path relative to a folder above it in the same zip."""
        return PurePosixPath(self.inner).relative_to(other.inner if isinstance(other, PackedPath) else str(other))

    def is_file(self) -> bool:
        """Whether it is a file."""
        return self.inner in entries_of(self.file)

    def is_dir(self) -> bool:
        """Whether it is a folder."""
        return not self.inner or any(self._below())

    def exists(self) -> bool:
        """Whether it is there."""
        return self.is_file() or self.is_dir()

    def files(self) -> "Iterator[PackedPath]":
        """All files at any depth below it."""
        return (PackedPath(self.file, name) for name in self._below())

    def rglob(self, name: str) -> "Iterator[PackedPath]":
        """Files of this name at any depth below it."""
        return (one for one in self.files() if one.name == name)

    def data(self) -> memoryview:
        """Its bytes, not yet read from disk.

        Raises:
            InputError: If it is no file of a readable zip.
        """
        found = entries_of(self.file).get(self.inner)
        if found is None:
            raise InputError(f"cannot read {self}: no such file in the zip")
        return found

    def open(self) -> io.BufferedReader:
        """Opens it for reading."""
        return io.BufferedReader(io.BytesIO(self.data()))  # type: ignore[arg-type]

    def _below(self) -> Iterator[str]:
        return (name for name in entries_of(self.file) if not self.inner or name.startswith(f"{self.inner}/"))


def entries_of(file: Path) -> dict[str, memoryview]:
    """Bytes of all entries of a zip by name, mapped and thus neither copied nor read before use.

    Args:
        file: The zip.

    Raises:
        InputError: If it is damaged, or has compressed entries.
    """
    if not file.is_file():
        raise InputError(f"cannot read {file}: it is no regular file")
    state = file.stat()
    return _mapped(file, state.st_ino, state.st_size, state.st_mtime_ns)


@lru_cache(maxsize=MAX_OPEN)
def _mapped(file: Path, _inode: int, size: int, _changed: int) -> dict[str, memoryview]:
    try:
        with file.open("rb") as stream:
            with zipfile.ZipFile(stream) as packed:
                listed = packed.infolist()
            if len(listed) > MAX_ENTRIES:
                raise ValueError(f"it has {len(listed)} entries")
            whole = memoryview(mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ))
        return {one.filename: _slice(whole, one, size) for one in listed}
    except (OSError, ValueError, struct.error, zipfile.BadZipFile, NotImplementedError) as error:
        raise InputError(f"{file} is damaged ({' '.join(str(error).split())[:120]}); make it again") from None


def _slice(whole: memoryview, entry: zipfile.ZipInfo, size: int) -> memoryview:
    if entry.compress_type != zipfile.ZIP_STORED or entry.compress_size != entry.file_size:
        raise ValueError(f"{entry.filename} is compressed")
    signature, name, extra = LOCAL_HEADER.unpack_from(whole, entry.header_offset)
    first = entry.header_offset + LOCAL_HEADER.size + name + extra
    if signature != b"PK\x03\x04" or first + entry.file_size > size:
        raise ValueError(f"{entry.filename} is not where the list has it")
    return whole[first : first + entry.file_size]


def pack_folder(folder: Path, file: Path) -> None:
    """Packs all files of a folder into an uncompressed zip, sorted by name.

    Args:
        folder: The folder.
        file: The zip.

    Raises:
        OSError: If it cannot be written.
    """
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED, allowZip64=True) as packed:
        for place in sorted(one for one in folder.rglob("*") if one.is_file()):
            about = zipfile.ZipInfo(place.relative_to(folder).as_posix(), FIXED_TIME)
            about.external_attr = 0o644 << 16
            with (
                packed.open(about, "w", force_zip64=place.stat().st_size >= 2**31) as entry,
                place.open("rb") as data,
            ):
                while piece := data.read(1 << 20):
                    entry.write(piece)
