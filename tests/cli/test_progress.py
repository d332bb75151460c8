"""The bar shows on a terminal after two seconds, and nowhere else."""

import io
import sys
import time

import pytest
import tqdm  # noqa: F401  (its first import takes longer than the test waits)

from mmweaver.cli.progress import StageBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def shown(monkeypatch: pytest.MonkeyPatch, stream: io.StringIO, *, patience_s: float, quiet: bool = False) -> str:
    """What work writes to stderr; patched here, for pytest puts its own stderr back after set-up."""
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", stream)
        with StageBar(2, quiet=quiet, patience_s=patience_s) as bar:
            bar("first")
            time.sleep(0.2)
            bar("second")
    return stream.getvalue()


def test_long_work_on_a_terminal_shows_its_stage(monkeypatch: pytest.MonkeyPatch):
    text = shown(monkeypatch, Terminal(), patience_s=0.01)
    assert "second" in text
    assert "1/2" in text
