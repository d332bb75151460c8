"""Damages files so that the damage reaches the decoder: bytes, text, JSON, arrays, and checksums made right again."""

import copy
import io
import json
import random
import struct
import warnings
import zipfile
import zlib
from typing import Any

import numpy as np

from mmweaver.compression.checked_file import CHECK, HEAD_CHECK, PREFIX
from mmweaver.compression.mmw_container import RECORD, VERSION, WORDS

ODD_NUMBERS: list[Any] = [
    0, -1, 1, 2**31, 2**32 + 1, 2**63, 10**40, 10**400, -(10**18), 1e308, -1e308, 1e-320, 1e30, 1e9, 0.5,
    float("nan"), float("inf"), -float("inf"),
]  # fmt: skip
ODD_VALUES: list[Any] = [*ODD_NUMBERS, None, True, False, "", "x", "NaN", "\ud800", "a" * 5000]
ODD_VALUES += [[], {}, [[]], [1], {"a": 1}]
ODD_WORDS = [
    "",
    "9" * 400,
    *["nan", "inf", "-inf", "1e400", "-1", "0", "1e-320", "x", "0x10", "٣", "1_0", "%", "\x00", "{", "}"],
]


class Undamaged(random.Random):
    """Chooses among seeds, and damages nothing: a case of it is a sound file."""


def mutated_bytes(data: bytes, rng: random.Random) -> bytes:
    """One to three damages: bits, bytes, cuts, repeats, zeros, integers at the edge of their range."""
    if isinstance(rng, Undamaged):
        return data
    out = bytearray(data)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        if not out:
            return bytes(out)
        at = rng.randrange(len(out)) if rng.random() < 0.6 else rng.randrange(min(len(out), 200))
        kind = rng.randrange(9)
        if kind == 0:
            out[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            out[at] = rng.randrange(256)
        elif kind == 2:
            del out[at:]
        elif kind == 3:
            del out[at : at + rng.choice((1, 4, 100))]
        elif kind == 4:
            out[at:at] = out[at : at + rng.choice((1, 8, 500))]
        elif kind == 5:
            out[at : at + 8] = bytes(8)
        elif kind == 6:
            out[at : at + 4] = rng.choice((b"\xff" * 4, b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\1\0"))
        elif kind == 7:
            out[at : at + 16] = rng.randbytes(16)
        else:
            out += rng.randbytes(rng.choice((1, 50)))
    return bytes(out)


def mutated_json(value: Any, rng: random.Random) -> Any:
    """A copy with one or two values replaced, removed, added or nested."""
    if isinstance(rng, Undamaged):
        return value
    damaged = json.loads(json.dumps(value))
    for _ in range(rng.choice((1, 1, 2))):
        places = list(_places(damaged))
        if not places:
            return odd_value(rng)
        holder, key = rng.choice(places)
        kind = rng.randrange(8)
        if kind <= 3:
            holder[key] = odd_value(rng)
        elif kind == 4 and isinstance(holder, dict):
            del holder[key]
        elif kind == 5 and isinstance(holder[key], (int, float)) and not isinstance(holder[key], bool):
            factor = rng.choice((-1, 0.5, 2, 1000, 1e-6, 1e9, 1e300))
            holder[key] = holder[key] * (factor if abs(holder[key]) < 1e300 else 2)
        elif kind == 6:
            holder[key] = [holder[key]] * rng.choice((0, 1, 2, 300))
        elif isinstance(holder, dict):
            holder[rng.choice(("x", "", "a" * 300))] = holder[key]
    return damaged


def odd_value(rng: random.Random) -> Any:
    """One of `ODD_VALUES`, a copy: what is put into it later must not appear in other cases."""
    return copy.deepcopy(rng.choice(ODD_VALUES))


def json_bytes(value: Any, rng: random.Random) -> bytes:
    """JSON text, now and then of a kind that a parser trips over."""
    if rng.random() < 0.03 and not isinstance(rng, Undamaged):
        return rng.choice(
            (b"[" * 100_000, b'{"a":' * 100_000, b"1" * 5000, b"", b"null", b"\xff\xfe", b"NaN", b'"\\ud800"')
        )
    return _dumped(value).encode("utf-8", "surrogatepass")


def mutated_text(text: str, rng: random.Random) -> str:
    """Lines and words of a text changed, removed, repeated."""
    if isinstance(rng, Undamaged):
        return text
    lines = text.split("\n")
    for _ in range(rng.choice((1, 1, 2, 4))):
        at = rng.randrange(len(lines))
        words = lines[at].split(" ")
        kind = rng.randrange(7)
        if kind <= 2:
            words[rng.randrange(len(words))] = rng.choice(ODD_WORDS)
            lines[at] = " ".join(words)
        elif kind == 3:
            del lines[at]
            lines = lines or [""]
        elif kind == 4:
            lines.insert(at, rng.choice(lines))
        elif kind == 5:
            lines[at] = " ".join(words[: rng.randrange(len(words) + 1)])
        else:
            lines[at] = lines[at] + rng.choice((" " + "7 " * 50, "\0", "é" * 300, "\r"))
    return "\n".join(lines)


def npy_bytes(array: np.ndarray) -> bytes:
    """The bytes of a .npy file."""
    stream = io.BytesIO()
    np.lib.format.write_array(stream, array, allow_pickle=False)
    return stream.getvalue()


def mutated_npy(array: np.ndarray, rng: random.Random) -> bytes:
    """Damaged values, types and shapes, a header that lies, or damaged bytes."""
    if isinstance(rng, Undamaged):
        return npy_bytes(array)
    kind = rng.randrange(4)
    if kind == 0:
        return mutated_bytes(npy_bytes(array), rng)
    if kind == 1:
        return npy_bytes(mutated_array(array, rng))
    if kind == 2:
        return mutated_bytes(npy_bytes(mutated_array(array, rng)), rng)
    shape = rng.choice(
        ("(99999999, 99999999)", "(-1, 64)", "()", "(0, 0)", "(48, 64", "(10**5,)", "(True, 64)", "(2,)*9")
    )
    descr = rng.choice(
        ("'<f8'", "'<c16'", "'|O'", "'<M8[s]'", "'|S0'", "[('a','<f8')]", "'<U9999999'", "('<f8',(3,))", "'<f16'")
    )
    order = rng.choice(("False", "True", "'x'"))
    return lying_npy(f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}", bytes(400))


def lying_npy(header: str, body: bytes = b"", version: int = 1) -> bytes:
    """A .npy of any header text."""
    text = header.encode("latin-1") + b"\n"
    size = struct.pack("<H", len(text) & 0xFFFF) if version == 1 else struct.pack("<I", len(text))
    return b"\x93NUMPY" + bytes((version, 0)) + size + text + body


def mutated_array(array: np.ndarray, rng: random.Random) -> np.ndarray:
    """Another type, shape, or values that are not finite or absurd."""
    kind = rng.randrange(9)
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # complex to real
        if kind == 0:
            try:
                return array.astype(rng.choice(("f4", "f2", "i2", "u1", "i8", "?", "c16", "U5", "S3", ">f8")))
            except (TypeError, ValueError):
                return array
        if kind == 1:
            return array[:0] if array.ndim else array
        if kind == 2:
            return array[None]
        if kind == 3:
            return array.ravel()
        if kind == 4:
            return array[:-1] if array.ndim and len(array) else array
        if kind == 5:
            return array.T
        if array.dtype.kind not in "fc" or not array.size:
            return array[:1] if array.ndim else array
        whole = np.array(array)
        flat = whole.reshape(-1) if whole.ndim else whole[None]
        share = rng.choice((1, 10, len(flat)))
        flat[rng.randrange(share) :: share] = rng.choice((np.nan, np.inf, -np.inf, 1e30, -1e30, 1e-30, 0, -1, 1e5))
        return flat.reshape(array.shape)


def mutated_npz(arrays: dict[str, np.ndarray], rng: random.Random) -> bytes:
    """Damaged arrays, names or archives, compressed or not."""
    held = dict(arrays)
    if isinstance(rng, Undamaged):
        return npz_bytes({name: npy_bytes(value) for name, value in held.items()})
    method = rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))
    kind = rng.randrange(6)
    raw: dict[str, bytes] = {}
    name = rng.choice(list(held))
    if kind == 0:
        del held[name]
    elif kind <= 3:
        held[name] = mutated_array(held[name], rng)
    elif kind == 4:
        raw[name] = mutated_npy(held[name], rng)
    data = npz_bytes({key: raw.get(key) or npy_bytes(value) for key, value in held.items()}, method)
    return mutated_bytes(data, rng) if kind == 5 else data


def npz_bytes(entries: dict[str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    """A zip archive of .npy entries."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, data in entries.items():
            archive.writestr(f"{name}.npy", data)
    return stream.getvalue()


def png_with_right_checksums(data: bytes) -> bytes:
    """A PNG whose chunks have their CRC again, so that damage reaches the decoder."""
    out, at = bytearray(data[:8]), 8
    while at + 12 <= len(data):
        size = int.from_bytes(data[at : at + 4], "big")
        if at + 12 + size > len(data):
            return bytes(out + data[at:])
        body = data[at + 4 : at + 8 + size]
        out += data[at : at + 4] + body + zlib.crc32(body).to_bytes(4, "big")
        at += 12 + size
    return bytes(out)


def mmw_parts(data: bytes) -> tuple[dict[str, Any], list[tuple[int, int, bytes]]]:
    """Header of a .mmw file, and frames, kind of times, and times with payload of its records."""
    _, _, size = PREFIX.unpack_from(data)
    head = json.loads(zlib.decompressobj(-15, WORDS).decompress(data[PREFIX.size : PREFIX.size + size]))
    records, at = [], PREFIX.size + size + CHECK.size
    while at < len(data):
        length, frames, kind = RECORD.unpack_from(data, at)
        first = at + RECORD.size + HEAD_CHECK.size
        records.append((frames, kind, data[first : first + length]))
        at = first + length + CHECK.size
    return head, records


def mmw_bytes(head: Any, records: list[tuple[int, int, bytes]], version: int = VERSION) -> bytes:
    """A .mmw file with right checksums, whatever it says."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15, 9, zlib.Z_DEFAULT_STRATEGY, WORDS)
    body = packer.compress(_dumped(head).encode("utf-8", "surrogatepass")) + packer.flush()
    front = PREFIX.pack(b"MMWV", version, min(len(body), 0xFFFF)) + body
    out = front + CHECK.pack(zlib.crc32(front))
    for frames, kind, payload in records:
        start = RECORD.pack(len(payload), frames, kind)
        record = start + HEAD_CHECK.pack(zlib.crc32(start) & 0xFFFF) + payload
        out += record + CHECK.pack(zlib.crc32(record))
    return out


def mutated_mmw(data: bytes, rng: random.Random) -> bytes:
    """A damaged header, record or payload under right checksums, or damaged bytes."""
    kind = rng.randrange(6)
    if kind == 0 or isinstance(rng, Undamaged):
        return mutated_bytes(data, rng)
    head, records = mmw_parts(data)
    if kind == 1:
        return mmw_bytes(mutated_json(head, rng), records)
    index = rng.randrange(len(records))
    frames, times, payload = records[index]
    if kind == 2:
        records[index] = (rng.randrange(65536), rng.randrange(4), payload)
        return mmw_bytes(head, records)
    chunk = bytearray(payload)
    for _ in range(rng.choice((1, 1, 3, 10))):
        at = rng.randrange(min(20, len(chunk))) if rng.random() < 0.4 else rng.randrange(len(chunk))
        chunk[at] = rng.randrange(256)
    if rng.random() < 0.15:
        del chunk[rng.randrange(1, len(chunk)) :]
    records[index] = (frames, times, bytes(chunk))
    return mmw_bytes(head, records)


def _places(value: Any) -> Any:
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in pairs:
        yield value, key
        yield from _places(item)


def _dumped(value: Any) -> str:
    text = json.dumps(value, default=str) if not _has_long(value) else repr(value).replace("'", '"')
    return text


def _has_long(value: Any) -> bool:
    if isinstance(value, dict):
        return any(_has_long(item) for item in value.values())
    if isinstance(value, list):
        return any(_has_long(item) for item in value)
    return isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > 10_000
