"""Packets of a .pcap, and other files."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.formats.pcap import MAGIC, udp_packets
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


def test_a_truncated_last_packet_is_omitted(tmp_path: Path):
    path = tmp_path / "a.pcap"
    path.write_bytes(pcap_of(PACKETS)[:-7])
    assert len(list(udp_packets(path, 4098))) == 2


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "it is empty"),
        (b"no packets", "not a .pcap"),
        (b"\x0a\x0d\x0d\x0a" + bytes(40), "editcap"),
        (b"\xd4\xc3\xb2\xa1" + bytes(4), "truncated"),
        (pcap_of([], link=1)[:20] + bytes((105, 0, 0, 0)), "type 105"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, content: bytes, message: str):
    path = tmp_path / "a.pcap"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        list(udp_packets(path, 4098))


def test_a_missing_file(tmp_path: Path):
    with pytest.raises(InputError, match="cannot read"):
        list(udp_packets(tmp_path / "none.pcap", 4098))
