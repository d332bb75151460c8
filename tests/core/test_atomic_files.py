"""A file or folder is whole or not there, whenever the process dies and whatever the disk answers."""

import contextlib
import functools
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from mmweaver.core.atomic_files import atomic_file, atomic_files, staged_folder
from mmweaver.core.checksums import SUMS_FILE, damages, read_sums
from mmweaver.core.errors import InputError
from mmweaver.core.output_checks import check_output_file
from mmweaver.core.staging import COMMITTED, staging_path


def names(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.iterdir())


def test_a_failed_write_leaves_the_old_file(tmp_path: Path):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with pytest.raises(RuntimeError), atomic_file(target) as path:
        path.write_text("half")
        raise RuntimeError
    assert target.read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_a_failed_folder_leaves_nothing_not_even_the_folders_above(tmp_path: Path):
    with pytest.raises(RuntimeError), staged_folder(tmp_path / "new" / "out") as stage:
        (stage / "a.txt").write_text("half")
        raise RuntimeError
    assert names(tmp_path) == []


def test_a_full_folder_is_refused_and_overwritten_on_demand(tmp_path: Path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("keep")
    with pytest.raises(InputError, match="--overwrite"), staged_folder(out):
        pass
    with staged_folder(out, overwrite=True) as stage:
        (stage / "new.txt").write_text("new")
    assert names(out) == [SUMS_FILE, "mine.txt", "new.txt"]
    assert names(tmp_path) == ["out"]
    assert set(read_sums(out) or {}) == {"new.txt"}


def test_files_that_stay_keep_their_checksums(tmp_path: Path):
    for name in ("old", "new"):
        with staged_folder(tmp_path, overwrite=True) as stage:
            (stage / "both.txt").write_text(name)
            (stage / f"{name}.txt").write_text(name)
    assert set(read_sums(tmp_path) or {}) == {"both.txt", "old.txt", "new.txt"}
    assert damages(tmp_path) == []


def test_an_interruption_leaves_all_files_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def interrupted(_: Path) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), atomic_files(tmp_path / "a.txt", tmp_path / "b.txt") as paths:
        for path in paths:
            path.write_text("new")
        monkeypatch.setattr("mmweaver.core.atomic_files.sync", interrupted)
    assert names(tmp_path) == []


def test_an_existing_folder_is_filled_and_stays_the_same_folder(tmp_path: Path):
    """It may be a mount point, or the working directory of a shell."""
    before = tmp_path.stat().st_ino
    with staged_folder(tmp_path) as stage:
        (stage / "a.txt").write_text("a")
    assert tmp_path.stat().st_ino == before
    assert names(tmp_path) == [SUMS_FILE, "a.txt"]


@pytest.mark.parametrize("moved", [0, 1, 2])
def test_moving_into_a_folder_that_was_interrupted_is_finished(tmp_path: Path, moved: int):
    """Old and new files mixed do not match the checksums; the next to write there moves the rest."""
    for name in ("a.txt", "b.txt"):
        (tmp_path / name).write_text("old")
    with staged_folder(tmp_path / "new") as stage:
        for name in ("a.txt", "b.txt"):
            (stage / name).write_text("new")
    committed = (tmp_path / "new").rename(tmp_path / COMMITTED)
    for name in (SUMS_FILE, "a.txt")[:moved]:
        (committed / name).rename(tmp_path / name)
    assert (len(damages(tmp_path)) > 0) == (moved > 0)
    with pytest.raises(InputError, match="not empty"), staged_folder(tmp_path):
        pass
    assert [(tmp_path / name).read_text() for name in ("a.txt", "b.txt")] == ["new", "new"]
    assert names(tmp_path) == [SUMS_FILE, "a.txt", "b.txt"]
    assert damages(tmp_path) == []


class _Killed(BaseException):
    """The process ends here."""


@pytest.mark.parametrize("at", range(1, 7))
@pytest.mark.parametrize("before", [(), ("a.txt", "b.txt", "z.txt")], ids=["empty", "full"])
def test_a_folder_that_is_filled_in_part_never_matches_its_checksums(
    tmp_path: Path, before: tuple[str, ...], at: int, monkeypatch: pytest.MonkeyPatch
):
    """Killed at any rename: all is old, or all is new, or a reader is told that something is damaged or missing."""
    out, texts = tmp_path / "out", ("a.txt", "b.txt", "z.txt")
    out.mkdir()
    if before:
        write(out, before, "old")
    count = 0

    def renamed(rename: Callable[..., None], *places: object) -> None:
        nonlocal count
        count += 1
        if count >= at:
            raise _Killed
        rename(*places)

    with monkeypatch.context() as patch, contextlib.suppress(_Killed):
        for name in ("rename", "replace"):
            patch.setattr(os, name, functools.partial(renamed, getattr(os, name)))
        write(out, texts, "new")
    is_old = {name: (out / name).read_text() for name in texts if (out / name).exists()} == dict.fromkeys(before, "old")
    is_new = all((out / name).exists() and (out / name).read_text() == "new" for name in texts)
    assert is_old or is_new or damages(out) != []
    write(out, texts, "newer")
    assert damages(out) == []
    assert {(out / name).read_text() for name in texts} == {"newer"}


def write(out: Path, texts: tuple[str, ...], content: str) -> None:
    with staged_folder(out, overwrite=True) as stage:
        for name in texts:
            (stage / name).write_text(content)


def test_files_that_belong_together_are_all_there_or_none(tmp_path: Path):
    first, second = tmp_path / "a.txt", tmp_path / "b.txt"
    with pytest.raises(InputError, match=r"a\.txt"), atomic_files(first, second) as stages:
        stages[0].write_text("a")
        raise OSError(28, "No space left on device")
    assert names(tmp_path) == []
    second.mkdir()  # so that the second cannot be renamed
    with pytest.raises(InputError, match=r"a\.txt"), atomic_files(first, second) as stages:
        stages[0].write_text("a")
    assert names(tmp_path) == ["b.txt"]


def test_what_dead_processes_left_is_removed_and_what_living_ones_write_is_not(tmp_path: Path):
    code = "import sys; from pathlib import Path; from mmweaver.core.staging import staging_path;"
    code += "staging_path(Path(sys.argv[1])).mkdir(); staging_path(Path(sys.argv[1])).write_text('')"
    living = staging_path(tmp_path / "walk.npz")
    living.write_text("")
    # the number of a living process, as another one had it before
    reused = living.with_name(living.name.replace(f"-{os.getpid()}-", f"-{os.getpid()}-1"))
    reused.mkdir()
    target = tmp_path / "walk.png"
    subprocess.run([sys.executable, "-c", code, str(target)], check=False)
    subprocess.run([sys.executable, "-c", code.replace("mkdir()", "write_text('')"), str(target)], check=True)
    (tmp_path / ".walk.png.mine").write_text("keep")
    with atomic_file(target) as temporary:
        temporary.write_text("new")
    assert names(tmp_path) == sorted([".walk.png.mine", living.name, "walk.png"])


@pytest.mark.parametrize(("age_s", "is_kept"), [(0.0, True), (3000.0, True), (4000.0, False)])
@pytest.mark.parametrize("kind", ["file", "folder"])
def test_what_another_host_writes_stays_for_an_hour_after_its_last_change(
    tmp_path: Path, kind: str, age_s: float, is_kept: bool
):
    """Its processes cannot be asked here; of a folder the newest file inside counts."""
    own = staging_path(tmp_path / "walk.npz").name
    place, process = own.rpartition(".mmweaver-")[2].split("-")[:2]
    other = tmp_path / own.replace(place, "0" * 8 if place[0] != "0" else "f" * 8).replace(f"-{process}-", "-1-")
    inside = [other]
    if kind == "folder":
        other.mkdir()
        inside = [other / "radar.npz", other]
    for path in inside[:1]:
        path.write_text("half")
    then = time.time() - age_s
    os.utime(inside[0], (then, then))
    if kind == "folder":
        os.utime(other, (then - 9000, then - 9000))
    with atomic_file(tmp_path / "a.txt") as temporary:
        temporary.write_text("mine")
    assert other.exists() == is_kept


def test_a_link_that_was_named_is_followed(tmp_path: Path):
    (tmp_path / "real").mkdir()
    (tmp_path / "out").symlink_to("real")
    (tmp_path / "file.txt").symlink_to("real/file.txt")
    check_output_file(tmp_path / "file.txt", overwrite=False)
    with staged_folder(tmp_path / "out") as stage:
        (stage / "a.txt").write_text("a")
    with atomic_file(tmp_path / "file.txt") as temporary:
        temporary.write_text("b")
    assert (tmp_path / "real" / "file.txt").read_text() == "b"
    assert (tmp_path / "out").is_symlink()
    assert (tmp_path / "file.txt").is_symlink()


def test_a_link_that_is_found_is_replaced(tmp_path: Path):
    (tmp_path / "theirs.txt").write_text("theirs")
    (tmp_path / "file.txt").symlink_to("theirs.txt")
    with atomic_file(tmp_path / "file.txt") as temporary:
        temporary.write_text("mine")
    assert (tmp_path / "theirs.txt").read_text() == "theirs"
    assert (tmp_path / "file.txt").read_text() == "mine"
    assert not (tmp_path / "file.txt").is_symlink()


def test_a_file_that_another_command_replaces_leaves_the_checksums(tmp_path: Path):
    with staged_folder(tmp_path / "out") as stage:
        (stage / "a.txt").write_text("a")
        (stage / "b.txt").write_text("b")
    with atomic_file(tmp_path / "out" / "a.txt") as temporary:
        temporary.write_text("another")
    assert set(read_sums(tmp_path / "out") or {}) == {"b.txt"}


def test_the_longest_name_that_fits_can_be_written(tmp_path: Path):
    target = tmp_path / ("a" * 251 + ".npz")
    with atomic_file(target) as temporary:
        temporary.write_text("")
        assert temporary.suffix == ".npz"
    assert target.is_file()
