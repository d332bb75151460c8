"""The .mmw container: a header and records of a few frames each, all covered by checksums.

    "MMWV" and the rest of a `checked_file`
    header: JSON (UTF-8), deflated with a dictionary
    record: length of payload u32 | frames u16 | times u8 | frame times | check u16 | payload | CRC-32 of all of it

Records can be appended, and one can be read without the others. A file that was cut short is readable up to its last
whole record. In versions 1 and 2 the header lists frames and bytes of every chunk, and a chunk is payload and CRC-32.
Reference: docs/mmw_format.md.
"""

import json
import math
import struct
import zlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from mmweaver.compression.checked_file import CHECK, PREFIX, CheckedFile, RecordPlace, checked, head_check
from mmweaver.compression.entropy import VERSION
from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import parse_json

MAGIC = b"MMWV"
MAX_CHUNK_BYTES = 64 * 2**20  # of a decoded chunk, unless a single frame is larger
MAX_CHUNKS, MAX_FRAMES = 100_000, 1_000_000
MAX_RATIO = 20_000  # decoded bytes per byte of a file: 256 bytes for 20 frames of an AWR1843 are 15,000
MAX_TIME_S = 1e15
# 2 may hold residuals with a map of open cells; 3 has records, 4 and 5 other models
READABLE = tuple(range(1, VERSION + 1))
LISTED = (1, 2)  # versions whose header lists the chunks
RECORD = struct.Struct("<IHB")
FOLLOWING, FROM_FIRST, ALL_TIMES = 0, 1, 2  # frame times: a period on from the record before, from a first one, all
TIME = struct.Struct("<d")
SAME_TIME_S = 1e-9
MAX_HEADER, MAX_TEXT = 0xFFFF, 1 << 24
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
    """Header of a .mmw file. `scale` as in RadarCube; frames begin at `start_s`, `period_s` apart."""

    config: RadarConfig
    scale: float
    start_s: float = 0.0
    period_s: float = 0.0


@dataclass(frozen=True, kw_only=True)
class MmwRecord:
    """Size of a chunk, and the times of its frames, counted from the start of the recording."""

    num_bytes: int
    frame_time_s: np.ndarray

    @property
    def num_frames(self) -> int:
        """Number of frames."""
        return len(self.frame_time_s)


def pack_header(header: MmwHeader) -> bytes:
    """The beginning of a file with this header.

    Raises:
        InputError: If the description of the radar is too long.
    """
    values: dict[str, Any] = {"radar": _packed_radar(header.config)}
    if header.scale == header.scale:  # JSON has no nan: left out
        values["scale"] = header.scale
    values |= {"frame_start_s": header.start_s, "frame_period_s": header.period_s}
    text = json.dumps(values, separators=(",", ":"), allow_nan=False).encode()
    packer = zlib.compressobj(9, zlib.DEFLATED, -15, 9, zlib.Z_DEFAULT_STRATEGY, WORDS)
    body = packer.compress(text) + packer.flush()
    if len(body) > MAX_HEADER:
        raise InputError("the radar's description is too long for a .mmw file; shorten its name")
    return checked(PREFIX.pack(MAGIC, VERSION, len(body)) + body)


def pack_record(chunk: bytes, frame_time_s: np.ndarray, header: MmwHeader, last_s: float | None) -> bytes:
    """A record of a file.

    Args:
        chunk: The payload.
        frame_time_s: Times (frame,) of its frames.
        header: Header of the file.
        last_s: Time of the last frame before it, None for the first record.
    """
    num = len(frame_time_s)
    first_s = header.start_s if last_s is None else last_s + header.period_s
    if _is_regular(frame_time_s, first_s, header.period_s):
        times, kind = b"", FOLLOWING
    elif _is_regular(frame_time_s, float(frame_time_s[0]), header.period_s):
        times, kind = TIME.pack(float(frame_time_s[0])), FROM_FIRST
    else:
        times, kind = np.asarray(frame_time_s, "<f8").tobytes(), ALL_TIMES
    head = RECORD.pack(len(chunk), num, kind) + times
    return checked(head + head_check(head) + chunk)


def pack_mmw(header: MmwHeader, chunks: list[bytes], frame_time_s: list[np.ndarray]) -> bytes:
    """The bytes of a whole file.

    Args:
        header: The header.
        chunks: Payload of each record.
        frame_time_s: Times (frame,) of the frames of each record.
    """
    parts, last_s = [pack_header(header)], None
    for chunk, time_s in zip(chunks, frame_time_s, strict=True):
        parts.append(pack_record(chunk, time_s, header, last_s))
        last_s = float(time_s[-1])
    return b"".join(parts)


def header_for(config: RadarConfig, scale: float, frame_time_s: np.ndarray) -> MmwHeader:
    """A header with start time and mean period of the frames.

    Args:
        config: The radar.
        scale: Scale of the cube.
        frame_time_s: Times (frame,) of all frames.
    """
    num = len(frame_time_s)
    start_s = float(frame_time_s[0])
    period_s = (float(frame_time_s[-1]) - start_s) / (num - 1) if num > 1 else config.frame_period_s
    return MmwHeader(config=config, scale=scale, start_s=start_s, period_s=period_s)


class MmwFile(CheckedFile):
    """A .mmw file: header and record positions are read and checked on construction, chunks on demand."""

    MAGIC, SUFFIX, READABLE = MAGIC, ".mmw", READABLE
    RECORD_NAME = "chunk"
    MADE_BY = "mmweaver compress CAPTURE.npz --quality 30 -o OUT.mmw"

    def __init__(self, path: Path | str):
        """Reads the header and finds the records.

        Args:
            path: Path of the file.

        Raises:
            InputError: If the file is unreadable, not a .mmw file, or damaged before its first chunk.
        """
        super().__init__(path)
        if not self.records:
            raise InputError(f"{path} holds no whole chunk: it is damaged or was cut short; compress it again")
        self._check_promises()

    @property
    def frame_time_s(self) -> np.ndarray:
        """Times (frame,) of all frames."""
        return np.concatenate([record.frame_time_s for record in self.records])

    @property
    def num_frames(self) -> int:
        """Number of frames of all records."""
        return sum(record.num_frames for record in self.records)

    def _read_header(self, body: bytes) -> None:
        values = parse_json(_inflated(body), f"the header of {self.path}")
        self.header = _header_of(values)
        if self.version in LISTED:
            self.records = self._listed(values, PREFIX.size + len(body) + CHECK.size)

    def _find_records(self, stream: BinaryIO) -> None:
        if self.version in LISTED:
            expected = self.places[-1].offset + self.places[-1].num_bytes + CHECK.size
            if self.num_bytes != expected:
                raise self.damaged(f"it has {self.num_bytes} bytes where its header promises {expected}")
            return
        self.records, last_s = [], None
        for (num, kind), times in self._scanned(stream, RECORD, _num_time_bytes):
            time_s = self._times(times, kind, num, last_s)
            self.records.append(MmwRecord(num_bytes=self.places[-1].num_bytes, frame_time_s=time_s))
            last_s = float(time_s[-1])
        if not self.records and self.cut_short:
            raise self.damaged("it is truncated before the end of its first chunk")

    def _check_promises(self) -> None:
        """Raises InputError where the records promise a cube far larger than any file of this size holds."""
        config = self.header.config
        frame_bytes = 8 * config.num_range_bins * config.num_loops * config.num_antennas
        most = max(MAX_CHUNK_BYTES, frame_bytes)  # one frame, however large
        largest = max((record.num_frames for record in self.records), default=0)
        total = self.num_frames * frame_bytes
        if largest * frame_bytes > most or total > max(most, MAX_RATIO * self.num_bytes):
            raise self.damaged(
                f"its {self.num_bytes} bytes promise {self.num_frames} frames of {frame_bytes / 1e6:.3g} MB"
            )

    def _listed(self, values: dict[str, Any], at: int) -> list[MmwRecord]:
        """The chunks of versions 1 and 2, the first of which lies at `at`."""
        frames, sizes = zip(*values["chunks"], strict=True)
        if not all(type(number) is int and number > 0 for number in (*frames, *sizes)):
            raise ValueError("chunks")
        if sum(sizes) > self.num_bytes or len(frames) > MAX_CHUNKS or sum(frames) > MAX_FRAMES:
            raise ValueError("more than the file holds")
        num = sum(frames)
        if "frame_time_s" in values:
            time_s = np.array([float(t) for t in values["frame_time_s"]])
        else:
            time_s = float(values["frame_start_s"]) + np.arange(num) * float(values["frame_period_s"])
        if len(time_s) != num or not (np.abs(time_s) < MAX_TIME_S).all():
            raise ValueError("frame times")
        records, first = [], 0
        for count, length in zip(frames, sizes, strict=True):
            self.places.append(RecordPlace(start=at, offset=at, num_bytes=length))
            records.append(MmwRecord(num_bytes=length, frame_time_s=time_s[first : first + count]))
            at, first = at + length + CHECK.size, first + count
        return records

    def _times(self, data: bytes, kind: int, num: int, last_s: float | None) -> np.ndarray:
        if kind == ALL_TIMES:
            time_s = np.frombuffer(data, "<f8").astype(np.float64)
        else:
            following_s = self.header.start_s if last_s is None else last_s + self.header.period_s
            first_s = TIME.unpack(data)[0] if kind == FROM_FIRST else following_s
            time_s = first_s + np.arange(num) * self.header.period_s
        if not (np.abs(time_s) < MAX_TIME_S).all():
            raise self.damaged("its frame times are impossible")
        return time_s


def _num_time_bytes(num: int, kind: int) -> int | None:
    return {FOLLOWING: 0, FROM_FIRST: TIME.size, ALL_TIMES: TIME.size * num}.get(kind) if num else None


def _is_regular(time_s: np.ndarray, first_s: float, period_s: float) -> bool:
    return bool(np.all(np.abs(time_s - first_s - np.arange(len(time_s)) * period_s) < SAME_TIME_S))


def _packed_radar(config: RadarConfig) -> dict[str, Any]:
    """The preset with differences to it, or the whole radar, whichever is shorter."""
    whole = config.to_values()
    best: dict[str, Any] = whole
    for name, usual in _preset_values().items():
        changes = {key: value for key, value in whole.items() if usual.get(key) != value}
        packed = {"preset": name, "changes": changes} if changes else {"preset": name}
        if usual.keys() == whole.keys() and len(json.dumps(packed)) < len(json.dumps(best)):
            best = packed
    return best


@cache
def _preset_values() -> dict[str, dict[str, Any]]:
    return {name: preset.to_values() for name, preset in PRESETS.items()}


def _radar_of(values: dict[str, Any]) -> RadarConfig:
    if "preset" not in values:
        return RadarConfig.from_values(values)
    preset, changes = PRESETS[values["preset"]], values.get("changes", {})
    return RadarConfig.from_values(preset.to_values() | changes) if changes else preset


def _inflated(body: bytes) -> bytes:
    unpacker = zlib.decompressobj(-15, WORDS)
    return unpacker.decompress(body, MAX_TEXT)


def _header_of(values: dict[str, Any]) -> MmwHeader:
    start_s, period_s = (float(values.get(name, 0.0)) for name in ("frame_start_s", "frame_period_s"))
    if not (abs(start_s) < MAX_TIME_S and abs(period_s) < MAX_TIME_S):
        raise ValueError("frame times")
    scale = float(values.get("scale", "nan"))
    if not (math.isnan(scale) or 1e-30 < scale < 1e30):
        raise ValueError("scale")
    return MmwHeader(config=_radar_of(values["radar"]), scale=scale, start_s=start_s, period_s=period_s)
