"""Lossless or bounded-error compression of a DCA1000 recording in blocks of frames: the .mmwl file.

    "MMWL" and the rest of a `checked_file`
    header: JSON (UTF-8), deflated: radar, frames per block, largest error in counts
    block:  length of payload u32 | frames u16 | check u16 | payload | CRC-32 of everything before

Blocks are independent, so frames can be read without the others, and a truncated file contains all frames before the
cut. The last block may contain fewer frames; the bytes of an unfinished frame follow as a block of 0 frames.
Reference: docs/mmw_format.md.
"""

import contextlib
import json
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from mmweaver.compression.checked_file import PREFIX, CheckedFile, checked, head_check
from mmweaver.compression.sample_block import BlockShape, decode_block, encode_block
from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.regular_files import check_regular, open_regular
from mmweaver.core.safe_files.safe_text import parse_json
from mmweaver.io.dca1000 import bytes_of_frame
from mmweaver.io.dca_packets import SampleBytes

MAGIC, VERSION = b"MMWL", 1
BLOCK = struct.Struct("<IH")
BLOCK_BYTES = 2**21  # of raw samples, about
MAX_FRAMES = 4096
MAX_ERROR = 1000
MAX_TEXT = 2**20
PACKETS = (".pcap", ".pcapng")

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class LosslessHeader:
    """Header of a .mmwl file."""

    config: RadarConfig
    frames_a_block: int
    max_error: int = 0

    @property
    def frame_bytes(self) -> int:
        """Bytes per frame of the recording."""
        return bytes_of_frame(self.config)

    def shape(self, num_frames: int) -> BlockShape:
        """Shape of a block of frames."""
        config = self.config
        return BlockShape(
            loops=num_frames * config.num_loops, antennas=config.num_antennas, samples=config.num_samples, parts=2
        )


def compress_bin(
    path: Path | str,
    out: Path | str,
    config: RadarConfig,
    *,
    max_error: int = 0,
    progress: Progress = lambda _: None,
) -> int:
    """Compresses adc_data.bin to a .mmwl file, block by block.

    Of a packet capture (.pcap, .pcapng) the samples are stored, in order and with zeros for lost packets, as
    in the adc_data.bin that decompression writes.

    Args:
        path: The recording.
        out: Path of the .mmwl file.
        config: The radar, for the order of the words; a wrong one costs bytes, not correctness.
        max_error: Maximum error of every word in counts; 0 is lossless.
        progress: Called with the amount that is done.

    Returns:
        Size of the file in bytes.

    Raises:
        InputError: If a file cannot be read or written.
    """
    if not 0 <= max_error <= MAX_ERROR:
        raise InputError(f"an error of at most {max_error} counts is not possible; choose 0 to {MAX_ERROR}")
    if not config.complex_samples or config.num_samples % 2:
        raise InputError("a DCA1000 records complex samples, an even number per chirp; give the radar that recorded it")
    frame = bytes_of_frame(config)
    frames_a_block = max(1, min(MAX_FRAMES, BLOCK_BYTES // frame))
    header = LosslessHeader(config=config, frames_a_block=frames_a_block, max_error=max_error)
    with _samples_of(Path(path)) as (source, size), atomic_file(Path(out)) as temporary, temporary.open("wb") as target:
        target.write(_packed_header(header))
        done = 0
        while data := source.read(frames_a_block * frame):
            whole = len(data) // frame
            if whole:
                target.write(_packed_block(_encoded(data[: whole * frame], header, whole), whole))
            if whole * frame < len(data):
                target.write(_packed_block(zlib.compress(data[whole * frame :], 9), 0))
            done += len(data)
            progress(f"{done / 2**20:,.0f} of {size / 2**20:,.0f} MB")
        return target.tell()


@contextlib.contextmanager
def _samples_of(path: Path) -> Iterator[tuple[BinaryIO | SampleBytes, int]]:
    """A readable source of the words of a recording, and their size in bytes."""
    size = check_regular(path)
    if not size:
        raise InputError(f"{path} is empty; record again")
    if path.suffix in PACKETS:
        packets = SampleBytes(path)
        yield packets, packets.size
    else:
        with open_regular(path) as source:
            yield source, size


class LosslessFile(CheckedFile):
    """A .mmwl file: header and block positions are read and checked on construction, blocks on demand."""

    MAGIC, SUFFIX, READABLE = MAGIC, ".mmwl", (VERSION,)
    RECORD_NAME = "block"
    MADE_BY = "mmweaver compress ADC_DATA.bin --radar RADAR --quality lossless -o OUT.mmwl"

    @property
    def num_frames(self) -> int:
        """Number of complete frames."""
        return sum(self.block_frames)

    def decompress(self, out: Path | str, frames: slice = slice(None), progress: Progress = lambda _: None) -> int:
        """Writes the recording, or a range of its frames, as a .bin.

        Args:
            out: Path of the .bin file.
            frames: Frames to write; by default all, and the bytes of an unfinished one.
            progress: Called with the amount that is done.

        Returns:
            Size of the file in bytes.

        Raises:
            InputError: If the file was truncated before its first complete block, or is damaged.
        """
        if self.cut_short and not self.num_frames:
            raise self.damaged("it was cut short before its first whole block")
        chosen = range(self.num_frames)[frames]
        is_whole = len(chosen) == self.num_frames
        if chosen.step != 1 or not (len(chosen) or is_whole):
            raise InputError(f"{self.path} has {self.num_frames} frames, and none of them is selected")
        frame, first = self.header.frame_bytes, 0
        with atomic_file(Path(out)) as temporary, temporary.open("wb") as target:
            for index, count in enumerate(self.block_frames):
                last = first + count
                if not count and is_whole:
                    target.write(self._tail(index))
                elif first < chosen.stop and last > chosen.start:
                    data = self.block(index)
                    target.write(data[max(0, chosen.start - first) * frame : (chosen.stop - first) * frame])
                    progress(f"frame {last} of {self.num_frames}")
                first = last
            return target.tell()

    def check(self) -> None:
        """Checks every block.

        Raises:
            InputError: If a block fails its checksum, or the last one is incomplete.
        """
        for index in range(len(self.block_frames)):
            self.payload(index)
        if self.cut_short:
            raise self.damaged(f"{self.cut_short} bytes at its end are no whole block")

    def block(self, index: int) -> bytes:
        """The bytes of a block of frames as in the recording.

        Args:
            index: Index of the block.

        Raises:
            InputError: If the block is damaged.
        """
        count = self.block_frames[index]
        try:
            samples = decode_block(self.payload(index), self.header.shape(count))
        except (ValueError, IndexError, struct.error, AssertionError, OverflowError) as error:
            raise self.damaged(f"block {index} is malformed ({error})") from None
        config = self.header.config
        lines = samples.reshape(count * config.num_loops, config.num_antennas, config.num_samples // 2, 2, 2)
        return lines.swapaxes(3, 4).astype("<i2").tobytes()

    def _tail(self, index: int) -> bytes:
        unpacker = zlib.decompressobj()
        try:
            data = unpacker.decompress(self.payload(index), self.header.frame_bytes)
        except zlib.error as error:
            raise self.damaged(f"its last bytes are malformed ({error})") from None
        return data

    def _read_header(self, body: bytes) -> None:
        values: dict[str, Any] = parse_json(
            zlib.decompressobj().decompress(body, MAX_TEXT), f"the header of {self.path}"
        )
        self.header = LosslessHeader(
            config=RadarConfig.from_values(values["radar"]),
            frames_a_block=int(values["frames_a_block"]),
            max_error=int(values["max_error"]),
        )
        if not 0 < self.header.frames_a_block <= MAX_FRAMES:
            raise ValueError("frames in a block")

    def _find_records(self, stream: BinaryIO) -> None:
        most = self.header.frames_a_block
        self.block_frames = [
            count for (count,), _ in self._scanned(stream, BLOCK, lambda count: 0 if count <= most else None)
        ]


def is_lossless_file(path: Path | str) -> bool:
    """Whether a file begins like a .mmwl file."""
    with open_regular(path) as stream:
        return stream.read(len(MAGIC)) == MAGIC


def describe_lossless(path: Path | str) -> dict[str, Any]:
    """Describes a .mmwl file by plain values: sizes, frames, blocks, error bound and radar.

    Args:
        path: Path of the file.

    Raises:
        InputError: If the file is damaged.
    """
    file = LosslessFile(path)
    raw = file.num_frames * file.header.frame_bytes
    return {
        "file": str(path),
        "version": VERSION,
        "bytes": file.num_bytes,
        "cut_short_bytes": file.cut_short,
        "frames": file.num_frames,
        "blocks": len(file.block_frames),
        "max_error_counts": file.header.max_error,
        "raw_bytes": raw,
        "ratio": round(raw / file.num_bytes, 2),
        "radar": {"name": file.header.config.name},
    }


def _encoded(data: bytes, header: LosslessHeader, num_frames: int) -> bytes:
    """A block of frames: groups of I0 I1 Q0 Q1 become samples of two parts; the order of I and Q does not matter."""
    config = header.config
    words = np.frombuffer(data, "<i2")
    lines = words.reshape(num_frames * config.num_loops, config.num_antennas, config.num_samples // 2, 2, 2)
    samples = lines.swapaxes(3, 4).reshape(len(lines), config.num_antennas, config.num_samples, 2)
    return encode_block(samples.astype(np.int64), header.max_error)


def _packed_header(header: LosslessHeader) -> bytes:
    values = {
        "radar": header.config.to_values(),
        "frames_a_block": header.frames_a_block,
        "max_error": header.max_error,
    }
    body = zlib.compress(json.dumps(values, separators=(",", ":"), allow_nan=False).encode(), 9)
    return checked(PREFIX.pack(MAGIC, VERSION, len(body)) + body)


def _packed_block(payload: bytes, num_frames: int) -> bytes:
    head = BLOCK.pack(len(payload), num_frames)
    return checked(head + head_check(head) + payload)
