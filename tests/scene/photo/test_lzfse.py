"""LZFSE: stored blocks without a library, others with it, and no block that unpacks to more than it may."""

import importlib.util
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo.lzfse import read_lzfse, unpacked_length


def test_a_compressed_file_needs_the_library_and_gives_its_content(tmp_path: Path):
    # a block of which the header alone is sound
    block = b"bvxn" + (40).to_bytes(4, "little") + (3).to_bytes(4, "little") + b"\x06\0\0" + b"bvx$"
    assert unpacked_length(block) == 40
    (tmp_path / "a").write_bytes(block)
    with pytest.raises(InputError, match="50 bytes"):
        read_lzfse(tmp_path / "a", 50)
    if importlib.util.find_spec("liblzfse") is None:
        with pytest.raises(InputError, match="pip install pyliblzfse"):
            read_lzfse(tmp_path / "a", 40)


def test_the_library_reads_what_it_wrote(tmp_path: Path):
    library = pytest.importorskip("liblzfse")
    content = bytes(range(256)) * 400
    (tmp_path / "a").write_bytes(library.compress(content))
    assert read_lzfse(tmp_path / "a", len(content)) == content


@pytest.mark.parametrize("data", [b"", b"abcd", b"bvx-\xff\xff\xff\x7f", b"bvx2" + bytes(28)])
def test_anything_else_is_no_stream(data: bytes, tmp_path: Path):
    (tmp_path / "a").write_bytes(data)
    with pytest.raises(InputError):
        read_lzfse(tmp_path / "a", 100)
