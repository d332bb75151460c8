"""UDP packets of a .pcap file (tcpdump) or .pcapng file (Wireshark), with the standard library only.

Reference: IETF draft-ietf-opsawg-pcap and draft-ietf-opsawg-pcapng; RFC 791, RFC 768.
"""

import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import check_regular, open_regular

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
