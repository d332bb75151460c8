from dataclasses import replace
from pathlib import Path

import pytest

from mmweaver.compression.mmw_container import MmwFile, MmwHeader, pack_mmw, write_mmw
from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843, BGT60

CHUNKS = [bytes(range(60)), b"second chunk"]


def header(config=AWR1843, **more) -> MmwHeader:
    values = {"config": config, "scale": 2.5, "frame_time_s": (1.0, 1.1, 1.2), "chunk_frames": (2, 1)}
    return MmwHeader(**(values | more))


@pytest.mark.parametrize("config", [AWR1843, BGT60, replace(AWR1843, name="mine", num_loops=16)], ids=lambda c: c.name)
def test_header_and_chunks_round_trip(config, tmp_path: Path):
    size = write_mmw(tmp_path / "a.mmw", header(config), CHUNKS)
    file = MmwFile(tmp_path / "a.mmw")
    assert size == file.num_bytes == (tmp_path / "a.mmw").stat().st_size
    assert file.header.config == config
    assert file.header.scale == 2.5
    assert file.header.frame_time_s == pytest.approx((1.0, 1.1, 1.2))
    assert [file.chunk(0), file.chunk(1)] == CHUNKS


def test_uneven_times_and_an_unknown_scale(tmp_path: Path):
    write_mmw(tmp_path / "a.mmw", header(scale=float("nan"), frame_time_s=(0.0, 0.1, 0.5)), CHUNKS)
    again = MmwFile(tmp_path / "a.mmw").header
    assert again.scale != again.scale
    assert again.frame_time_s == (0.0, 0.1, 0.5)


def test_the_header_is_short():
    assert len(pack_mmw(header(), CHUNKS)) < sum(map(len, CHUNKS)) + 110
    assert len(pack_mmw(header(replace(AWR1843, name="mine", num_loops=16)), CHUNKS)) < 600


def test_any_changed_byte_is_noticed(tmp_path: Path):
    data = pack_mmw(header(), CHUNKS)
    path = tmp_path / "a.mmw"
    for at in range(len(data)):
        for flip in (0x01, 0x80, 0xFF):
            path.write_bytes(data[:at] + bytes([data[at] ^ flip]) + data[at + 1 :])
            with pytest.raises(InputError):
                _read_all(path)


def test_any_cut_and_anything_added_is_noticed(tmp_path: Path):
    data = pack_mmw(header(), CHUNKS)
    path = tmp_path / "a.mmw"
    for at in range(len(data)):
        path.write_bytes(data[:at])
        with pytest.raises(InputError):
            _read_all(path)
    path.write_bytes(data + b"\0")
    with pytest.raises(InputError, match="bytes where its header"):
        _read_all(path)


def test_foreign_and_missing_files_have_one_clear_line(tmp_path: Path):
    (tmp_path / "a.mmw").write_bytes(b"PK\x03\x04" + bytes(100))
    with pytest.raises(InputError, match=r"is no \.mmw file"):
        MmwFile(tmp_path / "a.mmw")
    with pytest.raises(InputError, match="cannot read"):
        MmwFile(tmp_path / "none.mmw")
    with pytest.raises(InputError, match="cannot read"):
        MmwFile(tmp_path)
    newer = pack_mmw(header(), CHUNKS)
    (tmp_path / "a.mmw").write_bytes(newer[:4] + b"\x09" + newer[5:])
    with pytest.raises(InputError, match="version 9"):
        MmwFile(tmp_path / "a.mmw")


def _read_all(path: Path) -> None:
    file = MmwFile(path)
    for index in range(len(file.header.chunk_bytes)):
        file.chunk(index)
