"""Reassembles the raw packets of a DCA1000: lost ones are zero-filled and counted, late ones put in place.

A packet holds a sequence number (4 bytes, from 1), the number of bytes sent before it (6 bytes) and up to 1456 bytes
of samples, all little-endian, on UDP port 4098.

Reference: TI SPRUIJ4, DCA1000EVM Data Capture Card User's Guide; mmwave-capture-std keeps the packets as dca.pcap.
"""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.shapes import PerFrame
from mmweaver.formats.dca1000 import adc_of_words, bytes_of_frame
from mmweaver.formats.pcap import UdpPacket, udp_packets

DATA_PORT = 4098
HEADER_BYTES = 10
MAX_BYTES = 4_000_000_000
MAX_LOSS = 20  # of so many bytes at least one was received


@dataclass(frozen=True, kw_only=True)
class PacketReport:
    """Packet statistics of a recording."""

    packets: int
    lost: int  # by sequence number, before the last received packet
    lost_bytes: int  # in the frames that are kept; zero-filled
    late: int  # received after a packet of a higher number
    repeated: int
    bytes_after_last_frame: int  # of an unfinished frame, omitted


@dataclass(frozen=True, kw_only=True)
class PacketCapture:
    """The samples of all whole frames, their start times (seconds of the recorder's clock), and packet statistics."""

    adc: AdcCube
    frame_time_s: PerFrame
    report: PacketReport


@dataclass(frozen=True)
class _Piece:
    number: int
    first_byte: int
    time_s: float
    payload: bytes


def read_pcap(
    path: Path | str, config: RadarConfig, *, iq_order: str = "iq", num_frames: int | None = None
) -> PacketCapture:
    """Reads a dca.pcap; samples in counts of the converter.

    `num_frames` is the number that the radar was configured to send: an incomplete last frame is then kept, with its
    missing end zero-filled. Raises InputError where the file has no packets, less than one frame, or two recordings.
    """
    path = Path(path)
    pieces = [_piece(path, packet) for packet in udp_packets(path, DATA_PORT)]
    if not pieces:
        raise InputError(f"{path} holds no packets of a DCA1000 (UDP port {DATA_PORT}); was the radar started?")
    numbers = np.array([piece.number for piece in pieces])
    num_bytes = max(piece.first_byte + len(piece.payload) for piece in pieces)
    if num_bytes > MAX_BYTES:
        raise InputError(
            f"{path} says that {num_bytes / 1e9:.1f} GB were sent; at most {MAX_BYTES / 1e9:.0f} GB are read"
        )
    received = sum(len(piece.payload) for piece in pieces)
    if num_bytes > MAX_LOSS * received:
        raise InputError(
            f"{path} says that {num_bytes} bytes were sent, but holds {received}: nearly all packets are lost, or it is"
            " damaged; record again"
        )
    frame_bytes = bytes_of_frame(config)
    frames = num_bytes // frame_bytes
    if num_frames is not None:
        frames = min(num_frames, -(-num_bytes // frame_bytes))
    if frames == 0:
        raise InputError(
            f"{path} holds {num_bytes} bytes, but one frame of this radar has {frame_bytes}; was it"
            " recorded with this radar.cfg?"
        )
    size = max(frames * frame_bytes, num_bytes)
    data, is_received = _reassembled(path, pieces, size)
    late, repeated = _late_and_repeated(numbers)
    kept = slice(0, frames * frame_bytes)
    report = PacketReport(
        packets=len(pieces),
        lost=int(numbers.max() - len(np.unique(numbers))),
        lost_bytes=int(np.count_nonzero(~is_received[kept])),
        late=late,
        repeated=repeated,
        bytes_after_last_frame=max(0, num_bytes - frames * frame_bytes),
    )
    adc = adc_of_words(data[kept].view("<i2"), config, iq_order=iq_order)
    return PacketCapture(adc=adc, frame_time_s=_frame_times(pieces, frames, frame_bytes, config), report=report)


def _piece(path: Path, packet: UdpPacket) -> _Piece:
    if len(packet.payload) <= HEADER_BYTES:
        raise InputError(
            f"{path} has a packet of {len(packet.payload)} bytes on port {DATA_PORT}; a DCA1000's has more"
        )
    number, low, high = struct.unpack_from("<IIH", packet.payload)
    return _Piece(number, high << 32 | low, packet.time_s, packet.payload[HEADER_BYTES:])


def _late_and_repeated(numbers: np.ndarray) -> tuple[int, int]:
    """The number of packets received after one of a higher number, and of duplicates."""
    _, first = np.unique(numbers, return_index=True)
    once = numbers[np.sort(first)]
    return int(np.count_nonzero(once < np.maximum.accumulate(once))), len(numbers) - len(once)


def _reassembled(path: Path, pieces: list[_Piece], size: int) -> tuple[np.ndarray, np.ndarray]:
    """All bytes in order, and which of them were received, (byte,) each."""
    data, is_received = np.zeros(size, np.uint8), np.zeros(size, bool)
    for piece in pieces:
        place = slice(piece.first_byte, piece.first_byte + len(piece.payload))
        new = np.frombuffer(piece.payload, np.uint8)
        if is_received[place].any() and not (is_received[place].all() and np.array_equal(data[place], new)):
            raise InputError(
                f"{path} holds different data for byte {piece.first_byte}: more than one recording in a file;"
                " record each to a file of its own"
            )
        data[place], is_received[place] = new, True
    return data, is_received


def _frame_times(pieces: list[_Piece], frames: int, frame_bytes: int, config: RadarConfig) -> PerFrame:
    """Arrival time of the packet with each frame's first byte, s; interpolated where that packet was lost."""
    time_s = np.full(frames, np.nan)
    for piece in pieces:
        frame = -(-piece.first_byte // frame_bytes)  # the first frame that starts at or after this packet's first byte
        if frame < frames and frame * frame_bytes < piece.first_byte + len(piece.payload):
            time_s[frame] = np.fmin(time_s[frame], piece.time_s)
    index = np.arange(frames)
    known = np.isfinite(time_s)
    if not known.any():
        return pieces[0].time_s + index * config.frame_period_s
    offsets = time_s - index * config.frame_period_s
    return index * config.frame_period_s + np.interp(index, index[known], offsets[known])
