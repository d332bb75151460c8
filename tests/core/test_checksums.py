"""Damage of a listed file is noticed; other files are read as they are."""

import shutil
import subprocess
from pathlib import Path

import pytest

from mmweaver.core.checksums import SUMS_FILE, check_file, damages, write_sums
from mmweaver.core.errors import InputError


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "below").mkdir()
    (tmp_path / "a.npz").write_bytes(bytes(1000))
    (tmp_path / "below" / "b.txt").write_text("b")
    write_sums(tmp_path)
    return tmp_path


def test_a_flipped_bit_and_a_missing_file_are_noticed(folder: Path):
    file = folder / "a.npz"
    check_file(file)
    file.write_bytes(bytes(999) + b"\x10")
    with pytest.raises(InputError, match=r"a\.npz .*mmweaver verify"):
        check_file(file)
    file.unlink()
    with pytest.raises(InputError, match=r"a\.npz is missing"):
        check_file(file)
    (folder / "below" / "b.txt").write_text("c")
    assert [damage.file.name for damage in damages(folder)] == ["a.npz", "b.txt"]
    (folder / SUMS_FILE).unlink()
    check_file(folder / "below" / "b.txt", folder=folder)
    assert damages(folder) == []


def test_damage_of_the_list_itself_is_noticed(folder: Path):
    text = (folder / SUMS_FILE).read_bytes()
    for damaged in (text[:-1], text[:-40], text.replace(b"  a.npz", b" ?a.npz"), b"#" + text[3:], text + b"x"):
        (folder / SUMS_FILE).write_bytes(damaged)
        with pytest.raises(InputError, match="damaged"):
            check_file(folder / "a.npz")


def test_lists_of_others_are_left_to_them(folder: Path):
    (folder / SUMS_FILE).write_text("0000  a.npz\n")
    check_file(folder / "a.npz")


def test_sha256sum_reads_it(folder: Path):
    if shutil.which("sha256sum") is None:
        pytest.skip("no sha256sum here")
    done = subprocess.run(["sha256sum", "-c", SUMS_FILE], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
