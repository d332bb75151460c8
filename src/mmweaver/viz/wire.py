"""Binary format between Python and the page: one JSON header, then little-endian arrays.

uint32   length n of the header, a multiple of 4
n bytes  JSON, padded with spaces; its key "arrays" maps a name to [type, shape, byte offset after the header]
...      the arrays in C order, each padded to 4 bytes
"""

import json
import struct
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.io.result_folder import plain

TYPES = {"u1": "uint8", "i2": "int16", "i4": "int32", "f4": "float32"}


def pack(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> bytes:
    """Header and arrays as bytes.

    Args:
        header: Values for JSON.
        arrays: Arrays by name, uint8, int16, int32 or float32.

    Raises:
        ValueError: For an array of another type.
    """
    table: dict[str, list[Any]] = {}
    chunks: list[bytes] = []
    offset = 0
    for name, array in arrays.items():
        kind = array.dtype.str[1:]
        if kind not in TYPES:
            raise ValueError(f"{name} is {array.dtype}; the page reads {', '.join(TYPES.values())}")
        chunk = np.ascontiguousarray(array).astype(f"<{kind}", copy=False).tobytes()
        table[name] = [kind, list(array.shape), offset]
        chunk += b"\0" * (-len(chunk) % 4)
        chunks.append(chunk)
        offset += len(chunk)
    text = json.dumps(plain({**header, "arrays": table}), allow_nan=False, ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    return b"".join([struct.pack("<I", len(text)), text, *chunks])


def unpack(data: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """The header (without "arrays") and the arrays of `pack`.

    Raises:
        InputError: For bytes that are not of `pack`.
    """
    try:
        (length,) = struct.unpack_from("<I", data)
        header = parse_json(data[4 : 4 + length], "the header")
        listed = header.pop("arrays")
        if unknown := {kind for kind, _, _ in listed.values()} - set(TYPES):
            raise ValueError(f"no type is called {min(unknown)!r}")
        arrays = {
            name: np.frombuffer(data, f"<{kind}", int(np.prod(shape)), 4 + length + offset).reshape(shape)
            for name, (kind, shape, offset) in listed.items()
        }
    except (struct.error, ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        raise InputError(f"these bytes hold no sequence for the page: {error}") from None
    return header, arrays
