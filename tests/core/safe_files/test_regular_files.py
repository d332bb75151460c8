"""Only regular files are opened, of a bounded size, and libraries' words become one line."""

import os
import socket
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import check_exists, check_regular, foreign_errors, open_regular, read_bytes


def test_a_file_is_read_whole_or_refused(tmp_path: Path):
    (tmp_path / "a").write_bytes(b"x" * 3_000_000)
    assert check_regular(tmp_path / "a") == 3_000_000
    assert read_bytes(tmp_path / "a", max_bytes=3_000_000) == b"x" * 3_000_000
    with pytest.raises(InputError, match=r"a .*2\.86"):
        read_bytes(tmp_path / "a", max_bytes=2_999_999)


def test_a_path_that_names_nothing_is_said(tmp_path: Path):
    check_exists(tmp_path, "a folder")
    with pytest.raises(InputError, match=r"absent.*folder"):
        check_exists(tmp_path / "absent", "a folder")


def test_links_are_followed(tmp_path: Path):
    (tmp_path / "a").write_bytes(b"held")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with open_regular(tmp_path / "b") as file:
        assert file.read() == b"held"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no FIFO here")
def test_what_is_no_regular_file_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link").symlink_to(tmp_path / "fifo")
    with socket.socket(socket.AF_UNIX) as listening:
        monkeypatch.chdir(tmp_path)  # names of sockets are short
        listening.bind("socket")
        kinds = {"fifo": "a FIFO", "link": "a FIFO", "socket": "a socket", ".": "a folder", "/dev/zero": "a device"}
        for name, kind in kinds.items():
            with pytest.raises(InputError, match=kind):
                open_regular(tmp_path / name)
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    with pytest.raises(InputError, match="loop"):
        open_regular(tmp_path / "loop")


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (ValueError("two\nlines"), r"a\.npy.*two lines"),
        (KeyError("x"), "is damaged"),
        (MemoryError(), "needs more memory than there is"),
        (FileNotFoundError(2, "No such file"), r"a\.npy.*No such file"),
        (OSError("no code"), "no code"),
        (RuntimeError("set allow_pickle=True"), "pickled objects"),
        (RuntimeError(), "RuntimeError"),
        (InputError("our own words"), "our own words"),
    ],
)
def test_what_a_library_raises_becomes_one_line(error: Exception, message: str):
    with (
        pytest.raises(InputError, match=message) as caught,
        foreign_errors("a.npy", "damaged ({reason}); give another"),
    ):
        raise error
    assert "\n" not in str(caught.value)


def test_our_own_interrupts_pass():
    with pytest.raises(KeyboardInterrupt), foreign_errors("a", "damaged ({reason})"):
        raise KeyboardInterrupt
