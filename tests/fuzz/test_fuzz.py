"""Every reader under hostile input: the minimised failures of the past, and new damage in a bounded number of cases."""

import os
from pathlib import Path

import pytest

from mmweaver.core.errors import MAX_CHARACTERS, InputError
from mmweaver.core.safe_files.regular_files import read_bytes
from tests.fuzz.corpus import corpus
from tests.fuzz.harness import Reader, Report, fuzz, try_case
from tests.fuzz.readers import make_readers

FEW = {"mmw": 4}  # of this many times fewer cases, as decoding takes long


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fuzz")


@pytest.fixture(scope="module")
def readers(folder: Path) -> dict[str, Reader]:
    return {reader.name: reader for reader in make_readers(folder)}


def test_what_once_failed_is_refused(readers: dict[str, Reader], folder: Path):
    for name, what, data in corpus():
        report = Report(name=name)
        try_case(readers[name], folder / f"case{readers[name].suffix}", data, report)
        assert not report.failures, f"{name}, {what}: {dict(report.failures)}"
        assert report.refused == 1, f"{name}, {what} is accepted"


@pytest.mark.parametrize("cases", [12, pytest.param(60, marks=pytest.mark.slow)])
def test_damaged_files_are_refused_in_one_line_or_read_soundly(cases: int, readers: dict[str, Reader], folder: Path):
    for reader in readers.values():
        report = fuzz(reader, folder, seed=14, cases=range(cases // FEW.get(reader.name, 1)))
        assert not report.failures, f"{reader.name}: {dict(report.failures)}"
        assert report.refused > 0, f"{reader.name}: no damage was noticed"


def test_only_regular_files_are_opened(tmp_path: Path):
    os.mkfifo(tmp_path / "fifo")
    for place in (tmp_path / "fifo", Path("/dev/zero"), tmp_path, tmp_path / "none", Path("a\0b")):
        with pytest.raises(InputError, match="cannot read"):
            read_bytes(place, max_bytes=10)


def test_a_refusal_is_one_line_of_at_most_500_characters():
    text = str(InputError("bad\nvalue " + "x" * 500_000 + "\x1b[31m\u202e; do this"))
    assert len(text) <= MAX_CHARACTERS
    assert text.isprintable()
    assert text.endswith("do this")
