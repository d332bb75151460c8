"""Files of a checked header and checked records, the common structure of .mmw and .mmwl.

    magic number | version u8 | length of header u16 | header | CRC-32 of everything before | record, record, ...

All values are little-endian. A record ends with the CRC-32 of its contents; a 16-bit check after its head distinguishes
a damaged length from a truncated file.
"""

import struct
import zlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, ClassVar

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import check_regular, open_regular

PREFIX = struct.Struct("<4sBH")
CHECK = struct.Struct("<I")
HEAD_CHECK = struct.Struct("<H")


def checked(body: bytes) -> bytes:
    """Bytes followed by their CRC-32."""
    return body + CHECK.pack(zlib.crc32(body))


def head_check(head: bytes) -> bytes:
    """The 16-bit check that follows the head of a record."""
    return HEAD_CHECK.pack(zlib.crc32(head) & 0xFFFF)


@dataclass(frozen=True, kw_only=True)
class RecordPlace:
    """Where a record lies in its file."""

    start: int
    offset: int  # of the payload
    num_bytes: int  # of the payload


class CheckedFile(ABC):
    """A file whose header and record positions are read and checked on construction, records on demand.

    `cut_short` is the number of bytes after the last complete record; 0 for a complete file.
    """

    MAGIC: ClassVar[bytes]
    SUFFIX: ClassVar[str]
    READABLE: ClassVar[tuple[int, ...]]  # versions
    MADE_BY: ClassVar[str]  # the command that makes one
    RECORD_NAME: ClassVar[str]

    def __init__(self, path: Path | str):
        """Reads the header and finds the records.

        Args:
            path: Path of the file.

        Raises:
            InputError: If the file is unreadable, of another kind, or damaged before its first record.
        """
        self.path, self.cut_short = Path(path), 0
        self.places: list[RecordPlace] = []
        self.num_bytes = check_regular(path)
        with open_regular(path) as stream:
            front = stream.read(PREFIX.size)
            if len(front) < PREFIX.size or front[: len(self.MAGIC)] != self.MAGIC:
                raise InputError(f"{path} is no {self.SUFFIX} file; make one with: {self.MADE_BY}")
            _, self.version, size = PREFIX.unpack(front)
            if self.version not in self.READABLE:
                raise InputError(
                    f"{path} is a {self.SUFFIX} file of version {self.version}, or damaged; this program reads"
                    f" {', '.join(map(str, self.READABLE))}"
                )
            body, check = stream.read(size), stream.read(CHECK.size)
            if len(check) < CHECK.size or CHECK.unpack(check)[0] != zlib.crc32(front + body):
                raise self.damaged("its header fails its checksum")
            try:
                self._read_header(body)
            except InputError as error:
                raise self.damaged(str(error)) from None
            except (zlib.error, ValueError, LookupError, TypeError, OverflowError, AttributeError) as error:
                raise self.damaged(f"its header is malformed ({error})") from None
            self._find_records(stream)

    @abstractmethod
    def _read_header(self, body: bytes) -> None:
        """Reads the header; any error it raises is reported as damage in one line."""

    @abstractmethod
    def _find_records(self, stream: BinaryIO) -> None:
        """Finds the records, the first of which begins at the position of the stream."""

    def _scanned(
        self, stream: BinaryIO, head: struct.Struct, extra: Callable[..., int | None]
    ) -> Iterator[tuple[tuple[int, ...], bytes]]:
        """Finds the records from where the stream is; nothing is read but what stands in front of the payloads.

        Args:
            stream: the file.
            head: of a record; its first field is the length of the payload.
            extra: bytes that follow a head with these other fields; None for impossible ones.

        Yields:
            The other fields of each whole record's head, and its extra bytes.
        """
        at = stream.tell()
        while at + head.size <= self.num_bytes:
            stream.seek(at)
            front = stream.read(head.size)
            length, *fields = head.unpack(front)
            num_extra = extra(*fields)
            offset = at + head.size + (num_extra or 0) + HEAD_CHECK.size
            if num_extra is not None and offset > self.num_bytes:
                break
            words, check = stream.read(num_extra or 0), stream.read(HEAD_CHECK.size)
            if num_extra is None or check != head_check(front + words):
                raise self.damaged(f"{self.RECORD_NAME} {len(self.places)} fails its checksum")
            if offset + length + CHECK.size > self.num_bytes:
                break
            self.places.append(RecordPlace(start=at, offset=offset, num_bytes=length))
            yield tuple(fields), words
            at = offset + length + CHECK.size
        self.cut_short = self.num_bytes - at

    def payload(self, index: int) -> bytes:
        """A record's payload. Raises InputError where the record fails its checksum."""
        place = self.places[index]
        with open_regular(self.path) as stream:
            stream.seek(place.start)
            data = stream.read(place.offset + place.num_bytes + CHECK.size - place.start)
        body, check = data[: -CHECK.size], data[-CHECK.size :]
        if len(body) < place.offset + place.num_bytes - place.start or CHECK.unpack(check)[0] != zlib.crc32(body):
            raise self.damaged(f"{self.RECORD_NAME} {index} fails its checksum")
        return body[place.offset - place.start :]

    def damaged(self, why: str) -> InputError:
        """The error that reports damage of this file."""
        return InputError(f"{self.path} is damaged: {why}; copy it again or compress the recording again")
