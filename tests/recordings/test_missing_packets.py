"""Packets that a recorder left out are found, with their number, and the frames after them are read where they are."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.io.dca1000 import write_bin
from mmweaver.io.sample_files import PACKET_BYTES, BinSamples, part_files
from mmweaver.recordings.missing_packets import missing_packets
from tests.recordings.test_plausibility import RADAR, room

FRAMES = 24
FRAME_BYTES = RADAR.num_loops * RADAR.num_slots * RADAR.num_rx * RADAR.num_samples * 4


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("gaps") / "whole.bin"
    write_bin(path, room(RADAR, FRAMES), counts_per_unit=1.0)
    return path


def without(path: Path, lost: list[tuple[int, int, int]]) -> Path:
    """The file without `count` packets from packet `first` of a frame on, for each (frame, first, count)."""
    data, kept, at = path.read_bytes(), b"", 0
    for frame, first, count in lost:
        start = (frame * FRAME_BYTES // PACKET_BYTES + first) * PACKET_BYTES
        kept, at = kept + data[at:start], start + count * PACKET_BYTES
    out = path.with_name(f"lost_{len(lost)}_{lost[0][2]}.bin")
    out.write_bytes(kept + data[at:])
    return out


def test_a_whole_recording_has_none(recording: Path):
    assert missing_packets((recording,), RADAR) == ()


@pytest.mark.parametrize("lost", [[(3, 20, 1)], [(3, 5, 10)], [(2, 15, 1), (6, 13, 2), (10, 11, 1), (14, 9, 3)]])
def test_number_and_frame_of_missing_packets(recording: Path, lost: list[tuple[int, int, int]]):
    path = without(recording, lost)
    gaps = missing_packets((path,), RADAR)
    assert [gap.num_bytes // PACKET_BYTES for gap in gaps] == [count for _, _, count in lost]
    whole, source = recording.read_bytes(), BinSamples((path,), gaps)
    assert source.size == len(whole)
    data, is_received = source.read(0, source.size)
    truth = np.frombuffer(whole, np.uint8)
    wrong = (data != truth) & is_received
    assert not wrong.any()
    assert 0 < (~is_received).mean() < 0.4
    last = (lost[-1][0] + 2) * FRAME_BYTES
    assert np.array_equal(data[last:], truth[last:])


def test_runs_of_zeros_are_lost_whatever_part_is_read(recording: Path):
    data = bytearray(recording.read_bytes())
    places = [7 * PACKET_BYTES, 40 * PACKET_BYTES, 41 * PACKET_BYTES]
    for at in places:
        data[at : at + PACKET_BYTES] = bytes(PACKET_BYTES)
    path = recording.with_name("zeros.bin")
    path.write_bytes(data)
    source = BinSamples((path,))
    _, whole = source.read(0, source.size)
    assert (~whole).sum() == pytest.approx(3 * PACKET_BYTES, abs=16)  # a sample next to them may be zero by itself
    for first in range(0, 60_000, 997):
        assert np.array_equal(source.read(first, first + 997)[1], whole[first : first + 997])


def test_parts_of_a_split_recording_are_one_stream(recording: Path, tmp_path: Path):
    data = recording.read_bytes()
    for number, (first, last) in enumerate([(0, 100_001), (100_001, 250_000), (250_000, len(data))]):
        (tmp_path / f"adc_data_Raw_{number}.bin").write_bytes(data[first:last])
    parts = part_files(tmp_path / "adc_data_Raw_0.bin")
    assert [part.name for part in parts] == [f"adc_data_Raw_{number}.bin" for number in range(3)]
    read, is_received = BinSamples(parts).read(99_000, 260_000)
    assert read.tobytes() == data[99_000:260_000]
    assert is_received.all()
