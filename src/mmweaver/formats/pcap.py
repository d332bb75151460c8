"""UDP packets of a .pcap file as tcpdump writes it, or of a .pcapng of Wireshark, with the standard library only.

Reference: IETF draft-ietf-opsawg-pcap and draft-ietf-opsawg-pcapng; RFC 791, RFC 768.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import read_bytes

# magic number in the file: (byte order, ticks per second)
MAGIC = {
    b"\xd4\xc3\xb2\xa1": ("<", 1e6), b"\xa1\xb2\xc3\xd4": (">", 1e6),
    b"\x4d\x3c\xb2\xa1": ("<", 1e9), b"\xa1\xb2\x3c\x4d": (">", 1e9),
}  # fmt: skip
PCAPNG = b"\x0a\x0d\x0d\x0a"
SECTION, INTERFACE, PACKET, RESOLUTION = 0x0A0D0D0A, 1, 6, 9  # blocks of pcapng, and an option of an interface
# link type: bytes before the network layer, and the offset of the protocol number in them (None: always IP)
LINK_TYPES: dict[int, tuple[int, int | None]] = {1: (14, 12), 101: (0, None), 113: (16, 14), 276: (20, 0)}
MAX_BYTES = 8_000_000_000
IPV4, VLAN, UDP = 0x0800, 0x8100, 17


@dataclass(frozen=True)
class UdpPacket:
    """The payload of a packet and its capture time (seconds of the recorder's clock)."""

    time_s: float
    payload: bytes


def udp_packets(path: Path | str, port: int) -> Iterator[UdpPacket]:
    """Yields the packets of a .pcap or .pcapng that were sent to a UDP port, in the order of the file.

    A truncated last packet (the recorder was stopped) is omitted. Raises InputError where the file cannot be read, is
    not a .pcap, or is truncated before its first packet.
    """
    path = Path(path)
    data = read_bytes(path, max_bytes=MAX_BYTES)
    if data[:4] == PCAPNG:
        yield from _of_pcapng(path, data, port)
        return
    order, ticks, link = _header(path, data)
    at, header = 24, struct.Struct(f"{order}IIII")
    while at + 16 <= len(data):
        seconds, fraction, kept, _ = header.unpack_from(data, at)
        at += 16
        if at + kept > len(data):
            return
        payload = _udp_payload(data, at, at + kept, link, port)
        if payload is not None:
            yield UdpPacket(seconds + fraction / ticks, payload)
        at += kept


def _header(path: Path, data: bytes) -> tuple[str, float, int]:
    if data[:4] not in MAGIC:
        raise InputError(f"{path} is not a .pcap file{' (it is empty)' if not data else ''}; record it with tcpdump -w")
    if len(data) < 24:
        raise InputError(f"{path} is truncated within its header; it holds no packets")
    order, ticks = MAGIC[data[:4]]
    link = struct.unpack_from(f"{order}I", data, 20)[0] & 0xFFFF
    if link not in LINK_TYPES:
        raise InputError(
            f"{path} was captured on a link of type {link}; known: Ethernet (1), raw IP (101), Linux (113)"
        )
    return order, ticks, link


def _of_pcapng(path: Path, data: bytes, port: int) -> Iterator[UdpPacket]:
    """The same of a pcapng file: enhanced packet blocks, with the link and clock of their interface."""
    order = "<" if data[8:12] == b"\x4d\x3c\x2b\x1a" else ">"
    links: list[tuple[int, float]] = []  # of each interface: link type, ticks a second
    at = 0
    while at + 12 <= len(data):
        kind, length = struct.unpack_from(f"{order}II", data, at)
        if kind == SECTION:
            order, links = ("<" if data[at + 8 : at + 12] == b"\x4d\x3c\x2b\x1a" else ">"), []
            length = struct.unpack_from(f"{order}I", data, at + 4)[0]
        if length < 12 or length % 4:
            raise InputError(f"{path} has a damaged block at byte {at}; record it again")
        if at + length > len(data):
            return  # the recorder was stopped
        if kind == INTERFACE:
            links.append((struct.unpack_from(f"{order}H", data, at + 8)[0], _ticks(data, at + 16, at + length, order)))
        elif kind == PACKET:
            interface, high, low, kept = struct.unpack_from(f"{order}IIII", data, at + 8)
            if interface >= len(links) or kept > length - 32:
                raise InputError(f"{path} has a damaged block at byte {at}; record it again")
            link, ticks = links[interface]
            if link not in LINK_TYPES:
                raise InputError(
                    f"{path} was captured on a link of type {link}; known: Ethernet (1), raw IP (101), Linux (113)"
                )
            payload = _udp_payload(data, at + 28, at + 28 + kept, link, port)
            if payload is not None:
                yield UdpPacket((high << 32 | low) / ticks, payload)
        at += length


def _ticks(data: bytes, at: int, end: int, order: str) -> float:
    """Clock ticks a second of an interface, from its option if_tsresol; microseconds without it."""
    while at + 4 <= end - 4:
        code, size = struct.unpack_from(f"{order}HH", data, at)
        if code == 0:
            break
        if code == RESOLUTION and size == 1:
            value = data[at + 4]
            return float(2 ** (value & 0x7F)) if value & 0x80 else float(10**value)
        at += 4 + -(-size // 4) * 4
    return 1e6


def _udp_payload(data: bytes, at: int, end: int, link: int, port: int) -> bytes | None:
    """The payload if the packet is IPv4, UDP and for this port, else None."""
    length, kind_at = LINK_TYPES[link]
    if kind_at is not None:
        if at + length > end:
            return None
        kind = int.from_bytes(data[at + kind_at : at + kind_at + 2], "big")
        if kind == VLAN:
            kind, length = int.from_bytes(data[at + length + 2 : at + length + 4], "big"), length + 4
        if kind != IPV4:
            return None
    at += length
    if at + 20 > end or data[at] >> 4 != 4 or data[at + 9] != UDP:
        return None
    at += 4 * (data[at] & 0xF)
    if at + 8 > end or int.from_bytes(data[at + 2 : at + 4], "big") != port:
        return None
    size = int.from_bytes(data[at + 4 : at + 6], "big")
    return data[at + 8 : min(at + size, end)]  # Ethernet pads short packets
