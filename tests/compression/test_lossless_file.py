from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression import lossless_file
from mmweaver.compression.lossless_file import LosslessFile, compress_bin, describe_lossless
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.io.dca1000 import bytes_of_frame
from tests.captures import PAYLOAD, counts, packets_of, pcap_of, radar_of_cfg

RADAR = replace(AWR1843, num_samples=64, num_loops=8, num_range_bins=32, first_range_bin=0)


@pytest.fixture
def recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Seven frames and part of an eighth, two frames a block."""
    monkeypatch.setattr(lossless_file, "BLOCK_BYTES", 2 * bytes_of_frame(RADAR))
    draw = stream(0, "recording")
    num_words = bytes_of_frame(RADAR) // 2
    frames = np.rint(draw.normal(size=num_words) * 500 + draw.normal(size=(8, num_words)) * 4).astype("<i2")
    path = tmp_path / "adc_data.bin"
    path.write_bytes(frames.tobytes()[: -num_words - 3])
    return path


def test_the_same_bytes_come_back(recording: Path, tmp_path: Path):
    size = compress_bin(recording, tmp_path / "a.mmwl", RADAR)
    assert size == (tmp_path / "a.mmwl").stat().st_size < 0.8 * recording.stat().st_size
    file = LosslessFile(tmp_path / "a.mmwl")
    assert file.num_frames == 7
    assert file.decompress(tmp_path / "b.bin") == recording.stat().st_size
    assert (tmp_path / "b.bin").read_bytes() == recording.read_bytes()
    frame = bytes_of_frame(RADAR)
    file.decompress(tmp_path / "c.bin", slice(3, 6))
    assert (tmp_path / "c.bin").read_bytes() == recording.read_bytes()[3 * frame : 6 * frame]
    with pytest.raises(InputError, match="7 frames"):
        file.decompress(tmp_path / "d.bin", slice(9, 12))


def test_words_change_by_no_more_than_the_largest_error(recording: Path, tmp_path: Path):
    lossless, near = (compress_bin(recording, tmp_path / "a.mmwl", RADAR, max_error=error) for error in (0, 3))
    assert near < 0.8 * lossless
    LosslessFile(tmp_path / "a.mmwl").decompress(tmp_path / "b.bin", slice(0, 7))
    words = [
        np.fromfile(path, "<i2", 7 * bytes_of_frame(RADAR) // 2).astype(int) for path in (recording, tmp_path / "b.bin")
    ]
    assert np.abs(words[0] - words[1]).max() == 3
    assert describe_lossless(tmp_path / "a.mmwl")["max_error_counts"] == 3


def test_a_file_cut_short_holds_the_blocks_before(recording: Path, tmp_path: Path):
    compress_bin(recording, tmp_path / "a.mmwl", RADAR)
    data = (tmp_path / "a.mmwl").read_bytes()
    starts = [place.start for place in LosslessFile(tmp_path / "a.mmwl").places]
    (tmp_path / "a.mmwl").write_bytes(data[: starts[2] + 20])
    file = LosslessFile(tmp_path / "a.mmwl")
    assert (file.num_frames, file.cut_short) == (4, 20)
    file.decompress(tmp_path / "b.bin")
    assert (tmp_path / "b.bin").read_bytes() == recording.read_bytes()[: 4 * 8 * 3 * 4 * 64 * 4]
    (tmp_path / "a.mmwl").write_bytes(data[: starts[0] + 20])
    with pytest.raises(InputError, match=r"a\.mmwl"):
        LosslessFile(tmp_path / "a.mmwl").decompress(tmp_path / "c.bin")
    assert not (tmp_path / "c.bin").exists()


def test_damage_is_noticed(recording: Path, tmp_path: Path):
    compress_bin(recording, tmp_path / "a.mmwl", RADAR)
    data = (tmp_path / "a.mmwl").read_bytes()
    for at in stream(0, "damage").integers(0, len(data), 15):
        (tmp_path / "b.mmwl").write_bytes(data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1 :])
        with pytest.raises(InputError):
            LosslessFile(tmp_path / "b.mmwl").decompress(tmp_path / "b.bin")


def test_what_cannot_be_compressed_is_refused(recording: Path, tmp_path: Path):
    (tmp_path / "empty.bin").touch()
    for path, radar, error, word in (
        (tmp_path / "empty.bin", RADAR, 0, "empty"),
        (tmp_path / "none.bin", RADAR, 0, "cannot read"),
        (recording, replace(RADAR, complex_samples=False), 0, "complex samples"),
        (recording, RADAR, 5000, r"5000.*0 to 1000"),
    ):
        with pytest.raises(InputError, match=word):
            compress_bin(path, tmp_path / "a.mmwl", radar, max_error=error)
    assert not (tmp_path / "a.mmwl").exists()


def test_of_packets_the_samples_are_kept(tmp_path: Path):
    config = radar_of_cfg(tmp_path)
    packets = packets_of(tmp_path, counts(config))
    sent = b"".join(payload[10:] for _, payload in packets)
    packets[2:4] = [packets[3], packets[2]]
    del packets[1]
    (tmp_path / "dca.pcap").write_bytes(pcap_of(packets))
    compress_bin(tmp_path / "dca.pcap", tmp_path / "a.mmwl", config)
    LosslessFile(tmp_path / "a.mmwl").decompress(tmp_path / "b.bin")
    assert (tmp_path / "b.bin").read_bytes() == sent[:PAYLOAD] + bytes(PAYLOAD) + sent[2 * PAYLOAD :]
