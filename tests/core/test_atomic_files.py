"""A file or folder is whole or not there."""

from pathlib import Path

import pytest

from mmweaver.core.atomic_files import atomic_file, staged_folder
from mmweaver.core.errors import InputError


def test_a_failed_write_leaves_the_old_file(tmp_path: Path):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with pytest.raises(RuntimeError), atomic_file(target) as path:
        path.write_text("half")
        raise RuntimeError
    assert target.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == ["a.txt"]


def test_a_failed_folder_leaves_nothing(tmp_path: Path):
    with pytest.raises(RuntimeError), staged_folder(tmp_path / "out") as stage:
        (stage / "a.txt").write_text("half")
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []


def test_a_full_folder_is_refused_and_overwritten_on_demand(tmp_path: Path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("keep")
    with pytest.raises(InputError, match="--overwrite"), staged_folder(out):
        pass
    with staged_folder(out, overwrite=True) as stage:
        (stage / "new.txt").write_text("new")
    assert sorted(file.name for file in out.iterdir()) == ["mine.txt", "new.txt"]
    assert [file.name for file in tmp_path.iterdir()] == ["out"]


def test_a_full_disk_is_one_clear_line(tmp_path: Path):
    with pytest.raises(InputError, match="cannot write"), staged_folder(tmp_path / "out"):
        raise OSError(28, "No space left on device")
    assert list(tmp_path.iterdir()) == []
