"""Reassembly of raw DCA1000 packets: lost ones are zero-filled and counted, late ones are put in place.

A packet consists of a sequence number (4 bytes, from 1), the number of bytes sent before it (6 bytes) and up to 1456
bytes of samples, all little-endian, on UDP port 4098.

Reference: TI SPRUIJ4, DCA1000EVM Data Capture Card User's Guide; mmwave-capture-std stores the packets as dca.pcap.
"""

import struct
from array import array
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.regular_files import open_regular
from mmweaver.core.shapes import PerFrame
from mmweaver.io.dca1000 import adc_of_words, bytes_of_frame
from mmweaver.io.pcap import udp_packets

DATA_PORT = 4098
HEADER = struct.Struct("<IIH")
HEADER_BYTES = HEADER.size
MAX_BYTES = 4_000_000_000  # of frames read at once
MAX_LOSS = 20  # bytes sent / bytes received


@dataclass(frozen=True, kw_only=True)
class PacketReport:
    """Packet statistics of a recording."""

    packets: int
    lost: int  # by sequence number, before the last received packet
    lost_bytes: int  # within complete frames; zero-filled
    late: int  # received after a packet with a higher number
    repeated: int
    bytes_after_last_frame: int  # of an incomplete frame, dropped


@dataclass(frozen=True, kw_only=True)
class PacketCapture:
    """Samples of complete frames, their start times and packet statistics.

    Attributes:
        adc: Samples in ADC counts.
        frame_time_s: Start times of the frames in seconds of the recorder's clock.
        report: Statistics of the entire file, regardless of the frames read.
        num_frames: Complete frames in the file.
    """

    adc: AdcCube
    frame_time_s: PerFrame
    report: PacketReport
    num_frames: int


@dataclass(frozen=True, kw_only=True)
class _Packets:
    """Index of the packets of a file, without samples: 40 bytes per 1.5 kB of the file."""

    path: Path
    number: np.ndarray  # sequence number, (packet,) like all fields
    first_byte: np.ndarray  # offset in the sample stream
    num_bytes: np.ndarray
    at: np.ndarray  # offset in the file
    time_s: np.ndarray

    @property
    def last_byte(self) -> np.ndarray:
        return self.first_byte + self.num_bytes


def read_pcap(
    path: Path | str,
    config: RadarConfig,
    *,
    iq_order: str | None = None,
    num_frames: int | None = None,
    frames: slice = slice(None),
) -> PacketCapture:
    """Reads a dca.pcap.

    Memory use is that of the frames read plus a packet index of 3 % of the file size.

    Args:
        path: The file.
        config: The radar.
        iq_order: One of `dca1000.IQ_ORDERS`. Default: the radar's.
        num_frames: Number of frames that the radar was configured to send; an incomplete last frame is then kept and
            zero-filled. Default: unknown, only complete frames are kept.
        frames: Range of frames. Default: all.

    Returns:
        Samples in ADC counts, start times of the frames, and packet statistics of the entire file.

    Raises:
        InputError: If the file contains no packets, less than one frame, or two recordings.
    """
    packets, num_bytes = _sent(path)
    frame_bytes = bytes_of_frame(config)
    total = num_bytes // frame_bytes
    if num_frames is not None:
        total = min(num_frames, -(-num_bytes // frame_bytes))
    if total == 0:
        raise InputError(
            f"{path} holds {num_bytes} bytes, but one frame of this radar has {frame_bytes}; was it"
            " recorded with this radar.cfg?"
        )
    chosen = range(total)[frames]
    if len(chosen) * frame_bytes > MAX_BYTES:
        size = len(chosen) * frame_bytes / 1e9
        raise InputError(f"{path} holds {size:.1f} GB of samples; at most {MAX_BYTES / 1e9:.0f} GB are read at once")
    late, repeated = _late_and_repeated(packets.number)
    report = PacketReport(
        packets=len(packets.number),
        lost=int(packets.number.max() - len(np.unique(packets.number))),
        lost_bytes=total * frame_bytes - _num_received(packets, total * frame_bytes),
        late=late,
        repeated=repeated,
        bytes_after_last_frame=max(0, num_bytes - total * frame_bytes),
    )
    data = _reassembled(packets, chosen.start * frame_bytes, chosen.stop * frame_bytes)
    return PacketCapture(
        adc=adc_of_words(data.view("<i2"), config, iq_order=iq_order),
        report=report,
        num_frames=total,
        frame_time_s=_frame_times(packets, total, frame_bytes, config)[chosen.start : chosen.stop],
    )


class SampleBytes:
    """Byte stream sent by a DCA1000, reassembled from its packets; zeros where a packet was lost.

    Equals the adc_data.bin that TI's software would have written.
    """

    def __init__(self, path: Path | str):
        """Indexes the packets.

        Args:
            path: The .pcap file.

        Raises:
            InputError: If the file contains no packets, or nearly all are lost.
        """
        self._packets, self.size = _sent(path)
        self._at = 0

    def read(self, num_bytes: int) -> bytes:
        """Reads the next bytes.

        Args:
            num_bytes: Maximum number of bytes.

        Returns:
            The bytes, fewer at the end.

        Raises:
            InputError: If the file contains two recordings.
        """
        first, self._at = self._at, min(self.size, self._at + num_bytes)
        return _reassembled(self._packets, first, self._at).tobytes()


def _sent(path: Path | str) -> tuple[_Packets, int]:
    """Packet index of a file, and the number of sample bytes that were sent."""
    path = Path(path)
    changed = path.stat() if path.is_file() else None
    packets = _packets_of(path, None if changed is None else (changed.st_mtime_ns, changed.st_size))
    num_bytes, received = int(packets.last_byte.max()), int(packets.num_bytes.sum())
    if num_bytes > MAX_LOSS * received:
        raise InputError(
            f"{path} says that {num_bytes} bytes were sent, but holds {received}: nearly all packets are lost, or it is"
            " damaged; record again"
        )
    return packets, num_bytes


@lru_cache(maxsize=1)  # index a recording that is read in pieces only once
def _packets_of(path: Path, _changed: tuple[int, int] | None) -> _Packets:
    """Indexes the packets of a file. Raises InputError if there are none, or one is not from a DCA1000."""
    found = {name: array("Q") for name in ("number", "first_byte", "num_bytes", "at")}
    times = array("d")
    for packet in udp_packets(path, DATA_PORT):
        if len(packet.payload) <= HEADER_BYTES:
            raise InputError(
                f"{path} has a packet of {len(packet.payload)} bytes on port {DATA_PORT}; a DCA1000's has more"
            )
        number, low, high = HEADER.unpack_from(packet.payload)
        values = (number, high << 32 | low, len(packet.payload) - HEADER_BYTES, packet.at + HEADER_BYTES)
        for column, value in zip(found.values(), values, strict=True):
            column.append(value)
        times.append(packet.time_s)
    if not times:
        raise InputError(f"{path} holds no packets of a DCA1000 (UDP port {DATA_PORT}); was the radar started?")
    return _Packets(
        path=path, time_s=np.array(times), **{name: np.array(column, np.int64) for name, column in found.items()}
    )


def _late_and_repeated(numbers: np.ndarray) -> tuple[int, int]:
    """Number of packets received after one with a higher number, and number of duplicates."""
    _, first = np.unique(numbers, return_index=True)
    once = numbers[np.sort(first)]
    return int(np.count_nonzero(once < np.maximum.accumulate(once))), len(numbers) - len(once)


def _num_received(packets: _Packets, size: int) -> int:
    """Number of the first `size` bytes that were received."""
    order = np.argsort(packets.first_byte, kind="stable")
    first, last = packets.first_byte[order], np.minimum(packets.last_byte[order], size)
    before = np.maximum.accumulate(np.concatenate([[0], last[:-1]]))
    return int(np.maximum(last - np.maximum(first, before), 0).sum())


def _reassembled(packets: _Packets, first: int, last: int) -> np.ndarray:
    """Bytes from `first` to `last` in order, (byte,); zeros where nothing was received."""
    data, is_received = np.zeros(last - first, np.uint8), np.zeros(last - first, bool)
    with open_regular(packets.path) as file:
        for index in np.flatnonzero((packets.first_byte < last) & (packets.last_byte > first)):
            begin = int(packets.first_byte[index])
            file.seek(int(packets.at[index]))
            payload = np.frombuffer(file.read(int(packets.num_bytes[index])), np.uint8)
            new = payload[max(0, first - begin) : last - begin]
            place = slice(max(begin - first, 0), max(begin - first, 0) + len(new))
            if is_received[place].any() and not (is_received[place].all() and np.array_equal(data[place], new)):
                raise InputError(
                    f"{packets.path} holds different data for byte {begin}: more than one recording in a file;"
                    " record each to a file of its own"
                )
            data[place], is_received[place] = new, True
    return data


def _frame_times(packets: _Packets, frames: int, frame_bytes: int, config: RadarConfig) -> PerFrame:
    """Arrival time of the packet with each frame's first byte in seconds; interpolated if that packet was lost."""
    time_s = np.full(frames, np.nan)
    frame = -(-packets.first_byte // frame_bytes)  # first frame that starts at or after the packet's first byte
    starts = (frame < frames) & (frame * frame_bytes < packets.last_byte)
    np.fmin.at(time_s, frame[starts], packets.time_s[starts])
    index = np.arange(frames)
    known = np.isfinite(time_s)
    if not known.any():
        return packets.time_s[0] + index * config.frame_period_s
    offsets = time_s - index * config.frame_period_s
    return index * config.frame_period_s + np.interp(index, index[known], offsets[known])
