"""Packets of a .pcap, and other files."""

import struct
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.dca_packets import MAGIC, udp_packets
from tests.captures import START_S, pcap_of

PACKETS = [(START_S, b"first packet"), (START_S + 0.5, b"x"), (START_S + 1.25, bytes(1466))]


@pytest.mark.parametrize("magic", list(MAGIC))
@pytest.mark.parametrize("link", [1, 101, 113])
def test_every_byte_order_clock_and_link(tmp_path: Path, magic: bytes, link: int):
    path = tmp_path / "a.pcap"
    path.write_bytes(pcap_of(PACKETS, magic=magic, link=link))
    found = list(udp_packets(path, 4098))
    assert [packet.payload for packet in found] == [payload for _, payload in PACKETS]
    assert [packet.time_s for packet in found] == pytest.approx([time_s for time_s, _ in PACKETS], abs=2e-6)
    assert list(udp_packets(path, 4096)) == []


def pcapng_of(packets, link: int = 1, *, order: str = "<", resolution: int | None = 9) -> bytes:
    """The same packets in the blocks of Wireshark's format."""
    plain = pcap_of(packets, link=link)
    magic = struct.pack(f"{order}I", 0x1A2B3C4D)
    blocks = [struct.pack(f"{order}II", 0x0A0D0D0A, 28) + magic + struct.pack(f"{order}HHqI", 1, 0, -1, 28)]
    option = b"" if resolution is None else struct.pack(f"{order}HHB3xHH", 9, 1, resolution, 0, 0)
    blocks.append(struct.pack(f"{order}IIHHI", 1, 20 + len(option), link, 0, 0) + option
                  + struct.pack(f"{order}I", 20 + len(option)))  # fmt: skip
    blocks.append(struct.pack(f"{order}II4xI", 5, 16, 16))  # interface statistics, to be skipped
    at = 24
    for time_s, _ in packets:
        kept = struct.unpack_from("<IIII", plain, at)[2]
        data = plain[at + 16 : at + 16 + kept]
        at += 16 + kept
        ticks = round(time_s * (1e6 if resolution is None else 10**resolution))
        length = 32 + -(-kept // 4) * 4
        head = struct.pack(f"{order}IIIIIII", 6, length, 0, ticks >> 32, ticks & 0xFFFFFFFF, kept, kept)
        blocks.append(head + data + bytes(length - 32 - kept) + struct.pack(f"{order}I", length))
    return b"".join(blocks)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("resolution", [None, 9])
@pytest.mark.parametrize("link", [1, 101])
def test_pcapng(tmp_path: Path, order: str, resolution: int | None, link: int):
    path = tmp_path / "a.pcapng"
    path.write_bytes(pcapng_of(PACKETS, link, order=order, resolution=resolution))
    found = list(udp_packets(path, 4098))
    assert [packet.payload for packet in found] == [payload for _, payload in PACKETS]
    assert [packet.time_s for packet in found] == pytest.approx([time_s for time_s, _ in PACKETS], abs=2e-6)
    path.write_bytes(path.read_bytes()[:-7])
    assert len(list(udp_packets(path, 4098))) == 2


def test_a_truncated_last_packet_is_omitted(tmp_path: Path):
    path = tmp_path / "a.pcap"
    path.write_bytes(pcap_of(PACKETS)[:-7])
    assert len(list(udp_packets(path, 4098))) == 2


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "it is empty"),
        (b"no packets", "not a .pcap"),
        (b"\x0a\x0d\x0d\x0a" + bytes(40), "damaged"),
        (b"\xd4\xc3\xb2\xa1" + bytes(4), "truncated"),
        (pcap_of([], link=1)[:20] + bytes((105, 0, 0, 0)), "type 105"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, content: bytes, message: str):
    path = tmp_path / "a.pcap"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        list(udp_packets(path, 4098))
