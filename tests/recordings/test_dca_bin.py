"""Recordings as people have them: stopped by hand, split, with headers, with packets lost; each becomes the frames that
were sent, with one line on what was wrong."""

import struct
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.io.dca1000 import write_bin
from mmweaver.recordings.processing import process_recording
from mmweaver.recordings.read_recording import read_recording
from tests.recordings.test_plausibility import RADAR, room

PAYLOAD = 1456
CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"
needs_cases = pytest.mark.skipif(not CASES.is_dir(), reason="the made cases are not here")


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("whole") / "whole.bin"
    write_bin(path, room(RADAR, 6), counts_per_unit=1.0)
    return path


def packets(data: bytes) -> list[tuple[int, int, bytes]]:
    """Number from 1, bytes sent before, payload."""
    return [(at // PAYLOAD + 1, at, data[at : at + PAYLOAD]) for at in range(0, len(data), PAYLOAD)]


def warnings(path: Path, **options) -> list[str]:
    return process_recording(path, RADAR, analyse=False, **options).meta["warnings"]


def test_a_rest_after_the_last_frame_is_left_out_and_reported(whole: Path, tmp_path: Path):
    path = tmp_path / "cut.bin"
    path.write_bytes(whole.read_bytes()[:-1234])
    read = read_recording(path, RADAR)
    assert read.adc is not None
    assert np.array_equal(read.adc.samples, room(RADAR, 6).samples[:5])
    assert any(str(49152 - 1234) in text for text in warnings(path))
    with pytest.raises(InputError, match="strict"):
        process_recording(path, RADAR, analyse=False, strict=True)


def test_a_rest_of_another_radars_frame_is_refused(whole: Path, tmp_path: Path):
    from dataclasses import replace

    path = tmp_path / "cut.bin"
    path.write_bytes(whole.read_bytes()[:-1000])
    with pytest.raises(InputError, match="alike"):
        read_recording(path, replace(RADAR, num_samples=48, num_range_bins=48))


@pytest.mark.parametrize("raw", [False, True])
def test_headers_of_packets_say_what_was_lost(whole: Path, tmp_path: Path, raw: bool):
    kept = [one for one in packets(whole.read_bytes()) if one[0] % 40 != 7]
    kept[3], kept[4] = kept[4], kept[3]  # late
    head = (lambda n, at, size: struct.pack("<IIIH", n, size, at, 0)) if raw else (
        lambda n, at, size: struct.pack("<IIH", n, at, 0)
    )  # fmt: skip
    path = tmp_path / "adc_data_Raw_0.bin"
    path.write_bytes(b"".join(head(number, at, len(payload)) + payload for number, at, payload in kept))
    read = read_recording(path, RADAR)
    truth = room(RADAR, 6).samples
    assert read.adc is not None
    assert read.lost_share is not None
    intact = read.lost_share == 0
    assert 0.01 < 1 - intact.mean() < 0.2
    assert np.array_equal(read.adc.samples[intact], truth[intact])
    assert any("header" in text for text in warnings(path))


def test_zeros_of_packets_are_lost_and_their_chirps_estimated(whole: Path, tmp_path: Path):
    data = bytearray(whole.read_bytes())
    for number in (5, 50, 51, 120):
        data[number * PAYLOAD : (number + 1) * PAYLOAD] = bytes(PAYLOAD)
    path = tmp_path / "lost.bin"
    path.write_bytes(data)
    read, truth = read_recording(path, RADAR), room(RADAR, 6).samples
    assert read.adc is not None
    assert read.lost_share is not None
    assert read.lost_share.mean() == pytest.approx(4 * PAYLOAD / len(data), rel=0.02)
    is_lost = read.lost_share > 0
    assert np.array_equal(read.adc.samples[~is_lost], truth[~is_lost])
    middle = slice(16, 48)  # the ends of a chirp are not estimated where its window is near zero
    error = np.abs(read.adc.samples - truth)[is_lost][..., middle]
    assert (error**2).mean() < 0.1 * (np.abs(truth[is_lost][..., middle]) ** 2).mean()
    sentence = next(text for text in warnings(path) if "lost" in text)
    assert f"{100 * 4 * PAYLOAD / len(data):.2g} %" in sentence
    part = read_recording(path, RADAR, frames=slice(1, 4))
    assert part.adc is not None
    assert np.array_equal(part.adc.samples, read.adc.samples[1:4])


def test_parts_are_read_as_one(whole: Path, tmp_path: Path):
    data = whole.read_bytes()
    (tmp_path / "adc_data_Raw_0.bin").write_bytes(data[:150_000])
    (tmp_path / "adc_data_Raw_1.bin").write_bytes(data[150_000:])
    read = read_recording(tmp_path / "adc_data_Raw_0.bin", RADAR)
    assert read.adc is not None
    assert np.array_equal(read.adc.samples, room(RADAR, 6).samples)
    (tmp_path / "adc_data_Raw_0.bin").unlink()
    with pytest.raises(InputError, match="Raw_0"):
        read_recording(tmp_path / "adc_data_Raw_1.bin", RADAR)


@pytest.mark.parametrize(
    ("head", "word"),
    [
        (bytes([2, 1, 4, 3, 6, 5, 8, 7]), "mmweaver points"),
        (b"MATLAB 5.0 MAT-file", "MATLAB"),
        (b"\x89HDF\r\n\x1a\n", "HDF5"),
    ],
)
def test_other_files_are_named(tmp_path: Path, head: bytes, word: str):
    path = tmp_path / "a.bin"
    path.write_bytes(head + bytes(200_000))
    with pytest.raises(InputError, match=word):
        read_recording(path, RADAR)


def test_fewer_frames_than_the_cfg_announces(tmp_path: Path):
    from tests import captures

    config = captures.radar_of_cfg(tmp_path)
    cfg = tmp_path / "made.cfg"
    cfg.write_text(captures.CFG.replace("frameCfg 0 1 8 0", "frameCfg 0 1 8 80"))
    write_bin(tmp_path / "a.bin", captures.counts(config, 4), counts_per_unit=1.0)
    found = process_recording(tmp_path / "a.bin", cfg, analyse=False).meta["warnings"]
    assert any("80 frames" in text and "has 4" in text for text in found)


@needs_cases
@pytest.mark.parametrize("case", ["dca_zero_packets/lost.bin", "pcap_lost_packets/lost.pcap"])
def test_made_case_of_lost_packets(case: str):
    done = process_recording(CASES / case, CASES / "radar16.json", analyse=False)
    points = done.points
    azimuth_deg = np.degrees(np.arctan2(points.x_m, points.y_m))
    assert (np.abs(azimuth_deg) > 10).sum() == 0
    assert abs(len(points.frame) - 120) <= 6
    assert any("3.6 %" in text for text in done.meta["warnings"])


@needs_cases
@pytest.mark.parametrize(
    ("case", "frames", "word"),
    [("dca_trailing_partial/cut.bin", 4, "1000 bytes"), ("dca_packet_headers/adc_data_Raw_0.bin", 4, "headers")],
)
def test_made_cases_that_were_refused(case: str, frames: int, word: str):
    done = process_recording(CASES / case, CASES / "radar16.json", analyse=False)
    right = process_recording(CASES / "right.bin", CASES / "radar16.json", analyse=False)
    assert np.array_equal(done.cube.values, right.cube.values[:frames])
    assert any(word in text for text in done.meta["warnings"])


@needs_cases
def test_made_case_of_interleaved_words():
    found = process_recording(CASES / "dca_iq_interleaved" / "iqiq.bin", CASES / "radar16.json", analyse=False)
    assert any("--iq-order interleaved" in text for text in found.meta["warnings"])
    again = process_recording(
        CASES / "dca_iq_interleaved" / "iqiq.bin", CASES / "radar16.json", analyse=False, iq_order="interleaved"
    )
    assert again.meta["warnings"] == []
    assert len(again.points.frame) == 120
