import json
import struct
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.compression.mmw_container import PREFIX, WORDS, MmwFile, header_for, pack_mmw
from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.errors import InputError

CHUNKS = [bytes(range(60)), b"second chunk"]
TIMES_S = np.array([1.0, 1.1, 1.2])


def packed(config=AWR1843, scale: float = 2.5, time_s: np.ndarray = TIMES_S) -> bytes:
    return pack_mmw(header_for(config, scale, time_s), CHUNKS, [time_s[:2], time_s[2:]])


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "a.mmw"


@pytest.mark.parametrize("config", [AWR1843, BGT60, replace(AWR1843, name="mine", num_loops=16)], ids=lambda c: c.name)
def test_header_and_chunks_round_trip(config, path: Path):
    path.write_bytes(packed(config))
    file = MmwFile(path)
    assert file.num_bytes == path.stat().st_size
    assert file.header.config == config
    assert file.header.scale == 2.5
    assert file.frame_time_s == pytest.approx(TIMES_S)
    assert [record.num_frames for record in file.records] == [2, 1]
    assert [file.payload(0), file.payload(1)] == CHUNKS
    assert not file.cut_short


@pytest.mark.parametrize("time_s", [[0.0, 0.1, 0.5], [0.0, 0.4, 0.5], [5.0, 5.0, 5.0]])
def test_uneven_times_and_an_unknown_scale(time_s: list[float], path: Path):
    path.write_bytes(packed(scale=float("nan"), time_s=np.array(time_s)))
    file = MmwFile(path)
    assert file.header.scale != file.header.scale
    assert file.frame_time_s == pytest.approx(time_s, abs=1e-9)


@pytest.mark.parametrize("times_s", [[0.0, np.nan, 0.2], [0.0, 0.1, 1e300], [-1e15, 0.1, 0.2]])
def test_frames_at_impossible_times_are_refused(times_s: list[float], path: Path):
    """Their checksums are right: a writer at fault, or one who means harm."""
    header = header_for(AWR1843, 1.0, TIMES_S)
    path.write_bytes(pack_mmw(header, CHUNKS, [np.array(times_s[:2]), np.array(times_s[2:])]))
    with pytest.raises(InputError, match="times"):
        MmwFile(path)


def test_the_header_is_short():
    assert len(packed()) < sum(map(len, CHUNKS)) + 75
    assert len(packed(replace(AWR1843, name="mine", num_loops=16))) < sum(map(len, CHUNKS)) + 110


def test_any_changed_byte_is_noticed(path: Path):
    data = packed()
    for at in range(len(data)):
        for flip in (0x01, 0x80, 0xFF):
            path.write_bytes(data[:at] + bytes([data[at] ^ flip]) + data[at + 1 :])
            with pytest.raises(InputError):
                _read_all(path)


def test_a_file_cut_anywhere_holds_its_whole_chunks(path: Path):
    data = packed()
    path.write_bytes(data)
    first = MmwFile(path).places[1].start  # where the second record begins
    for at in range(len(data)):
        path.write_bytes(data[:at])
        if at < first:
            with pytest.raises(InputError):
                MmwFile(path)
        else:
            file = MmwFile(path)
            assert file.cut_short == at - first
            assert [file.payload(index) for index in range(len(file.records))] == CHUNKS[:1]


def test_a_damaged_length_is_damage_and_not_a_file_cut_short(path: Path):
    path.write_bytes(packed())
    data, at = bytearray(path.read_bytes()), MmwFile(path).places[1].start
    data[at + 2] ^= 0xFF  # far beyond the end of the file
    path.write_bytes(data)
    with pytest.raises(InputError, match="chunk 1"):
        MmwFile(path)


def test_foreign_and_missing_files_have_one_clear_line(path: Path, tmp_path: Path):
    path.write_bytes(b"PK\x03\x04" + bytes(100))
    with pytest.raises(InputError, match=r"a\.mmw is no"):
        MmwFile(path)
    with pytest.raises(InputError, match="cannot read"):
        MmwFile(tmp_path / "none.mmw")
    with pytest.raises(InputError, match="cannot read"):
        MmwFile(tmp_path)
    newer = packed()
    path.write_bytes(newer[:4] + b"\x09" + newer[5:])
    with pytest.raises(InputError, match="version 9"):
        MmwFile(path)


def test_listed_chunks_of_version_2_are_found(path: Path):
    values = {"radar": {"preset": "awr1843"}, "frame_start_s": 1.0, "frame_period_s": 0.1, "chunks": [[2, 60], [1, 12]]}
    path.write_bytes(_version_2(values))
    file = MmwFile(path)
    assert [file.payload(0), file.payload(1)] == CHUNKS
    assert file.frame_time_s == pytest.approx(TIMES_S)


@pytest.mark.parametrize(
    "change",
    [
        {"chunks": [[2, 60], [1, 10**12]]}, {"chunks": [[10**12, 60], [1, 12]]}, {"chunks": [[2, -60], [1, 12]]},
        {"frame_start_s": 1e400}, {"radar": {"preset": "none"}}, {"radar": {}}, {"chunks": []},
    ],
)  # fmt: skip
def test_impossible_headers_are_refused_before_anything_is_reserved(change: dict, path: Path):
    values = {"radar": {"preset": "awr1843"}, "frame_start_s": 1.0, "frame_period_s": 0.1, "chunks": [[2, 60], [1, 12]]}
    path.write_bytes(_version_2(values | change))
    with pytest.raises(InputError, match="damaged"):
        MmwFile(path)


def _version_2(values: dict) -> bytes:
    packer = zlib.compressobj(9, zlib.DEFLATED, -15, 9, zlib.Z_DEFAULT_STRATEGY, WORDS)
    body = packer.compress(json.dumps(values).encode()) + packer.flush()
    front = PREFIX.pack(b"MMWV", 2, len(body)) + body
    checked = [struct.pack("<I", zlib.crc32(part)) for part in (front, *CHUNKS)]
    return front + checked[0] + b"".join(chunk + check for chunk, check in zip(CHUNKS, checked[1:], strict=True))


def _read_all(path: Path) -> None:
    file = MmwFile(path)
    if file.cut_short:
        raise InputError("cut short")
    for index in range(len(file.records)):
        file.payload(index)
