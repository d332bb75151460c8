"""The .mmw container: a header and chunks of a few frames each, all covered by checksums.

    "MMWV" | version u8 | length of header u16 | header | chunk, chunk, ... ; all little-endian
    header: JSON (UTF-8), deflated with a dictionary | CRC-32 of all before it
    chunk:  payload | CRC-32 of it

The header lists the frames and bytes of every chunk, so that one chunk can be read without the others. It names the
radar in full, or by its preset where it is one. Reference: docs/mmw_format.md.
"""

import json
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.presets import PRESETS
from mmweaver.core.radar_config import RadarConfig

MAGIC, VERSION = b"MMWV", 2
READABLE = (1, 2)  # 2 may hold residuals with a map of open cells
PREFIX = struct.Struct("<4sBH")
CHECK = struct.Struct("<I")
# Deflate dictionary of header text; part of the format, so it must never change.
WORDS = (
    b'{"chunks":[[20,],"frame_period_s":,"frame_start_s":,"frame_time_s":,"radar":{"schema_version":1,"name":"",'
    b'"start_frequency_hz":77000000000.0,"chirp_slope_hz_per_s":60012000000000.0,"idle_time_s":7e-06,'
    b'"adc_start_time_s":6e-06,"ramp_end_time_s":6.5e-05,"num_samples":256,"sample_rate_hz":4510000.0,"num_loops":32,'
    b'"frame_period_s":0.1,"tx_position_m":[[0.0,0.0,0.0],"rx_position_m":[[-0.0,"tx_order":[0,2,1],'
    b'"complex_samples":true,"first_range_bin":16,"num_range_bins":64,"tx_power_dbm":12.0,"antenna_gain_dbi":10.5,'
    b'"noise_figure_db":15.0,"rx_gain_db":30.0,"azimuth_beamwidth_deg":56.0,"elevation_beamwidth_deg":28.0,'
    b'"adc_full_scale_v":0.5,"frequency_limits_hz":[57000000000.0,81500000000.0]},"scale":1.0,"preset":"awr1843",'
)


@dataclass(frozen=True, kw_only=True)
class MmwHeader:
    """Header of a .mmw file. `frame_time_s` counts from the start of the recording; `scale` as in RadarCube."""

    config: RadarConfig
    scale: float
    frame_time_s: tuple[float, ...]
    chunk_frames: tuple[int, ...]
    chunk_bytes: tuple[int, ...] = ()


def pack_mmw(header: MmwHeader, chunks: list[bytes]) -> bytes:
    """The bytes of a file; fills in the chunk lengths in the header."""
    front = _packed_header(header, [len(chunk) for chunk in chunks])
    return front + b"".join(chunk + CHECK.pack(zlib.crc32(chunk)) for chunk in chunks)


def unpack_mmw(data: bytes) -> tuple[MmwHeader, list[bytes]]:
    """Header and chunks of bytes from `pack_mmw`; nothing is checked."""
    _, _, size = PREFIX.unpack_from(data)
    header = _header_of(json.loads(_inflated(data[PREFIX.size : PREFIX.size + size])))
    chunks, at = [], PREFIX.size + size + CHECK.size
    for length in header.chunk_bytes:
        chunks.append(data[at : at + length])
        at += length + CHECK.size
    return header, chunks


def write_mmw(path: Path | str, header: MmwHeader, chunks: list[bytes]) -> int:
    """Writes the file atomically and returns its size. Raises InputError where it cannot be written."""
    data = pack_mmw(header, chunks)
    with atomic_file(Path(path)) as temporary:
        temporary.write_bytes(data)
    return len(data)


class MmwFile:
    """A .mmw file: the header is read and checked at once, chunks on demand."""

    def __init__(self, path: Path | str):
        """Raises InputError where the file is unreadable, not a .mmw file, truncated, or its header is damaged."""
        self.path = Path(path)
        try:
            self.num_bytes = self.path.stat().st_size
            with self.path.open("rb") as stream:
                front = stream.read(PREFIX.size)
                size = self._header_size(front)
                body = stream.read(size + CHECK.size)
        except OSError as error:
            raise InputError(f"cannot read {path}: {error.strerror or error}") from None
        if len(body) < size + CHECK.size:
            raise self._damaged("it is truncated")
        if CHECK.unpack(body[size:])[0] != zlib.crc32(front + body[:size]):
            raise self._damaged("its header fails its checksum")
        try:
            self.header = _header_of(json.loads(_inflated(body[:size])))
        except (zlib.error, ValueError, KeyError, TypeError, IndexError) as error:
            raise self._damaged(f"its header is malformed ({error})") from None
        self._first = PREFIX.size + size + CHECK.size
        expected = self._first + sum(self.header.chunk_bytes) + CHECK.size * len(self.header.chunk_bytes)
        if self.num_bytes != expected:
            raise self._damaged(f"it has {self.num_bytes} bytes where its header promises {expected}")

    def chunk(self, index: int) -> bytes:
        """One chunk's payload. Raises InputError where it fails its checksum."""
        sizes = self.header.chunk_bytes
        start = self._first + sum(sizes[:index]) + CHECK.size * index
        try:
            with self.path.open("rb") as stream:
                stream.seek(start)
                data = stream.read(sizes[index] + CHECK.size)
        except OSError as error:
            raise InputError(f"cannot read {self.path}: {error.strerror or error}") from None
        payload = data[: -CHECK.size]
        if len(payload) != sizes[index] or CHECK.unpack(data[-CHECK.size :])[0] != zlib.crc32(payload):
            raise self._damaged(f"chunk {index} fails its checksum")
        return payload

    def _header_size(self, front: bytes) -> int:
        if len(front) < PREFIX.size or front[:4] != MAGIC:
            raise InputError(
                f"{self.path} is no .mmw file; make one with: mmweaver compress capture.npz -o capture.mmw"
            )
        _, version, size = PREFIX.unpack(front)
        if version not in READABLE:
            raise InputError(
                f"{self.path} is a .mmw file of version {version}, or damaged; this program reads versions"
                f" {' and '.join(map(str, READABLE))}"
            )
        return size

    def _damaged(self, why: str) -> InputError:
        return InputError(f"{self.path} is damaged: {why}; copy it again or compress the recording again")


def _packed_header(header: MmwHeader, sizes: list[int]) -> bytes:
    config = header.config
    values: dict[str, Any] = {"chunks": [list(pair) for pair in zip(header.chunk_frames, sizes, strict=True)]}
    is_preset = config.name in PRESETS and PRESETS[config.name] == config
    values["radar"] = {"preset": config.name} if is_preset else json.loads(config.to_json())
    if header.scale == header.scale:  # JSON has no nan: left out
        values["scale"] = header.scale
    values |= _times(header.frame_time_s)
    text = json.dumps(values, separators=(",", ":"), allow_nan=False).encode()
    packer = zlib.compressobj(9, zlib.DEFLATED, -15, 9, zlib.Z_DEFAULT_STRATEGY, WORDS)
    body = packer.compress(text) + packer.flush()
    if len(body) > 0xFFFF:
        raise InputError("the header is too long; split the recording into shorter files")
    front = PREFIX.pack(MAGIC, VERSION, len(body)) + body
    return front + CHECK.pack(zlib.crc32(front))


def _times(time_s: tuple[float, ...]) -> dict[str, Any]:
    """Start and period of evenly spaced frames, or all frame times."""
    if len(time_s) > 1:
        step_s = (time_s[-1] - time_s[0]) / (len(time_s) - 1)
        if all(abs(t - time_s[0] - k * step_s) < 1e-9 for k, t in enumerate(time_s)):
            return {"frame_start_s": time_s[0], "frame_period_s": step_s}
    return {"frame_time_s": list(time_s)}


def _inflated(body: bytes) -> bytes:
    unpacker = zlib.decompressobj(-15, WORDS)
    return unpacker.decompress(body, 1 << 24)


def _header_of(values: dict[str, Any]) -> MmwHeader:
    radar = values["radar"]
    config = PRESETS[radar["preset"]] if "preset" in radar else RadarConfig.from_json(json.dumps(radar))
    frames, sizes = zip(*values["chunks"], strict=True)
    if not all(type(number) is int and number > 0 for number in (*frames, *sizes)):
        raise ValueError("chunks")
    num = sum(frames)
    if "frame_time_s" in values:
        time_s = tuple(float(t) for t in values["frame_time_s"])
    else:
        time_s = tuple(values["frame_start_s"] + k * values["frame_period_s"] for k in range(num))
    if len(time_s) != num:
        raise ValueError("frame times")
    return MmwHeader(
        config=config, scale=float(values.get("scale", "nan")), frame_time_s=time_s, chunk_frames=frames,
        chunk_bytes=sizes,
    )  # fmt: skip
