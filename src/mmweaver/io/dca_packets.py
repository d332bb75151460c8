"""Reassembly of raw DCA1000 packets: lost ones are zero-filled and counted, late ones are put in place.

A packet consists of a sequence number (4 bytes, from 1), the number of bytes sent before it (6 bytes) and up to 1456
bytes of samples, all little-endian, on UDP port 4098.

Reference: TI SPRUIJ4, DCA1000EVM Data Capture Card User's Guide; mmwave-capture-std stores the packets as dca.pcap.

UDP packets of a .pcap file (tcpdump) or .pcapng file (Wireshark), with the standard library only.

Reference: IETF draft-ietf-opsawg-pcap and draft-ietf-opsawg-pcapng; RFC 791, RFC 768.
"""

import os
import struct
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from io import BufferedReader
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.regular_files import check_regular, open_regular
from mmweaver.core.shapes import LostShare, PerFrame
from mmweaver.io.dca1000 import adc_of_sent, bytes_of_frame
from mmweaver.io.sample_files import PACKET_BYTES, JoinedFiles

# magic number in the file: (byte order, ticks per second)
MAGIC = {
    b"\xd4\xc3\xb2\xa1": ("<", 1e6),
    b"\xa1\xb2\xc3\xd4": (">", 1e6),
    b"\x4d\x3c\xb2\xa1": ("<", 1e9),
    b"\xa1\xb2\x3c\x4d": (">", 1e9),
}
PCAPNG = b"\x0a\x0d\x0d\x0a"
SECTION, INTERFACE, PACKET, RESOLUTION = 0x0A0D0D0A, 1, 6, 9  # pcapng block types, and an interface option
# link type: bytes before the network layer, and the offset of the protocol number in them (None: always IP)
LINK_TYPES: dict[int, tuple[int, int | None]] = {1: (14, 12), 101: (0, None), 113: (16, 14), 276: (20, 0)}
MAX_KEPT = 2**18  # maximum captured bytes per packet; longer ones are skipped
IPV4, VLAN, UDP = 0x0800, 0x8100, 17


@dataclass(frozen=True)
class UdpPacket:
    """Payload of a packet, its offset in the file, and its capture time in seconds of the recorder's clock."""

    time_s: float
    payload: bytes
    at: int


def udp_packets(path: Path | str, port: int) -> Iterator[UdpPacket]:
    """Iterates over the packets sent to a UDP port, in file order.

    Args:
        path: .pcap or .pcapng file.
        port: Destination port.

    Yields:
        One packet at a time; a truncated last packet (recorder stopped) is dropped.

    Raises:
        InputError: If the file cannot be read, is not a .pcap, or is truncated before its first packet.
    """
    path = Path(path)
    size = check_regular(path)
    with open_regular(path) as file:
        start = file.read(24)
        records = _pcapng_records(path, file, size) if start[:4] == PCAPNG else _pcap_records(path, file, size, start)
        for time_s, link, at, data in records:
            if (found := _udp_payload(data, link, port)) is not None:
                yield UdpPacket(time_s, found[1], at + found[0])


Record = tuple[float, int, int, bytes]  # time in s, link type, offset in the file, bytes of the packet


def _known_link(path: Path, link: int) -> int:
    if link not in LINK_TYPES:
        raise InputError(
            f"{path} was captured on a link of type {link}; known: Ethernet (1), raw IP (101), Linux (113)"
        )
    return link


def _read(file: BufferedReader, num: int) -> bytes:
    """Reads `num` bytes; skips packets that are too long and returns none of them."""
    if num <= MAX_KEPT:
        return file.read(num)
    file.seek(num, os.SEEK_CUR)
    return b""


def _pcap_records(path: Path, file: BufferedReader, size: int, start: bytes) -> Iterator[Record]:
    if start[:4] not in MAGIC:
        raise InputError(
            f"{path} is not a .pcap file{' (it is empty)' if not start else ''}; record it with tcpdump -w"
        )
    if len(start) < 24:
        raise InputError(f"{path} is truncated within its header; it holds no packets")
    order, ticks = MAGIC[start[:4]]
    link = _known_link(path, struct.unpack_from(f"{order}I", start, 20)[0] & 0xFFFF)
    at, header = 24, struct.Struct(f"{order}IIII")
    while len(head := file.read(16)) == 16:
        seconds, fraction, kept, _ = header.unpack(head)
        at += 16
        if at + kept > size:
            return
        yield seconds + fraction / ticks, link, at, _read(file, kept)
        at += kept


def _pcapng_records(path: Path, file: BufferedReader, size: int) -> Iterator[Record]:
    """Enhanced packet blocks of a pcapng file, with link type and clock of their interface."""
    order, at = "<", 0
    links: list[tuple[int, float]] = []  # link type and ticks per second of each interface
    file.seek(0)
    while len(head := file.read(12)) == 12:
        kind, length = struct.unpack_from(f"{order}II", head)
        if kind == SECTION:
            order, links = ("<" if head[8:12] == b"\x4d\x3c\x2b\x1a" else ">"), []
            length = struct.unpack_from(f"{order}I", head, 4)[0]
        is_damaged = length < 12 or length % 4
        if not is_damaged and at + length > size:
            return  # the recorder was stopped
        data = head if is_damaged else head + _read(file, length - 12)
        if kind == INTERFACE and len(data) >= 16:
            links.append((struct.unpack_from(f"{order}H", data, 8)[0], _ticks(data, 16, length, order)))
        elif kind == PACKET and len(data) >= 28:
            interface, high, low, kept = struct.unpack_from(f"{order}IIII", data, 8)
            is_damaged = interface >= len(links) or kept > length - 32
            if not is_damaged:
                link, ticks = links[interface]
                yield (high << 32 | low) / ticks, _known_link(path, link), at + 28, data[28 : 28 + kept]
        if is_damaged:
            raise InputError(f"{path} has a damaged block at byte {at}; record it again")
        at += length


def _ticks(data: bytes, at: int, end: int, order: str) -> float:
    """Clock ticks per second of an interface, from its option if_tsresol; microseconds by default."""
    while at + 4 <= end - 4:
        code, size = struct.unpack_from(f"{order}HH", data, at)
        if code == 0:
            break
        if code == RESOLUTION and size == 1:
            value = data[at + 4]
            return float(2 ** (value & 0x7F)) if value & 0x80 else float(10**value)
        at += 4 + -(-size // 4) * 4
    return 1e6


def _udp_payload(data: bytes, link: int, port: int) -> tuple[int, bytes] | None:
    """Offset and payload if the packet is IPv4 and UDP with this destination port, else None."""
    at, kind_at = LINK_TYPES[link]
    end = len(data)
    if kind_at is not None:
        if at > end:
            return None
        kind = int.from_bytes(data[kind_at : kind_at + 2], "big")
        if kind == VLAN:
            kind, at = int.from_bytes(data[at + 2 : at + 4], "big"), at + 4
        if kind != IPV4:
            return None
    if at + 20 > end or data[at] >> 4 != 4 or data[at + 9] != UDP:
        return None
    at += 4 * (data[at] & 0xF)
    if at + 8 > end or int.from_bytes(data[at + 2 : at + 4], "big") != port:
        return None
    size = int.from_bytes(data[at + 4 : at + 6], "big")
    return at + 8, data[at + 8 : min(at + size, end)]  # Ethernet pads short packets


DATA_PORT = 4098
HEADER = struct.Struct("<IIH")
HEADER_BYTES = HEADER.size
MAX_BYTES = 4_000_000_000  # of frames read at once
MAX_LOSS = 20  # bytes sent / bytes received
BLOCK_BYTES = 2**16  # read from a file at once
# headers of packets in a .bin: those of the network, and those of mmWave Studio's raw files
FILE_HEADER = np.dtype([("number", "<u4"), ("low", "<u4"), ("high", "<u2")])
RAW_HEADER = np.dtype([("number", "<u4"), ("length", "<u4"), ("low", "<u4"), ("high", "<u2")])
MAX_APART = 1000  # packets lost between the first two of a file
PACKETS_A_BLOCK = 2**14


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
        adc: Samples in ADC counts, zero where lost.
        lost_share: Share of each chirp's samples that is lost, (frame, loop, slot).
        frame_time_s: Start times of the frames in seconds of the recorder's clock.
        report: Statistics of the entire file, regardless of the frames read.
        num_frames: Complete frames in the file.
    """

    adc: AdcCube
    lost_share: LostShare
    frame_time_s: PerFrame
    report: PacketReport
    num_frames: int


@dataclass(frozen=True, kw_only=True)
class _Packets:
    """Index of the packets of a recording, without samples: 40 bytes per 1.5 kB."""

    files: JoinedFiles
    number: np.ndarray  # sequence number, (packet,) like all fields
    first_byte: np.ndarray  # offset in the sample stream
    num_bytes: np.ndarray
    at: np.ndarray  # offset in the files
    time_s: np.ndarray  # empty if the files have no times

    @property
    def last_byte(self) -> np.ndarray:
        return self.first_byte + self.num_bytes


class PacketSamples:
    """Byte stream of a DCA1000, reassembled from packets (`SentBytes`)."""

    def __init__(self, packets: _Packets):
        """Raises InputError if nearly all packets are lost."""
        self.packets, self.size = packets, int(packets.last_byte.max())
        received = int(packets.num_bytes.sum())
        if self.size > MAX_LOSS * received:
            raise InputError(
                f"{packets.files.paths[0]} says that {self.size} bytes were sent, but holds {received}: nearly all"
                " packets are lost, or it is damaged; record again"
            )

    def read(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Bytes from `first` to `last` with zeros in place of lost ones, and whether each was received."""
        return _reassembled(self.packets, first, last)

    def report(self, num_bytes: int) -> PacketReport:
        """Statistics of all packets; `num_bytes` are those of complete frames."""
        number = self.packets.number
        late, repeated = _late_and_repeated(number)
        return PacketReport(
            packets=len(number),
            lost=int(number.max() - len(np.unique(number))),
            lost_bytes=num_bytes - _num_received(self.packets, num_bytes),
            late=late,
            repeated=repeated,
            bytes_after_last_frame=max(0, self.size - num_bytes),
        )


def packets_with_headers(paths: tuple[Path, ...]) -> PacketSamples | None:
    """The packets of .bin files that still have their headers.

    The header is that of a packet (number, bytes sent before) or, as in mmWave Studio's raw files, has the payload's
    length between the two.

    Args:
        paths: The file, or the parts of a recording.

    Returns:
        The samples; None if there are no headers.

    Raises:
        InputError: If nearly all packets are lost.
    """
    files = JoinedFiles(paths)
    head = files.read(0, 2 * (RAW_HEADER.itemsize + PACKET_BYTES)).tobytes()
    for kind in (FILE_HEADER, RAW_HEADER):
        step = kind.itemsize + PACKET_BYTES
        if len(head) < step + kind.itemsize:
            continue
        pair = np.concatenate([np.frombuffer(head, kind, 1, at) for at in (0, step)])
        fits = "length" not in (kind.names or ()) or (pair["length"] == PACKET_BYTES).all()
        apart = int(np.diff(pair["number"].astype(np.int64))[0])
        if fits and 0 < apart < MAX_APART and np.diff(_sent_before(pair))[0] == apart * PACKET_BYTES:
            return PacketSamples(_headers(files, kind))
    return None


def _sent_before(header: np.ndarray) -> np.ndarray:
    return header["low"].astype(np.int64) | (header["high"].astype(np.int64) << 32)


def _headers(files: JoinedFiles, kind: np.dtype) -> _Packets:
    """Index of packets of equal size with headers; the last may be shorter."""
    step, headers = kind.itemsize + PACKET_BYTES, []
    for at in range(0, files.size, PACKETS_A_BLOCK * step):
        block = files.read(at, at + PACKETS_A_BLOCK * step)
        whole = np.pad(block, (0, -len(block) % step)).reshape(-1, step)
        headers.append(np.ascontiguousarray(whole[:, : kind.itemsize]).view(kind)[:, 0])
    header = np.concatenate(headers)
    at = np.arange(len(header)) * step + kind.itemsize
    num_bytes = np.clip(files.size - at, 0, PACKET_BYTES)
    used = num_bytes > 0
    return _Packets(
        files=files,
        number=header["number"].astype(np.int64)[used],
        first_byte=_sent_before(header)[used],
        num_bytes=num_bytes[used],
        at=at[used],
        time_s=np.zeros(0),
    )


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
    packets = PacketSamples(_packets_of(Path(path)))
    frame_bytes = bytes_of_frame(config)
    total = packets.size // frame_bytes
    if num_frames is not None:
        total = min(num_frames, -(-packets.size // frame_bytes))
    if total == 0:
        raise InputError(
            f"{path} holds {packets.size} bytes, but one frame of this radar has {frame_bytes}; was it"
            " recorded with this radar.cfg?"
        )
    chosen = range(total)[frames]
    if len(chosen) * frame_bytes > MAX_BYTES:
        size = len(chosen) * frame_bytes / 1e9
        raise InputError(f"{path} holds {size:.1f} GB of samples; at most {MAX_BYTES / 1e9:.0f} GB are read at once")
    adc, lost_share = adc_of_sent(packets, config, chosen, iq_order=iq_order)
    return PacketCapture(
        adc=adc,
        lost_share=lost_share,
        report=packets.report(total * frame_bytes),
        num_frames=total,
        frame_time_s=_frame_times(packets.packets, total, frame_bytes, config)[chosen.start : chosen.stop],
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
        self._packets = PacketSamples(_packets_of(Path(path)))
        self.size, self._at = self._packets.size, 0

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
        return self._packets.read(first, self._at)[0].tobytes()


def _packets_of(path: Path) -> _Packets:
    """Indexes the packets of a file, anew if it has changed."""
    changed = path.stat() if path.is_file() else None
    return _indexed(path, None if changed is None else (changed.st_mtime_ns, changed.st_size))


@lru_cache(maxsize=1)  # index a recording that is read in pieces only once
def _indexed(path: Path, _changed: tuple[int, int] | None) -> _Packets:
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
    columns = {name: np.array(column, np.int64) for name, column in found.items()}
    return _Packets(files=JoinedFiles((path,)), time_s=np.array(times), **columns)


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


def _reassembled(packets: _Packets, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
    """Bytes from `first` to `last` in order, (byte,), zeros where nothing was received, and where something was."""
    data, is_received = np.zeros(last - first, np.uint8), np.zeros(last - first, bool)
    block, start = np.zeros(0, np.uint8), 0
    for index in np.flatnonzero((packets.first_byte < last) & (packets.last_byte > first)):
        begin, at, size = (int(column[index]) for column in (packets.first_byte, packets.at, packets.num_bytes))
        if at < start or at + size > start + len(block):
            block, start = packets.files.read(at, at + max(size, BLOCK_BYTES)), at
        new = block[at - start : at - start + size][max(0, first - begin) : last - begin]
        place = slice(max(begin - first, 0), max(begin - first, 0) + len(new))
        if is_received[place].any() and not (is_received[place].all() and np.array_equal(data[place], new)):
            raise InputError(
                f"{packets.files.paths[0]} holds different data for byte {begin}: more than one recording in a file;"
                " record each to a file of its own"
            )
        data[place], is_received[place] = new, True
    return data, is_received


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
