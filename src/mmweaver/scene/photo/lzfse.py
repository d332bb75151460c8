"""Files compressed with Apple's LZFSE, of known length: the depth of Record3D.

Uncompressed blocks need no library; others need pyliblzfse, which is in no extra. The unpacked size is summed from the
headers of the blocks before anything is unpacked.
Reference: github.com/lzfse/lzfse, src/lzfse_internal.h (block headers).
"""

from importlib import import_module
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import foreign_errors, read_bytes

STORED, END = b"bvx-", b"bvx$"
LZVN, WITH_TABLES, WITHOUT_TABLES = b"bvxn", b"bvx1", b"bvx2"
TABLELESS_HEADER_BYTES = 32  # of a bvx2 block, at least
TABLES_HEADER_BYTES = 770  # of a bvx1 block
BROKEN = "no LZFSE file ({reason}); export the scan again"


def read_lzfse(path: Path, length: int) -> bytes:
    """Reads a file compressed with LZFSE.

    Args:
        path: The file.
        length: Length of the content in bytes.

    Returns:
        The content.

    Raises:
        InputError: If the file is not LZFSE of this length, or needs a library that is not installed.
    """
    data = read_bytes(path, max_bytes=2 * length + 4096)
    plain = _stored(data)
    if plain is None:
        if unpacked_length(data) != length:
            raise InputError(f"{path} is no LZFSE file of {length} bytes; export the scan again")
        try:
            library: Any = import_module("liblzfse")
        except ImportError:
            raise InputError(f"{path} is compressed with LZFSE; install its reader: pip install pyliblzfse") from None
        with foreign_errors(path, BROKEN):
            plain = bytes(library.decompress(data))
    if len(plain) != length:
        raise InputError(f"{path} holds {len(plain)} bytes, not {length}; export the scan again")
    return plain


def _stored(data: bytes) -> bytes | None:
    """Content if all blocks are stored uncompressed; None if others are present."""
    pieces, at = [], 0
    while data[at : at + 4] == STORED:
        size = int.from_bytes(data[at + 4 : at + 8], "little")
        pieces.append(data[at + 8 : at + 8 + size])
        at += 8 + size
    return b"".join(pieces) if pieces and data[at : at + 4] == END else None


def unpacked_length(data: bytes) -> int:
    """Sums the unpacked size from the headers of all blocks.

    Args:
        data: Content of the file.

    Returns:
        Length in bytes; -1 if `data` is not an LZFSE stream.

    >>> unpacked_length(b"bvx-" + (3).to_bytes(4, "little") + b"abc" + b"bvx$")
    3
    """
    at = total = 0
    while True:
        kind, raw = data[at : at + 4], int.from_bytes(data[at + 4 : at + 8], "little")
        if kind == END:
            return total
        if kind == STORED:
            at += 8 + raw
        elif kind == LZVN:
            at += 12 + int.from_bytes(data[at + 8 : at + 12], "little")
        elif kind == WITH_TABLES:
            at += TABLES_HEADER_BYTES + int.from_bytes(data[at + 8 : at + 12], "little")
        elif kind == WITHOUT_TABLES:
            first, second, third = (int.from_bytes(data[at + 8 + 8 * k : at + 16 + 8 * k], "little") for k in range(3))
            literal, matches = (first >> 20) & 0xFFFFF, (second >> 40) & 0xFFFFF
            at += max(third & 0xFFFFFFFF, TABLELESS_HEADER_BYTES) + literal + matches
        else:
            return -1
        total += raw
