"""The raw packets of a DCA1000 put together again: what was lost is zero and counted, what came late is put in place.

A packet holds a sequence number (4 bytes, from 1), how many bytes were sent before it (6 bytes) and up to 1456 bytes
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
MOST_BYTES = 4_000_000_000


@dataclass(frozen=True, kw_only=True)
class PacketReport:
    """What happened on the way from the board to the file."""

    packets: int
    lost: int  # by their sequence numbers, before the last one that came
    lost_bytes: int  # of the frames that are kept; they are zero
    late: int  # came after a packet of a higher number
    repeated: int
    bytes_after_last_frame: int  # of a frame that was not finished, left out


@dataclass(frozen=True, kw_only=True)
class PacketCapture:
    """The samples of all whole frames, when each began (seconds of the recorder's clock), and the packets' report."""

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

    `num_frames`: how many the radar was told to send; a last frame whose tail never came is then kept, the tail lost.
    Raises InputError where there are no packets, not one frame, or more than one recording in the file.
    """
    path = Path(path)
    pieces = [_piece(path, packet) for packet in udp_packets(path, DATA_PORT)]
    if not pieces:
        raise InputError(f"{path} holds no packets of a DCA1000 (UDP port {DATA_PORT}); was the radar started?")
    numbers = np.array([piece.number for piece in pieces])
    reach = max(piece.first_byte + len(piece.payload) for piece in pieces)
    if reach > MOST_BYTES:
        raise InputError(f"{path} says that {reach / 1e9:.1f} GB were sent; at most {MOST_BYTES / 1e9:.0f} GB are read")
    frame_bytes = bytes_of_frame(config)
    frames = reach // frame_bytes
    if num_frames is not None:
        frames = min(num_frames, -(-reach // frame_bytes))
    if frames == 0:
        raise InputError(
            f"{path} holds {reach} bytes, but one frame of this radar has {frame_bytes}; is radar.cfg the one it was"
            " recorded with?"
        )
    size = max(frames * frame_bytes, reach)
    data, there = _put_together(path, pieces, size)
    late, repeated = _late_and_repeated(numbers)
    kept = slice(0, frames * frame_bytes)
    report = PacketReport(
        packets=len(pieces),
        lost=int(numbers.max() - len(np.unique(numbers))),
        lost_bytes=int(np.count_nonzero(~there[kept])),
        late=late,
        repeated=repeated,
        bytes_after_last_frame=max(0, reach - frames * frame_bytes),
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
    """How many packets came after one of a higher number, and how many came again."""
    _, first = np.unique(numbers, return_index=True)
    once = numbers[np.sort(first)]
    return int(np.count_nonzero(once < np.maximum.accumulate(once))), len(numbers) - len(once)


def _put_together(path: Path, pieces: list[_Piece], size: int) -> tuple[np.ndarray, np.ndarray]:
    """All bytes in their places, and which of them came."""
    data, there = np.zeros(size, np.uint8), np.zeros(size, bool)
    for piece in pieces:
        place = slice(piece.first_byte, piece.first_byte + len(piece.payload))
        new = np.frombuffer(piece.payload, np.uint8)
        if there[place].any() and not (there[place].all() and np.array_equal(data[place], new)):
            raise InputError(
                f"{path} holds different data for byte {piece.first_byte}: more than one recording in a file;"
                " record each into its own"
            )
        data[place], there[place] = new, True
    return data, there


def _frame_times(pieces: list[_Piece], frames: int, frame_bytes: int, config: RadarConfig) -> PerFrame:
    """When the packet with each frame's first bytes came; from the frames around it where that one was lost."""
    time_s = np.full(frames, np.nan)
    for piece in pieces:
        frame = -(-piece.first_byte // frame_bytes)  # the first to begin at or after this packet's first byte
        if frame < frames and frame * frame_bytes < piece.first_byte + len(piece.payload):
            time_s[frame] = np.fmin(time_s[frame], piece.time_s)
    index = np.arange(frames)
    known = np.isfinite(time_s)
    if not known.any():
        return pieces[0].time_s + index * config.frame_period_s
    offsets = time_s - index * config.frame_period_s
    return index * config.frame_period_s + np.interp(index, index[known], offsets[known])
