"""Packets lost, late, repeated, truncated: zeros where nothing was received, the same bits everywhere else."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.dca_packets import PacketCapture, read_pcap
from tests.captures import PAYLOAD, START_S, Packet, counts, packets_of, pcap_of, radar_of_cfg

FRAME_BYTES = 8 * 2 * 4 * 64 * 4


@pytest.fixture
def sent(tmp_path: Path):
    config = radar_of_cfg(tmp_path)
    adc = counts(config)
    return adc, packets_of(tmp_path, adc)


def caught(folder: Path, adc, packets: list[Packet], **options) -> PacketCapture:
    path = folder / "dca.pcap"
    path.write_bytes(pcap_of(packets))
    return read_pcap(path, adc.config, iq_order="qi", **options)


def test_all_packets_in_order(tmp_path: Path, sent):
    adc, packets = sent
    capture = caught(tmp_path, adc, packets)
    assert capture.adc.samples.tobytes() == adc.samples.tobytes()
    assert np.isnan(capture.adc.scale)
    assert capture.frame_time_s == pytest.approx(START_S + 0.1 * np.arange(3), abs=2e-3)
    report = capture.report
    assert (report.packets, report.lost, report.lost_bytes, report.late, report.repeated) == (len(packets), 0, 0, 0, 0)


def test_a_stretch_of_frames_is_that_of_the_whole(tmp_path: Path, sent):
    adc, packets = sent
    mixed = [*packets[:4], packets[5], packets[4], *packets[6:9], *packets[10:], packets[2]]
    whole = caught(tmp_path, adc, mixed)
    assert whole.report.lost == whole.report.late == whole.report.repeated == 1
    for frames in (slice(0, 1), slice(1, 3), slice(2, 2)):
        part = caught(tmp_path, adc, mixed, frames=frames)
        assert np.array_equal(part.adc.samples, whole.adc.samples[frames])
        assert np.array_equal(part.frame_time_s, whole.frame_time_s[frames])
        assert (part.report, part.num_frames) == (whole.report, 3)


def test_late_and_repeated_packets_change_nothing(tmp_path: Path, sent):
    adc, packets = sent
    mixed = packets.copy()
    mixed[4], mixed[5] = mixed[5], mixed[4]
    mixed.insert(10, mixed[2])
    mixed.append(mixed[0])
    capture = caught(tmp_path, adc, mixed)
    assert capture.adc.samples.tobytes() == adc.samples.tobytes()
    assert (capture.report.late, capture.report.repeated, capture.report.lost) == (1, 2, 0)


def test_lost_packets_are_zeros_and_counted(tmp_path: Path, sent):
    adc, packets = sent
    gone = (0, 7, 8)
    capture = caught(tmp_path, adc, [packet for index, packet in enumerate(packets) if index not in gone])
    assert (capture.report.lost, capture.report.lost_bytes) == (3, 3 * PAYLOAD)
    same = capture.adc.samples == adc.samples
    zero = capture.adc.samples == 0
    assert (same | zero).all()
    assert np.count_nonzero(zero & ~same) == pytest.approx(3 * PAYLOAD / 4, abs=12)
    assert capture.frame_time_s[0] == pytest.approx(START_S, abs=2e-3)  # from the frames after it


def test_an_unfinished_frame_is_omitted_unless_the_radar_was_configured_to_send_it(tmp_path: Path, sent):
    adc, packets = sent
    short = packets[: 2 * FRAME_BYTES // PAYLOAD + 4]
    capture = caught(tmp_path, adc, short)
    assert len(capture.adc.samples) == 2
    assert 0 < capture.report.bytes_after_last_frame < FRAME_BYTES
    asked = caught(tmp_path, adc, short, num_frames=3)
    assert len(asked.adc.samples) == 3
    assert asked.adc.samples[:2].tobytes() == adc.samples[:2].tobytes()
    assert asked.report.lost_bytes > 0
    assert asked.report.bytes_after_last_frame == 0
    assert len(caught(tmp_path, adc, packets, num_frames=2).adc.samples) == 2


def test_inconsistent_packets_are_refused(tmp_path: Path, sent):
    adc, packets = sent
    with pytest.raises(InputError, match="4098"):
        caught(tmp_path, adc, [])
    with pytest.raises(InputError, match=r"4368.*16384"):
        caught(tmp_path, adc, packets[:3])
    with pytest.raises(InputError, match="one recording"):
        caught(tmp_path, adc, packets + packets_of(tmp_path, counts(adc.config, seed=1)))
    with pytest.raises(InputError, match=r"6 bytes.*4098"):
        caught(tmp_path, adc, [*packets, (START_S, bytes(6))])
    with pytest.raises(InputError, match="holds 100"):
        caught(tmp_path, adc, [(START_S, b"\x01\0\0\0" + b"\xff" * 6 + bytes(100))])
