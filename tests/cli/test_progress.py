"""The bar shows on a terminal after two seconds, and nowhere else."""

import io
import sys
import time

import pytest
import tqdm  # noqa: F401  (its first import takes longer than the test waits)

from mmweaver.cli import progress
from mmweaver.cli.progress import StageBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    stream = Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(progress, "REFRESH_S", 0.01)
    return stream


def work(seconds: float, *, quiet: bool = False) -> None:
    with StageBar(2, quiet=quiet) as bar:
        bar("first")
        bar("second")
        time.sleep(seconds)


def test_long_work_on_a_terminal_shows_its_stage(terminal: Terminal, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(progress, "PATIENCE_S", 0.01)
    work(0.3)
    assert "second" in terminal.getvalue()
    assert "1/2" in terminal.getvalue()


def test_short_work_shows_nothing(terminal: Terminal):
    work(0.05)
    assert terminal.getvalue() == ""


def test_quiet_work_and_pipes_show_nothing(terminal: Terminal, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(progress, "PATIENCE_S", 0.01)
    work(0.1, quiet=True)
    assert terminal.getvalue() == ""
    pipe = io.StringIO()
    monkeypatch.setattr(sys, "stderr", pipe)
    work(0.1)
    assert pipe.getvalue() == ""
